"""Every recorded field, computed a second time from the state and the contacts, at states where nothing is zero or
symmetric; and which source each share of torque and power comes from."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from trbdyn import Effects, Simulation
from trbdyn.model.cases import rig_30310
from trbdyn.model.effects import Friction
from trbdyn.results import fields

Array = NDArray[np.float64]

QUADRATURES = [field.name for field in fields.table() if field.name.startswith(("work_", "loss_"))]
POWERS = [field.name for field in fields.table() if field.name.startswith("power_") and field.name != "power_loss"]
TORQUES = [field.name for field in fields.table() if field.name.startswith("inner_torque_")]
TIME = 3e-3
AXIS = np.array([0.0, 0.0, 1.0])


def quaternion(rotation: Rotation) -> Array:
    """(w, x, y, z) with w >= 0."""
    x, y, z, w = rotation.as_quat()
    return np.array([w, x, y, z]) * (1.0 if w >= 0.0 else -1.0)


def weighted(values: Array, load: Array) -> Array:
    """Mean over the nodes, weighted by load."""
    total = load.sum(axis=-1)
    return np.where(total > 0.0, (values * load).sum(axis=-1) / np.where(total > 0.0, total, 1.0), 0.0)


def vectors(found: dict[str, Array], letter: str) -> Array:
    return np.stack([found[f"raceway_{letter}{axis}"] for axis in "xyz"], axis=-1)


def bodies(kit: SimpleNamespace, sim: Simulation, vector: Array, shaft: float) -> dict[str, Any]:
    """Kinematic fields, from the definitions of the state's coordinates."""
    bearing, state, geometry = sim.scene.bearing, sim.view(vector), sim.scene.bearing.geometry
    speed, angle = shaft * np.pi / 30.0, shaft * np.pi / 30.0 * TIME
    orbit, turn = geometry.cage_speed_ratio * speed, geometry.cage_speed_ratio * angle
    out: dict[str, Any] = {"time": TIME, "shaft_angle": angle, "shaft_speed": speed}

    to_inertial, attitude = kit.about_z(turn), kit.frame(float(state["cage_skew"]), float(state["cage_tilt"]))
    axis, centre = attitude.apply(AXIS), kit.cage_place(sim, vector)
    heights = {"cage_position": 0.0, "cage_rail_position": bearing.cage.rail_offset}
    for name, height in heights.items():
        point = centre + (height - bearing.cage.offset) * axis
        out[name] = to_inertial.apply(point) - [0.0, 0.0, geometry.centre_plane + height]
    out["cage_velocity"] = to_inertial.apply([float(state[f"cage_v_{part}"]) for part in "xyz"])
    spin = [float(state[f"cage_omega_{part}"]) for part in "nta"] + np.array([0.0, 0.0, orbit])
    out["cage_angular_velocity"] = (to_inertial * attitude).apply(spin)
    out["cage_orientation"] = quaternion(to_inertial * attitude * kit.about_z(float(state["cage_psi"])))
    out["cage_angle"] = turn + float(state["cage_psi"])
    x, y, z = to_inertial.apply(axis)
    out["cage_tilt"] = [-np.arctan2(y, z), np.arctan2(x, z)]
    cage_energy = np.dot([bearing.cage.inertia_transverse] * 2 + [bearing.cage.inertia_axial], spin**2)
    energy = 0.5 * (bearing.cage.mass * np.sum(out["cage_velocity"] ** 2) + cage_energy)

    rollers: dict[str, list[Any]] = {}
    for j, place in enumerate(kit.orbit_angles(sim, vector)):
        own = {part: float(state[f"roller_{part}"][j]) for part in ("skew", "tilt", "v_r", "v_t", "v_z")}
        position, to_inertial = kit.roller_place(sim, vector, j), kit.about_z(turn + place)
        attitude = kit.frame(own["skew"], geometry.roller_axis_angle + own["tilt"])
        velocity = np.array([own["v_r"], own["v_t"] + orbit * geometry.roller_centre_radius, own["v_z"]])
        sine, cosine = np.sin(geometry.roller_axis_angle), np.cos(geometry.roller_axis_angle)
        rolling = np.array([-orbit * sine, 0.0, orbit * cosine - geometry.roller_spin_ratio * speed])
        omega = rolling + [float(state[f"roller_omega_{part}"][j]) for part in "nta"]
        turned = -geometry.roller_spin_ratio * angle + float(state["spin_angle"][j])
        orbit_speed = velocity[1] / position[0]
        row = {
            "position": to_inertial.apply(position),
            "orientation": quaternion(to_inertial * attitude * kit.about_z(turned)),
            "velocity": to_inertial.apply(velocity),
            "angular_velocity": (to_inertial * attitude).apply(omega),
            "orbit_angle": turn + place,
            "orbit_speed": orbit_speed,
            "spin_speed": omega[2] - orbit_speed * attitude.apply(AXIS)[2],
            "skew": own["skew"],
            "tilt": own["tilt"],
        }
        inertia = [geometry.roller_inertia_transverse] * 2 + [geometry.roller_inertia_axial]
        energy += 0.5 * (geometry.roller_mass * np.sum(velocity**2) + np.dot(inertia, omega**2))
        for name, value in row.items():
            rollers.setdefault(f"roller_{name}", []).append(value)
    land = {f"land_{name}": value for name, value in guided(kit, sim, vector).items()}
    return out | rollers | {"kinetic_energy": energy} | land


def guided(kit: SimpleNamespace, sim: Simulation, vector: Array) -> dict[str, float]:
    """How the cage lies in the land, from poses; its forces as the contacts tell them."""
    land, geometry = sim.scene.bearing.land, sim.scene.bearing.geometry
    place, found = sim.equilibrium.displacement, sim.contacts(vector, TIME)
    turn = kit.about_z(kit.frame_angle(sim, vector, TIME)).inv()
    axis = turn.apply(kit.frame(-place[3], place[4]).apply(AXIS))
    centre = turn.apply(place[:3]) + np.array([0.0, 0.0, geometry.centre_plane])

    def apart(station: float) -> float:
        along = land.offset - sim.scene.bearing.cage.offset + station
        point = kit.cage_place(sim, vector) + along * kit.cage_attitude(sim, vector).apply(AXIS) - centre
        return float(np.linalg.norm(point - (point @ axis) * axis))

    strips = 0.5 * land.width * np.polynomial.legendre.leggauss(6)[0]
    names = ("force", "film_force", "contact_force", "friction", "torque")
    out = {name: float(found[f"land_{name}"]) for name in names}
    out["eccentricity"] = apart(0.0) / land.clearance
    out["gap"] = land.clearance - max(apart(station) for station in strips)
    return out


def contacts(
    kit: SimpleNamespace, sim: Simulation, vector: Array, found: dict[str, Array], sign: float
) -> dict[str, Any]:
    """Fields of the contacts, from their nodes."""
    out: dict[str, Any] = {}
    sliding, mean = vectors(found, "s"), vectors(found, "m")
    unloaded = found["raceway_load"] <= 0.0
    sliding[unloaded] = mean[unloaded] = [0.0, 1.0, 0.0]
    load, friction = found["raceway_load"], found["raceway_friction_coefficient"]
    slide_roll = np.sum(sliding * mean, axis=-1) / np.sum(mean * mean, axis=-1)
    along = sliding[..., 1] / np.linalg.norm(sliding, axis=-1), mean[..., 1] / np.linalg.norm(mean, axis=-1)
    traction = -(load * friction * along[0] + found["raceway_rolling"] * along[1])
    for race, side in enumerate(("outer", "inner")):
        out[f"{side}_load"] = load[race].sum(axis=-1)
        out[f"{side}_pressure"] = np.where(load[race] > 0.0, found["raceway_pressure"][race], 0.0).max(axis=-1)
        out[f"{side}_film"] = weighted(found["raceway_film"][race], load[race])
        out[f"{side}_film_parameter"] = weighted(found["raceway_film_parameter"][race], load[race])
        out[f"{side}_slide_roll"] = weighted(slide_roll[race], load[race])
        out[f"{side}_traction"] = traction[race].sum(axis=-1)
        lost = load[race] * friction[race] * np.linalg.norm(sliding[race], axis=-1)
        out[f"power_traction_{side}"] = lost.sum()
    for name in ("load", "pressure", "film", "film_parameter", "height", "overhang"):
        out[f"rib_{name}"] = found[f"rib_{name}"]
    touched = found["rib_load"] > 0.0
    ratio = found["rib_sliding_speed"] / np.where(touched, found["rib_mean_speed"], 1.0)
    out["rib_slide_roll"] = np.where(touched, ratio, 0.0)
    out["rib_friction"] = found["rib_load"] * found["rib_friction_coefficient"]
    out["power_rib"] = np.sum(out["rib_friction"] * found["rib_sliding_speed"])
    out["front_rib_load"] = found["front_rib_load"]
    out["pocket_force"], out["pocket_friction"] = found["pocket_load"], found["pocket_friction"]
    return out


def sums(kit: SimpleNamespace, sim: Simulation, vector: Array, found: dict[str, Array], sign: float) -> dict[str, Any]:
    """Forces, torques and their shares, turned to inertial coordinates and summed."""
    scene, turn = sim.scene, kit.frame_angle(sim, vector, TIME)
    displacement = sim.equilibrium.displacement
    ring_axis = kit.frame(-displacement[3], displacement[4]).apply(AXIS)
    turns = [kit.about_z(turn + angle) for angle in kit.orbit_angles(sim, vector)]
    out: dict[str, Any] = {"ring_position": displacement[:3], "ring_velocity": np.zeros(3)}
    axis = Rotation.from_rotvec([displacement[3], displacement[4], 0.0]).apply(AXIS)
    out["ring_tilt"] = np.array([-np.arctan2(axis[1], axis[2]), np.arctan2(axis[0], axis[2])])
    out["ring_angular_velocity"] = scene.speed_rpm * np.pi / 30.0 * axis
    in_r = kit.about_z(turn)
    for name in ("force", "moment"):
        out[f"ring_{name}"] = sum(t.apply(v) for t, v in zip(turns, found[f"ring_{name}"], strict=True))
        out[f"ring_{name}"] += in_r.apply(found[f"hub_ring_{name}"])
        out[f"cage_{name}"] = in_r.apply(found[f"cage_{name}"].sum(axis=0) + found[f"hub_cage_{name}"])
    for name in ("position", "velocity", "angular_velocity"):
        out[f"housing_{name}"] = np.zeros(3)  # an outer ring at rest
    out["housing_tilt"] = np.zeros(2)
    force, moment = (
        sum(t.apply(v) for t, v in zip(turns, found[f"outer_{name}"], strict=True)) for name in ("force", "moment")
    )
    arm = [0.0, 0.0, scene.bearing.geometry.centre_plane]
    out |= {"housing_force": force, "housing_moment": moment - np.cross(arm, force)}
    out["inner_torque"] = -sign * out["ring_moment"] @ ring_axis
    out["outer_torque"] = sign * found["outer_moment"][:, 2].sum()
    points, sliding, mean = (vectors(found, letter)[1] for letter in "psm")
    load = found["raceway_load"][1]
    sliding[load <= 0.0] = mean[load <= 0.0] = [0.0, 1.0, 0.0]
    drag = (load * found["raceway_friction_coefficient"][1] / np.linalg.norm(sliding, axis=-1))[
        ..., np.newaxis
    ] * sliding
    resistance = np.where(load > 0.0, found["raceway_rolling"][1] / np.linalg.norm(mean, axis=-1), 0.0)
    centre = np.add(displacement[:3], (0.0, 0.0, scene.bearing.geometry.centre_plane))
    for name, force in (("traction", drag), ("rolling", -resistance[..., np.newaxis] * mean)):
        moments = [
            t.apply(np.cross(p - t.inv().apply(centre), f).sum(axis=0))
            for t, p, f in zip(turns, points, force, strict=True)
        ]
        out[f"inner_torque_{name}"] = -sign * np.sum(moments, axis=0) @ ring_axis
    out["inner_torque_land"] = -sign * in_r.apply(found["hub_ring_moment"]) @ ring_axis
    out["elastic_energy"] = found["elastic_energy"].sum() + found["hub_elastic_energy"]
    power = found["power"].sum(axis=0) + found["hub_power"]
    for k, name in enumerate(POWERS):
        out.setdefault(name, power[k] if k < len(power) else 0.0)  # a held ring loses nothing in supports
    out["power_loss"] = power.sum()
    return out


OF_RIBS = ("load", "pressure", "film", "film_parameter", "slide_roll", "friction", "height", "overhang")
OF_CYLINDERS = tuple(
    f"{rib}_{name}"
    for rib in ("front_rib", "outer_rib", "outer_front_rib")
    for name in OF_RIBS
    if (rib, name) != ("front_rib", "load")
)
PARTLY = ("inner_torque_rolling", "outer_traction", "inner_traction", "outer_torque", "inner_torque", "power_rolling")
AT_REST = ("housing_position", "housing_tilt", "housing_velocity", "housing_angular_velocity")


@pytest.mark.parametrize("speed", [3000.0, -1700.0])
@pytest.mark.parametrize("back", [0.0, 2e-4])
def test_every_field_computed_a_second_time(kit: SimpleNamespace, speed: float, back: float) -> None:
    effects = Effects.standard().replace(damping="hunt_crossley", damping_race=0.05, damping_cage=0.1, front_rib=True)
    # the pressure force's torque on the ring, 1e-6 of all, is in no share
    effects = effects.replace(rolling_pressure_force=False, oil_fill=0.2, guidance="inner_land", pocket_film=1e-4)
    bearing = rig_30310()
    bearing = bearing.replace(cage=bearing.cage.replace(offset=1.5e-3))
    scenery = {
        "speed_rpm": speed,
        "radial_load": 1500.0,
        "misalignment_x": 4e-4,
        "misalignment_y": -3e-4,
        "bearing": bearing,
    }
    sim = kit.simulate(effects, scenery=scenery)
    vector = kit.perturbed(sim, 21, back=back)
    state = sim.view(vector)
    state["quadratures"][:] = 1.0 + np.arange(len(QUADRATURES) - 2)
    state["spin_angle"][:] = np.linspace(-1.0, 2.0, 12)
    found, record = sim.contacts(vector, TIME), sim.record(vector, TIME)
    sign = np.sign(speed)
    expected = bodies(kit, sim, vector, speed) | sums(kit, sim, vector, found, sign)
    expected |= contacts(kit, sim, vector, found, sign)
    expected |= dict(zip(QUADRATURES[:-2], 1.0 + np.arange(len(QUADRATURES) - 2), strict=True))
    expected["loss_support"] = expected["loss_vibration"] = 0.0  # a held ring and a rigid cage have no such quadratures
    ribs = {"inner_torque_rib", "inner_torque_front_rib"}
    assert set(expected) | ribs == set(record)
    left = {field.name for field in fields.table()} - set(record)
    assert left == set(OF_CYLINDERS) | {"cage_mode", "cage_mode_rate"}
    for name, values in expected.items():
        size = float(np.abs(values).max())
        one_sided = name.startswith("rib_") or name in ("power_rib", "front_rib_load", "power_front_rib")
        none = name in ("power_rolling_pressure", "ring_velocity", *AT_REST) or name.endswith(
            ("_support", "_vibration")
        )
        assert size > 0.0 or one_sided or none, name
        if name.endswith("_orientation"):
            signs = np.sign(np.sum(np.asarray(record[name]) * np.asarray(values), axis=-1, keepdims=True))
            assert (np.abs(signs) == 1.0).all()
            values = signs * values
        # speeds in denominators are guarded
        guarded = ("power_traction", "power_rib", "power_front", "inner_torque_", "outer_slide", "inner_slide")
        close = 1e-6 if name.startswith(guarded) else 1e-9
        # cells that touch in a part of their length only have rolling resistance, which the numbers of single nodes leave out
        close = 2e-3 if name in PARTLY else close
        np.testing.assert_allclose(record[name], values, rtol=close, atol=close * size, err_msg=name)
    total = sum(float(record[name]) for name in TORQUES)
    assert total == pytest.approx(float(record["inner_torque"]), rel=1e-9)
    if not back:
        assert record["rib_load"].max() > 10.0
        assert record["inner_torque_rib"] != 0.0
    else:
        assert record["front_rib_load"].max() > 1.0
        assert record["inner_torque_front_rib"] != 0.0


def test_quadratures_grow_by_the_recorded_powers(kit: SimpleNamespace) -> None:
    """Each loss by its own power, in the order of the table."""
    effects = Effects.standard().replace(damping="hunt_crossley", damping_race=0.05, damping_cage=0.1, oil_fill=0.2)
    effects = effects.replace(rolling_pressure_force=True, guidance="outer_land", pocket_film=1e-4)
    sim = kit.simulate(effects, scenery={"radial_load": 1500.0})
    seen = set()
    for seed, back in ((5, 0.0), (6, 2e-4)):
        vector = kit.perturbed(sim, seed, back=back)
        record, rates = sim.record(vector, 0.0), sim.view(sim.derivative(vector, 0.0))["quadratures"]
        for name, rate in zip(
            QUADRATURES[:-2], rates, strict=True
        ):  # the last ones: of a free ring and an elastic cage
            if name.startswith("loss_"):
                power = float(record[name.replace("loss_", "power_")])
                assert rate == pytest.approx(power, rel=1e-12), name
                seen |= {name} if power else set()
    assert seen == {name for name in QUADRATURES[:-2] if name.startswith("loss_")}


# ---- attribution ----


def shares(sim: Simulation, vector: Array) -> tuple[dict[str, float], dict[str, float]]:
    """Powers and shares of the torque that are not zero."""
    record = sim.record(vector, TIME)
    return tuple(  # type: ignore[return-value]
        {name: float(record[name]) for name in names if abs(float(record[name])) > 1e-12} for names in (POWERS, TORQUES)
    )


def test_rolling_resistance_alone(kit: SimpleNamespace) -> None:
    effects = film_without_traction().replace(rolling_resistance=True)
    sim = kit.simulate(effects, scenery={"radial_load": 1500.0})
    powers, torques = shares(sim, kit.perturbed(sim, 8))
    assert set(powers) == {"power_rolling"}
    assert set(torques) == {"inner_torque_rolling"}
    assert torques["inner_torque_rolling"] > 0.0


def test_rolling_pressure_force_alone(kit: SimpleNamespace) -> None:
    effects = film_without_traction().replace(rolling_resistance=True, rolling_pressure_force=True)
    sim = kit.simulate(effects)
    powers, torques = shares(sim, kit.perturbed(sim, 8))
    assert set(powers) == {"power_rolling", "power_rolling_pressure"}
    assert set(torques) <= {"inner_torque_rolling"}


@pytest.mark.parametrize("part", ["race", "cage"])
def test_damping_alone(kit: SimpleNamespace, part: str) -> None:
    effects = frictionless().replace(damping="hunt_crossley", damping_race=0.0, damping_cage=0.0)
    sim = kit.simulate(effects.replace(**{f"damping_{part}": 0.2}))
    vector = kit.perturbed(sim, 8)
    powers, torques = shares(sim, vector)
    assert set(powers) == {"power_damping"}
    assert powers["power_damping"] > 0.0
    assert torques == {}


def frictionless() -> Effects:
    """Every contact, and nothing that loses energy: dry with a friction coefficient of zero."""
    return Effects.paper().replace(
        lubrication="dry",
        friction=Friction(dry_friction=0.0),
        rolling_resistance=False,
        front_rib=True,
        gravity=False,
        damping="off",
    )


def film_without_traction() -> Effects:
    """Films whose sliding takes nothing; pockets and ribs, whose friction is another, are off."""
    return frictionless().replace(
        lubrication="full_film", traction="none", back_rib=False, front_rib=False, pocket_bars=False, pocket_ends=False
    )


def sliding() -> Effects:
    return frictionless().replace(friction=Friction(dry_friction=0.1))


def test_nothing_alone(kit: SimpleNamespace) -> None:
    sim = kit.simulate(frictionless())
    assert shares(sim, kit.perturbed(sim, 8)) == ({}, {})


@pytest.mark.parametrize(
    ("off", "power", "torque"),
    [
        ({}, {"power_rib"}, {"inner_torque_rib"}),
        ({"front_rib": False}, {"power_front_rib"}, {"inner_torque_front_rib"}),
        ({"pocket_bars": False, "pocket_ends": False}, {"power_pocket"}, set()),
    ],
)
def test_a_source_that_is_taken_away_takes_its_share_alone(
    kit: SimpleNamespace, off: dict[str, bool], power: set[str], torque: set[str]
) -> None:
    """All others stay to the last bit."""
    off = off or {"back_rib": False}
    back = 2e-4 if "front_rib" in off else 0.0
    scenery = {"displacement": tuple(kit.simulate(sliding()).equilibrium.displacement[:3])}
    every, less = (kit.simulate(effects, scenery=scenery) for effects in (sliding(), sliding().replace(**off)))
    vector = kit.perturbed(every, 8, back=back)
    (powers, torques), (other_powers, other_torques) = shares(every, vector), shares(less, vector)
    assert set(powers) - set(other_powers) == power
    assert set(torques) - set(other_torques) == torque
    assert {name: powers[name] for name in other_powers} == other_powers
    assert {name: torques[name] for name in other_torques} == other_torques
