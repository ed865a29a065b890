"""Growth of the cage's orbit in the complete model."""

from __future__ import annotations

import time as clock
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from planar_cage import Motion, growth

import trbdyn as trb
from trbdyn.model.scene import Scene

Array = NDArray[np.float64]

SAMPLES = 24
"""Records a turn of the cage."""


@dataclass(frozen=True)
class Run:
    """What a run of the complete model gave, in the units of `planar.Motion`.

    Attributes
    ----------
    motion : Motion
        Cage centre and pattern of the rollers (Cpr).
    rate, error : float
        Growth of the pattern a turn of the cage, and its standard error (1).
    cpu_s : float
        Processor time (s).
    """

    motion: Motion
    rate: float
    error: float
    cpu_s: float


def pattern_of(orbit_angle: Array, radius: float) -> Array:
    """First harmonic of the rollers' places in the frame that turns with them, as a place of the cage (m).

    Parameters
    ----------
    orbit_angle : ndarray, shape (T, Z)
        Orbit angles of the rollers (rad).
    radius : float
        Radius of their centres (m).
    """
    count = orbit_angle.shape[1]
    even = 2.0 * np.pi * np.arange(count) / count
    off = orbit_angle - even
    return np.asarray(2j * radius * ((off - off.mean(axis=1, keepdims=True)) @ np.exp(1j * even)) / count)


def run(scene: Scene, turns: float, *, accuracy: str = "fast", first: int = 2, last: int | None = None) -> Run:
    """Run a scene for some turns of its cage, and fit the growth of the pattern over the turns from `first` to `last`."""
    bearing = scene.bearing
    period = 60.0 / (scene.speed_rpm * bearing.geometry.cage_speed_ratio)  # type: ignore[operator]
    began = clock.process_time()
    result = trb.Simulation(scene, accuracy=accuracy).run(
        duration=turns * period, save_every=period / SAMPLES, save_groups=("cage", "rollers")
    )
    spent = clock.process_time() - began
    play = bearing.cage.play_radial
    place = result["cage_position"][:, :2] @ np.array([1.0, 1j]) / play
    pattern = pattern_of(result["roller_orbit_angle"], 0.5 * bearing.pitch_diameter) / play
    motion = Motion(place[:, None], pattern[:, None], SAMPLES)
    rate, error = growth(motion, first, last)
    return Run(motion, float(rate[0]), float(error[0]), spent)
