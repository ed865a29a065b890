"""Motion of the cage in one result: whirl against rotation, class, tilt's direction against the displacement."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trbdyn import observables
from trbdyn.results.result import Result

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Phasor:
    """Direction in which the cage's axis leans, seen from the direction of its displacement.

    Attributes
    ----------
    phase_deg : float
        Angle of the mean of lean times conjugate displacement (deg): 0 where the axis leans to the displacement.
    coherence : float
        Size of that mean over the product of both root mean squares: 1 for a fixed angle and ratio, 0 for no relation.
    """

    phase_deg: float
    coherence: float


def displacement(result: Result) -> Complex:
    """Place of the cage's centre, x + i y (Cpr)."""
    path = result.cage_locus()
    return np.asarray(path[:, 0] + 1j * path[:, 1])


def lean(result: Result) -> Complex:
    """Direction (with growing z) and size of the lean of the cage's axis, theta_y - i theta_x (rad)."""
    tilt = result["cage_tilt"]
    return np.asarray(tilt[:, 1] - 1j * tilt[:, 0])


def phasor(place: Complex, axis: Complex) -> Phasor:
    """Of a lean against a displacement, both of shape (T,)."""
    mean = complex(np.mean(axis * np.conj(place)))
    size = float(np.sqrt(np.mean(np.abs(axis) ** 2) * np.mean(np.abs(place) ** 2)))
    return Phasor(float(np.degrees(np.angle(mean))), abs(mean) / size if size > 0.0 else float("nan"))


def turning(place: Complex, cage_angle: Array) -> float:
    """Share of the mean square of the displacement about its mean that turns with the cage, over whole turns."""
    turned = np.abs(cage_angle - cage_angle[0]) / (2.0 * np.pi)
    kept = turned <= max(1, int(turned[-1]))
    moved = place[kept] - place[kept].mean()
    total = float(np.mean(np.abs(moved) ** 2))
    return float(abs(np.mean(moved * np.exp(-1j * cage_angle[kept]))) ** 2 / total) if total > 0.0 else float("nan")


def row(result: Result) -> dict[str, Any]:
    """Indicators of the cage's motion in a result."""
    place, axis = displacement(result), lean(result)
    motion = asdict(result.cage_motion)
    moving = phasor(place - place.mean(), axis - axis.mean())
    whole = phasor(place, axis)
    return {
        "cage_hz": result.cage_frequency,
        "whirl_hz": result.whirl_frequency,
        "peak_hz": observables.whirl_frequency_spectral(result["time"], result["cage_position"]),
        "whirl_ratio": result.whirl_ratio,
        "kind": motion["kind"],
        "orbit_over_cpr": motion["orbit_over_play"],
        "centre_over_cpr": abs(complex(place.mean())),
        "coherence": motion["whirl_coherence"],
        "speed_deviation": motion["speed_deviation_ratio"],
        "synchronous_share": turning(place, result["cage_angle"]),
        "lean_deg": whole.phase_deg,
        "lean_coherence": whole.coherence,
        "lean_moving_deg": moving.phase_deg,
        "lean_moving_coherence": moving.coherence,
        "skew_rms_mrad": 1e3 * float(np.sqrt(np.mean(result["roller_skew"] ** 2))),
        "tilt_rms_mrad": 1e3 * float(np.sqrt(np.mean(result["roller_tilt"] ** 2))),
    }


def spectrum(result: Result) -> tuple[Array, Array]:
    """Two-sided spectrum of the centre's place over orders of the cage (1; Cpr^2 an order); positive: with the cage."""
    frequency, density = observables.spectrum(result["time"], displacement(result))
    cage = result.cage_frequency
    order, size = frequency / cage, density * abs(cage)
    up = np.argsort(order)
    return np.asarray(order[up]), np.asarray(size[up])
