"""Every number that reaches the core acts: it is changed, and a force, a film or a coefficient follows as its law
says.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.typing import NDArray

import trbdyn as trb
from trbdyn import Effects, Scene, Simulation
from trbdyn.model.bearing import Profile
from trbdyn.model.flatten import scene_entries
from trbdyn.model.pocket import Pocket

Array = NDArray[np.float64]
BASE = Effects.standard().replace(damping="off", thermal_law="gupta", n_slices=16)
DRY, BOUNDARY = BASE.replace(lubrication="dry"), BASE.replace(lubrication="boundary")
WET = BASE.replace(oil_fill=0.3)
INNER, OUTER = BASE.replace(guidance="inner_land"), BASE.replace(guidance="outer_land")
DRY_LAND = OUTER.replace(lubrication="dry")
DAMPED = DRY.replace(damping="hunt_crossley", damping_race=0.01, damping_cage=0.02)
MOVING = DRY.replace(gravity=False)


def rough(scene: Scene) -> Scene:
    return changed(scene, "roughness_raceway", 1.2e-6)


def unchanged(scene: Scene) -> Scene:
    return scene


def changed(scene: Scene, name: str, value: float | None) -> Scene:
    """The scene with another value of a number of the core, and everything that is derived from it; None: as it is."""
    if value is None:
        return scene
    path = scene_entries(scene)[name].path
    values = scene.to_dict()
    place = values
    for part in path[:-1]:
        place = place[part]
    if path[0] == "lubricant" and place.pop("oil", None) is not None:
        # an oil's values follow from its temperature: one's own values take their place
        own = ("viscosity", "pressure_coefficient", "temperature_coefficient", "density")
        place |= {key: getattr(scene.lubricant, key) for key in own}
    if name in ("pressure_coefficient", "temperature"):
        place["pressure_law"] = "roelands"  # the law of Dicke has its own slope at each temperature
    assert path[-1] in place, path
    place[path[-1]] = value
    return Scene.from_dict(values)


@dataclass(frozen=True)
class Law:
    """How a quantity follows a number that is multiplied by a factor."""

    quantity: Callable[[Simulation, Array, dict[str, Array]], Array]
    ratio: Callable[[float], float]
    effects: Effects = BASE
    factor: float = 1.3
    prepare: Callable[[Scene], Scene] = unchanged


def contact(name: str) -> Callable[[Simulation, Array, dict[str, Array]], Array]:
    return lambda sim, vector, found: found[name]


def ends(sim: Simulation, vector: Array, found: dict[str, Array]) -> Array:
    return found["pocket_load"][:, 2:]


def smallest_thermal_factor(sim: Simulation, vector: Array, found: dict[str, Array]) -> Array:
    return np.asarray(found["raceway_thermal_factor"][found["raceway_load"] > 0.0].min())


def pocket_coefficient(sim: Simulation, vector: Array, found: dict[str, Array]) -> Array:
    return found["pocket_friction"] / np.where(found["pocket_load"] > 0.0, found["pocket_load"], np.inf)


def rate(name: str) -> Callable[[Simulation, Array, dict[str, Array]], Array]:
    return lambda sim, vector, found: np.asarray(sim.view(sim.derivative(vector, 0.0))[name])


def kinetic(sim: Simulation, vector: Array, found: dict[str, Array]) -> Array:
    return np.asarray(sim.record(vector, 0.0)["kinetic_energy"])


def drag(sim: Simulation, vector: Array, found: dict[str, Array]) -> Array:
    return np.asarray(sim.record(vector, 0.0)["power_drag"])


def land(name: str) -> Callable[[Simulation, Array, dict[str, Array]], Array]:
    """Of a cage that moves across a land on whose axis it is."""

    def look_at(sim: Simulation, vector: Array, found: dict[str, Array]) -> Array:
        centred = vector.copy()
        state = sim.view(centred)
        for part in ("x", "y", "skew", "tilt", "v_y", "v_z", "omega_n", "omega_t", "omega_a"):
            state[f"cage_{part}"] = 0.0
        return np.asarray(sim.contacts(centred, 0.0)[f"land_{name}"])

    return look_at


def power(exponent: float) -> Callable[[float], float]:
    return lambda factor: factor**exponent


def linear_pockets(scene: Scene) -> Scene:
    """Pocket friction in proportion to sliding: no limit, no decay, and a large entrainment speed."""
    for name, value in (("boundary_decay", 1e-3), ("boundary_limit", 0.0), ("cage_entrainment_speed", 90.0)):
        scene = changed(scene, name, value)
    return scene


def hot(scene: Scene) -> Scene:
    """Thermal factors at their floor."""
    return changed(scene, "conductivity", 1e-4)


LAWS: dict[str, Law] = {
    "youngs_modulus": Law(contact("raceway_load"), power(1.0), DRY),
    "end_stiffness": Law(ends, power(1.0), DRY),
    "dry_friction": Law(contact("raceway_friction_coefficient"), power(1.0), DRY),
    "roughness_raceway": Law(contact("raceway_film_parameter"), power(-1.0)),
    "roughness_rib": Law(contact("rib_film_parameter"), power(-1.0)),
    "viscosity": Law(contact("raceway_film_elastic"), power(0.692)),
    "pressure_coefficient": Law(contact("raceway_film_elastic"), power(0.470)),
    "starvation_factor": Law(contact("raceway_film"), power(1.0), factor=0.7),
    "thermal_floor": Law(smallest_thermal_factor, power(1.0), prepare=hot),
    "boundary_slope": Law(pocket_coefficient, power(1.0), BOUNDARY, prepare=linear_pockets),
    "cage_entrainment_speed": Law(pocket_coefficient, power(-1.0), BOUNDARY, 1.1, linear_pockets),
    "cage_mass": Law(rate("cage_v_x"), power(-1.0), MOVING),
    "oil_fill": Law(drag, power(1.0), WET, 0.7),
    "oil_density": Law(drag, power(1.0), WET),
    "drag_coefficient": Law(drag, power(1.0), WET.replace(bodies="rollers")),
    "land_inner_radius": Law(land("torque"), power(3.0), INNER),
    "land_outer_radius": Law(land("torque"), power(3.0), OUTER),
    "land_width": Law(land("film_force"), power(3.0), OUTER),
    "land_clearance": Law(land("film_force"), power(-3.0), OUTER),
    "land_fill": Law(land("film_force"), power(3.0), OUTER, 0.7),
    "roller_density": Law(kinetic, power(1.0), DRY.replace(bodies="rollers")),
}


def prepared(kit: SimpleNamespace, effects: Effects) -> tuple[Scene, Array]:
    """A scene whose ring is held, and a state in which everything touches."""
    rig = trb.cases.rig_30310()
    bearing = rig.replace(roller=rig.roller.replace(profile=Profile.straight()))
    given = {"bearing": bearing, "displacement": (0.0, 0.0, -6e-5)}
    sim = kit.simulate(effects, scenery=given)
    return sim.scene, kit.perturbed(kit.simulate(effects.replace(bodies="rollers_and_cage"), scenery=given), 12)


def look(scene: Scene, vector: Array, law: Law) -> Array:
    sim = Simulation(scene)
    if scene.effects.bodies == "rollers":
        vector = np.concatenate([vector[:132], vector[-(sim.state.vector.size - 132) :]])
    return np.asarray(law.quantity(sim, vector, sim.contacts(vector, 0.0)))


@pytest.mark.parametrize("name", LAWS)
def test_a_number_acts_as_its_law_says(kit: SimpleNamespace, name: str) -> None:
    law = LAWS[name]
    scene, vector = prepared(kit, law.effects)
    scene = law.prepare(scene)
    value = float(scene_entries(scene)[name].value)
    before, after = (look(changed(scene, name, factor * value), vector, law) for factor in (1.0, law.factor))
    size = np.abs(before).max()
    assert size > 0.0
    np.testing.assert_allclose(after, law.ratio(law.factor) * before, rtol=2e-3, atol=1e-9 * size)


def test_poisson_ratio(kit: SimpleNamespace) -> None:
    """E' = E/(1 - nu^2) of two equal bodies."""
    scene, vector = prepared(kit, DRY)
    law = Law(contact("raceway_load"), power(1.0))
    soft, stiff = (look(changed(scene, "poisson_ratio", nu), vector, law) for nu in (0.0, 0.4))
    np.testing.assert_allclose(stiff, soft / (1.0 - 0.16), rtol=1e-9)


def test_coulomb_speed(kit: SimpleNamespace) -> None:
    scene, vector = prepared(kit, DRY)
    for speed in (0.01, 0.5):
        sim = Simulation(changed(scene, "coulomb_speed", speed))
        found = sim.contacts(vector, 0.0)
        loaded = found["raceway_load"] > 0.0
        slides = found["raceway_sliding_speed"][loaded]
        mu = 0.1 * slides / np.hypot(slides, speed)
        np.testing.assert_allclose(found["raceway_friction_coefficient"][loaded], mu, rtol=1e-6)


@pytest.mark.parametrize("changes", [{}, {"boundary_limit": 0.2}, {"boundary_slope": 10.0}, {"boundary_decay": 300.0}])
def test_boundary_friction(kit: SimpleNamespace, changes: dict[str, float]) -> None:
    """(6) of the raceways."""
    scene, vector = prepared(kit, BOUNDARY)
    constants = {"boundary_limit": 0.1, "boundary_slope": 22.28, "boundary_decay": 181.46} | changes
    for name, value in changes.items():
        scene = changed(scene, name, value)
    found = Simulation(scene).contacts(vector, 0.0)
    loaded = found["raceway_load"] > 0.0
    s = found["raceway_slide_roll"][loaded]
    limit, slope, decay = constants.values()
    mu = (-limit + slope * s) * np.exp(-decay * s) + limit
    np.testing.assert_allclose(found["raceway_friction_coefficient"][loaded], mu, rtol=1e-6, atol=1e-12)


@pytest.mark.parametrize("changes", [{}, {"lambda_full": 2.5}, {"lambda_boundary": 0.2}])
def test_mixed_friction(kit: SimpleNamespace, changes: dict[str, float]) -> None:
    """(2): share of both laws by the film parameter."""
    scene, vector = prepared(kit, BASE)
    scene = rough(scene)
    low, high = ({"lambda_boundary": 0.01, "lambda_full": 1.5} | changes).values()
    for name, value in changes.items():
        scene = changed(scene, name, value)
    found = Simulation(scene).contacts(vector, 0.0)
    parts = ("film_parameter", "boundary_coefficient", "traction_coefficient", "friction_coefficient")
    loaded = found["raceway_load"] > 0.0
    film, boundary, traction, friction = (found[f"raceway_{part}"][loaded] for part in parts)
    share = np.clip((film - high) / (low - high), 0.0, 1.0) ** 6
    assert 0.0 < share.max() < 1.0
    np.testing.assert_allclose(friction, share * boundary + (1.0 - share) * traction, rtol=1e-6, atol=1e-12)


@pytest.mark.parametrize("changes", [{}, {"conductivity": 0.5}, {"temperature_coefficient": 0.02}, {"viscosity": 0.1}])
def test_thermal_factor(kit: SimpleNamespace, changes: dict[str, float]) -> None:
    """Gupta's factor; far above its floor."""
    scene, vector = prepared(kit, BASE)
    for name, value in changes.items():
        scene = changed(scene, name, value)
    found, oil = (
        Simulation(scene).contacts(vector, 0.0),
        {n: scene_entries(scene)[n].value for n in scene_entries(scene)},
    )
    loaded = found["raceway_load"] > 0.0
    speed, s, pressure = (found[f"raceway_{part}"][loaded] for part in ("mean_speed", "slide_roll", "pressure"))
    modulus = oil["youngs_modulus"] / (1.0 - oil["poisson_ratio"] ** 2)
    heat = oil["viscosity"] * oil["temperature_coefficient"] * speed**2 / oil["conductivity"]
    # the equivalent modulus of a film is twice that of a contact
    factors = [
        (1.0 - 13.2 * pressure / (scale * modulus) * heat**0.42) / (1.0 + 0.213 * (1.0 + 2.23 * s**0.83) * heat**0.64)
        for scale in (1.0, 2.0)
    ]
    close = [np.abs(found["raceway_thermal_factor"][loaded] / factor - 1.0).max() for factor in factors]
    assert min(close) < 2e-3


@pytest.mark.parametrize("part", ["race", "cage"])
def test_damping(kit: SimpleNamespace, part: str) -> None:
    """F = q (1 + c d_dot), never pulling."""
    scene, vector = prepared(kit, DAMPED)
    name = f"damping_{part}"
    finds = [Simulation(changed(scene, name, value)).contacts(vector, 0.0) for value in (0.0, 0.05, 0.1)]
    if part == "race":
        still, one, two = (found["raceway_load"] for found in finds)
        approach = finds[0]["raceway_approach"]
        loaded = still > 0.0
        np.testing.assert_allclose(one[loaded], (still * np.maximum(1.0 + 0.05 * approach, 0.0))[loaded], rtol=1e-6)
        return
    still, one, two = (found["pocket_load"] for found in finds)
    both = (one > 0.0) & (two > 0.0)
    assert both.any()
    np.testing.assert_allclose((two - still)[both], 2.0 * (one - still)[both], rtol=1e-6, atol=1e-6)
    assert np.abs(one - still).max() > 1e-3 * still.max()


@pytest.mark.parametrize("effects", [BOUNDARY, DRY], ids=["boundary", "dry"])
def test_factors_of_a_pocket_face(kit: SimpleNamespace, effects: Effects) -> None:
    """A face's own factors of stiffness and friction multiply its load and its coefficient of friction."""
    scene, vector = prepared(kit, effects)
    stiffer, rougher = [1.0, 0.7, 1.3, 2.0], [1.6, 0.5, 1.0, 0.8]

    def with_factors(stiffness: list[float], friction: list[float]) -> dict[str, Array]:
        bearing = scene.bearing
        faces = tuple(
            face.replace(stiffness_factor=k, friction_factor=f)
            for face, k, f in zip(trb.pocket_shapes.default_pocket(bearing).faces, stiffness, friction, strict=True)
        )
        cage = bearing.cage.replace(pocket=Pocket(faces=faces))
        return Simulation(scene.replace(bearing=bearing.replace(cage=cage))).contacts(vector, 0.0)

    plain, other = with_factors([1.0] * 4, [1.0] * 4), with_factors(stiffer, rougher)
    touched = plain["pocket_load"] > 0.0
    assert touched[:, :2].any(axis=0).all()  # both bars
    assert touched[:, 2:].any()
    loads, frictions = (np.where(touched, plain[f"pocket_{part}"], 0.0) for part in ("load", "friction"))
    np.testing.assert_allclose(other["pocket_load"], loads * stiffer, rtol=1e-9)
    np.testing.assert_allclose(other["pocket_friction"], frictions * stiffer * rougher, rtol=1e-9)
    assert (frictions[touched] > 0.0).all()


def test_inertia_of_the_cage(kit: SimpleNamespace) -> None:
    scene, vector = prepared(kit, MOVING)
    state = Simulation(scene).view(vector)
    for part in "nta":
        state[f"cage_omega_{part}"] = 0.0
    state["cage_skew"] = state["cage_tilt"] = 0.0
    # without spin of its own the cage turns by the pockets' moment alone
    state["cage_omega_a"] = -scene.bearing.geometry.cage_speed_ratio * 3000.0 * np.pi / 30.0
    for name, parts in (("cage_inertia_axial", "a"), ("cage_inertia_transverse", "nt")):
        value = float(scene_entries(scene)[name].value)
        one, two = (Simulation(changed(scene, name, factor * value)) for factor in (1.0, 1.05))
        spins = [
            np.array([s.view(s.derivative(vector, 0.0))[f"cage_omega_{part}"] for part in parts]) for s in (one, two)
        ]
        assert np.abs(spins[0]).max() > 1.0
        np.testing.assert_allclose(spins[1], spins[0] / 1.05, rtol=1e-9)


def test_clearance_of_the_front_rib(kit: SimpleNamespace) -> None:
    scene, vector = prepared(kit, DRY)
    vector = kit.perturbed(Simulation(scene), 12, back=3e-4)
    one, two = (Simulation(changed(scene, "front_rib_clearance", c)).contacts(vector, 0.0) for c in (2e-4, 1.9e-4))
    touched = one["front_rib_load"] > 0.0
    assert touched.any()
    growth = (two["front_rib_interference"] - one["front_rib_interference"])[touched]
    np.testing.assert_allclose(growth, 1e-5, rtol=0.05)


SHOWS: dict[str, tuple[float, str]] = {
    "land_offset": (10e-3, "land_gap"),
    "land_contact_film": (5e-6, "land_contact_force"),
    "cup_half_angle": (13.0, "outer_load"),
    "pitch_diameter": (0.0823891, "outer_load"),
    "roller_diameter": (0.0140005, "outer_load"),
    "effective_length": (0.0196, "outer_load"),
    "total_length": (0.0206, "kinetic_energy"),
    "sphere_ratio": (0.91, "rib_pressure"),
    "cage_offset": (1e-3, "cage_moment"),
    "cage_rail_offset": (13e-3, "cage_rail_position"),
    "rib_contact_height": (1.5e-3, "rib_height"),
    "rib_edge_low": (1.5e-3, "rib_overhang"),
    "rib_edge_high": (1.8e-3, "rib_overhang"),
    "temperature": (80.0, "inner_traction"),
    "rolling_blend": (0.9, "inner_traction"),
    "crown_radius": (50.0, "outer_load"),
    "cage_youngs_modulus": (1e11, "pocket_force"),
    "cage_poisson_ratio": (0.2, "pocket_force"),
    "roller_youngs_modulus": (1e11, "outer_load"),
    "roller_poisson_ratio": (0.2, "outer_load"),
}
"""Another value of a number, and the recorded field in which it shows at the same state."""


@pytest.mark.parametrize("name", SHOWS)
def test_a_number_shows(kit: SimpleNamespace, name: str) -> None:
    value, field = SHOWS[name]
    scene, vector = prepared(kit, DRY_LAND if name.startswith("land_") else BASE)
    if name == "crown_radius":
        roller = scene.bearing.roller.replace(profile=Profile.crowned(100.0))
        scene = scene.replace(bearing=scene.bearing.replace(roller=roller))
    if name == "rolling_blend":
        effects = scene.effects.replace(rolling_law="zhou_hoeprich", rolling_load="slices")
        scene = scene.replace(lubricant=scene.lubricant.replace(viscosity=1e-3), effects=effects)
    one, two = (
        Simulation(changed(scene, name, number)).record(vector, 0.0)[field]
        for number in (scene_entries(scene)[name].value if name == "temperature" else None, value)
    )
    assert np.abs(two - one).max() > 1e-9 * np.abs(one).max()


BODY = ("mass", "inertia_axial", "inertia_transverse", "offset", "damping", "damping_turns")
SUPPORT = ("support_radial", "support_axial", "support_tilt", "support_position")
ELSEWHERE = {
    "physics/test_inputs_act.py": "poisson_ratio coulomb_speed boundary_limit boundary_decay lambda_full lambda_boundary damping"
    " conductivity temperature_coefficient damping_race damping_cage cage_inertia_axial cage_inertia_transverse"
    " front_rib_clearance",
    "physics/test_cylindrical.py": "end_radius radial_clearance rib_clearance outer_rib outer_front_rib",
    "physics/test_film_damping.py": "film_damping film_damping_depth",
    "physics/test_drag.py": "cage_face_inner cage_face_outer",
    "physics/test_contacts.py": "pocket_film roughness_pocket",
    "physics/test_free_ring.py": " ".join(f"ring_{name}" for name in (*BODY, *SUPPORT, "unbalance", "unbalance_angle")),
    "physics/test_housing.py": " ".join(f"outer_{name}" for name in (*BODY, *SUPPORT)),
    "physics/test_assembly.py": "ring_carried ring_turned ring_shift",
    "physics/test_shared_housing.py": "outer_carried outer_turned",
    "physics/test_effects.py": "quadrature with_cage planar lubrication traction thermal rolling_resistance back_rib front_rib"
    " rolling_pressure_force rib_film rib_turning guidance pocket_bars pocket_ends pocket_edges profile viscosity_law n_rollers"
    " n_slices ring_free outer_free outer_turns cage_modes",
    "laws/test_in_contacts.py": "asperity_factor asperity_exponent rib_asperity_factor rib_asperity_exponent mixed_law"
    " rib_boundary_limit replenishment supply rolling_load",
    "laws/test_oracles.py": "oil_height flooded_gaps hysteresis",
    "geometry/test_profiles.py": "profile_a profile_c profile_d profile_k",
    "geometry/test_interference.py": "front_rib_low front_rib_high",
}
"""Numbers that other tests change, and where; switches, whole numbers and shapes among them."""


def test_nothing_is_forgotten() -> None:
    known = {name for names in ELSEWHERE.values() for name in names.split()}
    assert {*LAWS, *SHOWS, *TRACTION, *PROFILES} | known >= set(scene_entries(trb.cases.paper_30310()))
    assert all((Path(__file__).parents[1] / place).is_file() for place in ELSEWHERE)


TRACTION = {
    "eyring_stress": 4e6,
    "shear_modulus_floor": 8e8,
    "viscosity_exponent_cap": 12.0,
    "temperature": 80.0,
    "dicke_a": 300.0,
    "dicke_b": 3.2,
    "dicke_c": 4e-3,
    "dicke_d": 4e-4,
    "speed_floor": 0.9,
    "rolling_blend": 0.9,
}
PROFILES = {"profile_k1": 1.8, "profile_k2": 0.6, "profile_zm": 1e-6, "profile_load": 4000.0}
PROFILES |= {"profile_a": 0.0006, "profile_c": 0.018, "profile_d": 1e-3, "profile_k": 2.2}


@pytest.mark.parametrize(
    "name", [*(name for name in TRACTION if name not in ("temperature", "rolling_blend")), *PROFILES]
)
def test_constants_of_traction_and_profile_show(kit: SimpleNamespace, name: str) -> None:
    """At the same state, coefficients or loads are other ones."""
    value = {**TRACTION, **PROFILES}[name]
    rig = trb.cases.rig_30310()
    if name in ("profile_a", "profile_c", "profile_d", "profile_k"):
        rig = rig.replace(roller=rig.roller.replace(profile=Profile.iso(a_p=0.0005, c_p=0.0198, d_p=0.0, k_p=2.0)))
    # the shipped rig's logarithmic profile; at full slip for the floors and caps of traction
    scene = kit.simulate(BASE, scenery={"bearing": rig, "displacement": (0.0, 0.0, -6e-5)}).scene
    vector = kit.perturbed(Simulation(scene), 12)
    if name == "viscosity_exponent_cap":
        scene = scene.replace(lubricant=scene.lubricant.replace(pressure_law="barus"))
    if name == "speed_floor":
        scene = scene.replace(speed_rpm=0.0)
        vector = np.zeros_like(vector)
        Simulation(scene).view(vector)["roller_r"] = 5e-6
    one, two = (Simulation(s).contacts(vector, 0.0) for s in (scene, changed(scene, name, value)))
    quantity = (
        "raceway_load"
        if name in PROFILES
        else "raceway_film"
        if name == "speed_floor"
        else "raceway_traction_coefficient"
    )
    loaded = (one["raceway_load"] > 0.0) & (two["raceway_load"] > 0.0)
    assert loaded.any()
    change = np.abs(two[quantity][loaded] - one[quantity][loaded]).max()
    assert change > 1e-6 * np.abs(one[quantity][loaded]).max(), name
