"""Surfaces off their true form as the core takes them: how deep a roller sinks in, at each node of the contact line.

A rigid roller on a surface of depth h(v) along the direction of rolling v stands at u as deep as the highest place under it
allows: ``min over v of h(v) + (v - u)^2 / (2 Re)``, with Re the equivalent radius of the contact. A pit of the length L with
steep walls is so entered smoothly, along a parabola, and its ground is reached only where L is above ``2 sqrt(2 Re depth)``
(docs/theory/contacts.md#surfaces-off-their-true-form).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import InputError, Path, join_path
from trbdyn.model.contact_line import stations
from trbdyn.model.defects import Defect, DepthMap, Pit, Waviness

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene

Array = NDArray[np.float64]

RACES: Final = ("outer", "inner")
SAMPLES: Final = 64
"""Samples of a pit along rolling; of a map between two of its places, a quarter of them."""
SAMPLES_A_WAVE: Final = 32
MOST_SAMPLES: Final = 3000
"""Of a patch."""


@dataclass(frozen=True)
class _Line:
    """The contact line of a race, at each node: where it is, radius of the surface about its axis, and equivalent radius (m)."""

    station: Array
    race: Array
    roller: Array
    equivalent: Array

    def surface(self, on: str) -> Array:
        return self.roller if on == "roller" else self.race


def _line(scene: Scene, race: str) -> _Line:
    """As the core has it, without profile and deviations of diameters, which change a radius by less than 1e-3."""
    bearing, g = scene.bearing, scene.bearing.geometry
    station, side = stations(scene), 1.0 if race == "outer" else -1.0
    roller = 0.5 * bearing.roller.diameter + station * math.tan(g.roller_half_angle)
    middle = 0.5 * bearing.pitch_diameter + station * math.sin(g.roller_axis_angle)
    angle = math.radians(bearing.cup_half_angle_deg) if race == "outer" else g.cone_half_angle
    on_race = middle + side * roller * math.cos(g.roller_axis_angle)
    curvature = math.cos(g.roller_half_angle) / roller - side * math.cos(angle) / on_race
    return _Line(station, on_race, roller, 1.0 / curvature)


def form_rows(scene: Scene) -> Array:
    """The patches of a scene's surfaces, shape (samples of all, 4 + 2 n); no rows where all surfaces have their true form.

    Columns: patch, surface, angle (rad), shortest angle over which the depth changes (rad), then the depth (m) at each of n nodes
    and its slope (m/rad). Refused are defects beside the contact line or between its nodes, and those that no roller can follow.
    """
    patches = [
        patch for place, defect in enumerate(scene.defects) for patch in _patches(scene, ("defects", place), defect)
    ]
    if not patches:
        return np.zeros((0, 1))
    rows = [np.hstack([np.full((len(patch), 1), float(number)), patch]) for number, patch in enumerate(patches)]
    return np.ascontiguousarray(np.vstack(rows))


def _patches(scene: Scene, path: Path, defect: Defect) -> Iterator[Array]:
    """The patches of a defect: for each surface and race that meets it, without their numbers."""
    rollers: list[int | None] = [None]
    if defect.on == "roller":
        rollers = [defect.roller] if defect.roller is not None else list(range(scene.bearing.n_rollers))
    for roller in rollers:
        if roller is not None and roller >= scene.bearing.n_rollers:
            limit = (
                f"must be from 0 to {scene.bearing.n_rollers - 1}: the bearing has {scene.bearing.n_rollers} rollers"
            )
            raise InputError.of((*path, "roller"), roller, limit)
        for number, race in enumerate(RACES):
            if defect.on not in ("roller", race):
                continue
            line = _line(scene, race)
            angle, scale, depth = _depths(scene, path, defect, line, roller or 0)
            slope = np.gradient(depth, angle, axis=0)
            closed = math.isclose(angle[-1] - angle[0], 2.0 * math.pi)
            slope[[0, -1]] = (depth[1] - depth[-2]) / (2.0 * (angle[1] - angle[0])) if closed else 0.0
            surface = number if roller is None else 2 + 2 * roller + number
            yield np.hstack(
                [np.broadcast_to([surface, 0.0, scale], (len(angle), 3)) + np.eye(3)[1] * angle[:, None], depth, slope]
            )


def _depths(scene: Scene, path: Path, defect: Defect, line: _Line, roller: int) -> tuple[Array, float, Array]:
    """Angles of a patch (rad), shortest angle over which the depth changes (rad), depths that a roller feels (m)."""
    if isinstance(defect, Waviness):
        return _waves(path, defect, line, roller)
    nodes = line.station
    low, high = (
        (defect.position - 0.5 * defect.width, defect.position + 0.5 * defect.width)
        if isinstance(defect, Pit)
        else (defect.across[0], defect.across[-1])
    )
    inside = (nodes >= low) & (nodes <= high)
    if not inside.any():
        _refuse(scene, path, defect, nodes, low, high)
    radius = float(np.interp(0.5 * (low + high), nodes, line.surface(defect.on)))
    raised = 0.0
    if isinstance(defect, Pit):
        start, end, scale = -0.5 * defect.length, 0.5 * defect.length, defect.length
        step = defect.length / SAMPLES
    else:
        start, end = defect.along[0], defect.along[-1]
        smallest = float(np.diff(defect.along).min())
        step, scale = 4.0 * smallest / SAMPLES, 4.0 * smallest
        raised = math.sqrt(2.0 * float(line.equivalent.max()) * max(0.0, -min(map(min, defect.depth))))
    count = math.ceil((end - start + 2.0 * raised) / step)
    if count > MOST_SAMPLES:
        limit = f"must not be more than {MOST_SAMPLES} times as long as a sixteenth of its smallest spacing"
        raise InputError.of((*path, "along"), end - start, limit)
    along = np.linspace(start - raised, end + raised, count + 1)
    if along[-1] - along[0] >= 2.0 * math.pi * radius:
        limit = f"must be shorter than the way round the surface, {2.0 * math.pi * radius:g} (m)"
        raise InputError.of((*path, "length" if isinstance(defect, Pit) else "along"), along[-1] - along[0], limit)
    depth = np.zeros((count + 1, nodes.size))
    for node in np.flatnonzero(inside):
        depth[:, node] = felt(along, _profile(defect, along, float(nodes[node])), float(line.equivalent[node]))
    return math.radians(defect.angle_deg) + along / radius, scale / radius, depth


def _profile(defect: Pit | DepthMap, along: Array, station: float) -> Array:
    """Depth of the surface itself along rolling (m), at a node."""
    if isinstance(defect, Pit):
        profile = np.full(along.size, defect.depth)
        profile[[0, -1]] = 0.0
        return profile
    at_node = [float(np.interp(station, defect.across, row)) for row in defect.depth]
    return np.interp(along, defect.along, at_node, left=0.0, right=0.0)


def felt(along: Array, depth: Array, equivalent: float) -> Array:
    """How deep a roller sinks into a surface (m), shape (n,), at places along rolling (m) with the depth of the surface there (m;
    negative: height), which is zero at both ends and beyond. `equivalent` is the equivalent radius of the contact (m).
    """
    height = depth[None, :] + (along[None, :] - along[:, None]) ** 2 / (2.0 * equivalent)
    return np.asarray(height.min(axis=1))


def _waves(path: Path, waves: Waviness, line: _Line, roller: int) -> tuple[Array, float, Array]:
    orders, amplitudes = np.asarray(waves.orders), np.asarray(waves.amplitudes)
    random = np.random.default_rng([waves.seed, roller]).uniform(0.0, 2.0 * np.pi, orders.size) / orders
    phases = random if waves.phases_deg is None else np.radians(waves.phases_deg)
    radius = line.surface(waves.on)
    sharpest = float(np.max(np.sum(amplitudes * orders**2) / radius**2 * line.equivalent))
    if sharpest > 0.5:
        limit = f"must be at most {0.5 / sharpest:.3g} times as large: the rollers could not follow waves of these orders (m)"
        raise InputError.of((*path, "amplitudes"), waves.amplitudes, limit)
    angle = np.linspace(0.0, 2.0 * np.pi, SAMPLES_A_WAVE * int(orders.max()) + 1)
    depth = np.cos(orders * (angle[:, None] + phases)) @ amplitudes
    return angle, 2.0 * np.pi / int(orders.max()), np.repeat(depth[:, None], line.station.size, axis=1)


def _refuse(scene: Scene, path: Path, defect: Pit | DepthMap, nodes: Array, low: float, high: float) -> None:
    name = "position" if isinstance(defect, Pit) else "across"
    half = 0.5 * scene.bearing.roller.effective_length
    if low > half or high < -half:
        given = defect.position if isinstance(defect, Pit) else defect.across
        raise InputError.of(
            (*path, name), given, f"must lie between {-half:g} and {half:g}, where rollers touch the raceways (m)"
        )
    needed = math.ceil(2.0 * half / (high - low)) + 1
    limit = f"must be at least about {needed}: none of the nodes of the contact line lies on {join_path(path)}"
    raise InputError.of(("effects", "n_slices"), nodes.size, limit)
