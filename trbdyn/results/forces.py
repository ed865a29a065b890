"""What `Result.force_spectrum`, `octave_levels`, `sound` and `rattle` give: forces over time and frequency, hits."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.shown import Shown, Tabled

Array = NDArray[np.float64]
On = Literal["cage", "outer_ring"]
Along = Literal["x", "y", "z"]
LINES: Final = 5


@dataclass(frozen=True)
class Force:
    """A force at even times, its mean taken off.

    Attributes
    ----------
    interval : float
        Time between two values (s).
    values : ndarray, shape (n,)
        The force (N).
    mean : float
        What was taken off (N).
    on, along : str
        The body and the direction.
    """

    interval: float
    values: Array
    mean: float
    on: On
    along: Along

    @property
    def nyquist(self) -> float:
        """Half of the frequency of the records (Hz)."""
        return 0.5 / self.interval

    @property
    def rms(self) -> float:
        """Root mean square (N)."""
        return float(np.sqrt(np.mean(self.values**2)))

    @property
    def words(self) -> str:
        """What it is."""
        return f"Force on the {self.on.replace('_', ' ')} along {self.along}"

    @property
    def sampling(self) -> str:
        """What the records resolve."""
        return f"records every {1e3 * self.interval:.4g} ms: frequencies up to {self.nyquist:.5g} Hz"


@dataclass(frozen=True, repr=False)
class ForceSpectrum(Tabled):
    """The spectrum of a force; print it for the strongest lines.

    Attributes
    ----------
    frequency : ndarray, shape (n,)
        Frequencies up to half of that of the records (Hz).
    amplitude : ndarray, shape (n,)
        Amplitude of the sine that each is (N), one-sided; half a resolution beside a line it is up to 15 % low (Hann window).
    density : ndarray, shape (n,)
        Power spectral density (N2/Hz), one-sided; its integral is the mean square about the mean, of single hits as well.
    force : Force
        The force over time.
    shaft_frequency : float
        Frequency of the shaft (Hz).
    """

    frequency: Array
    amplitude: Array
    density: Array
    force: Force
    shaft_frequency: float

    _headed = True

    def strongest(self, count: int = LINES) -> list[tuple[float, float]]:
        """Frequency (Hz) and amplitude (N) of the strongest peaks, strongest first."""
        from scipy import signal

        places = signal.find_peaks(self.amplitude)[0]
        ordered = places[np.argsort(self.amplitude[places])[::-1][:count]]
        return [(float(self.frequency[place]), float(self.amplitude[place])) for place in ordered]

    def _shown(self) -> Shown:
        rows = tuple(
            (
                f"{frequency:.5g}",
                f"{frequency / self.shaft_frequency:.3f}" if self.shaft_frequency else "",
                f"{size:.4g}",
            )
            for frequency, size in self.strongest()
        )
        resolution = float(self.frequency[1] - self.frequency[0])
        notes = (
            f"{self.force.rms:.4g} N rms about the mean of {self.force.mean:.4g} N; "
            f"{self.force.sampling}, {resolution:.3g} Hz apart",
        )
        return Shown(self.force.words, rows, ("frequency (Hz)", "of the shaft", "amplitude (N)"), notes)


@dataclass(frozen=True, repr=False)
class OctaveLevels(Tabled):
    """Levels of a force by octaves or third octaves.

    Attributes
    ----------
    frequency : ndarray, shape (n,)
        Exact mid frequencies of the bands (Hz).
    names : tuple of str
        Nominal frequencies.
    level : ndarray, shape (n,)
        Levels (dB re 1 µN).
    fraction : int
        1: octaves; 3: third octaves.
    force : Force
        The force over time.
    """

    frequency: Array
    names: tuple[str, ...]
    level: Array
    fraction: int
    force: Force

    _headed = True

    def _shown(self) -> Shown:
        rows = tuple((name, f"{level:.1f}") for name, level in zip(self.names, self.level, strict=True))
        kind = "octaves" if self.fraction == 1 else "third octaves"
        seconds = self.force.interval * self.force.values.size
        notes = (f"{self.force.sampling}; bands whose filter settles within {seconds:.3g} s",)
        return Shown(f"{self.force.words} by {kind}", rows, ("band (Hz)", "level (dB re 1 µN)"), notes)


@dataclass(frozen=True, repr=False)
class Sound(Tabled):
    """A sound file of a force.

    Attributes
    ----------
    path : Path
        The file.
    rate : int
        Samples in a second of the file (1/s).
    full_scale : float
        Force of the largest sample (N).
    seconds : float
        Length of the run that is heard (s).
    slower : float
        How many times slower it is played (1).
    force : Force
        The force over time.
    """

    path: Path
    rate: int
    full_scale: float
    seconds: float
    slower: float
    force: Force

    def _shown(self) -> Shown:
        rows = (
            ("full_scale", f"{self.full_scale:.4g}", "N", "force of the largest sample"),
            ("rms", f"{self.force.rms:.4g}", "N", "of the force about its mean"),
            ("rate", str(self.rate), "1/s", "samples in a second of the file"),
            ("seconds", f"{self.seconds:.4g}", "s", f"of the run, played {self.slower:g} times slower"),
        )
        return Shown(f"{self.force.words} in {self.path.name}", rows, notes=(self.force.sampling,))


@dataclass(frozen=True, repr=False)
class Rattle(Tabled):
    """How often rollers hit the cage, and how hard; print it for a table.

    Every contact that begins is a hit, also one between two records. The impulse is that of the whole contact, so a roller that
    pushes the cage for long counts as one hit with a large impulse.

    Attributes
    ----------
    hits : int
        Contacts that began.
    per_second, per_turn : float
        Hits in a second (1/s), and in a turn of the shaft (1).
    impulse_per_hit, largest_impulse : float
        Mean and largest impulse of a hit (N s); 0 without hits.
    impulse_per_second : float
        Impulse in a second, the mean of all normal forces on the cage together (N).
    hits_by_face : dict of str to int
        Hits on each surface of the pockets.
    seconds, turns : float
        Time (s), and turns of the shaft.
    """

    hits: int
    per_second: float
    per_turn: float
    impulse_per_hit: float
    largest_impulse: float
    impulse_per_second: float
    hits_by_face: dict[str, int]
    seconds: float
    turns: float

    def _shown(self) -> Shown:
        rows = (
            (
                "hits",
                str(self.hits),
                "",
                f"contacts that began in {self.seconds:.4g} s, {self.turns:.4g} turns of the shaft",
            ),
            ("per_second", f"{self.per_second:.4g}", "1/s", "hits in a second"),
            ("per_turn", f"{self.per_turn:.4g}", "", "hits in a turn of the shaft"),
            ("impulse_per_hit", f"{self.impulse_per_hit:.3g}", "N s", "mean impulse of a hit"),
            ("largest_impulse", f"{self.largest_impulse:.3g}", "N s", "largest impulse of a hit"),
            (
                "impulse_per_second",
                f"{self.impulse_per_second:.4g}",
                "N",
                "mean of the normal forces on the cage together",
            ),
        )
        told = ", ".join(f"{name.replace('_', ' ')} {count}" for name, count in self.hits_by_face.items() if count)
        return Shown("Rattle of the cage", rows, notes=(f"hits: {told}",) if told else ())
