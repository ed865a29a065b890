"""Every node of every contact obeys the laws that trb.laws calls: kernels and laws are the same functions."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from trbdyn import Effects, Scene, Simulation, cases, laws
from trbdyn.model.effects import Friction
from trbdyn.model.lubricants import vg100

STARVED = {"starvation_factor": 0.1}
"""Thin films, so that boundary friction has its share."""
SCENES: dict[str, dict[str, Any]] = {
    "mixed": STARVED,
    "full_film": {"lubrication": "full_film"},
    "no_thermal": {"thermal": False, "rolling_resistance": False},
    "film_coulomb": {"traction": "coulomb"},
    "exponential": {
        "mixed_law": "exponential",
        "thermal_law": "aihara",
        "friction": Friction(
            asperity_factor=1.5,
            asperity_exponent=0.8,
            rib_asperity_factor=1.2,
            rib_asperity_exponent=1.1,
            rib_boundary_limit=0.2,
        ),
        **STARVED,
    },
    "supplied": {"replenishment": 3e-7, "oil_height": 2e-5, "hysteresis": 0.02, "supply": 0.6},
    "boundary": {"lubrication": "boundary"},
    "dry": {"lubrication": "dry"},
}


def scene_of(name: str, **changes: Any) -> Scene:
    effects = Effects.paper().replace(**{"quadrature": "gauss", "n_slices": 9, **SCENES.get(name, STARVED)})
    oil = vg100(60.0, pressure_law=name if name in ("roelands", "barus") else "dicke")  # type: ignore[arg-type]
    return cases.scene_30310(lubricant=oil, effects=effects, **changes)


def look(scene: Scene, seed: int = 3) -> SimpleNamespace:
    """Contacts at a state off equilibrium, and the numbers that the laws need."""
    sim = Simulation(scene, instruction_set="scalar")
    random, state = np.random.default_rng(seed), sim.state.vector
    view = sim.view(state)
    for part, size in (("r", 1e-6), ("z", 1e-6), ("skew", 1e-4), ("tilt", 1e-5), ("v_t", 0.02), ("omega_a", 8.0)):
        view[f"roller_{part}"] += size * random.uniform(-1.0, 1.0, 12)
    found = sim.contacts(state)
    part = {name.removeprefix("raceway_"): values for name, values in found.items() if name.startswith("raceway_")}
    rib = {name.removeprefix("rib_"): values for name, values in found.items() if name.startswith("rib_")}
    geometry, oil = scene.bearing.geometry, scene.lubricant
    groups = {"modulus": geometry.effective_modulus, "g": oil.pressure_coefficient * geometry.effective_modulus}
    return SimpleNamespace(**part, rib=SimpleNamespace(**rib), oil=oil, geometry=geometry, scene=scene, **groups)


def exact(values: np.ndarray) -> object:
    """The same number but for rounding in another order of operations."""
    return pytest.approx(values, rel=1e-11)


@pytest.fixture(scope="module", params=[*SCENES, "roelands", "barus"])
def seen(request: pytest.FixtureRequest) -> SimpleNamespace:
    found = look(scene_of(request.param))
    assert np.all(found.interference > 0)
    assert np.all(found.rib.interference > 0)
    return found


def test_load_and_pressure(seen: SimpleNamespace) -> None:
    assert seen.load_per_length == exact(laws.line_load(seen.interference, seen.modulus, 19.8e-3))
    assert seen.load == exact(seen.load_per_length * seen.weight)
    assert seen.half_width == exact(laws.line_half_width(seen.load_per_length, seen.radius, seen.modulus))
    assert seen.pressure == exact(laws.line_pressure(seen.load_per_length, seen.radius, seen.modulus))
    assert np.median(seen.pressure[0]) == pytest.approx(0.64e9, rel=0.2)


def test_slide_roll(seen: SimpleNamespace) -> None:
    assert seen.slide_roll == exact(seen.sliding_speed / seen.mean_speed)
    slid = np.sqrt(seen.sx**2 + seen.sy**2 + seen.sz**2)
    assert seen.sliding_speed == exact(np.hypot(slid, 1e-9))
    assert np.ptp(seen.slide_roll) > 1e-3


def thermal_of(seen: SimpleNamespace, pressure: Any, speed: Any, slip: Any) -> Any:
    oil = seen.oil
    if not seen.scene.effects.thermal:
        return np.ones_like(speed)
    loading = oil.viscosity * oil.temperature_coefficient * speed**2 / oil.conductivity
    if seen.scene.effects.thermal_law == "aihara":
        return laws.film_thermal_aihara(loading)
    return laws.film_thermal(pressure / seen.modulus, loading, slip, 0.05)


def test_film(seen: SimpleNamespace) -> None:
    effects = seen.scene.effects
    if not effects.films:
        assert not np.any(seen.film)
        return
    w = seen.load_per_length / (seen.modulus * seen.radius)
    u = seen.oil.viscosity * seen.mean_speed / (seen.modulus * seen.radius)
    elastic, rigid = laws.film_line_elastic(w, u, seen.g), laws.film_line_rigid(w, u)
    assert seen.film_elastic == exact(seen.radius * elastic)
    assert seen.film_rigid == exact(seen.radius * rigid)
    assert seen.thermal_factor == exact(thermal_of(seen, seen.pressure, seen.mean_speed, seen.slide_roll))
    thickest = np.maximum(seen.film_elastic, seen.film_rigid)
    assert seen.film == exact(effects.starvation_factor * seen.thermal_factor * thickest)
    assert seen.film_parameter == exact(seen.film / 0.16e-6)


def log_ratio(oil: Any, pressure: Any) -> Any:
    if oil.pressure_law == "barus":
        return laws.viscosity_barus(pressure, oil.pressure_coefficient, oil.viscosity_exponent_cap)
    if oil.pressure_law == "roelands":
        return laws.viscosity_roelands(pressure, oil.pressure_coefficient, oil.viscosity, oil.viscosity_exponent_cap)
    assert oil.dicke is not None
    return laws.viscosity_dicke(pressure, oil.temperature_c, oil.dicke.a, oil.dicke.b, oil.dicke.c, oil.dicke.d)


def traction_of(seen: SimpleNamespace, contact: Any, mean_pressure: Any, semi: Any) -> Any:
    oil, effects = seen.oil, seen.scene.effects
    if effects.traction == "coulomb" or effects.lubrication == "dry":
        return 0.1 * contact.sliding_speed / np.hypot(contact.sliding_speed, 0.01)
    eta = oil.viscosity * np.exp(log_ratio(oil, mean_pressure))
    sigma = eta * contact.sliding_speed / (oil.eyring_stress * contact.film)
    shear = laws.shear_modulus(mean_pressure, oil.temperature_c, oil.shear_modulus_floor)
    s = laws.traction_muraki_kimura(sigma, eta * contact.mean_speed / (shear * semi))
    return oil.eyring_stress * s / mean_pressure


def friction_of(seen: SimpleNamespace, contact: Any, mean_pressure: Any, semi: Any) -> Any:
    effects = seen.scene.effects
    limit = effects.friction.rib_boundary_limit if contact is seen.rib else 0.1
    boundary = laws.friction_boundary(contact.slide_roll, limit, 22.28, 181.46)
    if effects.lubrication == "boundary":
        return boundary
    film = traction_of(seen, contact, mean_pressure, semi)
    if effects.lubrication != "mixed":
        return film
    share = laws.boundary_share(contact.film_parameter, 0.01, 1.5)
    if effects.mixed_law == "exponential":
        share = laws.asperity_share(contact.film_parameter, *((1.2, 1.1) if contact is seen.rib else (1.5, 0.8)))
    return film + share * (boundary - film)


def test_friction(seen: SimpleNamespace) -> None:
    mean = math.pi / 4 * seen.pressure
    assert seen.friction_coefficient == exact(friction_of(seen, seen, mean, seen.half_width))
    if (
        seen.scene.effects.mixed_law == "power"
        and seen.scene.effects.starvation_factor < 1.0
        and seen.scene.effects.films
    ):
        assert laws.boundary_share(seen.film_parameter, 0.01, 1.5).min() > 0.01


def supply_of(seen: SimpleNamespace, w: Any, u: Any) -> Any:
    """Share of rolling resistance by SKF's replenishment, and by the meniscus."""
    effects, oil, bearing = seen.scene.effects, seen.oil, seen.scene.bearing
    share = 1.0
    if effects.replenishment:
        # of a speed of the rings at which both surfaces would pass the contact as fast in pure rolling
        rpm = seen.mean_speed / (seen.geometry.outer_race_radius * seen.geometry.cage_speed_ratio) * 30.0 / math.pi
        assert np.mean(rpm) == pytest.approx(3000.0, rel=0.02)
        across, section = 2e3 * bearing.pitch_diameter, 4e3 * bearing.roller.diameter
        kinematic = 1e6 * oil.viscosity / oil.density
        share = np.exp(-effects.replenishment * kinematic * rpm * across * np.sqrt(3.0 / section))
        assert 0.05 < share.min() < share.max() < 0.95
    if effects.oil_height:
        smallest = np.maximum(seen.radius * laws.film_line_smallest(w, u, seen.g), seen.film_rigid)
        share = share * laws.rolling_meniscus(effects.oil_height / smallest)
    return share


def test_rolling_resistance(seen: SimpleNamespace) -> None:
    effects = seen.scene.effects
    if not (effects.films and effects.rolling_resistance):
        assert not np.any(seen.rolling)
        return
    w = seen.load_per_length / (seen.modulus * seen.radius)
    u = seen.oil.viscosity * seen.mean_speed / (seen.modulus * seen.radius)
    share = laws.rolling_share(seen.film_elastic / seen.film_rigid, 0.1)
    law = laws.rolling_line(w, u, seen.g) * seen.radius * seen.weight / seen.oil.pressure_coefficient
    left, phi = supply_of(seen, w, u) * effects.starvation_factor, seen.thermal_factor
    assert effects.supply is not None
    # a starved inlet is short and heats less: 1/(1 + f (1/phi - 1)) in place of phi
    supplied = effects.supply * share * law * left / (1.0 + left * (1.0 / phi - 1.0))
    lost = laws.rolling_hysteresis(effects.hysteresis, seen.half_width, seen.radius) * seen.load
    assert seen.rolling == exact(supplied + lost)


WHOLE = {
    "zhou_hoeprich": lambda w, u, g: 29.2 * g**-0.352 * u**0.648 * w**0.246,
    "aihara": lambda w, u, g: 88.0 * g**-0.342 * u**0.658 * w**0.31,
}
"""F/(E' Re l) of laws that were made for the load of a whole contact."""


@pytest.mark.parametrize("name", WHOLE)
@pytest.mark.parametrize("quadrature", ["gauss", "uniform"])
def test_laws_of_a_whole_contact_count_the_load_once(name: str, quadrature: Any) -> None:
    """The crowned rollers of a 32216, whose loaded length grows with the load: the sum over slices is the law of the whole
    roller, with the exponent that the papers print; a law of every slice has a half more."""
    effects = Effects(rolling_law=name, supply=1.0, thermal=False, quadrature=quadrature)  # type: ignore[arg-type]
    found = []
    for load in (3000.0, 6000.0):
        sim = Simulation(cases.scene_32216(2000.0, load, effects=effects))
        part, bearing, oil = sim.contacts(), sim.scene.bearing, sim.scene.lubricant
        modulus, length = bearing.geometry.effective_modulus, bearing.roller.effective_length
        radius, speed = (np.mean(part[f"raceway_{key}"], axis=-1) for key in ("radius", "mean_speed"))
        w = np.sum(part["raceway_load"], axis=-1) / (modulus * radius * length)
        u = oil.viscosity * speed / (modulus * radius)
        law = WHOLE[name](w, u, oil.pressure_coefficient * modulus) * modulus * radius * length
        assert np.sum(part["raceway_rolling"], axis=-1) == pytest.approx(law, rel=5e-3)
        found.append(float(np.sum(part["raceway_rolling"])))
    assert math.log2(found[1] / found[0]) == pytest.approx({"zhou_hoeprich": 0.246, "aihara": 0.31}[name], abs=0.01)


@pytest.mark.parametrize("name", ["goksem_hargreaves", "aihara", "matsuyama", "biboulet_houpert", "line_solution"])
def test_other_laws_of_rolling_resistance(name: str) -> None:
    scene = scene_of("mixed")
    seen = look(scene.replace(effects=scene.effects.replace(rolling_law=name)))
    w = seen.load_per_length / (seen.modulus * seen.radius)
    u = seen.oil.viscosity * seen.mean_speed / (seen.modulus * seen.radius)
    share = (
        1.0
        if name in ("biboulet_houpert", "line_solution")
        else laws.rolling_share(seen.film_elastic / seen.film_rigid, 0.1)
    )
    law = getattr(laws, f"rolling_{name}")(w, u, seen.g) * seen.radius * seen.weight / seen.oil.pressure_coefficient
    assert seen.rolling == exact(0.1 * share * law / (1.0 + 0.1 * (1.0 / seen.thermal_factor - 1.0)))
    assert seen.rolling.min() > 0.0


def test_rib(seen: SimpleNamespace) -> None:
    rib, geometry, effects = seen.rib, seen.geometry, seen.scene.effects
    radii = geometry.rib_rx, geometry.rib_ry
    assert rib.load == exact(laws.point_stiffness(*radii, seen.modulus) * rib.interference**1.5)
    along = laws.point_semi_axis_long(rib.load, *radii, seen.modulus)
    across = laws.point_semi_axis_short(rib.load, *radii, seen.modulus)
    assert rib.pressure == exact(1.5 * rib.load / (math.pi * along * across))
    if effects.films:
        w = rib.load / (seen.modulus * radii[0] ** 2)
        u = seen.oil.viscosity * rib.mean_speed / (seen.modulus * radii[0])
        ratio = radii[1] / radii[0]
        assert rib.film_elastic == exact(radii[0] * laws.film_point_elastic(w, u, seen.g, ratio))
        assert rib.film_rigid == exact(radii[0] * laws.film_point_rigid(w, u, ratio))
        assert rib.thermal_factor == exact(thermal_of(seen, rib.pressure, rib.mean_speed, rib.slide_roll))
        thickest = np.maximum(rib.film_elastic, rib.film_rigid)
        assert rib.film == exact(effects.starvation_factor * rib.thermal_factor * thickest)
        assert rib.film_parameter == exact(rib.film / 0.24e-6)
    # the mean pressure of an ellipse, and its semi-axis along rolling
    assert rib.friction_coefficient == exact(friction_of(seen, rib, 2 / 3 * rib.pressure, along))
    assert rib.friction == exact(rib.load * rib.friction_coefficient)


def test_ellipse_of_the_rib_along_rolling() -> None:
    """The contact's length in the traction of a film is the semi-axis along rolling: a thick oil, in which it decides."""
    scene = scene_of("full_film")
    seen = look(scene.replace(lubricant=scene.lubricant.replace(viscosity=200.0, pressure_law="barus", dicke=None)))
    rib, pressure = seen.rib, 2 / 3 * seen.rib.pressure
    radii = seen.geometry.rib_rx, seen.geometry.rib_ry
    along = laws.point_semi_axis_long(rib.load, *radii, seen.modulus)
    across = laws.point_semi_axis_short(rib.load, *radii, seen.modulus)
    assert seen.geometry.rib_rx > seen.geometry.rib_ry  # so that the long axis lies along rolling
    right, wrong = (friction_of(seen, rib, pressure, semi) for semi in (along, across))
    assert np.abs(wrong / right - 1.0).min() > 0.05
    assert rib.friction_coefficient == exact(right)


def test_rib_film_choice() -> None:
    thicker = look(scene_of("no_thermal")).rib
    effects = scene_of("no_thermal").effects.replace(rib_film="pe")
    elastic = look(scene_of("no_thermal").replace(effects=effects)).rib
    rigid = thicker.film_rigid > thicker.film_elastic
    assert 0 < np.count_nonzero(rigid) < 12
    assert np.array_equal(thicker.film, np.where(rigid, thicker.film_rigid, thicker.film_elastic))
    assert np.array_equal(elastic.film, elastic.film_elastic)
    assert np.array_equal(elastic.film_elastic, thicker.film_elastic)


def test_rib_film_of_a_needle() -> None:
    """Aihara's formula stands here a second time; it gives two thirds of the other film."""
    scene = scene_of("no_thermal")
    seen = look(scene.replace(effects=scene.effects.replace(rib_film="needle")))
    rx, ry = seen.geometry.rib_rx, seen.geometry.rib_ry
    w, u = seen.rib.load / (seen.modulus * rx**2), seen.oil.viscosity * seen.rib.mean_speed / (seen.modulus * rx)
    k = 1.03 * (ry / rx) ** 0.64
    film = 1.25 * 3.63 * u**0.68 * seen.g**0.49 * w**-0.073 * (1.0 - np.exp(-0.68 * k)) * rx
    assert seen.rib.film == exact(film)
    assert k < 1.0
    other = look(scene.replace(effects=scene.effects.replace(rib_film="pe"))).rib.film
    assert film / other == pytest.approx(0.67, abs=0.02)


@pytest.mark.parametrize("turn", [0.0, 3e3, 3e5])
def test_sliding_that_turns_at_the_rib(turn: float) -> None:
    """Friction of a contact whose points slide differently, beside the sum over the points of its ellipse; its power is what both
    bodies lose, and its moment turns both against each other.
    """
    scene = scene_of("full_film")
    effects = scene.effects.replace(rib_turning=True, traction="coulomb", rib_film="pe", front_rib=False, gravity=False)
    scene = scene.replace(effects=effects)
    results = []
    for on in (True, False):
        sim = Simulation(scene.replace(effects=effects.replace(rib_turning=on)), instruction_set="scalar")
        vector = sim.state.vector.copy()
        sim.view(vector)["roller_omega_a"] += turn
        results.append(sim.contacts(vector))
    on, off = results
    q, mu, speed = on["rib_load"], on["rib_friction_coefficient"], on["rib_sliding_speed"]
    v = off["rib_sliding_speed"]
    moments = [found["moment"] for found in results]
    radii = scene.bearing.geometry.rib_rx, scene.bearing.geometry.rib_ry
    modulus = scene.bearing.geometry.effective_modulus
    a, b = (law(q, *radii, modulus) for law in (laws.point_semi_axis_long, laws.point_semi_axis_short))
    w2 = (speed**2 - v**2) / ((a**2 + b**2) / 5.0)
    assert (w2 > 0.0).all()
    # over the ellipse, with the load's share 1.5 sqrt(1 - x^2 - y^2)/pi at each point
    r, angle = np.meshgrid((np.arange(400) + 0.5) / 400, np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False))
    share = 1.5 * np.sqrt(1.0 - r**2) / np.pi * r * (1.0 / 400) * (2.0 * np.pi / 400)
    w = math.sqrt(w2[0])
    local = np.hypot(v[0] - w * b[0] * r * np.sin(angle), w * a[0] * r * np.cos(angle))
    assert share.sum() == pytest.approx(1.0, rel=1e-3)
    assert speed[0] == pytest.approx(math.sqrt(np.sum(share * local**2)), rel=2e-3)
    assert speed[0] == pytest.approx(np.sum(share * local), rel=0.08)
    lost = (q * mu * speed)[0]
    assert on["power"][0, 4] == pytest.approx(lost, rel=1e-9)
    assert np.linalg.norm(moments[0] - moments[1], axis=1).min() > 0.0


def test_friction_opposes_sliding_and_loses_power() -> None:
    """Every contact loses friction times sliding speed, and no other power."""
    seen = look(scene_of("no_thermal"))
    sim = Simulation(seen.scene, instruction_set="scalar")
    found = sim.contacts()
    for race, column in ((0, 0), (1, 1)):
        drag = found["raceway_load"] * found["raceway_friction_coefficient"] * found["raceway_sliding_speed"]
        # without the guard of 1e-9 m/s in the speed itself: s^2/sqrt(s^2 + guard^2)
        slid = found["raceway_sliding_speed"] ** 2 - 1e-18
        drag *= slid / found["raceway_sliding_speed"] ** 2
        assert found["power"][:, column] == pytest.approx(drag[race].sum(axis=-1), rel=1e-9, abs=1e-15)
