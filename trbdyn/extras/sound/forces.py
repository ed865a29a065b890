"""Forces on cage and outer ring over time: spectrum, levels of octaves, sound file; and how often the rollers hit the cage.

A force is the mean over each interval between two records, not the value at a record: hits that are shorter than that do not go
missing, and what is faster than the records can follow is weaker by sin(pi f dt)/(pi f dt), which is put right below half of the
frequency of the records. Where much of the power lies in the highest octave, more lies above it, would be folded below, and the
force is refused (docs/howto/sound.md).
"""

from __future__ import annotations

import io
import os
from typing import Final, get_args

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.own_files import write_whole
from trbdyn.base.validation import number_of
from trbdyn.errors import InputError
from trbdyn.results import observables
from trbdyn.results.derived import Derived
from trbdyn.results.forces import Along, Force, ForceSpectrum, OctaveLevels, On, Rattle, Sound

Array = NDArray[np.float64]

FEWEST: Final = 32
"""Fewest intervals of a spectrum."""
SILENT: Final = 1e-6
"""A force that varies by less (N, rms) is none."""
HANN: Final = 1.5
"""Width of a line in a Hann window, over the resolution."""
REFERENCE: Final = 1e-6
"""Force of 0 dB (N), ISO 1683."""
CYCLES: Final = 8.0
"""Least product of a band's width and the time: with less, its filter does not settle."""


def force_of(result: Derived, on: On, along: Along) -> Force:
    """The force on a body from the records of a run.

    Cage: mass times the change of the velocity of its centre of mass, the sum of all forces. Outer ring: the normal loads of all
    rollers at raceway and ribs, without friction.

    Raises
    ------
    InputError
        If an argument is not allowed, a group is not saved, or the records are too few, uneven or too far apart.
    """
    for name, value, kinds in (("on", on, On), ("along", along, Along)):
        if value not in get_args(kinds):
            raise InputError.of(name, value, f"must be {' or '.join(map(repr, get_args(kinds)))}")
    time, axis = result["time"], "xyz".index(along)
    steps = np.diff(time)
    if steps.size < FEWEST:
        raise InputError.of("result", f"{time.size} records", f"must have more than {FEWEST} for a force over time")
    interval = float(f"{np.median(steps):.9g}")
    even = np.abs(steps - interval) <= 1e-4 * interval
    kept = slice(0, steps.size - (0 if even[-1] else 1))  # a run may end between two records
    if not even[kept].all():
        raise InputError.of("result", "uneven records", "must have its records at even times (save_every)")
    if on == "cage":
        result._needs("cage", "force on the cage")
        raw = result.scene.bearing.cage.mass * np.diff(result._of_cage("cage_velocity")[:, axis]) / steps
    else:
        for group in ("rollers", "peaks"):
            result._needs(group, "force on the outer ring")
        raw = _on_outer_ring(result, axis)
    raw = raw[kept]
    mean = float(raw.mean())
    force = Force(interval, _sharpened(raw - mean), mean, on, along)
    _check_resolved(force)
    return force


def _on_outer_ring(result: Derived, axis: int) -> Array:
    load = result["outer_load_mean"][1:]
    half_angle = np.radians(result.scene.bearing.cup_half_angle_deg)
    if axis == 2:
        force = -np.sin(half_angle) * load.sum(axis=1)
        names = {field.name for field in result.fields}
        for name, sign in (("outer_rib_load_mean", 1.0), ("outer_front_rib_load_mean", -1.0)):
            if name in names:
                force = force + sign * result[name][1:].sum(axis=1)
        return np.asarray(force)
    angle = result["roller_orbit_angle"]
    middle = 0.5 * (angle[1:] + angle[:-1])
    return np.asarray((np.cos(half_angle) * load * (np.sin(middle) if axis else np.cos(middle))).sum(axis=1))


def _sharpened(values: Array) -> Array:
    """Means over intervals as values in their middle, for what is slower than half of the frequency of the records."""
    share = np.sinc(np.fft.rfftfreq(values.size))
    return np.fft.irfft(np.fft.rfft(values) / share, values.size)


def _check_resolved(force: Force) -> None:
    if force.rms <= SILENT:
        return
    frequency, density = observables.spectrum(force.interval * np.arange(force.values.size), force.values)
    high = observables.high_share(frequency, density)
    if high > observables.FOLDED:
        raise InputError.of(
            "save_every",
            force.interval,
            f"must be shorter (s): {100.0 * high:.0f} % of the power of the {force.words.lower()} lies in the highest octave "
            f"that these records resolve, {0.5 * force.nyquist:.4g} to {force.nyquist:.4g} Hz; "
            f"{100.0 * observables.FOLDED:.0f} % are allowed, as what is faster would be folded to lower frequencies",
        )


def force_spectrum(result: Derived, on: On, along: Along, segments: int) -> ForceSpectrum:
    """See `Derived.force_spectrum`."""
    force = force_of(result, on, along)
    if not isinstance(segments, int) or not 1 <= segments <= force.values.size // 16:
        raise InputError.of("segments", segments, f"must be a whole number from 1 to {force.values.size // 16}")
    times = force.interval * np.arange(force.values.size)
    frequency, density = observables.spectrum(times, force.values, segments)
    _, lines, _ = observables.windowed(times, force.values, segments)
    amplitude = np.sqrt(2.0 * lines * HANN * (frequency[1] - frequency[0]))
    shaft = abs(float(result.turning_speed.mean())) / (2.0 * np.pi)
    return ForceSpectrum(frequency, amplitude, density, force, shaft)


def octave_levels(result: Derived, on: On, along: Along, fraction: int) -> OctaveLevels:
    """See `Derived.octave_levels`."""
    if fraction not in (1, 3) or isinstance(fraction, bool):
        raise InputError.of("fraction", fraction, "must be 1, octaves, or 3, third octaves")
    try:
        import pyoctaveband
    except ImportError as error:
        raise ImportError("levels of octaves need PyOctaveBand: pip install trbdyn[sound]") from error
    force = force_of(result, on, along)
    seconds = force.interval * force.values.size
    edge = 10.0 ** (0.15 / fraction)
    lowest = CYCLES / (seconds * (edge - 1.0 / edge))
    middles = pyoctaveband.getansifrequencies(fraction, [lowest, max(force.nyquist, 1.1 * lowest)])[0]
    kept = [middle for middle in middles if middle >= lowest and middle * edge < force.nyquist]
    if not kept:
        raise InputError.of(
            "result",
            f"{seconds:.3g} s",
            f"must be longer: the lowest band whose filter settles is that of {lowest:.3g} Hz, and {force.sampling}",
        )
    rate = round(1.0 / force.interval)
    limits = [kept[0] / edge**0.5, kept[-1] * edge**0.5]
    factor = 2e-5 / REFERENCE  # the library's levels are of pressures, re 20 µPa
    levels, found = pyoctaveband.octavefilter(force.values, rate, fraction, limits=limits, calibration_factor=factor)
    names = pyoctaveband.getansifrequencies(fraction, limits)[3]
    return OctaveLevels(np.asarray(found), tuple(names), np.asarray(levels), fraction, force)


def sound(
    result: Derived,
    path: str | os.PathLike[str],
    on: On,
    along: Along,
    full_scale: float | None,
    slower: float,
    overwrite: bool,
) -> Sound:
    """See `Derived.sound`."""
    from scipy.io import wavfile

    if not 1e-3 <= number_of("slower", slower) <= 1e3:
        raise InputError.of("slower", slower, "must be from 0.001 to 1000 (1)")
    force = force_of(result, on, along)
    peak = float(np.abs(force.values).max())
    if full_scale is None:
        full_scale = peak or 1.0
    elif not peak <= number_of("full_scale", full_scale) < np.inf:
        raise InputError.of("full_scale", full_scale, f"must be at least the largest force, {peak:.5g} (N)")
    rate = round(1.0 / (force.interval * slower))
    if not 1000 <= rate <= 384_000:
        raise InputError.of(
            "slower", slower, f"must give 1000 to 384000 samples in a second of the file, not {rate} (1)"
        )
    samples = np.round(force.values / full_scale * 32767.0).astype(np.int16)
    stream = io.BytesIO()
    wavfile.write(stream, rate, samples)
    written = write_whole(path, stream.getvalue(), overwrite=overwrite, endings=(".wav",))
    return Sound(written, rate, float(full_scale), force.interval * force.values.size, float(slower), force)


def rattle(result: Derived) -> Rattle:
    """See `Derived.rattle`."""
    result._needs("peaks", "rattle")
    hits = result._of_cage("pocket_impacts")
    seconds, turns = result.duration, result.revolutions
    if not seconds:
        raise InputError.of("result", f"{hits.shape[0]} records", "must have two or more for a rate of hits")
    peaks = result.peaks
    hits, impulse = peaks["pocket_impacts"], peaks["pocket_impulse"]
    count = round(float(hits.sum()))
    return Rattle(
        hits=count,
        per_second=count / seconds,
        per_turn=count / turns if turns else 0.0,
        impulse_per_hit=float(impulse.sum()) / count if count else 0.0,
        largest_impulse=float(peaks["pocket_impulse_peak"].max()),
        impulse_per_second=float(impulse.sum()) / seconds,
        hits_by_face={name: round(float(n)) for name, n in zip(result.slot_names, hits.sum(axis=0), strict=False)},
        seconds=seconds,
        turns=turns,
    )
