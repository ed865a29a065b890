"""Static equilibrium of ring and rollers at speed (docs/theory/motion.md#equilibrium-of-the-ring), and why there may be none."""

from __future__ import annotations

import contextlib
import math
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.errors import LoadError
from trbdyn.model.flatten import RingLoad, ring_load
from trbdyn.model.motion import is_constant, value_at
from trbdyn.model.scene import Scene

Array = NDArray[np.float64]
Near = tuple[Array, Array]
"""Where the ring may stand (m, rad), shape (5,), and its rollers as `Equilibrium.rollers` (m, rad), shape (Z, 4)."""

JUST_CARRIES: Final = 1.0001
"""Axial load, over `least_axial_load`, under which a ring just carries."""
JUST_CARRIED: Final = 1e-3
"""At least this force (N) is carried then: less than the core's balance leaves would say nothing of the ring's place."""
MORE_CARRIED: Final = (1.0, 10.0, 100.0)
"""Factors of this excess that are tried in turn, where rollers that hardly touch leave the balance unsolved."""

BEYOND_REACH: Final = 1.005
"""Radial load, over the largest that the rollers' places allow, that is refused at once: elastic rollers differ by less."""

RAISED_BY: Final = 0.25
"""First step by which radial load and moments are raised where they are not balanced at once, in units of them."""
RAISED_LEAST: Final = 1e-3
"""Least step of the same: as well is the largest load known that the error names."""

FAR_SHARE: Final = 0.1
"""Way of a free ring at the pitch circle, over a roller's diameter, beyond which it is loose; usual ones are below 0.03."""

NEAR_SHARE: Final = 0.8
"""Share of the largest radial load from which a load that was not balanced is said to be too close to it."""


@dataclass(frozen=True)
class Equilibrium:
    """Static equilibrium of ring and rollers at speed, without friction, gravity and cage.

    Attributes
    ----------
    displacement : ndarray, shape (5,)
        Inner ring: translation x, y, z (m), rotation about x, y (rad).
    angles : ndarray, shape (Z,)
        Orbit angles at which the rollers stand (rad).
    rollers : ndarray, shape (Z, 4)
        Offsets of each roller: radius, axial position (m), tilt, skew (rad).
    outer_load, inner_load, rib_load : ndarray, shape (Z,)
        Normal loads (N).
    on_outer : ndarray, shape (5,)
        What the rollers do to the outer ring: force (N), and moment about x, y through the apex (N m).
    residual : float
        Largest force left unbalanced (N).
    iterations : int
        Steps of Newton's method.
    """

    displacement: Array
    angles: Array
    rollers: Array
    outer_load: Array
    inner_load: Array
    rib_load: Array
    on_outer: Array
    residual: float
    iterations: int


class EquilibriumSolver:
    """Solves for the equilibrium of a scene's ring with its rollers at some orbit angles (rad), shape (Z,)."""

    def __init__(self, model: _core.Model, scene: Scene, angles: Array) -> None:
        self.model, self.scene, self.angles = model, scene, angles
        self._rests: dict[tuple[float, float], float] = {}

    def solve(self, time: float, *, near: Near | None = None, displacement: Array | None = None) -> Equilibrium:
        """The equilibrium under the load at a time (s), or with the ring at a displacement (m, rad), shape (5,), whatever its
        load is.

        The search starts from a place of ring and rollers close by, if one is given.
        """
        load = ring_load(self.scene, time)
        if displacement is None and self.scene.unloaded == "rests":
            return self._no_further(load, time, near)
        return self._solve(load, time, near, displacement)

    def _no_further(self, load: RingLoad, time: float, near: Near | None) -> Equilibrium:
        """The equilibrium of a ring that goes no further than where it just carries; its loads hold it there or before."""
        rest = self._resting(load, time)
        if -load.force[2] > _just_carried(self.scene, time):
            with contextlib.suppress(LoadError):
                found = self._solve(load, time, near)
                if found.displacement[2] <= rest:
                    return found
        fixed, place = load.fixed.copy(), load.displacement.copy()
        fixed[2], place[2] = 1.0, rest
        return self._solve(replace(load, fixed=fixed, displacement=place), time, near)

    def _resting(self, load: RingLoad, time: float) -> float:
        """Axial place (m) at which rollers and rings just touch at a speed: rollers that orbit press into the cup."""
        speeds = load.shaft_speed, load.outer_speed
        if speeds not in self._rests:
            least, axial = least_axial_load(self.scene, time), _just_carried(self.scene, time)
            alone = replace(load, fixed=np.array([0.0, 0.0, 0.0, 1.0, 1.0]), displacement=np.zeros(5))
            place = 0.0
            for more in MORE_CARRIED if axial > 0.0 else ():
                force = np.array([0.0, 0.0, -(least + more * (axial - least))])
                try:
                    place = float(self._solve(replace(alone, force=force), time).displacement[2])
                    break
                except LoadError:
                    if more == MORE_CARRIED[-1]:
                        raise
            self._rests[speeds] = place
        return self._rests[speeds]

    def _solve(
        self, load: RingLoad, time: float, near: Near | None = None, displacement: Array | None = None
    ) -> Equilibrium:
        fixed = load.fixed if displacement is None else np.ones(5)
        place, rollers, rough = load.displacement if displacement is None else displacement, None, False
        if near is not None:
            place, rollers = np.where(fixed > 0.0, place, near[0]), near[1].ravel()
        elif displacement is None and self.scene.bearing.is_cylindrical:
            (place, rollers), rough = self._touching(load), True
        force = np.concatenate([load.force, load.moment])
        if displacement is None and not load.fixed[:3].any():
            self._check_reach(load, time)
        found = None
        try:
            found = self._balanced(load, force, fixed, place, rollers, rough=rough)
        except _core.CoreLoadError as error:
            # starts that were not tried yet: not from close by, and where the axial position is given with play
            trials: list[tuple[Array, Array | None]] = [(load.displacement, None)] if near is not None else []
            if self.scene.bearing.is_cylindrical:
                trials.append((load.displacement, None))
            elif load.displacement[2] > 0.0:
                trials.append((self._pushed(load), self._along_cup(float(load.displacement[2]))))
            for trial, guessed in trials if displacement is None else []:
                with contextlib.suppress(_core.CoreLoadError):
                    found = self._balanced(load, force, fixed, trial, guessed)
                    break
            largest = 0.0
            if found is None and displacement is None:
                found, largest = self._raised(load)
            if found is None:
                raise LoadError(_why_not(self.scene, time, str(error), largest)) from None
        if displacement is None and self.scene.ring == "free":
            self._check_place(load, found["displacement"], time)
        outer, inner, rib = np.asarray(found["loads"]).T
        return Equilibrium(
            displacement=found["displacement"],
            angles=self.angles,
            rollers=found["rollers"],
            outer_load=outer,
            inner_load=inner,
            rib_load=rib,
            on_outer=found["on_other"],
            residual=found["residual"],
            iterations=found["iterations"],
        )

    def _check_place(self, load: RingLoad, place: Array, time: float) -> None:
        """Refuse a balance so far away that the watch over a run would call a free ring loose there."""
        arm = 0.5 * self.scene.bearing.pitch_diameter
        moved = np.abs(place - load.displacement) * np.array([1.0, 1.0, 1.0, arm, arm]) * (load.fixed == 0.0)
        farthest = float(moved.max())
        if farthest > FAR_SHARE * self.scene.bearing.roller.diameter:
            said = (
                f"a balance was found where the ring is {1e3 * farthest:.3g} mm away, more than a tenth of a roller's "
                "diameter: nothing holds it there"
            )
            raise LoadError(_why_not(self.scene, time, said, 0.0))

    def _balanced(
        self,
        load: RingLoad,
        force: Array,
        fixed: Array,
        place: Array,
        rollers: Array | None,
        with_loads: bool = False,
        *,
        rough: bool = False,
    ) -> dict[str, Any]:
        """The core's equilibrium at the speeds of a load; rough: rollers that are given are not close to it."""
        speeds = load.shaft_speed, load.outer_speed
        return self.model.equilibrium(
            force, fixed, place, speeds[0], self.angles, rollers, with_loads, outer_speed=speeds[1], rough=rough
        )

    def _check_reach(self, load: RingLoad, time: float) -> None:
        """Refuse a radial load that no rollers at these angles can carry: their normal loads would have to pull."""
        radial = float(np.hypot(*load.force[:2]))
        if not radial > 0.0 or not self.scene.effects.back_rib or self.scene.bearing.is_cylindrical:
            return
        most = most_radial_load(self.scene, -float(load.force[2]), time)
        reach = most * _reach(self.angles, math.atan2(load.force[1], load.force[0]))
        if radial > BEYOND_REACH * reach:
            said = f"the bearing cannot carry this load: rollers at these angles carry at most {reach:.6g} N in this direction"
            raise LoadError(_why_not(self.scene, time, said, 0.0))

    def _raised(self, load: RingLoad) -> tuple[dict[str, Any] | None, float]:
        """The equilibrium under a load to which radial load and moments are raised from less, each from the equilibria before; or
        nothing, and the largest share of them that was balanced (1).
        """
        force, known = np.concatenate([load.force, load.moment]), list[tuple[float, Array, Array]]()
        raised = np.array([True, True, False, True, True])
        if not np.any(force[raised]):
            return None, 0.0
        share, step = 0.0, RAISED_BY
        while step >= RAISED_LEAST:
            wanted = min(share + step, 1.0) if known else 0.0
            acting = np.where(raised, wanted * force, force)
            place, rollers = load.displacement, None
            if known:
                (_, place, rollers), before = known[-1], known[max(len(known) - 2, 0)]
                ahead = (wanted - share) / (share - before[0]) if share > before[0] else 0.0
                place, rollers = place + ahead * (place - before[1]), rollers + ahead * (rollers - before[2])
                rollers = rollers.ravel()
            try:
                found = self._balanced(load, acting, load.fixed, place, rollers, wanted == 1.0)
            except _core.CoreLoadError:
                if not known:
                    return None, 0.0
                step *= 0.5
                continue
            if wanted == 1.0:
                return found, 1.0
            share = wanted
            known.append((share, found["displacement"], found["rollers"]))
        return None, share

    def _pushed(self, load: RingLoad) -> Array:
        """A guess of the ring's place: where its axial position is given with play, pushed to the side by its load."""
        place, push = load.displacement.copy(), float(np.hypot(*load.force[:2]))
        gap = max(place[2], 0.0) * math.tan(math.radians(self.scene.bearing.cup_half_angle_deg))
        if push > 0.0:
            place[:2] = np.where(load.fixed[:2] > 0.0, place[:2], gap * load.force[:2] / push)
        return place

    def _touching(self, load: RingLoad) -> tuple[Array, Array]:
        """A guess for cylinders, which have play: the ring moved by the clearances and by about what contacts give way, the
        rollers between the raceways where these are close, and else on the outer one; shapes (5,) and (4 Z,).
        """
        bearing, geometry = self.scene.bearing, self.scene.bearing.geometry
        place, radial, axial = load.displacement.copy(), load.force[:2], max(-float(load.force[2]), 0.0)
        push, clearance, count = float(np.hypot(*radial)), bearing.radial_clearance, bearing.n_rollers
        line = 0.356 * geometry.effective_modulus * bearing.roller.effective_length ** (8.0 / 9.0)
        if push > 0.0:
            moved = 0.5 * max(clearance, 0.0) + 2.0 * (5.0 * push / (count * line)) ** 0.9
            place[:2] = np.where(load.fixed[:2] > 0.0, place[:2], moved * radial / push)
        along = bearing.ribs.clearance + (axial / (count * geometry.rib_stiffness)) ** (2.0 / 3.0)
        if axial > 0.0 and not load.fixed[2]:
            place[2] = -2.0 * along
        closed = place[0] * np.cos(self.angles) + place[1] * np.sin(self.angles)
        rollers = np.zeros((count, 4))
        rollers[:, 0] = np.maximum(0.5 * closed, 0.25 * clearance)
        rollers[:, 1] = 0.5 * place[2]
        return place, rollers.ravel()

    def _along_cup(self, shift: float) -> Array:
        """Rollers that went along the cup by this axial distance (m), as a guess."""
        slope = math.tan(math.radians(self.scene.bearing.cup_half_angle_deg))
        return np.tile([shift * slope, shift, 0.0, 0.0], self.angles.size)


def _just_carried(scene: Scene, time: float) -> float:
    """Axial load (N) under which a ring just carries; 0 where the rollers need none."""
    least = least_axial_load(scene, time)
    return max(JUST_CARRIES * least, least + JUST_CARRIED) if least > 0.0 else 0.0


def least_axial_load(scene: Scene, time: float = 0.0) -> float:
    """Axial load (N) below which rollers that orbit press the ring off, without any other load; 0 without a back-face rib.

    The centrifugal force Fc of a roller presses it against the cup, whose slope pushes it with Fc tan(alpha_o) towards
    its large end, and there against the rib, whose normal lies at the angle theta to the bearing axis: the inner
    raceway carries nothing at Fa = Z Fc tan(alpha_o) / [1 + tan(theta) tan(alpha_o)].
    """
    if not scene.effects.back_rib or scene.bearing.is_cylindrical:
        return 0.0
    geometry = scene.bearing.geometry
    orbit = scene.orbit_speed(time)
    centrifugal = geometry.roller_mass * orbit**2 * geometry.roller_centre_radius
    slope = math.tan(math.radians(scene.bearing.cup_half_angle_deg))
    return scene.bearing.n_rollers * centrifugal * slope / (1.0 + math.tan(geometry.rib_normal_angle) * slope)


def most_radial_load(scene: Scene, axial_load: float, time: float = 0.0) -> float:
    """Radial load (N) that no position of the rings can carry under an axial load (N).

    The cup carries both loads: its normal loads Q have the axial sum Fa = sum Q sin(alpha_o) and the radial one
    Fr = sum Q cos(alpha_o) cos(psi). The part of Fa that holds the rollers against their centrifugal forces (`least_axial_load`)
    is spread evenly and carries no radial load; the rest carries most where it acts on one roller in the direction of the load:
    (Fa - least) / tan(alpha_o).
    """
    slope = math.tan(math.radians(scene.bearing.cup_half_angle_deg))
    return (axial_load - least_axial_load(scene, time)) / slope


def _reach(angles: Array, direction: float) -> float:
    """Share of `most_radial_load` that rollers at some angles carry in a direction (rad).

    The load is the mean of the rollers' directions, weighted with their normal loads, so it lies within the polygon whose corners
    are the rollers: the share reaches to its edge.
    """
    ahead = np.sort(np.mod(angles - direction, 2.0 * math.pi))
    before, after = ahead[-1] - 2.0 * math.pi, ahead[0]
    half, middle = 0.5 * (after - before), 0.5 * (after + before)
    return max(math.cos(half) / math.cos(middle), 0.0) if half < 0.5 * math.pi else 0.0


def _why_not(scene: Scene, time: float, said: str, largest: float) -> str:
    """Why there is no equilibrium, as far as it can be told; largest: share of radial load and moments that was balanced."""
    changes = any(not is_constant(quantity) for quantity in scene.ring_quantities().values())
    when = f" at {time:.6g} s" if changes or scene.rotating_load is not None else ""
    load, z = ring_load(scene, time), scene.ring_is_placed[2]
    axial, radial, speed = -load.force[2], float(np.hypot(*load.force[:2])), value_at(scene.speed_rpm, time)
    if scene.bearing.is_cylindrical:
        moments = f", moments {load.moment[0]:g} and {load.moment[1]:g} N m" if np.any(load.moment) else ""
        return f"no equilibrium{when} under axial_load = {axial:g} N, radial load {radial:g} N{moments}; {said}"
    if z:
        place = load.displacement[2]
        return (
            f"no equilibrium{when} with the ring held at z = {place:g} m under a radial load of {radial:g} N: "
            f"{'move it towards -z, so that rollers and rings touch' if place >= 0.0 else 'the load is too large'}; {said}"
        )
    least = least_axial_load(scene, time)
    if axial < least:
        return (
            f"no equilibrium{when}: axial_load = {axial:g} N is less than the rollers' centrifugal force needs at {speed:g} rpm; "
            f"axial_load must be at least {least:.4g} N at this speed, or the speed at most "
            f"{abs(speed) * math.sqrt(axial / least):.4g} rpm"
        )
    most = most_radial_load(scene, axial, time)
    bounds = f"axial_load at least {least:.4g} N at {speed:g} rpm, radial load below {most:.4g} N"
    if largest > 0.0:
        moment = f" and {largest * float(np.hypot(*load.moment)):.4g} N m" if np.any(load.moment) else ""
        bounds += f"; with these rollers {largest * radial:.4g} N{moment} in this direction were balanced"
    if radial > NEAR_SHARE * most:
        how = "more than" if radial >= most else "too close to all that"
        return (
            f"no equilibrium{when}: the radial load of {radial:g} N is {how} axial_load = {axial:g} N can hold "
            f"({bounds}): raise axial_load, or lower radial_load; {said}"
        )
    return f"no equilibrium{when} under axial_load = {axial:g} N, radial load {radial:g} N (needed: {bounds}); {said}"


def nominal_angles(scene: Scene) -> Array:
    """Evenly spaced orbit angles (rad), shape (Z,)."""
    count = scene.bearing.n_rollers
    return 2.0 * math.pi * np.arange(count) / count
