"""How far a cage moves between its rollers in a run (Fig. 17), beside the geometry.

The cage is pushed by its weight, in a chosen direction, for a time in which rollers that carry load hardly creep. The shaft turns
slowly, so that the direction in the cage's frame stays; pockets are damped, so that the cage comes to rest.
"""

from __future__ import annotations

import math
import time as clock
from typing import Any

import numpy as np

import trbdyn as trb
from trbdyn import observables
from trbdyn.model.scene import Start
from trbdyn.run.movable import Pockets

SPEED_RPM = 300.0
AXIAL_LOAD = 4930.0
DURATION = 0.02
DAMPING = 20.0
"""Damping of the pockets (s/m)."""


def run(eccentricity: float, direction_deg: float, gravity: float = 9.80665) -> dict[str, Any]:
    """Reach along a push, with rollers that stand in the middle of their pockets around a cage so far aside in that direction.

    Parameters
    ----------
    eccentricity : float
        Distance of that cage from the axis over Cpr: zero for rollers at equal spacing.
    direction_deg : float
        Direction of the push (deg).
    gravity : float
        Weight's acceleration (m/s2).
    """
    angle = math.radians(direction_deg)
    start = Start.whirl(eccentricity, direction_deg=direction_deg) if eccentricity else Start.equal()
    effects = trb.Effects.paper().replace(quadrature="gauss", n_slices=8, damping="hunt_crossley", damping_cage=DAMPING)
    scene = trb.cases.paper_30310(
        SPEED_RPM,
        AXIAL_LOAD,
        effects=effects,
        gravity=(gravity * math.cos(angle), gravity * math.sin(angle), 0.0),
        start=start,
    )
    began = clock.process_time()
    result = trb.Simulation(scene).run(duration=DURATION, save_every=1e-4, save_groups=("cage", "rollers"))
    play, count = scene.bearing.cage.play_radial, scene.bearing.n_rollers
    even = 2.0 * np.pi * np.arange(count) / count
    off = observables.wrap_angle(result["roller_orbit_angle"] - result["cage_angle"][:, None] - even)
    off = off - off.mean(axis=1, keepdims=True)
    turn = result["cage_angle"]
    place = (result["cage_position"][:, 0] + 1j * result["cage_position"][:, 1]) * np.exp(-1j * turn)
    along = np.real(place * np.exp(1j * (turn - angle)))
    late = result["time"] > 0.75 * DURATION
    toward = angle - float(turn[late].mean())
    aside = eccentricity * play * np.exp(1j * angle)
    pockets = Pockets(scene)
    held = pockets.held(off[0], [toward], (aside.real, aside.imag)).distance[0]
    reach = np.real((aside + held * np.exp(1j * toward)) * np.exp(-1j * toward))
    return {
        "eccentricity": eccentricity,
        "direction_deg": direction_deg,
        "reach": float(along[late].mean() / play),
        "shake": float(along[late].std() / play),
        "geometry": float(reach / play),
        "free": float(pockets.free([toward]).distance[0] / play),
        "roller_drift": float(0.5 * scene.bearing.pitch_diameter * np.abs(off[-1] - off[0]).max() / play),
        "cpu": clock.process_time() - began,
    }
