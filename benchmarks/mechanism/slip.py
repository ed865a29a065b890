"""Slip budget of the rollers: rolling resistance, the traction coefficient that balances it, and the slip that this takes.

A free roller's balance of force and spin wants sliding friction that cancels the rolling resistance at each raceway. Over the
load that is a coefficient that falls as W^(0.246-1).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import trbdyn as trb
from trbdyn.results.result import Result

Array = NDArray[np.float64]

SIDES = ("outer", "inner")
SAMPLES = 144


@dataclass(frozen=True)
class Budget:
    """Every array has the shape (SAMPLES, 2, Z): time, raceway, roller.

    Attributes
    ----------
    load : ndarray
        Normal load (N).
    rolling : ndarray
        Rolling resistance (N).
    friction : ndarray
        Sliding friction on the roller along its orbit, without rolling resistance (N); positive: forward.
    slide_roll : ndarray
        Slide-roll ratio along rolling; positive: roller faster.
    orbit : ndarray, shape (SAMPLES, Z)
        Orbit speed of each roller over the mean of all, less one.
    share : float
        Kinematic speed of the cage over that of the shaft.
    """

    load: Array
    rolling: Array
    friction: Array
    slide_roll: Array
    orbit: Array
    share: float

    @property
    def coefficient(self) -> Array:
        """Size of the sliding friction over the load."""
        return np.asarray(np.abs(self.friction) / self.load)

    @property
    def orbit_by_slip(self) -> Array:
        """Orbit speed that the slips alone give, over the kinematic one, less one; shape (SAMPLES, Z).

        From w_c R_o (1 + s_o) = (w_i - w_c) R_i (1 + s_i): slip at the outer raceway speeds a driven roller up, at the inner
        raceway it holds it back.
        """
        outer, inner = self.slide_roll[:, 0], self.slide_roll[:, 1]
        return np.asarray((1.0 - self.share) * (inner - outer))


def budget(result: Result) -> Budget:
    """Over the turn of the cage that follows a result, from its final state."""
    assert result.final_state is not None
    scene = result.scene
    sim = trb.Simulation(scene)
    sim.set_state(result.final_state, result.final_time)
    period = 1.0 / abs(result.cage_frequency)
    parts: list[list[Array]] = [[], [], [], [], []]
    for end in result.final_time + period * np.arange(1, SAMPLES + 1) / SAMPLES:
        while sim.time < end:
            sim.step()
        found, record = sim.contacts(), sim.record()
        rolling = np.asarray(found["raceway_rolling"]).sum(axis=2)
        whole = np.array([record[f"{side}_traction"] for side in SIDES])
        # on the roller, rolling resistance points forward at the outer raceway and backward at the inner one
        sense = np.array([[1.0], [-1.0]]) * np.sign(record["cage_angular_velocity"][2])
        for store, value in zip(
            parts,
            (
                np.array([record[f"{side}_load"] for side in SIDES]),
                rolling,
                whole - sense * rolling,
                np.array([record[f"{side}_slide_roll"] for side in SIDES]),
                np.asarray(record["roller_orbit_speed"]),
            ),
            strict=True,
        ):
            store.append(np.array(value))
    load, rolling, friction, slide_roll, orbit = (np.array(part) for part in parts)
    share = float(scene.bearing.geometry.cage_speed_ratio)
    return Budget(load, rolling, friction, slide_roll, orbit / orbit.mean() - 1.0, share)


def exponent(load: Array, values: Array) -> float:
    """Power of the load that fits positive values best (least squares of logarithms)."""
    x, y = np.log(load.ravel()), np.log(values.ravel())
    x = x - x.mean()
    return float(x @ (y - y.mean()) / (x @ x))


def ends(load: Array, values: Array, share: float = 0.1) -> tuple[float, float]:
    """Means of values where the load is among its smallest and its largest share."""
    low, high = np.quantile(load, (share, 1.0 - share))
    return float(values[load <= low].mean()), float(values[load >= high].mean())
