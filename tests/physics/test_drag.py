"""Drag of rollers in the mixture of oil and air: against the closed form, in the energy audit, and nothing where it is off."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import Effects
from trbdyn.errors import InputError

PAPER = Effects.paper()
FLOODED = PAPER.replace(oil_fill=1.0, drag_coefficient=1.2)


def of_cage(sim: SimpleNamespace, fill: float, speed: float) -> float:
    """Torque of the oil on the cage's end faces at a speed (rad/s): two laminar discs, one inside of the other (N m)."""
    oil, bearing = sim.scene.lubricant, sim.scene.bearing
    pitch, cosine = 0.5 * bearing.pitch_diameter, np.cos(np.radians(bearing.cup_half_angle_deg))
    outer, inner = (pitch + cosine * height for height in (bearing.cage.wall_outer, bearing.cage.wall_inner))
    nu = oil.viscosity / oil.density
    return float(1.935 * fill * oil.density * np.sqrt(nu * speed**3) * (outer**4 - inner**4))


def test_closed_form(kit: SimpleNamespace) -> None:
    fill, coefficient = 0.2, 1.3
    sim, still = kit.simulate(PAPER.replace(oil_fill=fill, drag_coefficient=coefficient)), kit.simulate(PAPER)
    vector = kit.perturbed(sim, 4)
    without = np.delete(vector, -1)  # the loss by drag is the last entry, where there is one
    roller, density = sim.scene.bearing.roller, sim.scene.lubricant.density
    area = roller.diameter * roller.total_length
    speed = np.linalg.norm(sim.record(vector)["roller_velocity"], axis=1)
    expected = 0.5 * fill * density * coefficient * area * speed**2
    found, before = sim.contacts(vector), still.contacts(without)
    np.testing.assert_allclose(np.linalg.norm(found["force"] - before["force"], axis=1), expected, rtol=1e-8)
    np.testing.assert_array_equal(found["moment"], before["moment"])
    record = sim.record(vector)
    turning = abs(float(record["cage_angular_velocity"] @ np.array([0.0, 0.0, 1.0])))
    lost = np.sum(expected * speed) + of_cage(sim, fill, turning) * turning
    assert float(record["power_drag"]) == pytest.approx(lost, rel=1e-5)
    for name in ("ring_force", "outer_force", "cage_force", "elastic_energy"):
        np.testing.assert_array_equal(found[name], before[name])
    change = sim.derivative(vector)[:-1] - still.derivative(without)
    slowed = np.linalg.norm(sim.view(np.append(change, 0.0))["roller_v_t"]) * sim.scene.bearing.geometry.roller_mass
    assert slowed == pytest.approx(np.linalg.norm(expected), rel=0.05)


@pytest.mark.parametrize("speed", [500.0, 3000.0])
def test_limits(kit: SimpleNamespace, speed: float) -> None:
    """Power goes with fill, coefficient and the cube of the speed; in pure rolling all rollers have the orbit's speed."""
    sim = kit.simulate(FLOODED, scenery={"speed_rpm": speed})
    geometry, roller = sim.scene.bearing.geometry, sim.scene.bearing.roller
    orbit = geometry.cage_speed_ratio * speed * np.pi / 30.0 * geometry.roller_centre_radius
    one = 0.5 * 1.2 * sim.scene.lubricant.density * roller.diameter * roller.total_length * orbit**3
    turning = geometry.cage_speed_ratio * speed * np.pi / 30.0
    whole = 12 * one + of_cage(sim, 1.0, turning) * turning
    assert float(sim.record()["power_drag"]) == pytest.approx(whole, rel=2e-3)
    half = kit.simulate(FLOODED.replace(oil_fill=0.5), scenery={"speed_rpm": speed})
    assert float(half.record()["power_drag"]) == pytest.approx(0.5 * whole, rel=2e-3)


def test_energy(kit: SimpleNamespace) -> None:
    result = kit.simulate(FLOODED, accuracy="reference").run(duration=6e-3, save_every=1e-5)
    assert result.success
    assert result.counters["drag_rollers"] > 0
    assert result.counters["drag_cages"] > 0
    audit = result.energy_audit
    assert abs(audit.closure) < 1e-3
    lost = result["loss_drag"][-1] - result["loss_drag"][0]
    assert lost == pytest.approx(np.trapezoid(result["power_drag"], result["time"]), rel=1e-3)
    assert audit.losses["drag"] == pytest.approx(lost)
    assert lost > 0.005 * audit.dissipated
    assert "drag" in result.power_split
    assert "drag" in result.torque_by_loss


def test_shaft_pays(kit: SimpleNamespace) -> None:
    """In steady rolling the shaft's work grows by what drag takes."""
    runs = [kit.simulate(effects).run(duration=0.03, save_every=1e-4) for effects in (PAPER, FLOODED)]
    plain, flooded = (run.window(0.015) for run in runs)
    more = np.mean(flooded["power_loss"]) - np.mean(plain["power_loss"])
    assert more > 0.5 * np.mean(flooded["power_drag"])


@pytest.mark.parametrize(("field", "value"), [("oil_fill", -0.1), ("oil_fill", 1.1), ("drag_coefficient", 25.0)])
def test_bad_input(field: str, value: float) -> None:
    with pytest.raises(InputError, match=field):
        trb.Effects(**{field: value})


def test_checkpoint_of_another_length(kit: SimpleNamespace) -> None:
    """A state with the loss by drag is one entry longer: it is refused where it does not fit."""
    long = kit.simulate(FLOODED).state.vector
    short = kit.simulate(PAPER)
    assert long.size == short.state.vector.size + 1
    with pytest.raises((InputError, ValueError)):
        short.set_state(long)
