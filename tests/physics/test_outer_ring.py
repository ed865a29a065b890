"""An outer ring that turns: rolling depends on the speed between the rings alone, the cage turns with both, energy adds up."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import Effects, History, InputError, Scene, Simulation, Start
from trbdyn.plot import conditions
from trbdyn.reporting.verdict import verdict
from trbdyn.run.replay import Replay

BARE = {"gravity": (0.0, 0.0, 0.0)}


def scene(inner: float | History, outer: float | History, **given: Any) -> Scene:
    return Scene(trb.cases.rig_30310(), speed_rpm=inner, outer_speed_rpm=outer, **({"axial_load": 4930.0} | given))


def mean(result: trb.Result, name: str) -> float:
    return float(getattr(result, name)[len(result) // 2 :].mean())


@pytest.mark.parametrize(("inner", "outer"), [(0.0, -3000.0), (1500.0, -1500.0), (4000.0, 1000.0)])
def test_rolling_depends_on_the_speed_between_the_rings(inner: float, outer: float) -> None:
    """The torque of the theory page, whichever ring turns. With rollers of little mass, and so little centrifugal forces, torque
    and loads are those of the speed between both.
    """
    bearing = trb.cases.rig_30310()
    heavy = Simulation(scene(inner, outer, **BARE)).run(duration=0.1)
    assert mean(heavy, "inner_torque") == pytest.approx(2.0320, rel=1e-3)
    light = bearing.replace(material=bearing.material.replace(density=100.0), cage=bearing.cage.replace(mass=0.02))
    effects = Effects.standard().replace(bodies="rollers")
    both = [
        Simulation(scene(*speeds, effects=effects, **BARE).replace(bearing=light)).run(duration=0.02)
        for speeds in ((3000.0, 0.0), (inner, outer))
    ]
    assert mean(both[1], "inner_torque") == pytest.approx(mean(both[0], "inner_torque"), rel=1e-4)
    assert mean(both[1], "outer_torque") == pytest.approx(mean(both[0], "inner_torque"), rel=1e-3)
    assert mean(both[1], "outer_load") == pytest.approx(mean(both[0], "outer_load"), rel=1e-4)
    assert mean(both[1], "outer_film_parameter") == pytest.approx(mean(both[0], "outer_film_parameter"), rel=1e-3)


@pytest.mark.parametrize(("inner", "outer"), [(0.0, 3000.0), (3000.0, 1000.0), (2000.0, -3000.0), (-500.0, 2500.0)])
def test_the_cage_turns_with_both(inner: float, outer: float) -> None:
    """Its speed is kappa times that of the inner ring and the rest of the outer ring's; both drives put in what is lost."""
    result = Simulation(scene(inner, outer, start=Start.whirl(0.9))).run(duration=0.04)
    ratio = result.scene.bearing.geometry.cage_speed_ratio
    expected = (ratio * inner + (1.0 - ratio) * outer) * np.pi / 30.0
    half = len(result) // 2
    angle = np.unwrap(result.cage_angle[half:])
    assert (angle[-1] - angle[0]) / np.ptp(result.time[half:]) == pytest.approx(expected, rel=5e-3)
    assert np.abs(result.cage_slip[half:]).max() < 0.02
    assert np.abs(result.spin_slip[half:]).max() < 0.02
    assert result.energy_closure < 1e-3
    sign = np.sign(inner - outer)
    put_in = sign * (result.inner_torque * inner - result.outer_torque * outer) * np.pi / 30.0
    works = np.gradient(result.work_shaft, result.time)
    assert works[half:].mean() == pytest.approx(put_in[half:].mean(), rel=0.02)


def test_torque_of_the_summary() -> None:
    """The friction torque is that of the moments on the rings, whichever ring turns; losses over the speed between both."""
    ratio = trb.cases.rig_30310().geometry.cage_speed_ratio
    for inner, outer in ((3000.0, 1000.0), (0.0, 2000.0), (2000.0 * (1.0 - ratio), -2000.0 * ratio)):
        result = Simulation(scene(inner, outer)).run(duration=0.05)
        found = result.summary()
        # of both rings, weighted by their speeds: where a roller is held up by the cage one carries more and the other one less
        put_in = np.abs(result.inner_torque * inner - result.outer_torque * outer) / abs(inner - outer)
        assert found["torque"] == pytest.approx(put_in[len(result) // 2 :].mean(), rel=4e-3)
        assert sum(found["torque_by_loss"].values()) == pytest.approx(found["torque"], rel=0.02)
        assert found["outer_speed_rpm"] == pytest.approx(outer)


def test_turns_are_those_of_the_ring_that_turns() -> None:
    """A wheel hub: turns, the report's words and verdicts, titles."""
    result = Simulation(scene(0.0, 3000.0, radial_load=2000.0)).run(revolutions=30)
    assert result.revolutions == pytest.approx(30.0, rel=1e-6)
    sentences = " ".join(sentence[2] for sentence in verdict(result, result.summary()))
    assert "30 turns of the outer ring" in sentences
    assert "less than one turn of the rollers" not in sentences
    assert "outer ring 3000 rpm" in conditions(result)
    assert "outer ring 3000 rpm" in repr(result.scene)


def test_centrifugal_forces_are_those_of_the_orbit() -> None:
    """The equilibrium carries rollers that orbit with both rings; a bearing that turns as a whole has no rolling at all."""
    whole = Simulation(scene(3000.0, 3000.0, effects=Effects.standard().replace(bodies="rollers"), **BARE))
    orbit = whole.scene.orbit_speed(0.0)
    assert orbit == pytest.approx(100.0 * np.pi)
    geometry = whole.scene.bearing.geometry
    found = whole.equilibrium
    pushed = geometry.roller_mass * orbit**2 * geometry.roller_centre_radius
    cup = np.radians(whole.scene.bearing.cup_half_angle_deg)
    across = found.outer_load * np.cos(cup) - found.inner_load * np.cos(geometry.cone_half_angle)
    rib = found.rib_load * np.sin(geometry.rib_normal_angle)
    assert across + rib == pytest.approx(pushed * np.ones(12), rel=0.02)
    result = whole.run(duration=5e-3)
    assert result.power_loss.max() < 1e-2
    assert np.abs(result.roller_orbit_speed - orbit).max() < 1e-4 * orbit


def test_speeds_that_change() -> None:
    """The outer ring speeds up while the inner one slows down."""
    inner, outer = History.ramp(2e-3, 0.03, 3000.0, 500.0), History.ramp(5e-3, 0.04, 0.0, 2000.0)
    result = Simulation(scene(inner, outer, ring="follows")).run(duration=0.06)
    expected = [result.scene.orbit_speed(float(time)) for time in result.time]
    assert result.roller_orbit_speed.mean(axis=1) == pytest.approx(np.array(expected), rel=0.02)
    assert result.energy_closure < 1e-3


def test_two_methods_agree() -> None:
    """BDF with tangents and Jacobian, and an explicit method without either."""
    start = Start.whirl(0.9)
    fine = {"rtol": 1e-6, "atol_position": 1e-12, "atol_angle": 1e-10, "atol_velocity": 1e-7, "atol_spin": 1e-5}
    runs = [
        Simulation(scene(1000.0, -2000.0, start=start), integrator=kind, **fine).run(duration=2e-3)
        for kind in ("bdf", "erk")
    ]
    moved = np.abs(runs[1].cage_position - runs[1].cage_position[0]).max()
    assert np.abs(runs[0].cage_position - runs[1].cage_position).max() < 2e-3 * moved


def test_runs_go_on(tmp_path: Path) -> None:
    """A run that goes on from a state, or is cut at a checkpoint, has the angles of the outer ring."""
    simulation = Simulation(scene(500.0, 2500.0, start=Start.whirl(0.5)))
    simulation.run(duration=0.01)
    state = simulation.state
    onward = Simulation(simulation.scene.replace(start=Start.state(state)))
    one, other = simulation.record(), onward.record()
    for name in ("cage_position", "cage_angle", "roller_orbit_angle", "outer_load"):
        assert other[name] == pytest.approx(one[name], rel=1e-9, abs=1e-12), name
    written = simulation.run(duration=2e-3, output=tmp_path / "outer.h5")
    assert trb.load(tmp_path / "outer.h5").scene.outer_speed_rpm == 2500.0
    seen = Replay(written).state(len(written) - 1)
    now = simulation.view(seen)
    then = simulation.view()
    for name in ("roller_psi", "roller_v_t", "roller_omega_a", "cage_x", "cage_v_x"):
        assert now[name] == pytest.approx(then[name], rel=1e-4, abs=1e-5), name


@pytest.mark.parametrize(("carrier", "wheel"), [(300.0, -1200.0), (-300.0, 1200.0)])
def test_planet(carrier: float, wheel: float) -> None:
    """Rings hold the rollers on the circle of the pin; the load turns with the carrier, and the loaded zone with it."""
    arm, load = 0.12, 8000.0
    effects = Effects.standard().replace(bodies="rollers")
    given = {"displacement": (None, None, -25e-6), "effects": effects}
    planet = trb.planet(
        trb.cases.rig_30310(), carrier_speed_rpm=carrier, planet_speed_rpm=wheel, arm=arm, load=load, **given
    )
    simulation = Simulation(planet)
    result = simulation.run(duration=0.1)
    assert result.success
    assert result.energy_closure < 1e-3
    turned = carrier * np.pi / 30.0 * simulation.time
    outward, along = (
        np.array([np.cos(turned), np.sin(turned)]),
        np.sign(carrier) * np.array([-np.sin(turned), np.cos(turned)]),
    )
    found, angle = simulation.contacts()["force"], result.roller_orbit_angle[-1]
    cosine, sine = np.cos(angle), np.sin(angle)
    held = np.array(
        [(found[:, 0] * cosine - found[:, 1] * sine).sum(), (found[:, 0] * sine + found[:, 1] * cosine).sum()]
    )
    pull = 12 * planet.bearing.geometry.roller_mass * (carrier * np.pi / 30.0) ** 2 * arm
    assert held @ outward == pytest.approx(-pull, rel=0.05)
    phase = carrier * np.pi / 30.0 * result.time
    tangential = np.sign(carrier) * np.column_stack([-np.sin(phase), np.cos(phase)])
    # the ring stands where evenly spaced rollers that start at fixed angles would balance the load: those that pass by differ
    assert (result.ring_force[:, :2] * tangential).sum(axis=1).mean() == pytest.approx(-load, rel=0.05)
    heaviest = angle[np.argmax(result.inner_load[-1])]
    assert np.cos(heaviest) * along[0] + np.sin(heaviest) * along[1] > np.cos(np.pi / 12.0) - 0.02


def test_planet_refuses() -> None:
    given = {"planet_speed_rpm": 0.0, "arm": 0.1, "load": 100.0, "displacement": (None, None, -25e-6)}
    with pytest.raises(InputError, match=r"carrier_speed_rpm.*must not be 0"):
        trb.planet(trb.cases.rig_30310(), carrier_speed_rpm=0.0, **given)
    with pytest.raises(InputError, match=r"arm.*must be > 0"):
        trb.planet(trb.cases.rig_30310(), carrier_speed_rpm=10.0, **(given | {"arm": 0.0}))
    with pytest.raises(InputError, match=r"speed_rpm.*must not be given"):
        trb.planet(trb.cases.rig_30310(), carrier_speed_rpm=10.0, **given, speed_rpm=3.0)


def test_refused() -> None:
    with pytest.raises(InputError, match=r"outer_speed_rpm.*must be from"):
        scene(0.0, 2e6)
    with pytest.raises(InputError, match=r"oil_fill.*turning outer ring"):
        scene(0.0, 100.0, effects=Effects.standard().replace(oil_fill=0.3))
