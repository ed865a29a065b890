"""Input models: what they derive and what they refuse."""

from __future__ import annotations

import copy
import inspect
import math
import pickle
from typing import Any

import numpy as np
import pytest

from trbdyn import _core, cases, pocket_shapes
from trbdyn.errors import InputError, StepError, TrbError
from trbdyn.model import flatten
from trbdyn.model.bearing import Bearing, Cage, Profile, Ribs, Roller, Scatter
from trbdyn.model.effects import Effects, Friction
from trbdyn.model.lubricants import Lubricant, vg100
from trbdyn.model.motion import History
from trbdyn.model.pocket import OtherPocket
from trbdyn.model.scene import RotatingLoad, Scene, Start
from trbdyn.run.options import ACCURACY, RunOptions


@pytest.fixture(scope="module")
def rig() -> Bearing:
    return cases.rig_30310()


@pytest.fixture(scope="module")
def scene() -> Scene:
    return cases.paper_30310()


class TestGeometry:
    @pytest.mark.parametrize(
        ("name", "value", "digits"),
        [
            ("roller_half_angle", math.radians(1.8707), 1e-6),
            ("roller_axis_angle", math.radians(11.0820), 1e-6),
            ("cone_half_angle", math.radians(9.2113), 1e-6),
            ("apex_to_mid", 214.315e-3, 1e-6),
            ("apex_to_large_end", 224.215e-3, 1e-6),
            ("outer_race_radius", 48.064e-3, 1e-6),
            ("inner_race_radius", 34.325e-3, 1e-6),
            ("outer_equivalent_radius", 8.163e-3, 1e-6),
            ("inner_equivalent_radius", 5.830e-3, 1e-6),
            ("large_end_diameter", 14.646e-3, 1e-6),
            ("small_end_diameter", 13.354e-3, 1e-6),
            ("roller_mass", 25.0e-3, 1e-4),
            ("roller_inertia_axial", 6.16e-7, 1e-9),
            ("roller_inertia_transverse", 1.21e-6, 5e-9),
            ("roller_mass_offset", 0.336e-3, 1e-6),
            ("sphere_radius", 202.24e-3, 1e-5),
            ("rib_contact_radius", 37.615e-3, 1e-6),
            ("rib_normal_angle", math.radians(9.475), 2e-5),
            ("rib_curvature_radius", 228.5e-3, 1e-4),
            ("rib_rx", 1.761, 1e-3),
            ("rib_ry", 0.2022, 1e-4),
            ("rib_ellipticity", 4.12, 5e-3),
            ("effective_modulus", 226.37e9, 1e7),
            ("cage_speed_ratio", 0.41662, 1e-5),
            ("roller_spin_ratio", 2.8606, 1e-4),
        ],
    )
    def test_rig_30310(self, rig: Bearing, name: str, value: float, digits: float) -> None:
        assert getattr(rig.geometry, name) == pytest.approx(value, abs=digits, rel=0)

    def test_names_are_those_of_the_core(self, rig: Bearing) -> None:
        assert {name for name, _, _ in _core.geometry_table()} == set(vars(rig.geometry))

    def test_bearing_32216_shares_one_apex(self) -> None:
        geometry = cases.bearing_32216().geometry
        assert math.tan(geometry.roller_half_angle) * geometry.apex_to_mid == pytest.approx(8.5e-3, rel=1e-12)
        assert geometry.apex_to_mid * math.sin(geometry.roller_axis_angle) == pytest.approx(54.25e-3, rel=1e-12)
        assert geometry.outer_race_radius > 54.25e-3 > geometry.inner_race_radius

    def test_changes_with_the_bearing(self, rig: Bearing) -> None:
        longer = rig.model_copy(update={"pitch_diameter": 83e-3})
        assert longer.geometry.apex_to_mid > rig.geometry.apex_to_mid

    def test_refusals_of_the_core_name_the_field(self, rig: Bearing) -> None:
        with pytest.raises(InputError, match=r"bearing\.roller\.total_length = 0\.5 : .*apex"):
            rig.replace(roller=rig.roller.replace(total_length=0.5))


class TestLubricant:
    @pytest.mark.parametrize(("temperature", "alpha", "beta"), [(60.0, 1.97e-8, 0.0392), (50.0, 2.096e-8, 0.0445)])
    def test_vg100(self, temperature: float, alpha: float, beta: float) -> None:
        oil = vg100(temperature_c=temperature)
        assert oil.pressure_coefficient == pytest.approx(alpha, rel=2e-3)
        assert oil.temperature_coefficient == pytest.approx(beta, abs=0.6e-4)

    def test_viscosity(self) -> None:
        oil = vg100()
        assert oil.viscosity == pytest.approx(34.59e-3, abs=1e-5)
        slope = math.log(vg100(60.001).viscosity / vg100(59.999).viscosity) / 0.002
        assert oil.temperature_coefficient == pytest.approx(-slope, rel=1e-6)
        law, bar = oil.dicke, 6000.0
        assert law is not None
        pressed = oil.viscosity * math.exp(bar / (law.a + law.b * 60 + (law.c + law.d * 60) * bar))
        assert pressed == pytest.approx(397.0, abs=1.0)
        assert oil.viscosity * math.exp(1.97e-8 * 6e8) == pytest.approx(4703.0, rel=2e-3)
        slope = math.log1p(math.expm1(1e-3 / (law.a + law.b * 60 + (law.c + law.d * 60) * 1e-3))) / 100.0
        assert oil.pressure_coefficient == pytest.approx(slope, rel=1e-6)

    @pytest.mark.parametrize("temperature", [-30.0, 300.0, float("nan"), "60", True, None])
    def test_refuses(self, temperature: Any) -> None:
        with pytest.raises(InputError, match="temperature_c"):
            vg100(temperature_c=temperature)

    def test_roelands_needs_enough_viscosity(self) -> None:
        with pytest.raises(InputError, match=r"lubricant\.viscosity"):
            vg100().replace(viscosity=5e-5, pressure_law="roelands")


@pytest.mark.parametrize(
    ("values", "place"),
    [((0.0, 1.0, 1e308, 0.0), 2), ((0.0, 1e-3, 2e-3, 1.7e308), 3), ((-1.7e308, 1.7e308, 0.0, 0.0), 1)],
)
def test_a_curve_that_overflows_names_its_steepest_step(values: tuple[float, ...], place: int) -> None:
    with pytest.raises(InputError, match=rf"history\.values\[{place}\] .*the curve overflows"):
        History(times=(0.0, 1e-5, 2e-5, 3e-5), values=values)


class TestScene:
    def test_round_trip_is_exact(self, rig: Bearing) -> None:
        awkward = 0.1 + 0.2
        start = Start.state(np.random.default_rng(0).normal(size=50), time=awkward)
        bearing = rig.replace(
            roller=rig.roller.replace(diameter_scatter=Scatter(range=1e-6, seed=4)),
            cage=rig.cage.replace(other_pockets=[OtherPocket(index=1, pocket=pocket_shapes.stepped_pocket(rig))]),
        )
        scene = Scene(
            bearing,
            speed_rpm=History.ramp(0.0, awkward, 0.0, 3000.0),
            axial_load=4930 / 3,
            start=start,
            effects=Effects.standard(),
            gravity=(0.0, -9.81, History.ramp(0, 1, 0, 1)),
        )
        again = Scene.from_json(scene.to_json())
        assert again == scene
        assert again.to_dict() == scene.to_dict()
        assert hash(again) == hash(scene)
        assert again.fingerprint == scene.fingerprint
        assert np.array_equal(flatten.parameter_block(again), flatten.parameter_block(scene))

    def test_copies_and_pickles(self, scene: Scene) -> None:
        for twin in (pickle.loads(pickle.dumps(scene)), copy.deepcopy(scene)):
            assert twin == scene
            assert twin.bearing.geometry == scene.bearing.geometry

    def test_every_change_changes_the_fingerprint(self, scene: Scene) -> None:
        others = [
            scene.replace(speed_rpm=3000.0000001),
            scene.replace(effects=Effects.standard()),
            scene.replace(start=Start.whirl()),
            scene.replace(bearing=scene.bearing.replace(pitch_diameter=82.39e-3)),
        ]
        assert len({scene.fingerprint, *(other.fingerprint for other in others)}) == 5

    def test_is_frozen(self, scene: Scene) -> None:
        with pytest.raises(InputError, match="replace"):
            scene.axial_load = 3.0
        with pytest.raises(InputError, match="replace"):
            scene.bearing.cage.mass = 3.0

    def test_numbers_of_numpy_are_numbers(self, rig: Bearing) -> None:
        scene = Scene(rig, speed_rpm=np.float32(1000), axial_load=np.int64(4930))
        assert (scene.speed_rpm, scene.axial_load) == (1000.0, 4930.0)
        assert type(scene.axial_load) is float

    @pytest.mark.parametrize(
        ("changes", "field", "allowed"),
        [
            ({"speed_rpm": True}, "speed_rpm", "number"),
            ({"speed_rpm": "3000"}, "speed_rpm", "number"),
            ({"speed_rpm": float("inf")}, "speed_rpm", "finite"),
            ({"speed_rpm": 1e9}, "speed_rpm", "1e+06"),
            ({"axial_load": -1.0}, "axial_load", ">= 0 (N)"),
            ({"axial_load": 0.0}, "axial_load", "> 0"),
            ({"radial_load": -1.0}, "radial_load", ">= 0"),
            ({"axial_load": History.ramp(0, 1, 100, 200)}, "axial_load", "follows"),
            ({"moment_x": 1.0, "misalignment_x": 1e-3}, "moment_x", "misalignment_x"),
            ({"misalignment_y": 0.2}, "misalignment_y", "0.08727"),
            ({"displacement": (0, 0, -1e-5)}, "axial_load", "0 where displacement"),
            ({"displacement": (0, 0, -1.0), "axial_load": 0}, "displacement[2]", "0.014"),
            ({"displacement": (0, 0)}, "displacement", ""),
            ({"axial_lod": 3.0}, "axial_lod", "did you mean 'axial_load'"),
            ({"lubricant": {"viscosity": 1.0}}, "lubricant.pressure_coefficient", "required"),
            ({"effects": {"friction": {"lambda_full": 0.001}}}, "effects.friction.lambda_full", "> lambda_boundary"),
            ({"effects": {"n_slices": 8.0}}, "effects.n_slices", "whole number"),
            ({"effects": {"planar": 1}}, "effects.planar", "true or false"),
            ({"effects": {"lubrication": "wet"}}, "effects.lubrication", "'mixed'"),
            ({"start": {"kind": "state"}}, "start.state_vector", "given"),
            ({"start": {"kind": "whirl", "eccentricity": 1.5}}, "start.eccentricity", "<= 1"),
            ({"start": Start.whirl(), "effects": Effects(bodies="rollers")}, "start.kind", "cage"),
            ({"ring": "loose"}, "ring", "'held', 'follows' or 'free'"),
            ({"bearing": None}, "bearing", ""),
        ],
    )
    def test_refuses(self, scene: Scene, changes: dict[str, Any], field: str, allowed: str) -> None:
        with pytest.raises(InputError) as caught:
            scene.replace(**changes)
        assert caught.value.field.startswith(field)
        assert allowed in caught.value.allowed
        assert isinstance(caught.value, ValueError)
        assert isinstance(caught.value, TrbError)

    def test_every_problem_has_its_line(self) -> None:
        with pytest.raises(InputError) as caught:
            Scene({"n_rollers": 2, "roller": {"diameter": -3, "densty": 1}}, speed_rpm=None)
        lines = str(caught.value).splitlines()
        assert "bearing.roller.diameter = -3 : must be >= 0.0001 (m)" in lines
        assert "bearing.n_rollers = 2 : must be >= 3" in lines
        assert any(
            line.startswith("bearing.roller.densty = 1 : unknown name; did you mean 'density'?") for line in lines
        )
        assert "speed_rpm = None : must be a number or a History of times and values (rpm)" in lines

    def test_values_without_names(self) -> None:
        """Every name that the model has is told, and signatures do not offer values without names."""
        with pytest.raises(
            InputError,
            match=r"must be given by name, as History\(times=\.\.\.\); names: times, values, slopes, repeats",
        ):
            History([0.0, 1.0], [2.0, 3.0])  # type: ignore[call-arg]
        assert str(inspect.signature(History)) == "(*, times, values, slopes=None, repeats=False)"

    def test_load_at_the_limit(self, rig: Bearing) -> None:
        most = 1000 / math.tan(math.radians(rig.cup_half_angle_deg))
        Scene(rig, speed_rpm=0, axial_load=1000, radial_load=0.999 * most).check_capacity()
        with pytest.raises(InputError, match="radial_load"):
            Scene(rig, speed_rpm=0, axial_load=1000, radial_load=1.001 * most).check_capacity()


class TestBearing:
    def test_rollers_that_overlap(self, rig: Bearing) -> None:
        with pytest.raises(InputError, match=r"bearing\.n_rollers = 19 : must be <= 18"):
            rig.replace(n_rollers=19)
        assert rig.replace(n_rollers=18).n_rollers == 18

    @pytest.mark.parametrize(
        ("part", "changes", "field"),
        [
            ("ribs", {"contact_height": 4e-3, "edge_high": 3.5e-3}, "ribs.contact_height"),
            ("ribs", {"front_high": 0.1e-3, "front_low": 0.3e-3}, "ribs.front_high"),
            ("roller", {"total_length": 19e-3}, "roller.total_length"),
            ("roller", {"diameter": float("nan")}, "roller.diameter"),
            ("roller", {"sphere_ratio": 1.5}, "roller.sphere_ratio"),
            ("cage", {"mass": 0.0}, "cage.mass"),
            ("cage", {"inertia_axial": 9e-4, "inertia_transverse": 2.1e-4}, "cage.inertia_axial"),
            ("cage", {"wall_outer": 1e-3, "wall_inner": 1.5e-3}, "cage.wall_outer"),
            ("material", {"poisson_ratio": 0.5}, "material.poisson_ratio"),
            ("roughness", {"rib": 0.0}, "roughness.rib"),
        ],
    )
    def test_refuses(self, rig: Bearing, part: str, changes: dict[str, float], field: str) -> None:
        with pytest.raises(InputError) as caught:
            getattr(rig, part).replace(**changes)
        assert caught.value.field == field

    def test_wall_beyond_the_small_end(self, rig: Bearing) -> None:
        with pytest.raises(InputError, match=r"bearing\.cage\.wall_outer = 0\.007 :"):
            rig.replace(cage=rig.cage.replace(wall_outer=7e-3))

    def test_scatter_is_seeded_and_within_its_range(self, rig: Bearing) -> None:
        def deviations(seed: int) -> np.ndarray:
            scatter = Scatter(range=1e-6, seed=seed)
            return rig.replace(roller=rig.roller.replace(diameter_scatter=scatter)).diameter_deviation

        assert np.array_equal(deviations(1), deviations(1))
        assert not np.array_equal(deviations(1), deviations(2))
        assert np.abs(np.concatenate([deviations(seed) for seed in range(50)])).max() == pytest.approx(0.5e-6, rel=0.05)
        assert np.abs(deviations(1)).max() <= 0.5e-6

    def test_given_deviations(self, rig: Bearing) -> None:
        one_larger = rig.replace(roller=rig.roller.replace(diameter_deviation=[1e-6] + [0.0] * 11))
        assert flatten.diameter_deviation(cases.paper_30310(bearing=one_larger)).tolist() == [1e-6] + [0.0] * 11
        with pytest.raises(
            InputError, match=r"bearing\.roller\.diameter_deviation = .*: must have one entry for each roller, 12"
        ):
            rig.replace(roller=rig.roller.replace(diameter_deviation=[1e-6]))

    def test_profile_kinds(self) -> None:
        assert Profile.straight().kind == "straight"
        assert Profile.crowned(40.0).crown_radius == 40.0
        assert Profile.logarithmic(1500.0).load == 1500.0

    def test_parts_by_dictionaries(self, rig: Bearing) -> None:
        built = Bearing(
            n_rollers=12,
            cup_half_angle_deg=rig.cup_half_angle_deg,
            pitch_diameter=rig.pitch_diameter,
            roller={
                "diameter": 14e-3,
                "effective_length": 19.8e-3,
                "total_length": 20.8e-3,
                "profile": {"kind": "logarithmic", "k1": 1.5, "k2": 0.4, "zm": 10e-6, "load": 1833.0},
            },
            ribs=Ribs(contact_height=1.667e-3),
            cage=Cage(**rig.cage.to_dict()),
            name="30310",
        )
        assert built == rig


class TestEffects:
    def test_presets(self) -> None:
        assert Effects.standard() == Effects()
        assert Effects(rolling_resistance=False).rolling_pressure_force is False
        assert Effects(quadrature="uniform").rolling_pressure_force is True
        with pytest.raises(InputError, match="rolling_pressure_force"):
            Effects(rolling_resistance=False, rolling_pressure_force=True)
        paper = Effects.paper()
        assert (paper.damping, paper.rolling_pressure_force, paper.rib_film) == ("off", False, "max")
        assert paper.quadrature == "uniform"
        assert Effects.standard().rolling_pressure_force
        off = Effects.frictionless()
        assert (off.traction, off.lubrication, off.rolling_resistance, off.damping) == (
            "none",
            "full_film",
            False,
            "off",
        )
        assert Effects.minimal().planar

    def test_replace_validates(self) -> None:
        assert Effects.paper().replace(n_slices=8).n_slices == 8
        with pytest.raises(InputError, match=r"effects\.rolling_pressure_force = True : needs rolling_resistance"):
            Effects.standard().replace(rolling_resistance=False)
        with pytest.raises(InputError, match="did you mean 'n_slices'"):
            Effects.paper().replace(slices=8)
        with pytest.raises(InputError, match="lambda_full"):
            Friction(lambda_boundary=2.0)


def turning(speed_rpm: float | History) -> Scene:
    return cases.paper_30310().replace(speed_rpm=speed_rpm)


class TestRunOptions:
    def test_end_time(self) -> None:
        run = RunOptions(revolutions=50)
        assert run.end_time(turning(3000.0)) == pytest.approx(1.0)
        assert run.end_time(turning(-3000.0), start=0.5) == pytest.approx(1.5)
        assert RunOptions(duration=0.3).end_time(turning(0.0), start=0.1) == pytest.approx(0.4)

    @pytest.mark.parametrize("revolutions", [0.5, 10.0, 100.0])
    def test_end_time_of_a_changing_speed(self, revolutions: float) -> None:
        speed = History.table((0.0, 0.3, 0.7, 1.0), (0.0, 3000.0, 1200.0, 1200.0))
        end = RunOptions(revolutions=revolutions).end_time(turning(speed))
        assert speed.integral(0.0, end) / 60.0 == pytest.approx(revolutions, rel=1e-9)

    @pytest.mark.parametrize("start", [0.0, -0.37, 12.21])
    @pytest.mark.parametrize(
        ("mean", "amplitude", "frequency", "revolutions"),
        [(3000.0, 2900.0, 7.0, 20.0), (600.0, 500.0, 1.7, 500.0), (-30.0, 3000.0, 5.0, 15.0), (0.0, 3000.0, 0.5, 15.0)],
    )
    def test_end_time_of_a_speed_that_repeats(
        self, mean: float, amplitude: float, frequency: float, revolutions: float, start: float
    ) -> None:
        """For the first time: a shaft that turns to and fro was nowhere as far before."""
        speed = History.harmonic(mean, amplitude, frequency_hz=frequency)
        end = RunOptions(revolutions=revolutions).end_time(turning(speed), start)
        assert abs(speed.integral(start, end)) / 60.0 == pytest.approx(revolutions, rel=1e-9)
        before = [abs(speed.integral(start, time)) / 60.0 for time in np.linspace(start, end, 500)[:-1]]
        assert max(before) < revolutions
        with pytest.raises(InputError, match="does not turn that often"):
            RunOptions(revolutions=1e3).end_time(turning(History.harmonic(0.0, 3000.0, frequency_hz=5.0)), start)

    def test_refuses(self) -> None:
        with pytest.raises(InputError, match=r"run\.duration"):
            RunOptions(revolutions=1, duration=1)
        with pytest.raises(InputError, match="is at rest"):
            RunOptions(revolutions=1).end_time(turning(0.0))
        with pytest.raises(InputError, match=r"run\.revolutions = None"):
            RunOptions().end_time(turning(60.0))
        with pytest.raises(InputError, match=r"run\.save_groups"):
            RunOptions(save_groups=["cages"])

    def test_settings(self) -> None:
        run = RunOptions(duration=1, accuracy="reference", atol_spin=0.5)
        assert run.settings()["rtol"] == ACCURACY["reference"].rtol
        assert run.settings()["atol_spin"] == 0.5
        assert ACCURACY["fast"].rtol > ACCURACY["standard"].rtol > ACCURACY["reference"].rtol


class TestErrors:
    def test_pickle(self) -> None:
        with pytest.raises(InputError) as caught:
            Lubricant(viscosity=-1)
        again = pickle.loads(pickle.dumps(caught.value))
        assert str(again) == str(caught.value)
        assert again.field == "lubricant.viscosity"
        step = StepError("too stiff", time=0.25, body="roller 3", quantity="skew")
        twin = pickle.loads(pickle.dumps(step))
        assert (str(twin), twin.time, twin.body, twin.quantity) == ("too stiff", 0.25, "roller 3", "skew")

    def test_bad_json(self) -> None:
        with pytest.raises(InputError, match="JSON"):
            Scene.from_json("{")
        with pytest.raises(InputError):
            Roller.from_json("[1, 2]")


class TestCases:
    def test_operating_points(self) -> None:
        points = cases.OPERATING_POINTS
        assert len(points) == 18
        assert points["2000rpm_4930N_5530N"].radial_load == 5530.0
        for point in points.values():
            cases.paper_30310(point.speed_rpm, point.axial_load, point.radial_load)

    def test_scenes(self) -> None:
        scene = cases.scene_32216(speed_rpm=500, effects=Effects.standard())
        assert scene.lubricant.temperature_c == 50.0
        assert (scene.speed_rpm, scene.axial_load, scene.bearing.n_rollers) == (500.0, 6000.0, 16)
        assert scene.effects == Effects.standard()


class TestHarmonic:
    """A mean with a cosine on it."""

    def test_small_amplitudes_and_late_phases(self) -> None:
        """An amplitude below 1; a phase of more than a turn is that of the rest."""
        wave, same = (History.harmonic(2.0, 0.5, frequency_hz=5.0, phase_deg=phase) for phase in (400.0, 40.0))
        for time in np.linspace(0.0, 1.0, 41):
            expected = 2.0 + 0.5 * math.cos(2.0 * math.pi * 5.0 * time + math.radians(40.0))
            assert wave.value(time) == pytest.approx(expected, abs=1e-4)
            assert wave.value(time) == pytest.approx(same.value(time), abs=1e-12)

    def test_a_negative_amplitude_is_refused(self) -> None:
        with pytest.raises(InputError, match="amplitude"):
            History.harmonic(2.0, -0.5, frequency_hz=5.0)


def test_a_rotating_load_is_added_in_both_directions(rig: Bearing) -> None:
    load = RotatingLoad(load=500.0, turns=1.0, direction_deg=30.0)
    scene = Scene(rig, speed_rpm=600.0, axial_load=4000.0, radial_load=100.0, ring="follows", rotating_load=load)
    for time in (0.0, 0.013, 0.04):
        turned = math.radians(30.0) + 2.0 * math.pi * 10.0 * time
        wanted = [500.0 * math.cos(turned), 100.0 + 500.0 * math.sin(turned), -4000.0]
        assert flatten.ring_load(scene, time).force == pytest.approx(wanted, abs=1e-9)
