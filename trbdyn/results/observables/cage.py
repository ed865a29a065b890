"""The cage's motion: locus, orbit and whirl frequency, tilt, speed, and what kind of motion it is.

The orbit radius is the distance of the cage's centre from the centre of its own orbit (its mean place); it tells how far the
cage whirls. The distance from the bearing axis is another number: a cage that hangs still on its rollers has an orbit radius of
zero, and lies far from the axis. They agree for a cage that whirls around the axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trbdyn.results.observables.signals import peak_frequency, spectrum

Array = NDArray[np.float64]
About = Literal["mean", "axis"]


def _planar(position: ArrayLike) -> Array:
    p = np.asarray(position, dtype=float)
    if p.ndim != 2 or p.shape[1] < 2:
        raise ValueError(f"positions must have shape (T, 2) or (T, 3), not {p.shape}")
    return p[:, :2]


def _centred(position: ArrayLike, about: About) -> Array:
    p = _planar(position)
    if about == "mean":
        return p - p.mean(axis=0)
    if about == "axis":
        return p
    raise ValueError(f"about must be 'mean' or 'axis', not {about!r}")


def locus(position: ArrayLike, radial_play: float) -> Array:
    """Locus of the cage's centre in units of the radial play.

    Parameters
    ----------
    position : array_like, shape (T, 2) or (T, 3)
        Cage centre in any plane, from its centred place, m.
    radial_play : float
        Radial play Cpr of the cage, m.

    Returns
    -------
    ndarray, shape (T, 2)
        x/Cpr and y/Cpr.
    """
    return _planar(position) / radial_play


def axis_distance(position: ArrayLike) -> Array:
    """Distance of the cage's centre from the bearing axis.

    Parameters
    ----------
    position : array_like, shape (T, 2) or (T, 3)
        Cage centre, from its centred place, m.

    Returns
    -------
    ndarray, shape (T,)
        Distance, m.
    """
    p = _planar(position)
    return np.hypot(p[:, 0], p[:, 1])


def orbit_radius(position: ArrayLike) -> Array:
    """Distance of the cage's centre from the centre of its own orbit, its mean place.

    Parameters
    ----------
    position : array_like, shape (T, 2) or (T, 3)
        Cage centre, m, over at least one whole turn of the cage.

    Returns
    -------
    ndarray, shape (T,)
        Distance, m.
    """
    p = _centred(position, "mean")
    return np.hypot(p[:, 0], p[:, 1])


def whirl_angle(position: ArrayLike, about: About = "mean") -> Array:
    """Angle of the cage's centre, unwrapped.

    Parameters
    ----------
    position : array_like, shape (T, 2) or (T, 3)
        Cage centre, m. Samples must be close enough that it turns less than half a revolution between two of them.
    about : {"mean", "axis"}
        Centre of the angle: the mean place, or the bearing axis.

    Returns
    -------
    ndarray, shape (T,)
        Angle from x towards y, rad.
    """
    p = _centred(position, about)
    return np.unwrap(np.arctan2(p[:, 1], p[:, 0]))


def _slope(time: ArrayLike, values: ArrayLike) -> float:
    """Slope of the least-squares line."""
    t = np.asarray(time, dtype=float)
    x = np.asarray(values, dtype=float)
    if t.size < 2 or t.shape != x.shape:
        raise ValueError(f"needs at least two times and as many values, not shapes {t.shape} and {x.shape}")
    t = t - t.mean()
    return float(t @ (x - x.mean()) / (t @ t))


def whirl_frequency(time: ArrayLike, position: ArrayLike, about: About = "mean") -> float:
    """Whirl frequency from the unwrapped angle: the slope of its least-squares line.

    Parameters
    ----------
    time : array_like, shape (T,)
        Times, s.
    position : array_like, shape (T, 2) or (T, 3)
        Cage centre, m.
    about : {"mean", "axis"}
        Centre of the angle. About the mean place, the window should hold at least one whole orbit.

    Returns
    -------
    float
        Frequency, Hz; positive in the direction of positive rotation about z, negative for backward whirl.
    """
    return _slope(time, whirl_angle(position, about)) / (2.0 * np.pi)


def whirl_frequency_spectral(time: ArrayLike, position: ArrayLike) -> float:
    """Whirl frequency from the peak of the two-sided spectrum of x + i y.

    Parameters
    ----------
    time : array_like, shape (T,)
        Times, s.
    position : array_like, shape (T, 2) or (T, 3)
        Cage centre, m.

    Returns
    -------
    float
        Frequency, Hz; signed as in `whirl_frequency`. nan for a cage at rest.
    """
    p = _planar(position)
    return peak_frequency(*spectrum(time, p[:, 0] + 1j * p[:, 1]))


def cage_frequency(time: ArrayLike, cage_angle: ArrayLike) -> float:
    """Rotation frequency of the cage, Hz: slope of its angle (rad, shape (T,)) over time (s, shape (T,)) by least squares."""
    return _slope(time, cage_angle) / (2.0 * np.pi)


def cage_speed_ratio(cage_angle: ArrayLike, shaft_angle: ArrayLike) -> float:
    """Turn of the cage over the turn of the shaft.

    Parameters
    ----------
    cage_angle, shaft_angle : array_like, shape (T,)
        Unwrapped angles, rad.

    Returns
    -------
    float
        Ratio over the whole record; nan if the shaft has not turned.
    """
    cage = np.asarray(cage_angle, dtype=float)
    shaft = np.asarray(shaft_angle, dtype=float)
    turn = shaft[-1] - shaft[0]
    return float((cage[-1] - cage[0]) / turn) if turn else float("nan")


def lean(position: ArrayLike, tilt: ArrayLike) -> Array:
    """Tilt of the cage's axis in the direction of the cage's displacement.

    The axis points along (theta_y, -theta_x, 1) for small tilts. Positive lean means that the axis leans, with growing z,
    to the side to which the cage's centre is displaced; so theta_x < 0 with the centre at +y is positive.

    Parameters
    ----------
    position : array_like, shape (T, 2) or (T, 3)
        Cage centre from the bearing axis, m.
    tilt : array_like, shape (T, 2)
        theta_x, theta_y, rad.

    Returns
    -------
    ndarray, shape (T,)
        Lean, rad; zero where the cage is centred.
    """
    p = _planar(position)
    theta = np.asarray(tilt, dtype=float)
    radius = np.hypot(p[:, 0], p[:, 1])
    projection = theta[:, 1] * p[:, 0] - theta[:, 0] * p[:, 1]
    return np.divide(projection, radius, out=np.zeros_like(radius), where=radius > 0)


def speed_deviation_ratio(velocity: ArrayLike) -> float:
    """Standard deviation over mean of the speed of the cage's centre in the x-y plane.

    Zero for a steady circle, sqrt(4/pi - 1) = 0.523 for a random planar velocity.

    Parameters
    ----------
    velocity : array_like, shape (T, 2) or (T, 3)
        Velocity of the cage's centre, m/s.

    Returns
    -------
    float
        Ratio; nan for a cage at rest.

    References
    ----------
    Ghaisas, N., Wassgren, C. R., Sadeghi, F., Cage instabilities in cylindrical roller bearings, ASME J. Tribology 126 (2004)
    681-689.
    """
    v = _planar(velocity)
    speed = np.hypot(v[:, 0], v[:, 1])
    mean = float(speed.mean())
    return float(speed.std() / mean) if mean > 0 else float("nan")


def whirl_coherence(position: ArrayLike, velocity: ArrayLike) -> float:
    """How far the motion is a turn in one sense: mean of r x v over the product of the root mean squares of r and v.

    r is the place of the cage's centre from its mean place, v its velocity less its mean, both in the x-y plane. One for a
    steady circle, minus one for a steady backward circle, 2 a b/(a^2 + b^2) for a harmonic ellipse of semi-axes a and b, zero
    for motion along a line and for random motion.

    Parameters
    ----------
    position, velocity : array_like, shape (T, 2) or (T, 3)
        Cage centre (m) and its velocity (m/s), over at least one whole turn of the cage.

    Returns
    -------
    float
        Coherence, from -1 to 1; nan for a cage at rest.
    """
    r, v = _centred(position, "mean"), _centred(velocity, "mean")
    size = float(np.sqrt(np.sum(r**2) * np.sum(v**2)))
    return float(np.sum(r[:, 0] * v[:, 1] - r[:, 1] * v[:, 0]) / size) if size > 0 else float("nan")


Kind = Literal["unknown", "stable", "rocking", "circling", "unstable"]

REST_ORBIT: Final = 0.1
"""Largest orbit (rms) of a stable cage, in units of the play."""
OWN_SIDE: Final = 0.25
"""Least share of its mean distance from the axis that a rocking cage keeps on its own side of the axis."""
LEAST_COHERENCE: Final = 0.5
"""Least coherence about the axis of a circling cage. A circle about a place beside the axis has more than this where it no longer
keeps `OWN_SIDE`: where its radius is above 0.75 of the distance of its centre.
"""
LEAST_TURNS: Final = 2.0
"""Turns of the cage below which its motion has no class."""
SELDOM: Final = 0.01
"""Share of the time that is left out of the least distance on its own side."""


@dataclass(frozen=True, slots=True)
class CageMotion:
    """What kind of motion the cage makes.

    Attributes
    ----------
    kind : {"unknown", "stable", "rocking", "circling", "unstable"}
        Class of the motion; unknown: the record is too short.
    orbit_over_play : float
        Root mean square distance from the mean place over the radial play.
    whirl_coherence : float
        How far the motion is a turn in one sense about its mean place, see `whirl_coherence`.
    speed_deviation_ratio : float
        Standard deviation over mean of the cage centre's speed, the indicator of Ghaisas et al.; for comparison.
    own_side : float
        Distance from the axis, in the direction of the mean place, that is kept for 99 % of the time, over that of the mean
        place; 1: it stays there, below 0: it comes to the other side. nan for a mean place on the axis.
    axis_coherence : float
        How far the motion is a turn in one sense about the bearing axis.
    """

    kind: Kind
    orbit_over_play: float
    whirl_coherence: float
    speed_deviation_ratio: float
    own_side: float
    axis_coherence: float

    def kind_at(self, orbit_over_play: float) -> Kind:
        """Class that the motion would have with another orbit of the same shape about the same mean place: near to a bound a
        small change of the orbit is another class. By the bounds of `classify` as they are by default.

        Parameters
        ----------
        orbit_over_play : float
            Orbit over the radial play.

        Returns
        -------
        {"unknown", "stable", "rocking", "circling", "unstable"}
        """
        if self.kind == "unknown" or self.orbit_over_play == 0.0:
            return self.kind
        # places along the mean place are 1 - (1 - side) f of it with f times the orbit, and moments about the axis go with f^2
        f = orbit_over_play / self.orbit_over_play
        whirl = self.whirl_coherence**2
        moment = self.axis_coherence**2
        # square of the distance of the mean place over the orbit
        ratio = whirl / moment - 1.0 if moment > 0.0 else math.inf
        axis = math.sqrt(whirl / (1.0 + max(ratio, 0.0) / f**2)) if f > 0.0 else 0.0
        return _kind(orbit_over_play, 1.0 - f * (1.0 - self.own_side), axis)


def _kind(
    orbit: float, side: float, coherence: float, rest: float = REST_ORBIT, least: float = LEAST_COHERENCE
) -> Kind:
    """Class by orbit over the play, own side and coherence about the axis, with the bounds of orbit and coherence."""
    if orbit < rest:
        return "stable"
    if side >= OWN_SIDE:
        return "rocking"
    return "circling" if abs(coherence) >= least else "unstable"


def classify(
    position: ArrayLike,
    velocity: ArrayLike,
    radial_play: float,
    rest_orbit: float = REST_ORBIT,
    least_coherence: float = LEAST_COHERENCE,
    cage_angle: ArrayLike | None = None,
) -> CageMotion:
    """Classify the cage's motion by where the centre of its orbit lies, how large the orbit is, and whether it encloses the axis.

    Stable: the centre stays near one place (root mean square distance from it below `rest_orbit` times the play). Rocking: it
    hangs beside the axis, and moves to and fro or in loops about that place without coming near to the other side of the axis
    (`own_side` at least 0.25). Circling: it goes round the bearing axis in one sense (coherence about the axis at least
    `least_coherence`, either way). Unstable: none of these. The deviation of the speed alone would not do: an orbit that repeats
    itself but is not round has a large one; nor would the coherence about the mean place, as a cage that rocks in small loops
    has any.

    Parameters
    ----------
    position : array_like, shape (T, 2) or (T, 3)
        Cage centre, m, over at least one whole turn of the cage.
    velocity : array_like, shape (T, 2) or (T, 3)
        Its velocity, m/s.
    radial_play : float
        Radial play Cpr, m.
    rest_orbit : float
        Largest orbit of a stable cage, in units of the play.
    least_coherence : float
        Least coherence about the axis of a circling cage.
    cage_angle : array_like, shape (T,), optional
        Turn of the cage, rad: with fewer than two turns the motion has no class.

    Returns
    -------
    CageMotion
        The class and the numbers behind it.
    """
    p = _planar(position)
    orbit = float(np.sqrt(np.mean(orbit_radius(position) ** 2)) / radial_play)
    coherence, ratio = whirl_coherence(position, velocity), speed_deviation_ratio(velocity)
    mean = p.mean(axis=0)
    square = float(mean @ mean)
    side = float(np.quantile(p @ mean, SELDOM)) / square if square > 0.0 else float("nan")
    # the same angular momentum as about the mean place, over a radius that counts the way to the axis, too
    size = float(np.sqrt(np.mean(np.sum(p**2, axis=1)))) / radial_play
    about_axis = coherence * orbit / size if size > 0.0 else float("nan")

    def kind() -> Kind:
        if cage_angle is not None:
            angle = np.asarray(cage_angle, dtype=float)
            if abs(float(angle[-1] - angle[0])) < 2.0 * np.pi * LEAST_TURNS:
                return "unknown"
        return _kind(orbit, side, about_axis, rest_orbit, least_coherence)

    return CageMotion(kind(), orbit, coherence, ratio, side, about_axis)
