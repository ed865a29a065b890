"""Stiffness of a bearing about its equilibrium at speed, and natural frequencies of a body on it
(docs/theory/motion.md#stiffness).
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from functools import cached_property, singledispatch
from typing import Any, Final

import numpy as np
import scipy
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.base.display import plain
from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown, Tabled
from trbdyn.errors import InputError, LoadError, RunWarning
from trbdyn.model.assembly import Assembly
from trbdyn.model.flatten import ring_load
from trbdyn.model.motion import value_at
from trbdyn.model.ring_body import RingBody
from trbdyn.model.roller import Profile
from trbdyn.model.scene import Scene
from trbdyn.statics.core_model import normal_contacts
from trbdyn.statics.equilibrium import EquilibriumSolver, nominal_angles

Array = NDArray[np.float64]

COORDINATES: Final = ("x", "y", "z", "rotation_x", "rotation_y")
"""Coordinates of the ring: translations, and rotations about x and y, through the roller-centre plane on the axis."""


UNSTABLE: Final = 1e-6
"""Negative eigenvalue of a stiffness, over the largest one, from which on it is said; smaller ones are rounding."""


@dataclass(frozen=True)
class Modes:
    """Natural vibrations of a body on a bearing.

    Attributes
    ----------
    frequencies : ndarray, shape (5,)
        Natural frequencies (Hz), ascending; fewer than five where nothing but friction holds the body along its axis.
    shapes : ndarray, shape (5, 5)
        Shape of each vibration, complex: displacement along x, y, z (m) and rotation about x, y (rad), one row each; the largest
        entry is 1, with rotations counted at half the pitch diameter.
    """

    frequencies: Array
    shapes: NDArray[np.complex128]


@dataclass(frozen=True, eq=False, repr=False)
class Stiffness(Tabled):
    """Stiffness of the inner ring, or of a shaft, about an equilibrium, with outer rings at rest and rollers in equilibrium at
    speed.

    Attributes
    ----------
    matrix : ndarray, shape (5, 5)
        Slopes of force (N) and moment (N m), along and about x and y, that hold the ring, with its displacement x, y, z (m) and
        rotation about x, y (rad).
    displacement : ndarray, shape (5,)
        The equilibrium (m, rad).
    load : ndarray, shape (5,)
        Load on the ring there (N, N m).
    roller_mass : ndarray, shape (5, 5)
        What the rollers add to the mass of the ring as they follow it (kg, kg m, kg m2).
    pitch_diameter : float
        Of the bearing, of several the largest (m).
    speed_rpm : float
        Speed of the shaft (rpm).
    subject : Scene, Assembly or None
        Whose stiffness it is, at the time `time` (s).
    body, point : str
        What moves, and the point of its axis at which displacements, forces and moments are taken, in words: of one bearing the
        inner ring and the roller-centre plane, of an assembly the shaft and its centre of mass.
    """

    _headed = True

    matrix: Array
    displacement: Array
    load: Array
    roller_mass: Array
    pitch_diameter: float
    speed_rpm: float
    subject: Scene | Assembly | None = None
    time: float = 0.0
    body: str = "inner ring"
    point: str = "the roller-centre plane"

    @cached_property
    def with_straight_rollers(self) -> float | None:
        """Axial stiffness with straight rollers over this one (1): what a profile that is not known leaves open. Makers' formula
        for the axial displacement of tapered bearings is that of straight rollers. None where rollers are straight, bearings are
        cylindrical, or straight rollers have no equilibrium.
        """
        if self.subject is None:
            return None
        parts = {prefix: part.bearing for prefix, part in self.subject.parts.items()}
        profiled = {prefix for prefix, one in parts.items() if one.roller.profile.kind != "straight"}
        if not profiled or any(one.is_cylindrical for one in parts.values()) or not self.matrix[2, 2] > 0.0:
            return None
        straight = {f"{prefix}bearing.roller.profile": Profile.straight() for prefix in profiled}
        try:
            other = stiffness(self.subject.replace(straight), time=self.time)
        except LoadError:
            return None
        return float(other.matrix[2, 2] / self.matrix[2, 2])

    def _profile(self) -> tuple[str, ...]:
        """What the profile of the rollers does to the stiffness along the axis."""
        times = self.with_straight_rollers
        if times is None or self.subject is None:
            return ()
        assumed = any("roller.profile" in path for part in self.subject.parts.values() for path in part.bearing.assumed)
        given = "a profile that nobody gave" if assumed else "the given profile"
        return (
            f"Rollers have {given}. With straight ones, for which makers' formula of the axial displacement holds "
            f"(7.7e-5 Q^0.9/(l^0.8 sin alpha), N and mm), the stiffness along the axis is {times:.3g} times this one.",
        )

    def _shown(self) -> Shown:
        names = ("force_x", "force_y", "force_z", "moment_x", "moment_y")
        shown = self.matrix * [1e-6, 1e-6, 1e-6, 1e-3, 1e-3]
        rows = tuple((name, *(plain(value, 5) for value in row)) for name, row in zip(names, shown, strict=True))
        heads = tuple(f"{name} ({'per µm' if k < 3 else 'per mrad'})" for k, name in enumerate(COORDINATES))
        return Shown(
            f"Stiffness of the {self.body} at {self.speed_rpm:g} rpm",
            rows,
            head=("force (N), moment (N m)", *heads),
            notes=(
                f"Forces in N, moments in N m, about {self.point}; rollers stay in equilibrium, without friction.",
                *self._profile(),
            ),
        )

    @property
    def springs(self) -> dict[str, float]:
        """The same as springs at one point of the axis, without coupling between them: `radial` and `axial` (N/m), `tilt`
        (N m/rad), and the axial `position` of the point from that of `matrix` (m), of a bearing positive towards the large ends.
        Exact under an axial load alone; else the means of both directions.

        A second bearing that faces the first, with its roller-centre plane at the distance L towards the large ends, is the
        support ``support_radial=radial, support_axial=axial, support_tilt=tilt, support_position=L - position`` of a `RingBody`.
        """
        k = self.matrix
        radial, coupling = 0.5 * (k[0, 0] + k[1, 1]), 0.5 * (k[0, 4] - k[1, 3])
        tilt = 0.5 * (k[3, 3] + k[4, 4]) - coupling**2 / radial
        return {"radial": radial, "axial": k[2, 2], "tilt": tilt, "position": coupling / radial}

    def modes(self, body: RingBody, *, gyroscopic: bool = True) -> Modes:
        """Natural vibrations of a body that is fixed to the inner ring, without damping and friction.

        Parameters
        ----------
        body : RingBody
            The body with its support; its dampers are left out.
        gyroscopic : bool
            Count the gyroscopic moments of the body's rotation.

        Returns
        -------
        Modes
            The five vibrations.

        Raises
        ------
        InputError
            If the body is no `RingBody`.

        Notes
        -----
        M q'' + G q' + K q = 0 with K from `matrix` and the support, M from the body and `roller_mass`, G from the body's axial
        inertia and speed (Genta, Dynamics of Rotating Systems). Friction on the raceways damps these vibrations strongly, above
        all axial ones.

        Examples
        --------
        >>> import trbdyn as trb
        >>> scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=3000, axial_load=4930.0)
        >>> body = trb.RingBody.hollow_cylinder(mass=20.0, outer_diameter=0.05, length=0.4)
        >>> trb.stiffness(scene).modes(body).frequencies.round(-1)[-1] > 100.0
        True
        """
        if not isinstance(body, RingBody):
            raise InputError.of("body", body, "must be a RingBody")
        arm = np.eye(5)  # from the reference point to the centre of mass
        arm[0, 4], arm[1, 3] = body.mass_offset, -body.mass_offset
        held, radial, tilt = np.eye(5), body.support_radial, body.support_tilt
        held[0, 4], held[1, 3] = body.support_position, -body.support_position
        whole_stiffness = self.matrix + held.T @ np.diag([radial, radial, body.support_axial, tilt, tilt]) @ held
        inertia = np.array([body.mass] * 3 + [body.inertia_transverse] * 2)
        mass = arm.T @ np.diag(inertia) @ arm + self.roller_mass
        spin = body.inertia_axial * self.speed_rpm * np.pi / 30.0 if gyroscopic else 0.0
        return vibrations(whole_stiffness, mass, spin, 0.5 * self.pitch_diameter)


def vibrations(stiffness: Array, mass: Array, spin: float, radius: float) -> Modes:
    """Natural vibrations of a rigid body with five coordinates, without damping.

    The spin is its angular momentum about its axis (kg m2/s); rotations count in shapes at a radius (m).
    """
    gyro = np.zeros((5, 5))
    gyro[3, 4], gyro[4, 3] = spin, -spin
    zero, one = np.zeros((5, 5)), np.eye(5)
    # both of equal size, or the eigenvalues lose their digits
    size = np.sqrt(np.trace(stiffness[:3, :3]) / np.trace(mass[:3, :3]))
    whole = np.block([[zero, size * one], [-stiffness / size, -gyro]])
    values, vectors = scipy.linalg.eig(whole, np.block([[one, zero], [zero, mass]]))
    up = np.flatnonzero(values.imag > 0.0)
    up = up[np.argsort(values[up].imag)][:5]
    shapes = vectors[:5, up].T
    sizes = shapes * np.array([1.0, 1.0, 1.0, radius, radius])
    largest = sizes[np.arange(len(up)), np.argmax(np.abs(sizes), axis=1)]
    return Modes(frequencies=values[up].imag / (2.0 * np.pi), shapes=shapes / largest[:, None])


@singledispatch
def stiffness(subject: Any, *, time: float | None = None) -> Stiffness:
    """Stiffness of the inner ring, or of a shaft on its bearings, about the equilibrium at speed: what rotor-dynamics programs
    read.

    Parameters
    ----------
    subject : Scene or Assembly
        The subject; friction, cage and gravity on the rollers do not take part. Of an assembly the matrix is that at the
        shaft's centre of mass; `trbdyn.equilibrium` has it at other points, and that of each bearing.
    time : float, optional
        Time of the load (s); that of the start by default.

    Returns
    -------
    Stiffness
        The 5 x 5 matrix with the equilibrium it belongs to. It is the tangent at this load: a tapered bearing is stiffer under
        more load.

    Raises
    ------
    LoadError
        If bearings cannot carry the load, or nothing holds a roller.

    Warns
    -----
    RunWarning
        If the matrix has a negative eigenvalue: a free ring would leave this place.

    Notes
    -----
    docs/theory/motion.md#stiffness. All five coordinates of the ring are free in the matrix, prescribed ones as well. Rollers of
    a cylindrical bearing that no rib holds along their axis keep their axial place, as friction lets them.

    Examples
    --------
    >>> import trbdyn as trb
    >>> scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=3000, axial_load=4930.0)
    >>> round(trb.stiffness(scene).matrix[2, 2] * 1e-8, 2)
    2.0
    """
    expect("scene", subject, Scene, Assembly)
    raise AssertionError


@stiffness.register(Scene)
def _of_scene(scene: Scene, *, time: float | None = None) -> Stiffness:
    scene.check_capacity()
    at = scene.start.time if time is None else time
    model, angles = normal_contacts(scene), nominal_angles(scene)
    solver = EquilibriumSolver(model, scene, angles)
    found = solver.solve(at)
    load = ring_load(scene, at)
    force = np.concatenate([load.force, load.moment])
    try:
        fine = model.equilibrium(
            force,
            load.fixed,
            found.displacement,
            load.shaft_speed,
            angles,
            found.rollers.ravel(),
            stiffness=True,
            outer_speed=load.outer_speed,
        )
    except _core.CoreLoadError as error:
        raise LoadError(str(error)) from None
    _check_stable(fine["stiffness"], 0.5 * scene.bearing.pitch_diameter)
    geometry = scene.bearing.geometry
    follow = fine["follow"].reshape(-1, 4, 5)
    inertia = np.array([geometry.roller_mass] * 2 + [geometry.roller_inertia_transverse] * 2)
    return Stiffness(
        matrix=fine["stiffness"],
        displacement=fine["displacement"],
        load=force,
        roller_mass=np.einsum("jia,i,jib->ab", follow, inertia, follow),
        pitch_diameter=scene.bearing.pitch_diameter,
        speed_rpm=value_at(scene.speed_rpm, at),
        subject=scene,
        time=at,
    )


def _check_stable(matrix: Array, radius: float) -> None:
    """Say that a stiffness has a negative eigenvalue, with rotations counted at a radius (m).

    An axial place that no rib holds, as in an NU, has no stiffness of its own and is left out.
    """
    size = np.array([1.0, 1.0, 1.0, radius, radius])
    scaled = matrix / np.outer(size, size)
    kept = [number for number in range(5) if number != 2 or scaled[2, 2] > UNSTABLE * np.abs(scaled).max()]
    values, vectors = np.linalg.eig(scaled[np.ix_(kept, kept)])
    worst = int(np.argmin(values.real))
    if values.real[worst] < -UNSTABLE * np.abs(values).max():
        moved = COORDINATES[kept[int(np.argmax(np.abs(vectors[:, worst])))]]
        warnings.warn(
            f"the stiffness has the negative eigenvalue {values.real[worst]:.3g} N/m, mostly of {moved}: a free ring would leave "
            "this place, and a natural vibration is missing",
            RunWarning,
            stacklevel=3,
        )
