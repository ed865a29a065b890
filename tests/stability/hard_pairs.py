"""Hard cases of bearings on one shaft: what each is, and why it is hard."""

from __future__ import annotations

from functools import partial
from typing import Any

from hard_scenes import Hard

import trbdyn as trb
from trbdyn import Assembly, History, Shaft, ShaftBearing, ShaftLoad

BEARING = trb.cases.rig_30310()
SHAFT = Shaft(mass=6.0, inertia_axial=4e-3, inertia_transverse=5e-2)


hard_pair = partial(Hard, slow=True, closure=1e-3, tolerances=0.02, window=3e-4)
"""A hard case of bearings on a shaft."""


def pair(end_play: float = -20e-6, **given: Any) -> Assembly:
    return Assembly.pair(
        BEARING, "back to back", **{"spread": 0.15, "end_play": end_play, "shaft": SHAFT, "speed_rpm": 3000.0} | given
    )


def push(axial: float | History, radial: float | History = 0.0) -> ShaftLoad:
    return ShaftLoad(position=0.02, force=(0.0, radial, axial))


def unequal_tandem() -> Assembly:
    """A large and a small bearing side by side in cold oil, and one against them in hot oil."""
    bearings = (
        ShaftBearing(
            trb.cases.bearing_32216(), position=-0.12, small_ends="right", lubricant=trb.lubricants.vg100(30.0)
        ),
        ShaftBearing(BEARING, position=-0.02, small_ends="right", lubricant=trb.lubricants.vg100(30.0)),
        ShaftBearing(BEARING, position=0.12, small_ends="left", end_play=-30e-6, lubricant=trb.lubricants.vg100(90.0)),
    )
    return Assembly(shaft=SHAFT, bearings=bearings, loads=(push(2000.0, -3000.0),), speed_rpm=-4000.0)


PAIRS: tuple[Hard, ...] = (
    hard_pair(
        "pair_one_side_unloaded",
        "end play and an axial load: one bearing carries nothing but the weight of its own rollers",
        lambda: pair(120e-6, loads=[push(4000.0)]),
    ),
    hard_pair(
        "pair_reversing_load",
        "the axial load goes through zero, and the shaft through its end play onto the other bearing, in 10 ms",
        lambda: pair(20e-6, loads=[push(History.ramp(2e-3, 12e-3, 3000.0, -3000.0), -300.0)]),
    ),
    hard_pair(
        "pair_load_drops",
        "all of the load drops to zero for 8 ms and comes back within a tenth of a millisecond",
        lambda: pair(
            0.0,
            loads=[
                push(
                    History.step([2e-3, 10e-3], [3000.0, 0.0, 3000.0]),
                    History.step([2e-3, 10e-3], [-4000.0, 0.0, -4000.0]),
                )
            ],
        ),
    ),
    hard_pair(
        "pair_unbalance_10000_rpm",
        "an unbalance of 600 N turns with the shaft at 10 000 rpm",
        lambda: pair(speed_rpm=10000.0, shaft=SHAFT.replace(unbalance=5.5e-4)),
        duration=0.012,
    ),
    hard_pair(
        "pair_run_up",
        "from standstill to 6000 rpm under a torque, through every speed and film",
        lambda: pair(speed_rpm=0.0, torque=130.0, loads=[push(500.0, -2000.0)]),
    ),
    hard_pair(
        "pair_torque_stops",
        "the torque of a running shaft is taken away suddenly",
        lambda: pair(torque=History.step([5e-3], [5.2, 0.0])),
    ),
    hard_pair(
        "pair_impact",
        "a hit of 20 kN for half a millisecond at the end of the shaft, which tilts it out of the bearings",
        lambda: pair(
            loads=[
                ShaftLoad(position=0.2, force=(0.0, History.table([4e-3, 4.25e-3, 4.5e-3], [0.0, -20000.0, 0.0]), 0.0))
            ]
        ),
    ),
    hard_pair(
        "three_bearings",
        "sizes, oils and directions differ, and three cages hit their rollers at different times",
        unequal_tandem,
    ),
)
