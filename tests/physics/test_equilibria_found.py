"""Equilibria are found wherever a search of another kind finds them: random shafts and random light loads, drawn by a seed.

The package's search follows the potential. A refused shaft is judged by means of another kind: linear programming gives the share
of its loads that the cups can carry at most, wherever shaft and rollers are. Below one there is no equilibrium; else forces are
solved with SciPy's root finders from several starts. A refused bearing is judged by these.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import least_squares, linprog, root

import trbdyn as trb
from trbdyn import _core
from trbdyn.model.flatten import ring_load
from trbdyn.model.scene import LEAST_ACROSS
from trbdyn.statics.core_model import normal_contacts
from trbdyn.statics.equilibrium import EquilibriumSolver, least_axial_load, most_radial_load, nominal_angles
from trbdyn.statics.ring_motion import ring_motion
from trbdyn.statics.shaft_balance import ShaftOnBearings

Array = NDArray[np.float64]

LENGTH = 1e-5
"""Unit of displacements in the other search (m); of rotations it is this length over a radius."""
LEFT = 1e-5
"""Force that the other search may leave, over the largest force that acts."""
MOST = 40
"""Most slopes that one start of the other search takes."""
FAR = 1.2e-3
"""Places (m) beyond which nothing holds a ring or shaft."""
TRAVEL = 5e-3
"""The same of an outer ring with a spring (m)."""
SURELY = 0.97
"""Share of the loads below which there is surely no equilibrium: tilt and displacement alter lever arms by less."""


def tapered() -> dict[str, trb.Bearing]:
    """Bearings of several sizes and angles."""
    pages = {
        "30204": {"bore": 0.020, "outside": 0.047, "width": 0.01525, "C": 27.5e3, "e": 0.35},
        "32208": {"bore": 0.040, "outside": 0.080, "width": 0.02475, "C": 74.8e3, "e": 0.37},
        "31311": {"bore": 0.055, "outside": 0.120, "width": 0.0315, "C": 121e3, "e": 0.83},
    }
    found = {name: trb.Bearing.from_catalogue(name=name, **page) for name, page in pages.items()}
    return found | {"30310": trb.cases.rig_30310()}


def random_speed(random: np.random.Generator) -> float:
    """A speed (rpm): every tenth case at rest, else evenly drawn in the logarithm."""
    speed = float(10.0 ** random.uniform(-0.5, 3.7))
    return 0.0 if random.random() < 0.1 else round(speed, 3)


def shafts(seed: int, count: int) -> Iterator[Callable[[], trb.Assembly]]:
    """Random shafts, made where they are called: pairs with play or preload, with a spring, motor shafts; loads along any
    direction."""
    random, bearings = np.random.default_rng(seed), tapered()
    for _ in range(count):
        left, right = random.choice(list(bearings), 2)
        back = random.random() < 0.6
        kind = random.choice(["pair", "pair", "pair", "spring", "motor"])
        play, spread = float(random.uniform(-30e-6, 120e-6)), float(random.uniform(0.1, 0.4))
        across = 10.0 ** random.uniform(0.5, 4.2) * np.exp(2j * math.pi * random.random())
        along = float(random.choice([0.0, 1.0, -1.0]) * abs(across) * random.uniform(0.0, 0.6))
        where = float(random.uniform(-0.8, 0.8)) * spread
        load = {"position": where, "force": (across.real, across.imag, along)}
        mass, speed = float(random.uniform(1.0, 30.0)), random_speed(random)
        side = random.choice(["left", "right"]) if kind == "motor" else ""
        spring = (float(random.uniform(50.0, 2000.0)), float(random.uniform(1e4, 1e6))) if kind == "spring" else None
        yield partial(shaft_of, bearings[left], bearings[right], back, play, spread, load, mass, speed, side, spring)


def shaft_of(
    left: trb.Bearing,
    right: trb.Bearing,
    back: bool,
    play: float,
    spread: float,
    load: dict[str, Any],
    mass: float,
    speed: float,
    side: Any,
    spring: tuple[float, float] | None,
) -> trb.Assembly:
    """A shaft; `side`: where the small ends of the guided bearing of a motor shaft point."""
    shaft = trb.Shaft.hollow_cylinder(mass=mass, outer_diameter=0.05, length=spread + 0.1)
    common: dict[str, Any] = {"shaft": shaft, "loads": [trb.ShaftLoad(**load)], "speed_rpm": speed}
    if side:
        ends = [
            trb.ShaftBearing(trb.cases.bearing_nj210(), position=-0.5 * spread, small_ends=side),
            trb.ShaftBearing(left, position=0.5 * spread, small_ends="left", end_play=0.5 * play),
            trb.ShaftBearing(right, position=0.5 * spread + 0.09, small_ends="right", end_play=0.5 * play),
        ]
        return trb.Assembly(bearings=ends, **common)
    pair = trb.Assembly.pair(
        left,
        "back to back" if back else "face to face",
        other=right,
        spread=spread if back else spread + 0.15,
        end_play=play,
        **common,
    )
    if spring is None:
        return pair
    first, second = pair.bearings
    pushed = trb.PreloadSpring(force=spring[0], stiffness=spring[1])
    return pair.replace(bearings=(first.replace(spring=pushed, end_play=0.0), second))


def light_loads(seed: int, count: int) -> Iterator[trb.Scene]:
    """Random bearings under light loads: just carried, 0.1 to 300 N across, resting, with play in the axial place, cylinders."""
    random, bearings = np.random.default_rng(seed), tapered()
    for _ in range(count):
        bearing, speed = bearings[random.choice(list(bearings))], random_speed(random)
        kind = random.choice(["light", "light", "across", "rests", "placed", "cylinder"])
        direction = float(random.choice([0.0, 90.0, 180.0, random.uniform(0.0, 360.0)]))
        given: dict[str, Any] = {"speed_rpm": speed, "radial_direction_deg": direction}
        if kind == "cylinder":
            held: dict[str, Any] = random.choice(
                [{"axial_load": 0.0, "displacement": (None, None, 0.0)}, {"axial_load": 50.0}]
            )
            yield trb.cases.scene_nj210().replace(radial_load=float(10.0 ** random.uniform(-1.0, 3.5)), **given, **held)
            continue
        alone = trb.Scene(bearing, axial_load=1e4, speed_rpm=speed)
        axial = float(1.05 * least_axial_load(alone) + 10.0 ** random.uniform(-2.0, 2.5))
        if kind == "rests":
            axial = float(random.choice([0.0, axial]))
            yield trb.Scene(bearing, axial_load=axial, unloaded="rests", **given)
        elif kind == "placed":
            place = float(random.uniform(-5e-6, 40e-6))
            radial = float(10.0 ** random.uniform(-1.0, 3.5))
            yield trb.Scene(bearing, displacement=(None, None, place), radial_load=radial, **given)
        elif kind == "across":
            radial = float(10.0 ** random.uniform(-1.0, 2.5))
            held_by = math.tan(math.radians(bearing.cup_half_angle_deg)) * radial
            axial = float(1.05 * least_axial_load(alone) + random.uniform(1.2, 4.0) * held_by)
            yield trb.Scene(bearing, axial_load=axial, radial_load=radial, **given)
        else:
            radial = float(random.uniform(0.0, 0.85)) * most_radial_load(alone, axial)
            yield trb.Scene(bearing, axial_load=axial, radial_load=radial, **given)


def other_search(forces: Callable[[Array], Array], starts: list[Array], largest: float) -> Array | None:
    """A place where forces (over `largest`) vanish, in units of `LENGTH`, found with SciPy from several starts; or none."""

    def guarded(place: Array) -> Array:
        try:
            return forces(np.asarray(place))
        except _core.CoreLoadError:
            return np.full(len(place), 1e3)

    for start in starts:
        for way in ("lm", "hybr", "trf"):
            try:
                if way == "trf":
                    found = least_squares(guarded, start, max_nfev=MOST).x
                else:
                    found = root(
                        guarded, start, method=way, options={"maxfev" if way == "hybr" else "maxiter": 6 * MOST}
                    ).x
            except (ValueError, np.linalg.LinAlgError):
                continue
            far = np.array([FAR] * 5 + [TRAVEL] * (found.size - 5))[: found.size]
            if np.all(np.abs(found) * LENGTH < far) and np.max(np.abs(guarded(found))) < max(LEFT, 1e-5 / largest):
                return np.asarray(found)
    return None


def bearing_columns(one: trb.ShaftBearing, reference: float) -> tuple[Array, Array]:
    """Forces and moments about a point that a bearing's outer ring can exert, shape (K, 5), and which act either way, shape
    (K,): its raceway only pushes, at both ends of each roller; ribs at both ends of a cylinder hold it either way.
    """
    bearing, turned = one.bearing, -one.side
    angle, half = math.radians(bearing.cup_half_angle_deg), 0.5 * bearing.roller.effective_length
    along, columns, either = np.array([0.0, 0.0, turned]), [], []
    for psi in 2.0 * math.pi * np.arange(bearing.n_rollers) / bearing.n_rollers:
        out = np.array([math.cos(psi), math.sin(psi), 0.0])
        centre = bearing.geometry.roller_centre_radius * out + [0.0, 0.0, one.centre_plane - reference]
        push = -math.cos(angle) * out + math.sin(angle) * along
        line = math.sin(angle) * out + math.cos(angle) * along
        forces = [(centre - half * line, push, False), (centre + half * line, push, False)]
        for at, force, pulls in forces + ([(centre, along, True)] if bearing.is_cylindrical else []):
            columns.append(np.concatenate([force, np.cross(at, force)[:2]]))
            either.append(pulls)
    return np.array(columns), np.array(either)


def share_carried(assembly: trb.Assembly) -> float:
    """Largest share of a shaft's loads (at most 10) that normal forces of rollers on the outer rings can balance.

    Centrifugal forces and gyroscopic moments of evenly spaced rollers have no resultant. Displacements are neglected beside lever
    arms, and contacts carry any force: no equilibrium carries more.
    """
    reference = float(np.mean([one.centre_plane for one in assembly.bearings]))
    parts = [bearing_columns(one, reference) for one in assembly.bearings]
    columns, either = (np.concatenate(part) for part in zip(*parts, strict=True))
    load = np.zeros(5)
    for position, offset, force, moment in ShaftOnBearings(assembly, 0.0).loads:
        lever = offset + np.array([0.0, 0.0, position - reference])
        load += np.concatenate([force, (np.cross(lever, force) + moment)[:2]])
    bounds = [(None if pulls else 0.0, None) for pulls in either] + [(0.0, 10.0)]
    limits: list[Array] = []
    most: list[float] = []
    first = 0
    for one, (own, _) in zip(assembly.bearings, parts, strict=True):
        if one.spring is not None:
            row = np.zeros(len(bounds))
            row[first : first + len(own)] = -one.side * own[:, 2]
            least, largest = (max(one.spring.force + way * one.spring.stiffness, 0.0) for way in (-TRAVEL, TRAVEL))
            limits, most = [*limits, row, -row], [*most, largest, -least]
        first += len(own)
    found = linprog(
        -np.eye(len(bounds))[-1],
        A_ub=limits or None,
        b_ub=most or None,
        A_eq=np.vstack([columns, load]).T,
        b_eq=np.zeros(5),
        bounds=bounds,
    )
    return float(found.x[-1]) if found.status == 0 else 0.0


def other_shaft(assembly: trb.Assembly, seed: int = 0) -> Array | None:
    """Place of a shaft in equilibrium by the other search, shape (5 + S,), or none."""
    system = ShaftOnBearings(assembly, 0.0)
    reference = float(np.mean([one.centre_plane for one in assembly.bearings]))
    size, radius = 5 + len(system.sprung), 0.05
    unit = LENGTH * np.array([1.0, 1.0, 1.0, 1.0 / radius, 1.0 / radius, *[1.0] * (size - 5)])
    largest = max(float(np.abs(force).max()) for _, _, force, _ in system.loads)
    arms = np.array([1.0, 1.0, 1.0, radius, radius, *[1.0] * (size - 5)]) * largest
    push = sum(force for _, _, force, _ in system.loads)
    side = push / np.linalg.norm(push)
    random = np.random.default_rng(seed)
    starts = [np.zeros(size)]
    for axial in (0.0, 2.0, -2.0, 6.0, -6.0):
        start = np.zeros(size)
        start[:2], start[2], start[5:] = 2.0 * side[:2], axial, 1.0
        starts.append(start)
    starts += [np.concatenate([random.uniform(-3.0, 3.0, 5), np.ones(size - 5)]) for _ in range(3)]
    found = other_search(lambda place: system.at(place * unit, reference).missing / arms, starts, largest)
    return None if found is None else found * unit


def other_ring(scene: trb.Scene) -> Array | None:
    """Place of a ring in equilibrium by the other search, shape (5,), or none."""
    model, angles, load = normal_contacts(scene), nominal_angles(scene), ring_load(scene, 0.0)
    radius, free = 0.5 * scene.bearing.pitch_diameter, load.fixed == 0.0
    unit = LENGTH * np.array([1.0, 1.0, 1.0, 1.0 / radius, 1.0 / radius])
    force = np.concatenate([load.force, load.moment])
    largest = max(float(np.abs(load.force).max()), 1e-3)

    def missing(place: Array) -> Array:
        whole = load.displacement.copy()
        whole[free] = place * unit[free]
        found = model.equilibrium(np.zeros(5), np.ones(5), whole, load.shaft_speed, angles, None, True)
        return ((force - found["reaction"]) / np.array([1.0, 1.0, 1.0, radius, radius]) / largest)[free]

    side = load.force[:2] / max(float(np.hypot(*load.force[:2])), 1e-12)
    starts = [
        np.array([*(r * side), z, 0.0, 0.0])[free]
        for r, z in ((0.0, 0.0), (0.1, -0.1), (1.0, -0.3), (1.0, 0.5), (3.0, 0.0))
    ]
    found = other_search(missing, starts, largest)
    return None if found is None else found


def refused_shafts(seed: int, count: int) -> tuple[int, list[str]]:
    """How many shafts the package refuses, and which of them are wrong; so are those that it finds and that nothing can carry."""
    refused, wrong = 0, []
    for number, made in enumerate(shafts(seed, count)):
        assembly = made()
        impossible = share_carried(assembly) < SURELY
        try:
            trb.equilibrium(assembly)
        except trb.LoadError as error:
            refused += 1
            place = None if impossible else other_shaft(assembly)
            if place is not None:
                wrong.append(f"{number}: {assembly.speed_rpm} rpm, at {place}: {error}")
        else:
            if impossible:
                wrong.append(f"{number}: {assembly.speed_rpm} rpm: nothing carries this load")
    return refused, wrong


def refused_scenes(seed: int, count: int) -> list[str]:
    """What the package refuses though the other search finds it, or what rests and is refused: it always has an equilibrium."""
    wrong = []
    for number, scene in enumerate(light_loads(seed, count)):
        try:
            EquilibriumSolver(normal_contacts(scene), scene, nominal_angles(scene)).solve(0.0)
        except trb.LoadError as error:
            place = other_ring(scene)
            if place is not None or scene.unloaded == "rests":
                wrong.append(f"{number}: {scene.speed_rpm} rpm, at {place}: {error}")
    return wrong


@pytest.mark.parametrize(("seed", "count", "refused"), [(1, 6, 0), pytest.param(48, 500, 9, marks=pytest.mark.slow)])
def test_no_shaft_is_refused_that_another_search_finds(seed: int, count: int, refused: int) -> None:
    assert refused_shafts(seed, count) == (refused, [])


@pytest.mark.parametrize("number", [53, 176, 498])
def test_rollers_that_hardly_touch_and_springs_far_back_do_not_stop_the_search(number: int) -> None:
    made = next(itertools.islice(shafts(48, 500), number, None))
    assert trb.equilibrium(made()).residual < 1e-6


@pytest.mark.parametrize("count", [20, pytest.param(500, marks=pytest.mark.slow)])
def test_no_light_load_is_refused_that_another_search_finds(count: int) -> None:
    assert refused_scenes(49, count) == []


@pytest.mark.parametrize(("least", "axial_load"), [(LEAST_ACROSS, 0.0), (0.0, 50.0)])
def test_a_cylindrical_bearing_follows_a_load_that_nearly_goes(least: float, axial_load: float) -> None:
    """Rollers on ribs centre the ring under an axial load; without any, a load that goes leaves it anywhere in its clearance."""
    load = trb.History.step((0.004, 0.009), (3000.0, least, 3000.0), rise=8e-4)
    place = None if axial_load else (None, None, 0.0)
    effects = trb.Effects.standard().replace(n_slices=4)
    scene = trb.cases.scene_nj210(effects=effects).replace(
        axial_load=axial_load, displacement=place, ring="follows", radial_load=load, speed_rpm=300.0
    )
    motion, _ = ring_motion(normal_contacts(scene), scene)
    clearance = scene.bearing.radial_clearance
    moved = math.hypot(*motion.displacement(0.006)[:2])
    assert moved < 1e-9 if axial_load else 0.45 * clearance < moved < 0.55 * clearance
    with pytest.raises(trb.InputError, match=r"radial_load = 0.0 : must be >= 0.001 at 0.0048 s"):
        scene.replace(
            axial_load=0.0, displacement=(None, None, 0.0), radial_load=load.replace(values=(3000.0, 0.0, 0.0, 3000.0))
        )


@pytest.mark.parametrize("speed", [30.0, 1000.0])
def test_a_ring_that_rests_takes_up_its_load_without_a_jump(speed: float) -> None:
    load = trb.History(times=(0.0, 0.01, 0.02, 0.03, 0.04), values=(1000.0, 1000.0, 0.0, 0.0, 1000.0))
    scene = trb.Scene(trb.cases.rig_30310(), axial_load=load, speed_rpm=speed, unloaded="rests", ring="follows")
    motion, _ = ring_motion(normal_contacts(scene), scene)
    assert abs(motion.displacement(0.025)[2]) < 1e-7
    assert motion.displacement(0.04)[2] == pytest.approx(motion.displacement(0.0)[2], rel=1e-6)
