"""Cylindrical roller bearings, whose half angle is zero: geometry, equilibrium and motion against formulas for cylinders."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import ellipe

import trbdyn as trb
from trbdyn.model.contact_line import stations
from trbdyn.model.outlines import cone_outline, cup_outline
from trbdyn.results import fields
from trbdyn.results.peaks import from_row
from trbdyn.statics.core_model import normal_contacts
from trbdyn.statics.equilibrium import nominal_angles
from trbdyn.viewer.meshes import ears

Array = NDArray[np.float64]
PLACED = (None, None, 0.0)
SHARE = 2e-3
"""What a held load of a ring's contact may be off; TRB_PEAK_SHARE of the core."""


def bearing(flanges: str = "NU", clearance: float = 20e-6, **changes: Any) -> trb.Bearing:
    """16 rollers of 11 mm, of straight profile."""
    own = {"diameter": 11e-3, "effective_length": 10.6e-3, "profile": trb.Profile(kind="straight")}
    return trb.Bearing(
        n_rollers=16,
        cup_half_angle_deg=0.0,
        pitch_diameter=70.5e-3,
        radial_clearance=clearance,
        roller=trb.Roller(**{**own, **changes.pop("roller", {})}),
        ribs=trb.Ribs(flanges=flanges, **changes.pop("ribs", {})),  # type: ignore[arg-type]
        **changes,
    )


def scene(flanges: str = "NU", clearance: float = 20e-6, **changes: Any) -> trb.Scene:
    if flanges in ("NU", "N"):
        changes = {"displacement": PLACED, **changes}
    else:
        changes = {"axial_load": 500.0, **changes}
    given = {"bearing": bearing(flanges, clearance), "speed_rpm": 3000.0, "radial_load": 4000.0}
    return trb.Scene(**(given | changes))


def test_geometry_of_cylinders() -> None:
    geometry, density = bearing().geometry, 7810.0
    radius, total, pitch = 5.5e-3, bearing().roller.total_length, 70.5e-3
    mass = density * math.pi * radius**2 * total
    assert geometry.roller_half_angle == geometry.roller_axis_angle == geometry.cone_half_angle == 0.0
    assert geometry.apex_to_mid == geometry.centre_plane == geometry.roller_mass_offset == 0.0
    assert geometry.roller_mass == pytest.approx(mass, rel=1e-12)
    assert geometry.roller_inertia_axial == pytest.approx(0.5 * mass * radius**2, rel=1e-12)
    assert geometry.roller_inertia_transverse == pytest.approx(mass * (radius**2 / 4 + total**2 / 12), rel=1e-12)
    assert geometry.cage_speed_ratio == pytest.approx(0.5 * (1.0 - 11.0 / 70.5), rel=1e-12)
    assert geometry.outer_equivalent_radius == pytest.approx(1.0 / (1.0 / radius - 2.0 / (pitch + 11e-3)), rel=1e-12)
    assert geometry.inner_equivalent_radius == pytest.approx(1.0 / (1.0 / radius + 2.0 / (pitch - 11e-3)), rel=1e-12)
    assert geometry.sphere_radius == pytest.approx(50 * 11e-3)


def load_of(depth: float | Array, of: trb.Bearing) -> Any:
    """Palmgren's load of a roller, spread evenly along it."""
    length, modulus = of.roller.effective_length, of.geometry.effective_modulus
    return 0.356 * modulus * length ** (8.0 / 9.0) * np.maximum(depth, 0.0) ** (10.0 / 9.0)


@pytest.mark.parametrize("clearance", [-15e-6, 0.0, 20e-6, 80e-6])
@pytest.mark.parametrize("radial_load", [500.0, 20000.0])
def test_equilibrium_of_a_radial_load(clearance: float, radial_load: float) -> None:
    """Where the ring stands, each roller in balance between two raceways, solved by SciPy, pushes it as the load asks."""
    under = scene("NU", clearance, radial_load=radial_load)
    found = trb.Simulation(under).equilibrium
    geometry = under.bearing.geometry
    orbit = geometry.cage_speed_ratio * 100.0 * math.pi

    races = [0.5 * (70.5e-3 + side * (11e-3 + 0.5 * clearance)) for side in (1.0, -1.0)]

    def push(place: Array, angle: float) -> Array:
        """Force of the roller at an angle on an inner ring at a place."""
        outward = np.array([math.cos(angle), math.sin(angle)])

        def inner(radius: float) -> tuple[float, Array]:
            apart = radius * outward - place
            distance = float(np.linalg.norm(apart))
            return float(load_of(races[1] + 5.5e-3 - distance, under.bearing)), apart / distance

        def unbalanced(radius: float) -> float:
            load, normal = inner(radius)
            outer = load_of(radius + 5.5e-3 - races[0], under.bearing)
            return float(load * (normal @ outward) + geometry.roller_mass * orbit**2 * radius - outer)

        half = 0.5 * under.bearing.pitch_diameter
        load, normal = inner(brentq(unbalanced, half - 1e-3, half + 1e-3, xtol=1e-16))
        return -load * normal

    pushes = np.array([push(found.displacement[:2], angle) for angle in found.angles])
    np.testing.assert_allclose(pushes.sum(axis=0), [0.0, -radial_load], atol=1e-6 * radial_load)
    np.testing.assert_allclose(found.inner_load, np.linalg.norm(pushes, axis=1), rtol=1e-5, atol=1e-6 * radial_load)
    np.testing.assert_allclose(found.displacement[2:], 0.0)
    np.testing.assert_allclose(found.rollers[:, 1:], 0.0, atol=1e-9)


@pytest.mark.parametrize("flanges", ["NU", "NJ", "NUP", "N"])
def test_preload_by_a_negative_clearance(flanges: str) -> None:
    """Without a radial load each roller is pressed together by half of the clearance, a quarter at each raceway."""
    loose = {"displacement": PLACED, "axial_load": 0.0}
    preloaded = scene(flanges, -20e-6, radial_load=0.0, speed_rpm=10.0, **loose)
    found = trb.Simulation(preloaded).equilibrium
    expected = load_of(5e-6, preloaded.bearing)
    np.testing.assert_allclose(found.inner_load, expected, rtol=1e-3)
    np.testing.assert_allclose(found.outer_load, expected, rtol=1e-3)
    run = trb.Simulation(preloaded.replace(speed_rpm=3000.0)).run(duration=2e-3).summary()
    assert abs(run["energy_closure"]) < 1e-3
    assert abs(run["cage_slip"]) < 0.01


@pytest.mark.parametrize("flanges", ["NJ", "NUP"])
def test_ribs_carry_the_axial_load(flanges: str) -> None:
    """One rib of each ring at every roller, whose couple the raceways take up by their uneven load."""
    sim = trb.Simulation(scene(flanges))
    seen, geometry = sim.contacts(), sim.scene.bearing.geometry
    lean = math.cos(geometry.rib_normal_angle)
    assert seen["rib_load"].sum() * lean == pytest.approx(500.0, rel=1e-5)
    assert seen["outer_front_rib_load"].sum() * lean == pytest.approx(500.0, rel=1e-5)
    np.testing.assert_array_equal(seen["outer_rib_load"], 0.0)
    np.testing.assert_array_equal(seen["front_rib_load"], 0.0)
    heavy = np.argmax(seen["rib_load"])
    per_length, weight = (seen[f"raceway_{name}"][:, heavy] for name in ("load_per_length", "weight"))
    # the tilted roller rolls over on its spheres, and the faces lean: both make the couple smaller
    roller, force = sim.scene.bearing.roller, seen["rib_load"][heavy]
    height = 0.5 * roller.diameter - sim.scene.bearing.ribs.contact_height
    height -= geometry.sphere_radius * abs(sim.equilibrium.rollers[heavy, 2])
    couple = force * (2.0 * lean * height - abs(math.sin(geometry.rib_normal_angle)) * roller.total_length)
    # raceways: the outer one is loaded more towards one end, the inner one towards the other
    moments = np.sum(per_length * weight * stations(sim.scene), axis=-1)
    assert abs(moments[0] - moments[1]) == pytest.approx(couple, rel=3e-3)
    assert np.sign(moments[0]) == -np.sign(moments[1])


@pytest.mark.parametrize("flanges", ["NU", "NJ", "NUP", "N"])
def test_it_rolls_at_the_kinematic_speed(flanges: str) -> None:
    """Rollers under load roll, take the cage along, and the energies close."""
    result = trb.Simulation(scene(flanges, 0.0, speed_rpm=1500.0)).run(revolutions=2.0)
    summary = result.summary()
    assert result.success
    ratio = result.scene.bearing.geometry.cage_speed_ratio
    assert result.cage_speed_ratio == pytest.approx(ratio, rel=5e-3)
    assert abs(summary["energy_closure"]) < 1e-3
    loaded = result["inner_load"][-1] > 500.0  # others have just come, and still slide
    spin = -result["roller_spin_speed"][-1][loaded] / result["shaft_speed"][-1]
    np.testing.assert_allclose(spin, result.scene.bearing.geometry.roller_spin_ratio, rtol=5e-3)


def test_energy_without_friction() -> None:
    """Kinetic and elastic energy and the works are conserved where nothing loses any."""
    quiet = trb.Effects.frictionless().replace(gravity=False, bodies="rollers")
    sim = trb.Simulation(scene("NJ", effects=quiet, misalignment_x=2e-4), accuracy="reference", integrator="bdf")
    result = sim.run(duration=4e-3, save_every=1e-4)
    energy = result["kinetic_energy"] + result["elastic_energy"] - result["work_shaft"] - result["work_ring"]
    assert np.ptp(energy) < 1e-5 * float(np.abs(result["elastic_energy"]).max())
    lost = [field.name for field in result.fields if field.name.startswith("loss_")]
    assert all(abs(float(result[name][-1])) < 1e-12 for name in lost)
    assert not {f"loss_{name}" for name in ("traction_outer", "rib", "front_rib", "damping")} & set(lost)


def test_tangents_and_exact_forces_agree() -> None:
    """A run whose forces of raceways and ribs are followed by tangents, and one in which all are evaluated."""
    quiet = scene("NUP", effects=trb.Effects(bodies="rollers"), misalignment_x=2e-4, moment_y=None)
    runs = [trb.Simulation(quiet, rings_share=share).run(revolutions=0.5) for share in (0.1, 1e-9)]
    lost = [sum(float(run[name][-1]) for name in ("loss_rolling", "loss_traction_inner", "loss_rib")) for run in runs]
    assert lost[0] == pytest.approx(lost[1], rel=2e-4)


def test_a_free_ring_floats_between_ribs() -> None:
    """A ring that is free goes through the clearance along its axis until ribs carry its load."""
    body = trb.RingBody(mass=1.0, inertia_axial=5e-4, inertia_transverse=4e-4)
    free = scene("NJ", ring="free", ring_body=body)
    result = trb.Simulation(free).run(revolutions=1.0)
    assert result.success
    assert abs(result.summary()["energy_closure"]) < 1e-3
    # the inner ring's rib goes to its rollers, and these to the rib of the outer ring; the ring leans a little, too
    gap = free.bearing.ribs.clearance
    assert -3.0 * gap < float(result["ring_position"][:, 2].mean()) < -2.0 * gap
    assert float(result["rib_load"].sum(axis=1).mean()) == pytest.approx(500.0, rel=0.05)


def test_a_free_ring_that_no_rib_holds() -> None:
    """A vertical shaft on an NU sinks upon its support, where skewed rollers push it about; the load of an NJ may drop to
    zero for a while.
    """
    body = trb.RingBody(mass=2.0, inertia_axial=5e-4, inertia_transverse=4e-4)
    on_support = body.replace(support_axial=2e5, damping=200.0)
    hung = scene("NU", displacement=None, ring="free", ring_body=on_support, gravity=(0.0, 0.0, -9.80665))
    place = trb.Simulation(hung).run(duration=0.04)["ring_position"][:, 2]
    sink = 2.0 * 9.80665 / 2e5
    assert abs(float(place[0])) < 1e-9
    assert -3.0 * sink < float(place.min()) < -0.2 * sink
    load = trb.History.step((2e-3, 6e-3), (500.0, 0.0, 500.0))
    assert trb.Simulation(scene("NJ", axial_load=load, ring="free", ring_body=body)).run(duration=8e-3).success


@pytest.mark.slow
def test_the_floating_side_of_a_shaft() -> None:
    """A pair of tapered bearings carries all of the axial load; the shaft is in balance, and runs."""
    shaft = trb.Shaft.hollow_cylinder(mass=8.0, outer_diameter=0.05, length=0.4)
    gear = trb.ShaftLoad(position=0.12, force=(900.0, -3000.0, 800.0))
    pair = trb.Assembly.pair(
        trb.cases.rig_30310(), "back to back", spread=0.06, end_play=-20e-6, shaft=shaft, speed_rpm=3000, loads=[gear]
    )
    seat = trb.ShaftBearing(bearing("NU"), position=0.2, small_ends="left", name="floating")
    whole = pair.replace(bearings=(*pair.bearings, seat))
    found = trb.equilibrium(whole)
    loads = {name: found[name] for name in ("left", "right", "floating")}
    radial = 3000.0 + 8.0 * 9.80665
    assert loads["floating"].radial_load > 500.0
    assert abs(loads["floating"].axial_load) < 1.0
    assert abs(loads["left"].axial_load - loads["right"].axial_load) == pytest.approx(800.0, rel=2e-3)
    assert sum(load.radial_load for load in loads.values()) > math.hypot(900.0, radial) * 0.999
    result = trb.Simulation(whole).run(revolutions=0.05)
    assert abs(result["floating"].summary()["energy_closure"]) < 1e-2
    assert "outer_ribs" in result["floating"].groups


def pressure_at_a_rib(own: trb.Bearing, rib: str, load: Array) -> Array:
    """Hertz's largest pressure of a sphere on a cone, nominal place: hollow at the outer ring, round at the inner."""
    outwards = 1.0 if rib.startswith("outer") else -1.0
    place = 0.5 * (own.pitch_diameter + outwards * own.roller.diameter) - outwards * own.ribs.contact_height
    lean, sphere = abs(math.sin(own.geometry.rib_normal_angle)), own.geometry.sphere_radius
    shorter, longer = sorted((1.0 / (1.0 / sphere - outwards * lean / place), sphere))
    ratio = trb.laws.point_ellipticity(longer, shorter)
    equivalent = longer * shorter / (longer + shorter)
    size = 6.0 * ellipe(1.0 - ratio**-2) * equivalent / (math.pi * own.geometry.effective_modulus)
    return np.asarray(
        1.5 * np.cbrt(load) / (math.pi * np.cbrt(ratio * size**2))
    )  # semi-axes cbrt(ratio^2 size load), cbrt(size load / ratio)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_every_rib_has_its_records_and_peaks(side: float) -> None:
    """An inner ring between two ribs of each ring, pushed against two of them: their contacts at the ends of all steps."""
    gap = bearing("NUP").ribs.clearance
    undamped = trb.Effects(damping="off")  # pressures are those of the elastic part of a load
    pushed = scene("NUP", axial_load=0.0, displacement=(None, None, side * (2.0 * gap + 1e-5)), effects=undamped)
    sim, roughness = trb.Simulation(pushed), pushed.bearing.roughness.rib
    sim._core.begin_peaks(0.0)
    seen, records = [sim.contacts()], [sim.record()]
    while sim.time < 1e-3:
        sim.step()
        seen.append(sim.contacts())
        records.append(sim.record())
    peaks = from_row(sim._core.whole_peaks(sim.time), sim.bearings[0].model.peak_layout())
    time = np.array([record["time"] for record in records])
    loaded = ("front_rib", "outer_rib") if side > 0.0 else ("rib", "outer_front_rib")
    for rib in ("rib", "front_rib", "outer_rib", "outer_front_rib"):
        of = {name: np.array([one[f"{rib}_{name}"] for one in seen]) for name in ("load", "height", "film", "friction")}
        load = of["load"]
        assert (load.max() > 100.0) == (rib in loaded)
        force = sum(load[0]) * math.cos(pushed.bearing.geometry.rib_normal_angle)
        if rib in loaded:
            assert force == pytest.approx(abs(records[0]["ring_force"][2]), rel=1e-2)
        np.testing.assert_allclose(peaks[f"{rib}_load_peak"], load.max(axis=0), rtol=SHARE)
        mean = np.trapezoid(load, time, axis=0) / time[-1]
        np.testing.assert_allclose(peaks[f"{rib}_load_mean"], mean, rtol=SHARE)
        pressure = pressure_at_a_rib(pushed.bearing, rib, load)
        np.testing.assert_allclose(peaks[f"{rib}_pressure_peak"], pressure.max(axis=0), rtol=SHARE)
        film = np.where(load > 0.0, of["film"] / roughness, np.inf).min(axis=0)
        wanted = np.where(np.isfinite(film), film, np.nan)
        np.testing.assert_allclose(peaks[f"{rib}_film_parameter_min"], wanted, rtol=SHARE)
        again = {name: np.array([record[f"{rib}_{name}"] for record in records]) for name in fields_of_ribs()}
        for name in ("load", "height", "film", "friction"):
            np.testing.assert_array_equal(again.pop(name), of[name])
        np.testing.assert_allclose(again.pop("pressure"), pressure, rtol=2e-4)
        np.testing.assert_allclose(again.pop("film_parameter"), of["film"] / roughness, rtol=1e-12)
        sliding, rolling = (
            np.array([one[f"{rib}_{name}"] for one in seen]) for name in ("sliding_speed", "mean_speed")
        )
        np.testing.assert_allclose(again.pop("slide_roll") * rolling, sliding, rtol=1e-12)
        assert (again.pop("overhang") >= 0.0).all()
        assert not again


def fields_of_ribs() -> set[str]:
    """Quantities of a rib's contact."""
    return {field.name.removeprefix("rib_") for field in fields.table() if field.name.startswith("rib_")}


def test_records_of_the_outer_ribs() -> None:
    """Cylindrical bearings have them, tapered ones do not."""
    own = trb.Simulation(scene("NJ")).run(duration=1e-3)
    other = trb.Simulation(trb.cases.scene_30310()).run(duration=1e-3, save_groups=("outer_ribs", "contacts", "peaks"))
    assert "outer_ribs" in own.groups
    assert "outer_ribs" not in other.groups
    assert not [name for name in other.peaks if name.startswith("outer_rib")]
    for name, says in {
        "front_rib_pressure": "this bearing has none",
        "outer_rib_load": "or which this bearing or its scene does not have",
    }.items():
        with pytest.raises(trb.InputError, match=says):
            _ = other[name]
    assert float(own["outer_front_rib_load"].sum(axis=1)[0]) == pytest.approx(500.0, rel=1e-3)
    assert float(own["outer_front_rib_pressure"].max()) > 5e7
    told = own.summary()
    assert 16 * told["outer_front_rib_load_mean"] == pytest.approx(500.0, rel=0.05)
    assert told["outer_front_rib_pressure_max"] == own.window().peaks["outer_front_rib_pressure_peak"].max() > 5e7
    assert 1.0 < told["film_parameter_outer_front_rib_min"] <= told["film_parameter_outer_front_rib"]
    assert not {"outer_rib_load_mean", "front_rib_pressure_max"} & set(told)  # which carry nothing
    assert "outer_rib_load_mean" not in other.summary()


def test_the_rating_is_that_of_a_radial_bearing() -> None:
    rating = trb.rating(scene("NJ"))
    assert rating.equivalent_load == pytest.approx(4000.0)
    assert rating.e is rating.Y is rating.Y0 is None
    assert any("ribs" in said for said in rating.warnings)


@pytest.mark.parametrize("flanges", ["NU", "NJ", "NUP", "N"])
def test_rings_are_drawn_whole(flanges: str) -> None:
    """Triangles fill the section of a ring with its ribs, which no point of it sees as a whole."""

    def area(corners: Array) -> float:
        x, y = corners.T
        return 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))

    for outline in (cup_outline(bearing(flanges)), cone_outline(bearing(flanges))):
        corners = np.array(outline)
        filled = ears(corners)
        assert len(filled) == len(corners) - 2
        assert sum(area(corners[list(triangle)]) for triangle in filled) == pytest.approx(area(corners), rel=1e-9)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: bearing(None), "ribs.flanges"),  # type: ignore[arg-type]
        (lambda: scene("NU", axial_load=100.0, displacement=None), "no ribs that would carry"),
        (lambda: scene("NUP", axial_load=0.0), "displacement = (None, None, 0.0)"),
        (lambda: scene("NU", unloaded="rests", displacement=None), "cylindrical rollers"),
        (
            lambda: bearing("NU", ribs={"front_high": 2e-3}),
            "ribs.front_high = 0.002 : must not be given for cylindrical",
        ),
        (lambda: bearing("NU", roller={"sphere_ratio": 0.9}), "roller.sphere_ratio = 0.9"),
        (lambda: trb.cases.rig_30310().replace(radial_clearance=1e-5), "must not be given for tapered"),
        (lambda: trb.cases.rig_30310().replace(radial_clearance=-1e-5), "must not be given for tapered"),
        (lambda: bearing("NU", -1.2e-3), "must be at least -0.0011 and below 0.011"),
        (
            lambda: trb.cases.rig_30310().replace(cup_half_angle_deg=0.3),
            "must be 0, for cylindrical rollers, or from 0.6",
        ),
        (lambda: trb.cases.rig_30310().replace(cup_half_angle_deg=0.0), "ribs.flanges"),
    ],
)
def test_what_is_refused(make: Any, says: str) -> None:
    with pytest.raises(trb.InputError, match=r".") as found:
        make()
    assert says in str(found.value)


def test_a_rib_that_is_not_there_carries_no_film() -> None:
    """Peaks of an NU, whose inner ring has no rib: no load, and no film that would be thinnest; nor may a run wait for them."""
    floating = scene("NU", axial_load=0.0, displacement=(None, None, 0.0))
    result = trb.Simulation(floating).run(duration=1e-3)
    assert not result["rib_load_peak"].any()
    for rib in ("rib", "front_rib"):
        assert np.isnan(result[f"{rib}_film_parameter_min"]).all()
    summary = result.summary()
    assert "film_parameter_rib" not in summary
    assert "film_parameter_rib_min" not in summary
    tapered = trb.Simulation(trb.Scene(trb.cases.rig_30310(), speed_rpm=3000.0, axial_load=4930.0))
    with pytest.raises(trb.InputError, match="does not have: outer ring's rib"):
        tapered.run(duration=1e-3, until={"outer_rib_load_mean": 0.1})


@pytest.mark.parametrize("flanges", ["NU", "N"])
@pytest.mark.parametrize("load", [500.0, 3000.0, 12000.0])
def test_tilting_stiffness_is_that_of_straight_contacts(flanges: str, load: float) -> None:
    """Rollers of even contact resist tilt of the loaded plane by k L^2/12, k against displacement; nothing weak is eliminated."""
    found = trb.stiffness(scene(flanges, radial_load=load, speed_rpm=100.0))
    length = bearing().roller.effective_length
    matrix = found.matrix
    assert matrix[4, 4] == pytest.approx(matrix[0, 0] * length**2 / 12.0, rel=0.05)
    assert matrix[3, 3] == pytest.approx(matrix[1, 1] * length**2 / 12.0, rel=0.05)


def test_stiffness_is_that_of_differences_with_rollers_held_along_their_axis() -> None:
    own = scene(radial_load=3000.0)
    found, held = trb.stiffness(own), own.replace(effects=own.effects.replace(back_rib=False))
    model, angles, speed = normal_contacts(held), nominal_angles(held), 100.0 * math.pi
    steps, slopes = np.array([1e-8, 1e-8, 1e-8, 1e-6, 1e-6]), np.zeros((5, 5))
    for column, step in enumerate(steps):
        ends = []
        for sign in (1.0, -1.0):
            place = found.displacement.copy()
            place[column] += sign * step
            ends.append(model.equilibrium(np.zeros(5), np.ones(5), place, speed, angles, None, True)["reaction"])
        slopes[:, column] = (ends[0] - ends[1]) / (2.0 * step)
    arms = np.array([1.0, 1.0, 1.0, 0.01, 0.01])
    assert np.abs((found.matrix - slopes) / np.outer(arms, arms)).max() < 1e-4 * found.matrix[0, 0]


def test_a_motor_shaft_has_five_vibrations() -> None:
    shaft = trb.Shaft.hollow_cylinder(mass=12.0, outer_diameter=0.05, length=0.4)
    load = trb.ShaftLoad(position=0.0, force=(0.0, -4000.0, -600.0))
    ends = [
        trb.ShaftBearing(trb.cases.bearing_nj210(), position=-0.15, small_ends="left"),
        trb.ShaftBearing(bearing("NU"), position=0.15, small_ends="right"),
    ]
    found = trb.equilibrium(trb.Assembly(bearings=ends, shaft=shaft, loads=[load], speed_rpm=1500.0))
    assert all(one.stiffness[3, 3] > 0.0 and one.stiffness[4, 4] > 0.0 for one in found.bearings)
    assert len(found.modes().frequencies) == 5


@pytest.mark.parametrize("flanges", ["NU", "N"])
def test_a_floating_ring_stands_in_the_middle(flanges: str) -> None:
    own = trb.Scene(bearing(flanges), speed_rpm=3000.0, radial_load=4000.0)
    said = own.replace(displacement=PLACED)
    assert own.displacement == PLACED
    assert own.fingerprint == said.fingerprint
    assert trb.Scene.from_dict(own.to_dict()) == own
    assert np.array_equal(trb.stiffness(own).matrix, trb.stiffness(said).matrix)
    fixed = own.replace(bearing=bearing("NJ"), axial_load=500.0, displacement=None)
    assert fixed.displacement is None
