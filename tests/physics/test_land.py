"""The cage on the land of a ring: its film against Reynolds' equation, closed forms and limits; its contact; its power and its
place in the audit; nothing where it is off.
"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad

import trbdyn as trb
from trbdyn import Effects, Simulation
from trbdyn.errors import InputError
from trbdyn.model.effects import Friction
from trbdyn.model.scene import Start
from trbdyn.results import fields
from trbdyn.results.summary import table
from trbdyn.run.toml_case import case_from_dict

Array = NDArray[np.float64]

PAPER = Effects.paper()
ALONE = PAPER.replace(pocket_bars=False, pocket_ends=False, gravity=False)
"""Nothing but the land touches the cage."""
LOSSES = [field.name.removeprefix("loss_") for field in fields.table() if field.name.startswith("loss_")]
LANDS = ("inner_land", "outer_land")
AXIS = np.array([0.0, 0.0, 1.0])


def land_sim(
    kit: SimpleNamespace, guidance: str, effects: Effects = ALONE, land: dict[str, Any] | None = None, **scenery: Any
) -> Simulation:
    bearing = trb.cases.rig_30310()
    bearing = bearing.replace(land=bearing.land.replace(**(land or {})))
    return kit.simulate(effects.replace(guidance=guidance), scenery={"bearing": bearing, **scenery})


def placed(sim: Simulation, **values: float) -> Array:
    """The start with the cage's entries changed; x, y are places of the cage's centre at the land."""
    vector = sim.state.vector
    state = sim.view(vector)
    for name in ("x", "y", "skew", "tilt", "v_x", "v_y", "v_z", "omega_n", "omega_t"):
        state[f"cage_{name}"] = 0.0
    for name, value in values.items():
        state[f"cage_{name}"] = value
    return vector


def ring_of(sim: Simulation, guidance: str) -> tuple[Array, Array, Array]:
    """Axis, centre and angular velocity of the guiding ring, which is held, at t = 0 (R is inertial there)."""
    if guidance == "outer_land":
        return AXIS, np.zeros(3), np.zeros(3)
    place = sim.equilibrium.displacement
    turn = np.hypot(place[3], place[4])
    axis = (
        AXIS
        if turn == 0.0
        else np.array([np.sin(turn) * place[4] / turn, -np.sin(turn) * place[3] / turn, np.cos(turn)])
    )
    centre = place[:3] + np.array([0.0, 0.0, sim.scene.bearing.geometry.centre_plane])
    return axis, centre, axis * sim.scene.speed_rpm * np.pi / 30.0


def cage_of(kit: SimpleNamespace, sim: Simulation, vector: Array) -> tuple[Array, Array, Array, Array]:
    """Axis, centre of mass, velocity and angular velocity of the cage in R."""
    state, orbit = sim.view(vector), sim.scene.bearing.geometry.cage_speed_ratio * sim.scene.speed_rpm * np.pi / 30.0
    attitude = kit.frame(float(state["cage_skew"]), float(state["cage_tilt"]))
    spin = np.array([float(state[f"cage_omega_{part}"]) for part in "nta"]) + np.array([0.0, 0.0, orbit])
    velocity = np.array([float(state[f"cage_v_{part}"]) for part in "xyz"])
    return attitude.apply(AXIS), kit.cage_place(sim, vector), velocity, attitude.apply(spin)


# ---- the law of the film ----


@pytest.mark.parametrize("e", [0.0, 0.1, 0.5, 0.9, 0.99])
def test_integrals_of_the_film(e: float) -> None:
    for angle_deg in (0.0, 20.0, 90.0, 160.0, 180.0, -60.0):
        integrals_are_those_of_quadrature(e, angle_deg)


def integrals_are_those_of_quadrature(e: float, angle_deg: float) -> None:
    along, across = e * math.cos(math.radians(angle_deg)), e * math.sin(math.radians(angle_deg))
    for law, part in ((trb.laws.journal_along, np.cos), (trb.laws.journal_across, np.sin)):

        def share(t: float, part: Any = part) -> float:
            return float(np.cos(t) * part(t) / (1.0 - along * np.cos(t) - across * np.sin(t)) ** 3)

        wanted, _ = quad(share, -0.5 * np.pi, 0.5 * np.pi, epsrel=1e-10, epsabs=1e-10, limit=500)
        assert law(along, across) == pytest.approx(wanted, rel=1e-8, abs=1e-8)


def film_force(e: float, rate: float, precession: float, turning: float) -> tuple[float, float]:
    """Radial and tangential force on the inner surface over eta R L^3/c^2, at an eccentricity e along the first axis, its
    rate, its precession and the sum of both angular velocities.
    """
    velocity = np.array([rate, e * (precession - 0.5 * turning)])
    speed = float(np.hypot(*velocity))
    u, w = e * velocity[0] / speed, -e * velocity[1] / speed
    along, across = trb.laws.journal_along(u, w), trb.laws.journal_across(u, w)
    force = -(along * velocity + across * np.array([-velocity[1], velocity[0]]))
    return float(force[0]), float(force[1])


@pytest.mark.parametrize("e", [1e-6, 0.1, 0.5, 0.9, 0.99])
@pytest.mark.parametrize("turning", [3.0, -2.0])
def test_steady_journal(e: float, turning: float) -> None:
    """Ocvirk and DuBois 1953."""
    radial, tangential = film_force(e, 0.0, 0.25, turning)
    relative = turning - 0.5
    assert radial == pytest.approx(-abs(relative) * e**2 / (1 - e**2) ** 2, rel=1e-9)
    assert tangential == pytest.approx(relative * np.pi * e / (4.0 * (1 - e**2) ** 1.5), rel=1e-9)


@pytest.mark.parametrize("e", [0.1, 0.5, 0.9])
def test_squeeze_of_a_journal_that_does_not_turn(e: float) -> None:
    """Half of the film carries: more than half of the whole film's force where the gap closes, less where it opens; together
    they are the whole film's, pi (1 + 2 e^2)/(1 - e^2)^2.5. It never pulls.
    """
    closing, opening = film_force(e, 1.0, 0.0, 0.0)[0], film_force(e, -1.0, 0.0, 0.0)[0]
    assert closing < 0.0 < opening
    assert opening - closing == pytest.approx(np.pi * (1 + 2 * e**2) / (1 - e**2) ** 2.5, rel=1e-9)
    assert -closing > 1.5 * opening


@pytest.mark.parametrize("turning", [2.0, -2.0])
def test_small_squeeze_has_a_tangential_force(turning: float) -> None:
    """The slope of the force with the rate of the eccentricity, where the journal turns: radial pi (1 + 2 e^2)/(2 (1 -
    e^2)^2.5), tangential 2 e/(1 - e^2)^2 in the sense of the turning. Formulas without the latter do not fulfil Reynolds'
    equation.
    """
    e, step = 0.5, 1e-7
    (low, left), (high, right) = film_force(e, -step, 0.0, turning), film_force(e, step, 0.0, turning)
    assert (high - low) / (2 * step) == pytest.approx(-np.pi * (1 + 2 * e**2) / (2 * (1 - e**2) ** 2.5), rel=1e-6)
    assert (right - left) / (2 * step) == pytest.approx(np.sign(turning) * 2 * e / (1 - e**2) ** 2, rel=1e-6)


def test_the_film_never_gives_energy() -> None:
    random = np.random.default_rng(3)
    for e in 1.0 - 10.0 ** random.uniform(-4.0, 0.0, 300):
        angle = random.uniform(0.0, 2.0 * np.pi)
        assert trb.laws.journal_along(e * np.cos(angle), e * np.sin(angle)) > 0.0


# ---- the film in the bearing, against Reynolds' equation ----


def reynolds(kit: SimpleNamespace, sim: Simulation, guidance: str, vector: Array) -> tuple[Array, float, float]:
    """Force on the cage (N), torques on cage and ring about their own axes (N m), untilted: from the gap and its change in time,
    differentiated numerically, and the shear stress at each wall."""
    land, eta = sim.scene.bearing.land, sim.scene.lubricant.viscosity
    _, centre, spin = ring_of(sim, guidance)
    _, place, velocity, omega = cage_of(kit, sim, vector)
    apart, inside, c = (place - centre)[:2], guidance == "outer_land", land.clearance
    radius = land.outer_radius if inside else land.inner_radius
    theta = (np.arange(4000) + 0.5) * 2.0 * np.pi / 4000
    normal = np.array([np.cos(theta), np.sin(theta)])

    def gap(time: float) -> Array:
        return np.asarray(c + (-1.0 if inside else 1.0) * (apart + time * velocity[:2]) @ normal)

    film, step = gap(0.0), 1e-3 * c / max(float(np.hypot(*velocity[:2])), 1e-3)
    change = (gap(step) - gap(-step)) / (2.0 * step)
    around = np.gradient(np.concatenate([film[-1:], film, film[:1]]), 2.0 * np.pi / 4000)[1:-1]
    # d/dz (h^3/(12 eta) dp/dz) = (w1 + w2)/2 dh/dtheta + dh/dt, no pressure at both sides: a parabola, its mean over the width
    pressure = np.maximum(-(0.5 * (omega[2] + spin[2]) * around + change) * eta * land.width**2 / film**3, 0.0)
    area = radius * land.width * 2.0 * np.pi / 4000
    inner_force = -(normal * pressure).sum(axis=1) * area
    rise = np.gradient(np.concatenate([pressure[-1:], pressure, pressure[:1]]), 2.0 * np.pi / 4000)[1:-1] / radius
    inner_speed, outer_speed = (omega[2], spin[2]) if inside else (spin[2], omega[2])
    shear = eta * (outer_speed - inner_speed) * radius / film
    on_inner = float(np.sum(shear - 0.5 * film * rise) * area * radius)
    on_outer = float(np.sum(-shear - 0.5 * film * rise) * area * radius)
    force = inner_force if inside else -inner_force
    return force, *((on_inner, on_outer) if inside else (on_outer, on_inner))


@pytest.mark.parametrize("guidance", LANDS)
@pytest.mark.parametrize(
    "motion",
    [
        {"x": 4e-5, "y": -2e-5},
        {"x": 4e-5, "y": -2e-5, "v_x": 3e-2, "v_y": 1e-2},
        {"x": 4e-5, "y": -2e-5, "v_x": -5e-2, "v_y": 2e-2},
        {"x": -7e-5, "y": 3e-5, "v_x": 1e-2, "v_y": 0.2, "omega_a": -400.0},
        {"v_x": 0.1},
    ],
)
def test_film_is_that_of_reynolds_equation(kit: SimpleNamespace, guidance: str, motion: dict[str, float]) -> None:
    sim = land_sim(kit, guidance)
    vector = placed(sim, **motion)
    found = sim.contacts(vector, 0.0)
    force, on_cage, on_ring = reynolds(kit, sim, guidance, vector)
    size = float(np.hypot(*force))
    assert size > 0.0
    np.testing.assert_allclose(found["hub_cage_force"][:2], force, atol=2e-5 * size)
    ring = "ring" if guidance == "inner_land" else "outer"
    np.testing.assert_allclose(found[f"hub_{ring}_force"], -found["hub_cage_force"], atol=1e-12 * size)
    # about the own axes: the cage's centre of mass lies on its axis, the ring's reference point on its own
    scale = abs(on_cage) + abs(on_ring)
    assert found["hub_cage_moment"][2] == pytest.approx(on_cage, abs=2e-4 * scale)
    assert found[f"hub_{ring}_moment"][2] == pytest.approx(on_ring, abs=2e-4 * scale)
    apart = kit.cage_place(sim, vector)[:2] - ring_of(sim, guidance)[1][:2]
    assert on_cage + on_ring == pytest.approx(-(apart[0] * force[1] - apart[1] * force[0]), abs=2e-4 * scale)


@pytest.mark.parametrize("guidance", LANDS)
def test_a_centred_cage(kit: SimpleNamespace, guidance: str) -> None:
    """Half of the whole film's damping, pi eta R L^3/(2 c^3), and Petroff's torque."""
    sim = land_sim(kit, guidance)
    land, eta = sim.scene.bearing.land, sim.scene.lubricant.viscosity
    radius = land.inner_radius if guidance == "inner_land" else land.outer_radius
    _, centre, spin = ring_of(sim, guidance)
    found = sim.contacts(placed(sim, x=centre[0], y=centre[1], v_x=0.02, v_y=-0.05), 0.0)
    damping = 0.5 * np.pi * eta * radius * land.width**3 / land.clearance**3
    np.testing.assert_allclose(found["hub_cage_force"], [-0.02 * damping, 0.05 * damping, 0.0], rtol=1e-9, atol=1e-12)
    orbit = sim.scene.bearing.geometry.cage_speed_ratio * 3000.0 * np.pi / 30.0
    torque = 2.0 * np.pi * eta * radius**3 * land.width / land.clearance * (spin[2] - orbit)
    assert found["hub_cage_moment"][2] == pytest.approx(torque, rel=1e-9)
    assert found["land_torque"] == pytest.approx(torque, rel=1e-9)
    assert found["land_eccentricity"] == pytest.approx(0.0, abs=1e-9)


def test_starved_film(kit: SimpleNamespace) -> None:
    """Force with the cube of the filled width, torque with the width; none without oil."""
    states = []
    for fill in (1.0, 0.5, 0.0):
        sim = land_sim(kit, "outer_land", land={"fill": fill})
        states.append(sim.contacts(placed(sim, x=3e-5, v_x=0.1), 0.0))
    full, half, none = states
    np.testing.assert_allclose(half["hub_cage_force"], full["hub_cage_force"] / 8.0, rtol=1e-9, atol=1e-15)
    assert half["hub_power"][LOSSES.index("land_film")] > 0.0
    centred = [land_sim(kit, "outer_land", land={"fill": fill}) for fill in (1.0, 0.5)]
    torques = [float(sim.contacts(placed(sim), 0.0)["land_torque"]) for sim in centred]
    assert torques[1] == pytest.approx(0.5 * torques[0], rel=1e-9)
    assert not none["hub_cage_force"].any()
    assert not none["hub_power"].any()


# ---- forces, moments, power ----


@pytest.mark.parametrize("guidance", LANDS)
@pytest.mark.parametrize("lubrication", ["mixed", "boundary", "dry"])
def test_action_is_reaction(kit: SimpleNamespace, guidance: str, lubrication: str) -> None:
    effects = Effects.standard().replace(lubrication=lubrication)
    sim = land_sim(kit, guidance, effects, radial_load=2000.0, misalignment_x=1e-3, misalignment_y=-5e-4)
    ring = "ring" if guidance == "inner_land" else "outer"
    _, centre, _ = ring_of(sim, guidance)
    for seed in range(6):
        vector = kit.perturbed(sim, seed)
        found = sim.contacts(vector, 0.0)
        force = found["hub_cage_force"]
        size = float(np.linalg.norm(force))
        assert size > 1.0
        np.testing.assert_allclose(found[f"hub_{ring}_force"], -force, atol=1e-12 * size)
        moment = found["hub_cage_moment"] + np.cross(kit.cage_place(sim, vector), force)
        moment += found[f"hub_{ring}_moment"] + np.cross(centre, found[f"hub_{ring}_force"])
        assert np.abs(moment).max() < 1e-12 * size * 0.3
        other = "outer" if ring == "ring" else "ring"
        assert not found[f"hub_{other}_force"].any()
        assert not found[f"hub_{other}_moment"].any()


@pytest.mark.parametrize("guidance", LANDS)
def test_losses_are_minus_the_power_of_the_forces(kit: SimpleNamespace, guidance: str) -> None:
    """At random states of a tilted cage: work put in less the growth of kinetic and elastic energy, by differences."""
    effects = ALONE.replace(damping="hunt_crossley", damping_race=0.0, damping_cage=0.5, gravity=True)
    sim = land_sim(kit, guidance, effects, radial_load=2000.0, misalignment_x=5e-4)
    seen = set()
    for seed in range(5):
        vector = kit.perturbed(sim, 60 + seed)
        if seed % 2:
            sim.view(vector)["cage_x"] *= 0.2
            sim.view(vector)["cage_y"] *= 0.2
        rates, step = sim.derivative(vector), 1e-10
        up, down = (sim.record(vector + sign * step * rates, sign * step) for sign in (1.0, -1.0))
        growth = sum((up[name] - down[name]) / (2.0 * step) for name in ("kinetic_energy", "elastic_energy"))
        works = ("work_shaft", "work_ring", "work_gravity")
        put_in = sum(float((up[name] - down[name]) / (2.0 * step)) for name in works)
        record = sim.record(vector)
        lost = float(record["power_loss"])
        size = abs(put_in) + abs(lost) + abs(float((up["elastic_energy"] - down["elastic_energy"]) / (2.0 * step)))
        assert put_in - float(growth) == pytest.approx(lost, abs=2e-5 * size)
        for name in ("land", "land_film", "damping"):
            assert float(record[f"power_{name}"]) >= 0.0
            seen |= {name} if float(record[f"power_{name}"]) > 0.0 else set()
    assert seen == {"land", "land_film", "damping"}


@pytest.mark.parametrize("guidance", LANDS)
def test_contact(kit: SimpleNamespace, guidance: str) -> None:
    """Dry: Palmgren's load over the width, Coulomb friction at the land's radius; nothing before the stated height of the
    film.
    """
    effects = ALONE.replace(lubrication="dry")
    sim = land_sim(kit, guidance, effects, land={"contact_film": 5e-6})
    land, (_, centre, spin) = sim.scene.bearing.land, ring_of(sim, guidance)
    inside = guidance == "outer_land"
    radius = land.outer_radius if inside else land.inner_radius
    clear = sim.contacts(placed(sim, x=centre[0] + 94.9e-6, y=centre[1]), 0.0)
    assert not clear["hub_cage_force"].any()
    assert clear["land_gap"] == pytest.approx(5.1e-6, rel=1e-6)
    vector = placed(sim, x=centre[0] + 105e-6, y=centre[1])
    found = sim.contacts(vector, 0.0)
    load = trb.laws.line_load(10e-6, 206e9 / (1 - 0.3**2), land.width) * land.width
    assert found["hub_cage_force"][0] == pytest.approx(-load, rel=1e-9)
    assert found["land_contact_force"] == pytest.approx(load, rel=1e-9)
    assert found["land_gap"] == pytest.approx(-5e-6, rel=1e-6)
    _, _, _, omega = cage_of(kit, sim, vector)
    arm = radius if inside else -radius  # the cage round the land touches it on the other side
    slip = arm * (omega[2] - spin[2]) - 105e-6 * omega[2]  # the axis of the cage lies that far from the land's
    friction = 0.1 * load * slip / np.hypot(slip, 0.01)
    assert found["hub_cage_force"][1] == pytest.approx(-friction, rel=1e-6)
    assert found["land_friction"] == pytest.approx(abs(friction), rel=1e-6)
    assert found["hub_power"][LOSSES.index("land")] == pytest.approx(abs(friction * slip), rel=1e-6)
    assert found["hub_elastic_energy"] == pytest.approx(9.0 / 19.0 * load * 10e-6, rel=1e-9)


@pytest.mark.parametrize("guidance", LANDS)
def test_contact_alone_conserves_energy(kit: SimpleNamespace, guidance: str) -> None:
    """A tilting cage that bounces on the land, without friction and film."""
    effects = Effects.frictionless().replace(pocket_bars=False, pocket_ends=False, gravity=False)
    drift = []
    for rtol in (1e-5, 1e-7):
        scenery = {"radial_load": 1500.0}
        sim = kit.simulate(effects.replace(guidance=guidance), scenery=scenery, rings_share=0.0, **kit.tolerances(rtol))
        vector = placed(sim, v_x=0.4, v_y=-0.2, v_z=0.05, omega_n=5.0, omega_t=-8.0)
        sim.set_state(vector)
        result = sim.run(duration=3e-3, save_every=1e-5)
        assert result["land_contact_force"].max() > 100.0
        assert not result["land_film_force"].any()
        assert not result.power_loss.any()
        moving = 0.5 * sim.scene.bearing.cage.mass * (0.4**2 + 0.2**2)
        drift.append(float(np.abs(result.energy_balance["residual"]).max()) / moving)
    assert drift[1] < 1e-4
    assert drift[1] < 0.2 * drift[0]


@pytest.mark.parametrize("preset", ["fast", "standard", "reference"])
@pytest.mark.parametrize("mass", [0.02, 0.2, 2.5])
def test_no_preset_makes_energy_in_a_hit(kit: SimpleNamespace, mass: float, preset: str) -> None:
    """A cage that hits the land in its centre rebounds with its speed, however gentle the hit."""
    effects = Effects.frictionless().replace(pocket_bars=False, pocket_ends=False, gravity=False, guidance="outer_land")
    rig = trb.cases.rig_30310()
    inertia = {name: getattr(rig.cage, name) * mass / rig.cage.mass for name in ("inertia_axial", "inertia_transverse")}
    bearing = rig.replace(land=rig.land.replace(offset=0.0), cage=rig.cage.replace(mass=mass, **inertia))
    room = bearing.land.clearance - bearing.land.contact_film
    for speed in (3e-4, 1e-3, 1e-2, 0.1):
        sim = kit.simulate(effects, scenery={"bearing": bearing, "speed_rpm": 0.0}, accuracy=preset)
        sim.set_state(placed(sim, x=room - 2e-6, v_x=speed))
        for _ in range(5000):
            sim.step()
            now = sim.view(sim.state.vector)
            if float(now["cage_v_x"]) < 0.0 and float(now["cage_x"]) < room - 1e-6:
                break
        assert 0.9 < -float(now["cage_v_x"]) / speed < 1.01, f"{1e3 * speed:g} mm/s"


# ---- continuity ----


def forces(kit: SimpleNamespace, sim: Simulation, states: list[dict[str, float]]) -> Array:
    return np.array([sim.contacts(placed(sim, **state), 0.0)["hub_cage_force"] for state in states])


@pytest.mark.parametrize("guidance", LANDS)
@pytest.mark.parametrize("speed", [3000.0, 100.0])
def test_continuous_in_the_place(kit: SimpleNamespace, guidance: str, speed: float) -> None:
    """Through the centre, the onset of contact, and beyond the clearance: halving the step halves the largest jump."""
    sim = land_sim(kit, guidance, land={"contact_film": 1e-6}, speed_rpm=speed, displacement=(0.0, 0.0, -2e-5))
    for low, high in ((-1e-7, 1e-7), (98.9e-6, 99.1e-6), (99.9e-6, 100.2e-6)):
        jumps = []
        for count in (41, 81):
            places = np.linspace(low, high, count)
            values = forces(kit, sim, [{"x": x, "v_x": 0.05, "v_y": -0.02} for x in places])
            assert np.isfinite(values).all()
            jumps.append(np.abs(np.diff(values, axis=0)).max())
        assert jumps[1] < 0.65 * jumps[0], (low, jumps)


@pytest.mark.parametrize("e", [0.0, 0.5, 0.98])
def test_continuous_where_the_mean_speed_reverses(kit: SimpleNamespace, e: float) -> None:
    """Where everything that moves the oil vanishes, so does the force; across it there is no jump."""
    sim = land_sim(kit, "outer_land")
    orbit = sim.scene.bearing.geometry.cage_speed_ratio * float(sim.record()["shaft_speed"])
    x, sizes = 1e-4 * e, []
    for off in (1e-6, 1e-8, 0.0):
        values = forces(
            kit, sim, [{"x": x, "omega_a": sign * off - orbit, "v_x": sign * off * 1e-5} for sign in (1, -1)]
        )
        sizes.append(np.abs(values).max())
    assert sizes[1] < 2e-2 * sizes[0] + 1e-15
    assert sizes[2] == 0.0


def test_tilted_cage(kit: SimpleNamespace) -> None:
    """A film along the whole circle that the cage tilts into presses it back, so that its axis is erected; strips converge to the
    integral over the width."""
    sim = land_sim(kit, "outer_land")
    land, eta = sim.scene.bearing.land, sim.scene.lubricant.viscosity
    # the cage turns about the middle of its guiding surface
    arm = land.offset - sim.scene.bearing.cage.offset
    rate = 20.0
    vector = placed(sim, omega_t=rate, v_x=-rate * arm)
    found = sim.contacts(vector, 0.0)
    # along x the surface moves with rate z; short-bearing force of each slice, half of the film on either side
    moment = -0.5 * np.pi * eta * land.outer_radius * rate / land.clearance**3 * land.width**5 / 20.0
    about_middle = found["hub_cage_moment"] - np.cross([0.0, 0.0, arm], found["hub_cage_force"])
    assert np.abs(found["hub_cage_force"][:2]).max() < 1e-6 * abs(moment) / land.width
    assert about_middle[1] == pytest.approx(moment, rel=1e-6)


# ---- runs ----

RUNS: dict[str, tuple[Effects, dict[str, Any]]] = {
    "1000 rpm": (PAPER, {"speed_rpm": 1000.0}),
    "3000 rpm": (Effects.standard(), {}),
    "10000 rpm": (Effects.standard(), {"speed_rpm": 10000.0}),
    "whirl": (Effects.standard(), {"start": Start.whirl(0.35)}),
    "combined": (Effects.standard(), {"radial_load": 3000.0}),
    "dry": (PAPER.replace(lubrication="dry"), {}),
    "boundary": (PAPER.replace(lubrication="boundary"), {}),
}


@pytest.mark.parametrize("guidance", LANDS)
@pytest.mark.parametrize("case", RUNS)
def test_energy(kit: SimpleNamespace, guidance: str, case: str) -> None:
    effects, scenery = RUNS[case]
    sim = kit.simulate(effects.replace(guidance=guidance), scenery=scenery)
    vector = sim.state.vector
    state = sim.view(vector)
    state["cage_v_x"] += 0.15
    state["cage_v_y"] -= 0.1
    sim.set_state(vector)
    result = sim.run(duration=8e-3, save_every=2e-5)
    assert result.success
    assert result.energy_closure < 1e-3
    lost, films = float(result["loss_land_film"][-1]), effects.films
    assert (lost > 0.0) is films
    assert (result.counters["land_films"] > 0) is films
    # a film keeps the cage off the land
    assert bool(result["land_contact_force"].max() > 100.0) is not films
    assert bool(result["land_film_force"].max() > 10.0) is films
    for name in ("loss_land_film", "loss_land"):
        # records are interpolated between steps: a loss that begins at a hit may dip by a rounding of the whole
        assert np.diff(result[name]).min() >= -1e-5 * float(result[name][-1]) - 1e-12
    audit = result.energy_audit
    assert audit.losses["land_film"] == pytest.approx(lost)
    assert "land" in result.power_split
    assert ("land" in result.torque_split) is True
    if films:
        later = result.window(1e-3)  # the film that is closed at the start stops the cage within microseconds
        grown = later["loss_land_film"][-1] - later["loss_land_film"][0]
        assert grown == pytest.approx(np.trapezoid(later["power_land_film"], later["time"]), rel=0.02)


def test_closure_falls_with_the_tolerance(kit: SimpleNamespace) -> None:
    closures = []
    for rtol in (1e-4, 1e-6):
        sim = kit.simulate(Effects.standard().replace(guidance="inner_land"), **kit.tolerances(rtol))
        vector = sim.state.vector
        sim.view(vector)["cage_v_x"] += 0.2
        sim.set_state(vector)
        result = sim.run(duration=5e-3, save_every=1e-4)
        closures.append(float(np.abs(result.energy_balance["residual"]).max()) / result.energy_audit.dissipated)
    assert closures[1] < 1e-4
    assert closures[1] < 0.2 * closures[0]


@pytest.mark.parametrize("guidance", LANDS)
def test_a_land_keeps_the_cage(kit: SimpleNamespace, guidance: str) -> None:
    """A cage that would use up the play of its pockets stays within the land's clearance."""
    cage, land = trb.cases.rig_30310().cage, trb.cases.rig_30310().land
    reached = {}
    for name in ("rollers", guidance):
        scenery = {"start": Start.whirl(0.35)}
        result = kit.simulate(Effects.standard().replace(guidance=name), scenery=scenery).run(
            duration=0.02, save_every=1e-4
        )
        reached[name] = float(np.hypot(*result["cage_rail_position"][:, :2].T).max())
    assert land.clearance < 0.5 * cage.play_radial
    assert reached[guidance] < 1.02 * land.clearance + 2e-6
    assert reached[guidance] < reached["rollers"] + 2e-6


def test_explicit_method_agrees(kit: SimpleNamespace) -> None:
    """Both integrators, over a stretch with a hit through a thin film."""
    ends = []
    bearing = trb.cases.rig_30310()
    bearing = bearing.replace(land=bearing.land.replace(fill=0.1))
    for options in ({"integrator": "bdf"}, {"integrator": "erk"}):
        effects = Effects.standard().replace(guidance="outer_land")
        sim = kit.simulate(effects, scenery={"bearing": bearing}, accuracy="reference", **options)
        vector = sim.state.vector
        sim.view(vector)["cage_v_x"] += 0.3
        sim.set_state(vector)
        result = sim.run(duration=6e-4, save_every=1e-5)
        assert result["land_contact_force"].max() > 10.0
        assert result["loss_land_film"][-1] > 0.0
        ends.append(result["cage_velocity"][-1])
    np.testing.assert_allclose(ends[0], ends[1], atol=2e-3 * 0.3)


@pytest.mark.parametrize("guidance", LANDS)
def test_peaks_and_summary(kit: SimpleNamespace, guidance: str) -> None:
    sim = kit.simulate(Effects.standard().replace(guidance=guidance))
    vector = sim.state.vector
    sim.view(vector)["cage_v_x"] += 0.3
    sim.set_state(vector)
    result = sim.run(duration=4e-3, save_every=1e-5)
    assert float(result.peaks["land_force_peak"]) >= 0.99 * result["land_force"].max()
    assert float(result.peaks["land_gap_min"]) <= result["land_gap"].min() + 1e-9
    summary = result.summary()
    assert summary["land_force_peak"] > 0.0
    assert summary["land_gap_min"] < 1e-4
    assert "gap between cage and land" in table(summary)


# ---- off, starts and bad input ----


def test_off(kit: SimpleNamespace) -> None:
    """Its numbers do nothing, to the bit, and nothing is evaluated."""
    bearing = trb.cases.rig_30310()
    ends = []
    for land in (bearing.land, bearing.land.replace(clearance=1e-5, contact_film=1e-6, inner_radius=0.05)):
        sim = kit.simulate(Effects.standard(), scenery={"bearing": bearing.replace(land=land)})
        result = sim.run(duration=2e-3)
        assert result.counters["land_films"] == result.counters["land_contacts"] == 0
        for field in result.fields:
            if "land" in field.name and not field.name.endswith("_time"):
                assert not result[field.name].any(), field.name
        assert "land_force_peak" not in {name for name, value in result.summary().items() if value is not None}
        ends.append(sim.state.vector)
    np.testing.assert_array_equal(*ends)


def test_a_state_has_the_land_s_losses_only_with_a_land(kit: SimpleNamespace) -> None:
    sizes = {
        (guidance, fill): kit.simulate(PAPER.replace(guidance=guidance, oil_fill=fill)).state.vector.size
        for guidance in ("rollers", *LANDS)
        for fill in (0.0, 0.1)
    }
    usual = sizes["rollers", 0.0]
    assert sizes["rollers", 0.1] == usual + 1
    assert {sizes[guidance, fill] for guidance in LANDS for fill in (0.0, 0.1)} == {
        usual + 4
    }  # drag, and the films of pockets, stand before the land's two


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("width", 0.0),
        ("clearance", -1e-4),
        ("clearance", math.nan),
        ("contact_film", 6e-5),
        ("contact_film", 5e-9),
        ("fill", 1.5),
        ("inner_radius", "wide"),
        ("clearence", 1e-4),
    ],
)
def test_bad_land(field: str, value: Any) -> None:
    bearing = trb.cases.rig_30310()
    with pytest.raises(InputError, match=rf"land\.?.*{field}") as caught:
        bearing.replace(land={**bearing.land.to_dict(), field: value})
    if field == "clearence":
        assert "clearance" in str(caught.value)


def test_bad_guidance() -> None:
    with pytest.raises(InputError, match=r"guidance.*inner_land"):
        Effects(guidance="inner")
    with pytest.raises(InputError, match="needs a cage"):
        Effects(guidance="inner_land", bodies="rollers")


def test_a_start_beyond_the_land(kit: SimpleNamespace) -> None:
    effects = PAPER.replace(guidance="outer_land")
    with pytest.raises(InputError, match=r"eccentricity.*0\.39"):
        kit.scene(effects, start=Start.whirl(0.9))
    assert kit.scene(effects, start=Start.whirl(0.39)).start.eccentricity == 0.39
    assert kit.scene(PAPER, start=Start.whirl(0.9)).start.eccentricity == 0.9


@pytest.mark.parametrize("guidance", LANDS)
@pytest.mark.parametrize(("lubrication", "gap"), [("dry", 0.5e-6), ("mixed", 25e-6)])
def test_a_cage_begins_on_the_land_that_it_would_pass(
    kit: SimpleNamespace, guidance: str, lubrication: str, gap: float
) -> None:
    """At the point of touching, or at half of the clearance where oil carries it."""
    sim = land_sim(kit, guidance, PAPER.replace(lubrication=lubrication), land={"clearance": 5e-5})
    found = sim.contacts()
    assert float(found["land_gap"]) == pytest.approx(gap, abs=2e-8)
    assert float(found["land_contact_force"]) == 0.0


def test_a_start_that_presses_the_cage_into_its_land_is_told(kit: SimpleNamespace) -> None:
    with pytest.warns(UserWarning, match=r"pressed .* um into the land"):
        land_sim(
            kit, "inner_land", PAPER, land={"clearance": 5e-6}, displacement=(4e-5, 0.0, -6e-5), start=Start.whirl(0.0)
        )


def test_in_a_case_file() -> None:
    case = {
        "bearing": {"case": "30310", "land": {"clearance": 8e-5}},
        "effects": {"guidance": "inner_land"},
        "scene": {"speed_rpm": 2000.0, "axial_load": 3000.0},
    }
    scene, _ = case_from_dict(case)
    assert scene.effects.guidance == "inner_land"
    assert scene.bearing.land.clearance == 8e-5
    assert scene.bearing.land.contact_film == pytest.approx(8e-7)
    assert "land.clearance" not in scene.bearing.assumed
    assert scene.bearing.assumed["land.width"] == pytest.approx(3e-3)


def test_boundary_friction_of_the_land_follows_the_scene(kit: SimpleNamespace) -> None:
    effects = ALONE.replace(lubrication="dry", friction=Friction(dry_friction=0.0))
    sim = land_sim(kit, "outer_land", effects)
    found = sim.contacts(placed(sim, x=1.02e-4), 0.0)
    assert found["land_contact_force"] > 0.0
    assert found["land_friction"] == 0.0
