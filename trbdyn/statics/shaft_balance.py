"""Forces on a rigid shaft that stands at a place on its bearings, their slopes and their potential
(docs/theory/motion.md#a-shaft-on-several-bearings).

Unknowns are the place of the shaft at a reference point of its axis, translation along x, y, z and rotation about x and y, and
the axial place of each outer ring that a spring presses. Each bearing answers the place of its inner ring with the equilibrium
of its rollers at speed, found by the core.
"""

from __future__ import annotations

import contextlib
import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.model.assembly import Assembly, ShaftBearing
from trbdyn.model.motion import value_at
from trbdyn.statics.core_model import normal_contacts
from trbdyn.statics.equilibrium import nominal_angles
from trbdyn.statics.free_ring import ALONG, axis_of

Array = NDArray[np.float64]

MOST_FOLLOW: Final = 100.0
"""Largest motion of a roller, over that of its ring, by which it follows the ring. Where contacts hardly touch, slopes give more;
between cone and cup, whose slopes differ by a few degrees, a roller goes some ten times as far at most."""


@dataclass(frozen=True)
class Answer:
    """What a bearing does where its inner ring stands, in the bearing's own frame."""

    displacement: Array  # place of the inner ring against the outer ring (m, rad), shape (5,)
    reaction: Array  # force and moment that hold the inner ring there (N, N m), shape (5,)
    stiffness: Array  # slopes of the reaction with the displacement, shape (5, 5)
    rollers: Array  # offsets of each roller: radius, axial position (m), tilt, skew (rad), shape (Z, 4)
    follow: Array  # how each roller follows the ring, shape (Z, 4, 5)
    loads: Array  # normal loads of the rollers at the outer ring, the inner ring and the rib (N), shape (Z, 3)
    energy: float  # potential (J)


@dataclass(frozen=True)
class Balance:
    """Forces on the shaft at a place. The unknowns are its five coordinates, and the places of the outer rings with a spring."""

    place: Array  # the unknowns (m, rad), shape (5 + S,)
    answers: tuple[Answer, ...]  # of the bearings
    missing: Array
    """Forces and moments that act on the shaft, and forces on the outer rings with a spring, and are not held (N, N
    m), shape (5 + S,)."""
    slopes: Array  # slopes of the same with the place, with opposite sign, shape (5 + S, 5 + S)
    energy: float  # potential of bearings, springs and loads (J)

    @property
    def stiffness(self) -> Array:
        """Stiffness of the shaft, shape (5, 5), where the outer rings with a spring stay in equilibrium."""
        return self.slopes[:5, :5] + self.slopes[:5, 5:] @ self.sprung_follow

    @property
    def sprung_follow(self) -> Array:
        """How the outer rings with a spring follow the shaft, shape (S, 5)."""
        return np.asarray(-np.linalg.solve(self.slopes[5:, 5:], self.slopes[5:, :5]), dtype=float)


class ShaftOnBearings:
    """An assembly at a time (s), ready to be asked for its forces."""

    def __init__(self, assembly: Assembly, time: float) -> None:
        self.assembly = assembly
        speeds = assembly.speed_rpm, assembly.outer_speed_rpm
        self.speed, self.outer_speed = (value_at(speed, time) * math.pi / 30.0 for speed in speeds)
        scenes = [
            assembly.scene(index, time=time, displacement=(0, 0, -1e-6, 0, 0))
            for index in range(len(assembly.bearings))
        ]
        self._models = [normal_contacts(scene) for scene in scenes]
        self._angles = [nominal_angles(scene) for scene in scenes]
        self.sprung = [index for index, one in enumerate(assembly.bearings) if one.spring is not None]
        self.loads: list[tuple[float, Array, Array, Array]] = []
        for load in assembly.acting():
            force = np.array([value_at(part, time) for part in load.force])
            moment = np.array([*(value_at(part, time) for part in load.moment), 0.0])
            self.loads.append((load.position, np.array([*load.offset, 0.0]), force, moment))

    def answer(self, index: int, displacement: Array, near: Answer | None = None) -> Answer:
        """What a bearing does where its inner ring stands at a displacement (m, rad); `CoreLoadError` if its rollers have no
        equilibrium.

        Its rollers are searched for from where they follow the ring from a place `near`, and else from their places without
        load.
        """
        if near is not None:
            with contextlib.suppress(_core.CoreLoadError):
                return self._solved(index, displacement, self._followed(index, displacement, near).ravel())
        return self._solved(index, displacement, None)

    def _followed(self, index: int, displacement: Array, near: Answer) -> Array:
        """Where the rollers follow the ring from a place close by. One that hardly touches stays."""
        bearing = self.assembly.bearings[index].bearing
        radius, half = 0.5 * bearing.pitch_diameter, 0.5 * bearing.roller.effective_length
        moved = displacement - near.displacement
        follows = near.follow @ moved
        longest = np.max(np.abs(moved * [1.0, 1.0, 1.0, radius, radius]))
        usual = np.max(np.abs(follows * [1.0, 1.0, half, half]), axis=1) < MOST_FOLLOW * longest
        return near.rollers + follows * usual[:, None]

    def _solved(self, index: int, displacement: Array, rollers: Array | None) -> Answer:
        turned = -self.assembly.bearings[index].side
        found: dict[str, Any] = self._models[index].equilibrium(
            np.zeros(5),
            np.ones(5),
            displacement,
            turned * self.speed,
            self._angles[index],
            rollers,
            True,
            True,
            outer_speed=turned * self.outer_speed,
        )
        return Answer(
            displacement=displacement,
            reaction=found["reaction"],
            stiffness=found["stiffness"],
            rollers=found["rollers"],
            follow=found["follow"].reshape(-1, 4, 5),
            loads=found["loads"],
            energy=found["energy"],
        )

    def at(
        self,
        place: Array,
        reference: float,
        answers: tuple[Answer, ...] | None = None,
        near: tuple[Answer, ...] | None = None,
    ) -> Balance:
        """Forces, slopes and potential where the shaft's axis stands at a place: the unknowns (m, rad), shape (5 + S,), at a
        position (m).

        `answers` are those of the bearings there, if they are known; `near` those at a place close by, from where rollers
        follow.
        """
        axis, turning = axis_of(place[3:5])
        missing, slopes = np.zeros(place.size), np.zeros((place.size, place.size))
        energy, given = 0.0, []
        for index, one in enumerate(self.assembly.bearings):
            arm = one.centre_plane - reference
            to_ring = ring_slopes(one, arm, turning, place.size, self._spring(index))
            where = self._ring_place(index, place, arm, axis)
            guess = None if near is None else near[index]
            answer = self.answer(index, where, guess) if answers is None else answers[index]
            given.append(answer)
            turn3, turn2 = turns_of(one)
            change = answer.stiffness @ to_ring
            force, pull = turn3 * answer.reaction[:3], turn3[:, None] * change[:3]
            missing[:3] -= force
            slopes[:3] += pull
            missing[3:5] -= turn2 * answer.reaction[3:] + arm * np.cross(axis, force)[:2]
            slopes[3:5] += turn2[:, None] * change[3:] + arm * np.cross(axis, pull, axisb=0)[:, :2].T
            slopes[3:5, 3:5] += arm * np.cross(turning, force, axisa=0)[:, :2].T
            energy += answer.energy
            if one.spring is not None:
                at, spring = 5 + self._spring(index), one.spring
                missing[at] = spring.force - spring.stiffness * place[at] + answer.reaction[2]
                slopes[at] = -change[2]
                slopes[at, at] += spring.stiffness
                energy += 0.5 * spring.stiffness * place[at] ** 2 - spring.force * place[at]
        for position, offset, force, moment in self.loads:
            arm = position - reference
            missing[:3] += force
            lever = np.cross(offset, force) + moment
            missing[3:5] += lever[:2] + arm * np.cross(axis, force)[:2]
            slopes[3:5, 3:5] -= arm * np.cross(turning, force, axisa=0)[:, :2].T
            energy -= force @ (place[:3] + arm * (axis - ALONG)) + lever[:2] @ place[3:5]
        return Balance(place, tuple(given), missing, slopes, energy)

    def _spring(self, index: int) -> int:
        """Which of the springs presses a bearing; -1: none."""
        return self.sprung.index(index) if index in self.sprung else -1

    def _ring_place(self, index: int, place: Array, arm: float, axis: Array) -> Array:
        one = self.assembly.bearings[index]
        turn3, turn2 = turns_of(one)
        where = np.concatenate([turn3 * (place[:3] + arm * (axis - ALONG)), turn2 * place[3:5]])
        where[2] += one.end_play if one.spring is None else -place[5 + self._spring(index)]
        return where


def turns_of(one: ShaftBearing) -> tuple[Array, Array]:
    """Signs of a vector's three components, and of two of a rotation, from the shaft's frame to the bearing's and back."""
    turned = -one.side
    return np.array([1.0, turned, turned]), np.array([1.0, turned])


def ring_slopes(one: ShaftBearing, arm: float, turning: Array, size: int, spring: int) -> Array:
    """Slopes of the place of a bearing's inner ring against its outer ring with the unknowns, shape (5, size)."""
    turn3, turn2 = turns_of(one)
    slopes = np.zeros((5, size))
    slopes[:3, :3] = np.diag(turn3)
    slopes[:3, 3:5] = arm * turn3[:, None] * turning
    slopes[3:, 3:5] = np.diag(turn2)
    if spring >= 0:
        slopes[2, 5 + spring] = -1.0
    return slopes
