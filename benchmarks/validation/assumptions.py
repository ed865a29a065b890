"""One set of assumptions for every measurement, written down before the runs. Nothing in it is fitted to a measured number.

- Effects are `Effects.standard()`, with the drag of the state of lubrication that the source names.
- The scene's temperature is that of films. The source gives that of the outer ring; films are as warm or warmer: from 3 K below
  (the thermocouple) to 10 K above. The value beside the band is for the ring's temperature.
- Supply of oil: the starvation factor is SKF's kinematic replenishment. Its factor K_rs is 3e-8 for a low bath and 6e-8 for oil
  and air; the band goes from 6e-8 to a full supply (1), the value is for 3e-8.
- Roughness 0.7 to 1.5 times the default, boundary friction 0.07 to 0.2: as `trbdyn.study.open_inputs` has them.
- Share of oil round the rollers: the band of the state 'bath'.
- Cup angle of the 32216: 13.7 deg (the load zone of the source) to 15.7 deg (catalogues); the value is for ISO 355.
"""

from __future__ import annotations

from typing import Final

import trbdyn as trb
from trbdyn.model.lubricants import OIL_SUPPLIES
from trbdyn.study import Band
from validation.measured import Measurement

SAMPLES, SEED = 64, 0
TURNS = 4.0
CATALOGUE: Final = {"32216": {"bore": 0.080, "outside": 0.140, "Y": 1.4, "series": "322"}}
"""Boundary dimensions (m) and axial factor Y, from catalogues."""
ANGLES: Final = {"32216": (13.7, 15.7)}
"""Bands of the cup's half angle (deg)."""


def replenishment(point: Measurement, supply: str) -> float:
    """SKF's kinematic replenishment (`trbdyn.lubricants.replenishment`).

    Parameters
    ----------
    point : Measurement
        Speed and bearing.
    supply : {'low_bath', 'oil_air'}
        K_rs of 3e-8 or 6e-8.
    """
    page = CATALOGUE[point.bearing]
    oil = trb.lubricants.vg100(point.ring_c)
    return trb.lubricants.replenishment(oil, point.speed_rpm, bore=page["bore"], outside=page["outside"], supply=supply)


def scene_of(point: Measurement) -> trb.Scene:
    """The scene of a measurement, every open input at its value."""
    effects = trb.Effects.standard().replace(oil_fill="bath", starvation_factor=replenishment(point, "low_bath"))
    return trb.Scene(
        trb.cases.BEARINGS[point.bearing](),
        speed_rpm=point.speed_rpm,
        axial_load=point.axial_load,
        radial_load=point.radial_load,
        radial_direction_deg=-90.0,
        lubricant=trb.lubricants.vg100(point.ring_c),
        effects=effects,
    )


def bands_of(point: Measurement) -> tuple[Band, ...]:
    """Bands of the open inputs."""
    scene = scene_of(point)
    rough, bath = scene.bearing.roughness, OIL_SUPPLIES["bath"]
    low, high = ANGLES[point.bearing]
    return (
        Band(
            path="lubricant.temperature_c",
            low=point.ring_c - 3.0,
            high=point.ring_c + 10.0,
            source="films over the ring",
        ),
        Band(
            path="effects.starvation_factor",
            low=replenishment(point, "oil_air"),
            high=1.0,
            source="SKF's replenishment",
        ),
        Band(path="effects.oil_fill", low=bath.low, high=bath.high, source=bath.words),
        Band(path="bearing.roughness.raceway", low=0.7 * rough.raceway, high=1.5 * rough.raceway, source="finishing"),
        Band(path="bearing.roughness.rib", low=0.7 * rough.rib, high=1.5 * rough.rib, source="finishing"),
        Band(path="effects.friction.boundary_limit", low=0.07, high=0.2, source="published"),
        Band(path="bearing.cup_half_angle_deg", low=low, high=high, source="load zone and catalogues"),
    )
