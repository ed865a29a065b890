"""What a run keeps if nobody says so: every quantity at short intervals for short runs, less of it for long ones.

A record of all quantities of a bearing with 12 rollers takes 10 kB, half of it the group peaks. The default is a record every
0.1 ms with all groups, up to 5000 records. Longer runs keep as many at longer intervals, but not longer than 1 ms or a twentieth
of a turn of the shaft, so that orbits can still be read; peaks are those of all steps at any interval. From 0.5 ms the files are
compressed. Beyond 20 000 records the groups contacts and pocket are left out; the peaks and means of their loads are in the
group peaks. What is given explicitly is kept as it is given.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Final

from trbdyn.model.motion import History, values_of
from trbdyn.run.options import GROUPS, Group

SHORTEST: Final = 1e-4
"""Default interval of records (s)."""
RECORDS: Final = 5_000
"""Records up to which a run keeps them at the shortest interval."""
LONGEST: Final = 1e-3
"""Longest default interval (s)."""
OF_A_TURN: Final = 0.05
"""Longest default interval in turns of the shaft at its highest speed."""
MANY: Final = 20_000
"""Records beyond which the groups `DETAILS` are left out by default."""
DETAILS: Final[tuple[Group, ...]] = ("contacts", "pocket")
COMPRESSED: Final = 5e-4
"""Interval (s) from which result files are compressed: with denser records compression would cost more time than the records."""


def interval(length: float, speed_rpm: float | History) -> float:
    """Default interval of records (s) of a run of some length (s): 1, 2 or 5 times a power of ten."""
    fastest = max(map(abs, values_of(speed_rpm))) / 60.0
    most = min(LONGEST, OF_A_TURN / fastest) if fastest > 0.0 else LONGEST
    wanted = length / RECORDS
    if wanted <= SHORTEST or most <= SHORTEST:
        return SHORTEST
    steps = [factor * 10.0**power for power in (-4, -3) for factor in (1.0, 2.0, 5.0)]
    allowed = [step for step in steps if step <= most * (1.0 + 1e-9)]
    return next((step for step in allowed if step >= wanted * (1.0 - 1e-9)), allowed[-1])


def kept_by_default(
    length: float, speed_rpm: float | History, save_every: float | None, save_groups: Sequence[Group] | None
) -> dict[str, Any]:
    """``save_every`` and ``save_groups`` of a run, by default where they are not given.

    Parameters
    ----------
    length : float
        Length of the run (s).
    speed_rpm : float or History
        Speed of the shaft (rpm).
    save_every : float, optional
        Time between records (s), as given.
    save_groups : sequence of str, optional
        Groups of quantities, as given.
    """
    every = interval(length, speed_rpm) if save_every is None else save_every
    if save_groups is not None:
        # what is no sequence is refused where options are checked
        groups = tuple(save_groups) if isinstance(save_groups, Iterable) else save_groups
        return {"save_every": every, "save_groups": groups}
    many = save_every is None and length / every > MANY * (1.0 + 1e-9)
    return {"save_every": every, "save_groups": tuple(group for group in GROUPS if not (many and group in DETAILS))}


def compression(save_every: float) -> str | None:
    """How the datasets of a result file are compressed."""
    return "gzip" if save_every >= COMPRESSED * (1.0 - 1e-9) else None


def said(save_every: float, groups: Sequence[str]) -> str:
    """What is kept, in words; what is left out is named."""
    left = [group for group in GROUPS if group not in groups and group != "time"]
    words = f"a record every {1e3 * save_every:g} ms of bearing time"
    return words + (f", without the groups {', '.join(left)}" if left else ", all groups")
