"""Static equilibrium at speed of a shaft on several bearings, its stiffness and its natural vibrations
(docs/theory/motion.md#a-shaft-on-several-bearings).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown, Tabled
from trbdyn.base.validation import number_of
from trbdyn.errors import InputError, LoadError
from trbdyn.model.assembly import Assembly
from trbdyn.model.motion import value_at
from trbdyn.model.ring_body import RingBody
from trbdyn.model.scene import Scene
from trbdyn.statics.free_ring import ALONG, axis_of
from trbdyn.statics.shaft_balance import Answer, Balance, ShaftOnBearings, ring_slopes, turns_of
from trbdyn.statics.stiffness import Modes, Stiffness
from trbdyn.statics.stiffness import stiffness as stiffness

Array = NDArray[np.float64]

BALANCED: Final = 2e-9
"""Force that is left, over the largest force on the shaft, from which on it is in equilibrium; or `BALANCED_FORCE`."""
BALANCED_FORCE: Final = 1e-6
"""The same as a force (N)."""
STEPS: Final = 200
"""Most steps of Newton's method; usual are about ten."""
FIRST_DAMPING: Final = 1e-3
LONGEST_STEP: Final = 5e-5
"""Longest step (m): the stiffness says nothing about longer ones."""
FARTHEST: Final = 1.5e-3
"""Displacement (m) at which nothing holds the shaft any more."""
SPRING_TRAVEL: Final = 5e-3
"""The same of a ring that a spring presses: a soft spring lets it go farther."""
CONTACT: Final = 1e9
"""Stiffness of a usual contact (N/m), the unit of the damping."""
STIFFEST: Final = 1e4
"""Largest damping: no step leads farther than a nanometre a kilonewton then."""
TOUCH: Final = 1e-6
"""Load of a roller at the inner ring, over the heaviest of all, from which on it follows this ring in vibrations."""
HELD: Final = 1e-6
"""Stiffness of a motion, over the largest, below which nothing holds it."""


@dataclass(frozen=True)
class BearingOnShaft:
    """A bearing of an assembly in equilibrium. Forces and directions are in the frame of the shaft.

    Attributes
    ----------
    name : str
        Name of the bearing.
    axial_load : float
        Axial force of the shaft on it, towards the small ends of its rollers (N). Where it has lifted off, that is what the
        centrifugal forces of its rollers press.
    radial_load : float
        Radial force of the shaft on it (N).
    force : ndarray, shape (3,)
        The same as a vector (N).
    moment : ndarray, shape (2,)
        Moment of the shaft on it about x and y, through its roller-centre plane (N m).
    displacement : ndarray, shape (5,)
        Place of the inner ring against the outer ring in the bearing's own frame, as `Scene.displacement` and misalignments
        (m, rad).
    angles : ndarray, shape (Z,)
        Where its rollers stand, from +x towards +y (rad).
    outer_load, inner_load, rib_load : ndarray, shape (Z,)
        Normal loads of the rollers (N).
    stiffness : ndarray, shape (5, 5)
        Of the bearing in its own frame, as `Stiffness.matrix`.
    scene : Scene
        The bearing alone with its inner ring held at this place: for pictures, a sheet of ratings or a run.
    """

    name: str
    axial_load: float
    radial_load: float
    force: Array
    moment: Array
    displacement: Array
    angles: Array
    outer_load: Array
    inner_load: Array
    rib_load: Array
    stiffness: Array
    scene: Scene

    @property
    def lifted(self) -> bool:
        """Whether no roller touches the inner raceway."""
        return not bool(np.any(self.inner_load > 0.0))


@dataclass(frozen=True, eq=False, repr=False)
class ShaftEquilibrium(Tabled):
    """A shaft in static equilibrium on its bearings at speed, without friction.

    Attributes
    ----------
    assembly : Assembly
        The assembly.
    time : float
        Time of the loads (s).
    bearings : tuple of BearingOnShaft
        In the order of the assembly.
    axial_force : float
        Axial force on the shaft besides `Assembly.loads` that was needed, where its axial place was prescribed (N); else 0.
    residual : float
        Largest force left unbalanced (N).
    iterations : int
        Steps of Newton's method.
    """

    assembly: Assembly
    time: float
    bearings: tuple[BearingOnShaft, ...]
    axial_force: float
    residual: float
    iterations: int
    _balance: Balance
    _reference: float
    _system: ShaftOnBearings

    def __getitem__(self, name: str) -> BearingOnShaft:
        """A bearing by its name."""
        if name not in self.assembly.names:
            raise InputError.of("name", name, f"must be one of {', '.join(self.assembly.names)}")
        return self.bearings[self.assembly.names.index(name)]

    @property
    def tilt(self) -> Array:
        """Rotation of the shaft about x and y, shape (2,) (rad)."""
        return self._balance.place[3:5]

    def displacement(self, position: float = 0.0) -> Array:
        """Where a point of the axis went along x, y and z, shape (3,) (m).

        Parameters
        ----------
        position : float
            Position of the point along the shaft (m).
        """
        return self._at(position).place[:3]

    @property
    def outer_ring_places(self) -> tuple[float, ...]:
        """Axial place of each bearing's outer ring (m), as `ShaftBearing.end_play`; of one with a spring as it stands here."""
        places = [one.end_play for one in self.assembly.bearings]
        for number, index in enumerate(self._system.sprung):
            places[index] = -float(self._balance.place[5 + number])
        return tuple(places)

    def stiffness(self, position: float = 0.0) -> Array:
        """Stiffness of the shaft at a point of its axis: slopes of force (N) and moment about x and y (N m) on the shaft there
        with displacement along x, y, z (m) and rotation about x and y (rad).

        Rollers and outer rings with a spring stay in equilibrium; the loads keep their direction.

        Parameters
        ----------
        position : float
            Position of the point along the shaft (m).

        Returns
        -------
        ndarray, shape (5, 5)
        """
        return self._at(position).stiffness

    def modes(self, *, gyroscopic: bool = True) -> Modes:
        """Natural vibrations of the rigid shaft on its bearings, without damping and friction. Shapes are those of its centre of
        mass.

        Rollers add their mass as they follow the shaft. An outer ring with a spring counts without its mass.

        Parameters
        ----------
        gyroscopic : bool
            Count the gyroscopic moments of the shaft's rotation.
        """
        shaft = self.assembly.shaft
        body = RingBody(mass=shaft.mass, inertia_axial=shaft.inertia_axial, inertia_transverse=shaft.inertia_transverse)
        return self.at_mass.modes(body, gyroscopic=gyroscopic)

    @property
    def at_mass(self) -> Stiffness:
        """Stiffness at the shaft's centre of mass, with the mass that the rollers add as they follow the shaft."""
        shaft = self.assembly.shaft
        balance = self._at(shaft.mass_position)
        _, turning = axis_of(balance.place[3:5])
        follows = np.vstack([np.eye(5), balance.sprung_follow])
        mass = np.zeros((5, 5))
        for index, (one, answer) in enumerate(zip(self.assembly.bearings, balance.answers, strict=True)):
            spring = self._system.sprung.index(index) if index in self._system.sprung else -1
            arm = one.centre_plane - shaft.mass_position
            geometry = one.bearing.geometry
            inertia = np.array([geometry.roller_mass] * 2 + [geometry.roller_inertia_transverse] * 2)
            moves = answer.follow @ ring_slopes(one, arm, turning, balance.place.size, spring) @ follows
            touch = answer.loads[:, 1:].max(axis=1)
            moves[touch <= TOUCH * answer.loads.max()] = 0.0
            mass += np.einsum("jia,i,jib->ab", moves, inertia, moves)
        load = np.zeros(5)
        for position, offset, force, moment in self._system.loads:
            lever = offset + (position - shaft.mass_position) * axis_of(balance.place[3:5])[0]
            load += np.concatenate([force, (np.cross(lever, force) + moment)[:2]])
        return Stiffness(
            matrix=balance.stiffness,
            displacement=balance.place[:5],
            load=load,
            roller_mass=mass,
            pitch_diameter=max(one.bearing.pitch_diameter for one in self.assembly.bearings),
            speed_rpm=value_at(self.assembly.speed_rpm, self.time),
            subject=self.assembly,
            time=self.time,
            body="shaft",
            point=f"the shaft's centre of mass, at {1e3 * shaft.mass_position:.4g} mm along the shaft",
        )

    def _at(self, position: float) -> Balance:
        """The balance with another reference point."""
        arm = number_of("position", position) - self._reference
        place = self._balance.place.copy()
        axis, _ = axis_of(place[3:5])
        place[:3] += arm * (axis - ALONG)
        return self._system.at(place, position, self._balance.answers)

    def _shown(self) -> Shown:
        rows = []
        total = sum(one.axial_load for one in self.bearings)
        for one in self.bearings:
            share = 100.0 * one.axial_load / total if total > 0.0 else 0.0
            heaviest = f"{one.outer_load.max():.4g}" if not one.lifted else "lifted off"
            loaded = f"{np.count_nonzero(one.inner_load > 0.0)} of {one.angles.size}"
            rows.append((one.name, f"{one.axial_load:.5g}", f"{share:.3g}", f"{one.radial_load:.5g}", heaviest, loaded))
        x, y, z = 1e6 * self.displacement()
        tilt = 1e3 * self.tilt
        return Shown(
            f"Equilibrium of {self.assembly}",
            (("bearing", "axial load N", "share %", "radial load N", "heaviest roller N", "rollers loaded"), *rows),
            head=("name", "axial", "share", "radial", "heaviest", "loaded"),
            notes=(
                f"The shaft's origin went by ({x:.4g}, {y:.4g}, {z:.4g}) um, its axis turned by ({tilt[0]:.4g}, {tilt[1]:.4g}) "
                "mrad about x and y.",
            ),
        )


def equilibrium(assembly: Assembly, *, time: float = 0.0, axial_displacement: float | None = None) -> ShaftEquilibrium:
    """Static equilibrium at speed of a rigid shaft on its bearings.

    Parameters
    ----------
    assembly : Assembly
        The assembly.
    time : float
        Time of speed, loads and gravity (s).
    axial_displacement : float, optional
        Hold the shaft at this axial place (m), whatever force it takes (`ShaftEquilibrium.axial_force`).

    Returns
    -------
    ShaftEquilibrium
        Place of the shaft, loads of all bearings and rollers, stiffness, natural vibrations.

    Raises
    ------
    InputError
        If a number is not allowed.
    LoadError
        If the bearings cannot carry the loads, or nothing holds a motion of the shaft.

    Notes
    -----
    docs/theory/motion.md#a-shaft-on-several-bearings.

    Examples
    --------
    >>> import trbdyn as trb
    >>> shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    >>> pair = trb.Assembly.pair(trb.cases.rig_30310(), "back to back", spread=0.15, end_play=-40e-6, shaft=shaft, speed_rpm=3000)
    >>> found = trb.equilibrium(pair)
    >>> round(found["left"].axial_load / 1e3, 2)
    3.33
    """
    expect("assembly", assembly, Assembly)
    if axial_displacement is not None and not abs(number_of("axial_displacement", axial_displacement)) < FARTHEST:
        raise InputError.of("axial_displacement", axial_displacement, f"must be from {-FARTHEST:g} to {FARTHEST:g} (m)")
    system = ShaftOnBearings(assembly, number_of("time", time))
    reference = float(np.mean([one.centre_plane for one in assembly.bearings]))
    return _Search(system, reference, axial_displacement).run(time)


@stiffness.register(Assembly)
def _stiffness(assembly: Assembly, *, time: float | None = None) -> Stiffness:
    return equilibrium(assembly, time=assembly.bearings[0].start.time if time is None else time).at_mass


class _Search:
    """Newton's method, damped until the potential falls (Levenberg-Marquardt), as in the core's equilibrium of one ring."""

    def __init__(self, system: ShaftOnBearings, reference: float, axial_displacement: float | None) -> None:
        self.system, self.reference = system, reference
        size = 5 + len(system.sprung)
        self.place = np.zeros(size)
        self.place[5:] = 1e-5  # outer rings with a spring begin pressed
        self.free = np.ones(size, dtype=bool)
        assembly = system.assembly
        self.place[2] = self._seated()
        if axial_displacement is not None:
            self.free[2], self.place[2] = False, axial_displacement
        planes = [one.centre_plane for one in assembly.bearings]
        self.arm = max(
            0.5 * (max(planes) - min(planes)), 0.5 * max(one.bearing.pitch_diameter for one in assembly.bearings)
        )
        self.lengths = np.array([1.0, 1.0, 1.0, self.arm, self.arm, *[1.0] * (size - 5)])
        self.farthest = np.array([FARTHEST] * 5 + [SPRING_TRAVEL] * (size - 5))

    def _seated(self) -> float:
        """An axial place at which the bearings that hold the shaft's axial load just touch their rollers; 0 with preload (m)."""
        bearings = self.system.assembly.bearings
        plays = [one.end_play if one.spring is None else -1e-5 for one in bearings]
        if sum(plays) <= 0.0:
            return 0.0
        axial = sum(float(force[2]) for _, _, force, _ in self.system.loads)
        side = math.copysign(1.0, axial) if axial else bearings[0].side
        holding = [play for one, play in zip(bearings, plays, strict=True) if one.side == side]
        return side * (min(holding) + 1e-6) if holding else 0.0

    def _off(self, balance: Balance) -> float:
        return float(np.max(np.abs(balance.missing / self.lengths)[self.free]))

    def _largest(self, balance: Balance) -> float:
        forces = [np.abs(force).max() for _, _, force, _ in self.system.loads]
        return float(max(*forces, *(np.abs(answer.reaction[:3]).max() for answer in balance.answers)))

    def run(self, time: float) -> ShaftEquilibrium:
        try:
            balance = self.system.at(self.place, self.reference)
        except _core.CoreLoadError as error:
            raise LoadError(
                f"no equilibrium of the rollers where the search for the shaft's place begins; {error}"
            ) from None
        damping, off = FIRST_DAMPING, self._off(balance)
        for step in range(STEPS):
            if off <= max(BALANCED_FORCE, BALANCED * self._largest(balance)):
                return self._found(balance, off, step, time)
            better = None
            while better is None and damping < STIFFEST:
                better = self._stepped(balance, off, damping)
                damping = 10.0 * max(damping, 1e-10) if better is None else damping
            if better is None:
                break
            balance, off = better, self._off(better)
            damping = 0.0 if damping < 1e-9 else 0.03 * damping
            if np.any(np.abs(balance.place * self.lengths) > self.farthest):
                break
        raise LoadError(self._why_not(balance, off))

    def _stepped(self, balance: Balance, off: float, damping: float) -> Balance | None:
        """The balance after a step, if it lies lower or is closer to equilibrium."""
        kept = np.flatnonzero(self.free)
        matrix = balance.slopes + damping * CONTACT * np.diag(self.lengths**2)
        step = np.zeros(balance.place.size)
        try:
            step[kept] = np.linalg.solve(matrix[np.ix_(kept, kept)], balance.missing[kept])
        except np.linalg.LinAlgError:
            return None
        longest = np.max(np.abs(step * self.lengths))
        if not longest < math.inf:
            return None
        try:
            share = min(1.0, LONGEST_STEP / max(longest, 1e-30))
            other = self.system.at(balance.place + share * step, self.reference, near=balance.answers)
        except _core.CoreLoadError:
            return None
        lower = other.energy < balance.energy - 1e-13 * abs(balance.energy)
        return other if lower or self._off(other) < off else None

    def _found(self, balance: Balance, off: float, steps: int, time: float) -> ShaftEquilibrium:
        kept = self.free[:5]
        stiffness = (balance.stiffness / np.outer(self.lengths[:5], self.lengths[:5]))[np.ix_(kept, kept)]
        values, vectors = np.linalg.eigh(0.5 * (stiffness + stiffness.T))
        if values[0] < HELD * values[-1]:
            name = np.array(["along x", "along y", "along its axis", "against tilt about x", "against tilt about y"])[
                kept
            ]
            raise LoadError(
                f"nothing holds the shaft {name[np.argmax(np.abs(vectors[:, 0]))]}: give a preload (end_play < 0, a spring), or "
                "a load that presses it onto its bearings"
            )
        assembly = self.system.assembly
        bearings = tuple(self._bearing(index, answer, time) for index, answer in enumerate(balance.answers))
        return ShaftEquilibrium(
            assembly=assembly,
            time=time,
            bearings=bearings,
            axial_force=0.0 if self.free[2] else -float(balance.missing[2]),
            residual=off,
            iterations=steps,
            _balance=balance,
            _reference=self.reference,
            _system=self.system,
        )

    def _bearing(self, index: int, answer: Answer, time: float) -> BearingOnShaft:
        assembly = self.system.assembly
        one = assembly.bearings[index]
        turn3, turn2 = turns_of(one)
        force = turn3 * answer.reaction[:3]
        even = 2.0 * math.pi * np.arange(one.bearing.n_rollers) / one.bearing.n_rollers
        return BearingOnShaft(
            name=assembly.names[index],
            axial_load=float(one.side * force[2]),
            radial_load=float(np.hypot(*force[:2])),
            force=force,
            moment=turn2 * answer.reaction[3:],
            displacement=answer.displacement,
            angles=np.mod(-one.side * even, 2.0 * math.pi),
            outer_load=answer.loads[:, 0],
            inner_load=answer.loads[:, 1],
            rib_load=answer.loads[:, 2],
            stiffness=answer.stiffness,
            scene=assembly.scene(index, time=time, displacement=answer.displacement.tolist()),
        )

    def _why_not(self, balance: Balance, off: float) -> str:
        x, y, z = balance.place[:3]
        carried = ", ".join(
            f"{name} {np.hypot(*answer.reaction[:2]):.4g} N radially and {-answer.reaction[2]:.4g} N axially"
            for name, answer in zip(self.system.assembly.names, balance.answers, strict=True)
        )
        return (
            f"no equilibrium: the bearings cannot carry these loads, or nothing holds the shaft; with the shaft at ({x:.3g}, "
            f"{y:.3g}, {z:.3g}) m {off:.4g} N are left unbalanced, and the bearings carry {carried}"
        )
