"""Shafts on several bearings in static equilibrium: loads, stiffness, preload, and the start of runs."""

from __future__ import annotations

import math
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest

import trbdyn as trb
from trbdyn import (
    Assembly,
    InputError,
    LoadError,
    PreloadSpring,
    Scene,
    Shaft,
    ShaftBearing,
    ShaftLoad,
    Simulation,
)
from trbdyn.statics.assembly import ShaftEquilibrium
from trbdyn.statics.seat import Seat
from trbdyn.statics.seating import seating_of

BEARING = trb.cases.rig_30310()
OTHER = trb.cases.bearing_32216()
SHAFT = Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
FORCES = (
    ShaftLoad(position=0.13, force=(300.0, -900.0, 0.0)),
    ShaftLoad.gear(position=0.02, pitch_diameter=0.09, torque=180.0, helix_angle_deg=15.0, direction_deg=70.0),
    ShaftLoad(position=-0.01, moment=(20.0, -35.0)),
)


def pair(arrangement: Any = "back to back", *, end_play: float = -20e-6, **given: Any) -> Assembly:
    values = {"spread": 0.15 if arrangement == "back to back" else 0.1, "shaft": SHAFT, "speed_rpm": 3000.0} | given
    return Assembly.pair(BEARING, arrangement, end_play=end_play, **values)


def tandem(small_ends: Any, push: float) -> Assembly:
    bearings = [ShaftBearing(BEARING, position=place, small_ends=small_ends) for place in (-0.05, 0.08)]
    return Assembly(
        shaft=SHAFT,
        bearings=bearings,
        loads=(ShaftLoad(position=0.03, force=(100.0, -600.0, push)),),
        speed_rpm=-1500.0,
    )


CASES = {
    "back to back": pair(loads=FORCES),
    "face to face": pair("face to face", loads=FORCES),
    "end play": pair(loads=FORCES, end_play=60e-6),
    "two sizes": pair(loads=FORCES, other=OTHER),
    "tandem to the left": tandem("left", -4000.0),
    "tandem to the right": tandem("right", 4000.0),
}
with_cases = pytest.mark.parametrize("assembly", CASES.values(), ids=CASES)
with_quick_cases = pytest.mark.parametrize(
    "assembly",
    [
        pytest.param(one, id=name, marks=[pytest.mark.slow] * (name in ("end play", "two sizes")))
        for name, one in CASES.items()
    ],
)


def moments_about_origin(found: ShaftEquilibrium) -> np.ndarray:
    """Forces and moments about the origin of all that acts on the shaft, where it stands (N, N m)."""
    total, axis = np.zeros(6), np.array([math.sin(found.tilt[1]), -math.sin(found.tilt[0]), 1.0])
    for load in found.assembly.acting():
        force, moment = np.array(load.force), np.array([*load.moment, 0.0])
        total[:3] += force
        total[3:] += np.cross(load.position * axis + [*load.offset, 0.0], force) + moment
    for one, answer in zip(found.assembly.bearings, found.bearings, strict=True):
        total[:3] -= answer.force
        total[3:] -= np.cross(one.centre_plane * axis, answer.force) + np.append(answer.moment, 0.0)
    return total


@with_cases
def test_forces_and_moments_balance(assembly: Assembly) -> None:
    """Summed by hand about another point than that of the search, to second order in the small tilt."""
    total = moments_about_origin(trb.equilibrium(assembly))
    assert np.abs(total[:3]).max() < 1e-5
    assert np.abs(total[3:5]).max() < 1e-4


@with_quick_cases
def test_a_run_begins_in_equilibrium(assembly: Assembly) -> None:
    """The rings of the core stand where the equilibrium has them, with its forces; its rollers' friction hardly moves the
    shaft."""
    found = trb.equilibrium(assembly)
    simulation = Simulation(assembly)
    for name, record in simulation.record().items():
        one = found[name]
        assert record["ring_position"] == pytest.approx(one.displacement[:3], abs=1e-12)
        # rollers without load begin away from the rib, to which their centrifugal force takes them
        away = 15.0 * np.count_nonzero(one.inner_load == 0.0)
        assert record["ring_force"][2] == pytest.approx(one.axial_load, rel=3e-4, abs=0.1 + away)
        assert np.hypot(*record["ring_force"][:2]) == pytest.approx(one.radial_load, rel=1e-3, abs=2.0)
    result = simulation.run(duration=2e-3)
    assert result.shaft_position[0] == pytest.approx(found.displacement(assembly.shaft.mass_position), abs=1e-12)
    assert result.shaft_displacement(0.1)[0] == pytest.approx(found.displacement(0.1), abs=1e-11)
    assert np.abs(result.shaft_position - result.shaft_position[0]).max() < 3e-7
    assert result.energy.closure < 3e-4


def test_the_seats_of_a_run_are_where_the_equilibrium_has_the_rings() -> None:
    """Two ways to compute where a ring stands, with a tilt a hundred times the usual one."""
    for assembly in CASES.values():
        found, seating = trb.equilibrium(assembly), seating_of(assembly)
        for one, seat in zip(found.bearings, seating.seats.values(), strict=True):
            assert isinstance(seat, Seat)
            assert seat.ring_place(seating.shaft) == pytest.approx(one.displacement, abs=1e-15)


def test_the_load_lines_cross_the_axis_at_the_load_centres() -> None:
    """A radial load in the middle between the load centres of two equal bearings is shared out equally."""
    load = ShaftLoad(position=0.0, force=(0.0, -3000.0, 0.0))
    for arrangement in ("back to back", "face to face"):
        found = trb.equilibrium(pair(arrangement, loads=(load,), gravity=(0.0, 0.0, 0.0)))
        left, right = found.bearings
        assert left.radial_load == pytest.approx(1500.0, rel=1e-8)
        assert right.radial_load == pytest.approx(1500.0, rel=1e-8)
        assert left.axial_load == pytest.approx(right.axial_load, rel=1e-8)


def test_preload_diagram_goes_through_the_operating_point() -> None:
    """A helical gear pushes along the axis at its pitch circle: the moment of this force shifts loads between the bearings, and
    acts at every point of the diagram."""
    shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    gear = trb.ShaftLoad.gear(position=0.02, pitch_diameter=0.2, torque=600.0, helix_angle_deg=20.0)
    pair = trb.Assembly.pair(
        trb.cases.rig_30310(), "back to back", spread=0.15, end_play=-40e-6, shaft=shaft, speed_rpm=3000, loads=[gear]
    )
    found = trb.equilibrium(pair)
    place = float(found.displacement()[2])
    diagram = trb.preload_diagram(pair, [place])
    for one in found.bearings:
        assert diagram.loads[one.name][0] == pytest.approx(one.axial_load, rel=1e-6)
    assert diagram.axial_force[0] == pytest.approx(gear.force[2], rel=1e-6)
    assert [one.axial_load for one in diagram.operating.bearings] == [one.axial_load for one in found.bearings]
    assert f"{found['left'].axial_load:.5g} N" in str(diagram)
    whole = trb.preload_diagram(pair)
    assert whole.displacement.min() < place < whole.displacement.max()


def test_preload_diagram_is_that_of_two_single_bearings() -> None:
    """Each at its own displacement, found by the equilibrium of a scene alone."""
    assembly = pair(gravity=(0.0, 0.0, 0.0))
    places = np.array([-15e-6, -5e-6, 0.0, 5e-6, 15e-6])
    diagram = trb.preload_diagram(assembly, places.tolist())
    for number, place in enumerate(places):
        loads = []
        for side, name in ((1.0, "left"), (-1.0, "right")):
            alone = Scene(BEARING, speed_rpm=-side * 3000.0, displacement=(0.0, 0.0, -10e-6 - side * place))
            record = trb.Simulation(alone).record()
            single = float(record["inner_force"][:, 2].sum()) if "inner_force" in record else None
            load = diagram.loads[name][number]
            loads.append(load)
            if single is not None:
                assert load == pytest.approx(abs(single), rel=1e-6)
        assert diagram.axial_force[number] == pytest.approx(loads[0] - loads[1], rel=1e-6, abs=1e-5)
    assert diagram.loads["left"][::-1] == pytest.approx(diagram.loads["right"], rel=1e-6)
    assert np.all(np.diff(diagram.loads["left"]) > 0.0)


@with_quick_cases
def test_stiffness_is_that_of_differences(assembly: Assembly) -> None:
    """Loads at a point that differ a little, and where the shaft then stands."""
    position = 0.04
    stiffness = trb.equilibrium(assembly).stiffness(position)
    assert stiffness == pytest.approx(stiffness.T, abs=1e-5 * np.abs(stiffness).max())
    steps = np.array([2.0, 2.0, 2.0, 0.1, 0.1])
    compliance = np.empty((5, 5))
    for axis, step in enumerate(steps):
        moved = []
        for sign in (1.0, -1.0):
            force, moment = np.zeros(3), np.zeros(2)
            (force if axis < 3 else moment)[axis % 3] = sign * step
            more = ShaftLoad(position=position, force=tuple(force), moment=tuple(moment))
            found = trb.equilibrium(assembly.replace(loads=(*assembly.loads, more)))
            moved.append(np.concatenate([found.displacement(position), found.tilt]))
        compliance[:, axis] = (moved[0] - moved[1]) / (2.0 * step)
    # forces (N) by moments (N m) have the arm of the bearings, about 0.1 m, in them
    assert stiffness @ compliance == pytest.approx(np.eye(5), abs=1e-2)


def test_a_spring_gives_its_force_whatever_the_shaft_does() -> None:
    """A soft spring on the right: the right bearing carries its force, and the left one the force and the axial load."""
    bearings = (
        ShaftBearing(BEARING, name="left", position=-0.075, small_ends="right"),
        ShaftBearing(BEARING, name="right", position=0.075, small_ends="left", spring=PreloadSpring(force=1500.0)),
    )
    for axial in (0.0, 2000.0):
        loads = (ShaftLoad(position=0.0, force=(0.0, 0.0, axial)),)
        assembly = Assembly(shaft=SHAFT, bearings=bearings, loads=loads, speed_rpm=3000.0, gravity=(0.0, 0.0, 0.0))
        found = trb.equilibrium(assembly)
        assert found["right"].axial_load == pytest.approx(1500.0, rel=1e-6)
        assert found["left"].axial_load == pytest.approx(1500.0 + axial, rel=1e-6)
        assert seating_of(assembly).seats["right"].shift == pytest.approx(found.outer_ring_places[1])
        assert found.outer_ring_places[1] < 0.0


def test_vibrations_are_those_of_mass_and_stiffness() -> None:
    """A heavy shaft without tilt: the axial frequency is that of the axial stiffness, and a speed splits the tilting ones."""
    heavy = Shaft(mass=500.0, inertia_axial=2.0, inertia_transverse=20.0)
    found = trb.equilibrium(pair(shaft=heavy, gravity=(0.0, 0.0, 0.0)))
    matrix = found.stiffness(0.0)
    axial = math.sqrt(matrix[2, 2] / heavy.mass) / (2.0 * math.pi)
    assert min(abs(found.modes().frequencies / axial - 1.0)) < 5e-3
    still, turning = found.modes(gyroscopic=False).frequencies, found.modes().frequencies
    assert np.min(np.diff(still)) < 1e-3
    assert np.min(np.diff(turning)) > np.min(np.diff(still))


def test_lives_of_the_whole_are_shorter_than_those_of_its_bearings() -> None:
    sheet = trb.rating(pair(loads=FORCES))
    own = [one.reference_life_hours for one in sheet.bearings.values()]
    whole = sheet.reference_life_hours
    assert whole is not None
    assert sum(life ** (-9.0 / 8.0) for life in own if life is not None) ** (-8.0 / 9.0) == pytest.approx(whole)


def test_loads_that_change_in_time_act_at_their_points() -> None:
    """A force history away from the first bearing: its moment comes with it, and repeating loads of two points add up."""
    step = trb.History.step([1e-3], [0.0, 800.0])
    wave = trb.History.harmonic(0.0, 300.0, frequency_hz=100.0)
    loads = (ShaftLoad(position=0.1, force=(step, 0.0, 0.0)), ShaftLoad(position=-0.02, force=(0.0, wave, wave)))
    assembly = pair(loads=loads)
    result = Simulation(assembly).run(duration=0.012, save_every=1e-4)
    signs = {
        name: np.array([1.0, -one.side, -one.side]) for name, one in zip(assembly.names, assembly.bearings, strict=True)
    }
    late = result.time > 2e-3
    held = sum(signs[name] * one.ring_force for name, one in result.items())[late]
    expected = np.column_stack(
        [step.value(result.time), wave.value(result.time) - 6.0 * 9.80665, wave.value(result.time)]
    )[late]
    assert np.abs((held + expected).mean(axis=0)).max() < 20.0
    work = sum(one["work_ring"][-1] for one in result.values())
    assert result.energy.closure < 1e-4
    assert work != 0.0


def test_run_up_under_a_torque() -> None:
    """The speed grows as torque less friction over the inertia about the axis says, with the first bearing either way round."""
    for arrangement in ("back to back", "face to face"):
        result = Simulation(pair(arrangement, speed_rpm=600.0, torque=8.0)).run(duration=0.02)
        signs = [-one.side for one in result.assembly.bearings] if result.assembly else []
        speed = signs[0] * result["left"]["shaft_speed"]
        assert speed[-1] > speed[0] == pytest.approx(600.0 * math.pi / 30.0)
        friction = sum(float(one["inner_torque"].mean()) for one in result.values())
        gained = (8.0 - abs(friction)) / SHAFT.inertia_axial * result.time[-1]
        assert speed[-1] - speed[0] == pytest.approx(gained, rel=0.05)
        assert result.energy.closure < 1e-4


@pytest.mark.parametrize(
    ("changed", "says"),
    [
        ({"end_play": 1e-3}, "end_play"),
        ({"end_play": 20e-6, "gravity": (0.0, 0.0, 0.0)}, "preload"),
        ({"spread": 0.02}, "rollers lie within"),
        (
            {"shaft": Shaft(mass=5.0, inertia_axial=1e-3, inertia_transverse=1e-3, unbalance=1e-4), "torque": 5.0},
            "unbalance",
        ),
        ({"speed_rpm": 1e9}, "speed_rpm"),
    ],
)
def test_bad_input(changed: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=says):
        Simulation(pair(**changed))


def test_what_nothing_holds_is_said() -> None:
    with pytest.raises(InputError, match="nothing else holds the shaft along its axis"):
        tandem("left", 100.0)
    with pytest.raises(LoadError, match="nothing holds the shaft"):
        trb.equilibrium(
            pair(end_play=100e-6, gravity=(0.0, 0.0, 0.0), loads=(ShaftLoad(position=0.0, moment=(1e-9, 0.0)),))
        )
    with pytest.raises(LoadError, match="cannot carry"):
        trb.equilibrium(pair(loads=(ShaftLoad(position=0.0, force=(0.0, 0.0, 1e9)),)))
    names = [
        ShaftBearing(BEARING, name="a", position=place, small_ends=way)
        for place, way in ((-0.1, "right"), (0.1, "left"))
    ]
    with pytest.raises(InputError, match="must differ"):
        Assembly(shaft=SHAFT, bearings=names, speed_rpm=1000.0)


@pytest.mark.parametrize("name", ["32208", "30310", "LM67048/10"])
def test_axial_stiffness_beside_the_formula_of_makers(name: str) -> None:
    """delta = 7.7e-5 Q^0.9/(l^0.8 sin alpha) is that of straight rollers, within 2 %; the sheet says what the profile does."""
    bearing = trb.Bearing.named(name)
    straight = bearing.replace({"roller.profile": trb.Profile.straight()})
    angle, length = math.radians(bearing.cup_half_angle_deg), 1e3 * bearing.roller.effective_length
    for share in (0.02, 0.1):
        axial = share * bearing.ratings.dynamic
        load = axial / (bearing.n_rollers * math.sin(angle))
        formula = 1e-3 * 7.7e-5 * load**0.9 / (length**0.8 * math.sin(angle))
        plain, profiled = (
            trb.stiffness(trb.Scene(one, speed_rpm=0.0, axial_load=axial)) for one in (straight, bearing)
        )
        assert -plain.displacement[2] == pytest.approx(formula, rel=0.02)
        assert plain.matrix[2, 2] == pytest.approx(axial / (0.9 * formula), rel=0.02)
        assert plain.with_straight_rollers is None
        assert profiled.with_straight_rollers == pytest.approx(plain.matrix[2, 2] / profiled.matrix[2, 2], rel=1e-6)
        assert 1.0 < profiled.with_straight_rollers < 2.0
    assert "a profile that nobody gave. With straight ones" in str(profiled)


def test_the_sheet_of_a_pair_says_what_the_profile_does() -> None:
    found = trb.stiffness(trb.load_assembly("pair_30310"))
    assert found.with_straight_rollers > 1.0
    assert "With straight ones" in str(found)


def test_stiffness_of_a_shaft_names_its_point() -> None:
    found = str(trb.stiffness(pair()))
    assert "Stiffness of the shaft at" in found
    assert "about the shaft's centre of mass, at" in " ".join(found.split())
    assert "roller-centre plane" not in found
    alone = str(trb.stiffness(trb.Scene(BEARING, speed_rpm=1000.0, axial_load=5000.0)))
    assert "Stiffness of the inner ring" in alone
    assert "about the roller-centre plane" in alone


@pytest.mark.parametrize("radius", [0.02, 0.3])
def test_a_drawing_shows_the_arrow_of_every_load(radius: float) -> None:
    """The road pushes a wheel far below its bearings: the arrow is drawn at the border, and tells where it acts."""
    road = trb.ShaftLoad.wheel(position=0.03, rolling_radius=radius, load=5000.0, cornering=0.3)
    hub = pair(speed_rpm=0.0, outer_speed_rpm=800.0, loads=(road,))
    with plt.rc_context():
        ax = trb.plot.shaft_drawing(hub)
        (low, high), (left, right) = ax.get_ylim(), ax.get_xlim()
        arrows = [text for text in ax.texts if getattr(text, "arrow_patch", None) is not None]
        assert len(arrows) == 1
        for z, y in (arrows[0].xy, arrows[0].xyann):
            assert left <= z <= right
            assert low <= y <= high
        assert arrows[0].xy[1] < arrows[0].xyann[1]  # on the spindle, down
        assert any("acts at y = -300 mm" in text.get_text() for text in ax.texts) == (radius > 0.1)
        plt.close(ax.get_figure())


def test_a_bearing_that_is_turned_over_is_said() -> None:
    two = pair(speed_rpm=1000.0)
    assert two.turned_over == tuple(name for name, one in zip(two.names, two.bearings, strict=True) if one.side > 0.0)
    (name,) = two.turned_over
    result = trb.Simulation(two, accuracy="fast").run(duration=2e-4)
    assert result[name].scene.speed_rpm == -1000.0
    said = " ".join(str(result).split())
    assert f"{name} is shown in axes of its own, turned by half a turn about x" in said
    assert said.count("axes of its own") == 1
