"""The rollers: their spacing, their slip against pure rolling, and their forces on the cage."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def wrap_angle(angle: ArrayLike) -> Array:
    """Angle brought to [-pi, pi), rad."""
    return np.mod(np.asarray(angle, dtype=float) + np.pi, 2.0 * np.pi) - np.pi


def spacing(orbit_angle: ArrayLike, n: int = 1) -> Array:
    """Angle from each roller to the n-th after it, in the direction of growing angles: the sum of n adjacent gaps.

    Parameters
    ----------
    orbit_angle : array_like, shape (T, Z)
        Angle of each roller's centre about the bearing axis, rad. Rollers are numbered in the direction of growing angles, and
        none is half a revolution away from its even place.
    n : int
        Number of gaps to add up, 1 to Z - 1.

    Returns
    -------
    ndarray, shape (T, Z)
        Angle from roller j to roller j + n (counted round), rad; nominally 2 pi n/Z.

    Raises
    ------
    ValueError
        If n is out of range or the shape is not (T, Z).
    """
    angle = np.asarray(orbit_angle, dtype=float)
    if angle.ndim != 2:
        raise ValueError(f"orbit angles must have shape (T, Z), not {angle.shape}")
    z = angle.shape[1]
    if not 1 <= n < z:
        raise ValueError(f"n = {n}: the number of gaps must lie between 1 and {z - 1}")
    nominal = 2.0 * np.pi * n / z
    return nominal + wrap_angle(np.roll(angle, -n, axis=1) - angle - nominal)


def spacing_std(orbit_angle: ArrayLike) -> Array:
    """Standard deviation, over the rollers, of the gaps between neighbours at each time.

    Parameters
    ----------
    orbit_angle : array_like, shape (T, Z)
        As in `spacing`.

    Returns
    -------
    ndarray, shape (T,)
        Standard deviation, **degrees**; zero for evenly spaced rollers.
    """
    return np.degrees(spacing(orbit_angle).std(axis=1))


def kinematic_slip(speed: ArrayLike, shaft_speed: ArrayLike, ratio: float) -> Array:
    """Slip against pure rolling: 1 - speed/(ratio x shaft speed).

    Parameters
    ----------
    speed : array_like, shape (T,) or (T, Z)
        Speed of the cage, orbit speed or spin speed of the rollers, rad/s.
    shaft_speed : array_like, shape (T,)
        Speed of the inner ring, rad/s.
    ratio : float
        Kinematic ratio of the speed to the shaft's.

    Returns
    -------
    ndarray, shape of `speed`
        Slip; positive when slower than rolling, nan where the shaft stands still.
    """
    omega = np.asarray(speed, dtype=float)
    rolling = ratio * np.asarray(shaft_speed, dtype=float)
    rolling = rolling.reshape(rolling.shape + (1,) * (omega.ndim - rolling.ndim))
    rolling = np.broadcast_to(rolling, omega.shape)
    quotient = np.full(omega.shape, np.nan)
    np.divide(omega, rolling, out=quotient, where=rolling != 0)
    return 1.0 - quotient


@dataclass(frozen=True, slots=True)
class PocketStatistics:
    """Statistics of the force between the rollers and each face of their pockets, over the recorded times.

    Attributes
    ----------
    peak, p95, mean : ndarray, shape (Z, slots)
        Largest force, 95th percentile of the force while in contact, and mean over all times, N.
    duty : ndarray, shape (Z, slots)
        Share of the times in contact.
    """

    peak: Array
    p95: Array
    mean: Array
    duty: Array


def pocket_statistics(force: ArrayLike, threshold: float = 0.0) -> PocketStatistics:
    """Peak, 95th percentile, mean and duty of pocket forces.

    Impacts between two recorded times are not seen: the peak is that of the record.

    Parameters
    ----------
    force : array_like, shape (T, Z, slots)
        Normal force of each face, N.
    threshold : float
        Force above which a face counts as touched, N.

    Returns
    -------
    PocketStatistics
        Arrays of shape (Z, slots); p95 is zero for faces never touched.

    Raises
    ------
    ValueError
        If the shape is wrong or there is no time.
    """
    f = np.asarray(force, dtype=float)
    if f.ndim != 3 or f.shape[0] == 0:
        raise ValueError(f"pocket forces must have shape (T, Z, slots) with T > 0, not {f.shape}")
    touched = f > threshold
    flat = f.reshape(f.shape[0], -1)
    mask = touched.reshape(flat.shape)
    p95 = [np.percentile(flat[mask[:, k], k], 95.0) if mask[:, k].any() else 0.0 for k in range(flat.shape[1])]
    return PocketStatistics(
        peak=f.max(axis=0), p95=np.reshape(p95, f.shape[1:]), mean=f.mean(axis=0), duty=touched.mean(axis=0)
    )
