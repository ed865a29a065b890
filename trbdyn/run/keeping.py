"""What a run keeps if nobody says so: every quantity 32 times a turn of the shaft, closer in short runs, less of it in long ones.

A record of all quantities of a bearing with 12 rollers takes 2.7 kB in a file (its numbers are compressed), so a turn takes
less than 0.1 MB. Shorter intervals are for runs that would have fewer than 200 records otherwise. Peaks are those of all steps
at any interval. Beyond 20 000 records the groups contacts, outer_ribs and pocket are left out; the peaks and means of their loads
are in the group peaks. What is given explicitly is kept as it is given.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Final

from trbdyn.model.motion import History, values_of
from trbdyn.results.fields import contacts
from trbdyn.run.options import GROUPS, Group

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene
    from trbdyn.results.fields import Field

A_TURN: Final = 32
"""Records a turn of the shaft at its highest speed."""
RECORDS: Final = 200
"""Records that a short run has at least, where `SHORTEST` allows it."""
SHORTEST: Final = 1e-4
"""Shortest default interval of records (s)."""
LONGEST: Final = 1e-2
"""Longest default interval (s), for slow shafts."""
RESTING: Final = 1e-3
"""Default interval (s) where the shaft rests."""
MANY: Final = 20_000
"""Records beyond which the groups `DETAILS` are left out by default."""
DETAILS: Final[tuple[Group, ...]] = ("contacts", "outer_ribs", "pocket")

OPTIONAL: Final[tuple[Group, ...]] = ("housing", "outer_ribs")
"""Groups of what few bearings have, and which are kept there by default: of a housing that moves, of ribs of the outer ring."""


def groups_of(scenes: Iterable[Scene]) -> tuple[Group, ...]:
    """Those of the groups `OPTIONAL` that one scene at least has."""
    has = [{"housing": scene.housing is not None, "outer_ribs": scene.bearing.is_cylindrical} for scene in scenes]
    return tuple(group for group in OPTIONAL if any(there[group] for there in has))


def absent(scene: Scene, *, moves: bool) -> tuple[str, ...]:
    """Names of fields, and beginnings of names, of what a scene has switched off: they would be zero, and are not kept.

    `moves` says whether a ring of the bearing moves by itself, with a shaft or with a housing.
    """
    effects = scene.effects
    pockets = effects.has_pockets
    rolling = effects.films and effects.rolling_resistance
    slides = effects.lubrication != "full_film" or effects.traction != "none"
    acts: tuple[tuple[bool, tuple[str, ...], tuple[str, ...]], ...] = (
        (effects.gravity, ("work_gravity",), ()),
        (pockets, ("pocket_",), ()),
        (pockets and (slides or effects.pocket_film > 0.0), ("pocket_friction",), ()),
        (pockets and slides, (), ("pocket",)),
        (effects.films, _films(), ()),
        (slides, ("inner_torque_traction", "rib_friction", "front_rib_friction"), ("traction_outer", "traction_inner")),
        (rolling, ("inner_torque_rolling",), ("rolling",)),
        (rolling and effects.rolling_pressure_force, (), ("rolling_pressure",)),
        (effects.back_rib, ("rib_", "outer_rib_", "inner_torque_rib"), ()),
        (effects.front_rib, ("front_rib_", "outer_front_rib_", "inner_torque_front_rib"), ()),
        (effects.back_rib and slides, (), ("rib",)),
        (effects.front_rib and slides, (), ("front_rib",)),
        (effects.damping != "off", (), ("damping",)),
        (effects.guidance != "rollers", ("land_", "inner_torque_land"), ("land", "land_film")),
        (effects.oil_fill > 0.0, (), ("drag",)),
        (effects.pocket_film > 0.0, (), ("pocket_film",)),
        (moves, (), ("support",)),
        (scene.elastic_cage is not None, (), ("vibration",)),
    )
    off = [name for on, names, _ in acts if not on for name in names]
    return (*off, *(f"{kind}_{name}" for on, _, lost in acts if not on for name in lost for kind in ("power", "loss")))


def _films() -> tuple[str, ...]:
    """Fields and peaks of the films of all contacts."""
    quantities = ("film", "film_parameter", "film_parameter_min", "film_parameter_min_time")
    return tuple(f"{side}_{quantity}" for side in contacts() for quantity in quantities)


def there(fields: Iterable[Field], off: Sequence[str]) -> tuple[Field, ...]:
    """Fields but those whose names are, or begin with, what is `absent`."""
    starts = tuple(name for name in off if name.endswith("_"))
    return tuple(field for field in fields if field.name not in off and not field.name.startswith(starts))


def interval(length: float, speed_rpm: float | History) -> float:
    """Default interval of records (s) of a run of some length (s): a 32nd of a turn, or a half, a quarter and so on of that."""
    fastest = max(map(abs, values_of(speed_rpm))) / 60.0
    every = min(LONGEST, 1.0 / (A_TURN * fastest)) if fastest > 0.0 else RESTING
    while every > length / RECORDS and every > SHORTEST:
        every /= 2.0
    return max(every, SHORTEST)


def kept_by_default(
    length: float,
    speed_rpm: float | History,
    save_every: float | None,
    save_groups: Sequence[Group] | None,
    *,
    optional: Sequence[Group] = (),
) -> dict[str, Any]:
    """``save_every`` and ``save_groups`` of a run of some length (s), by default where they are not given; `optional` are those
    of few bearings of which there is something to keep (`groups_of`).
    """
    every = interval(length, speed_rpm) if save_every is None else save_every
    if save_groups is not None:
        # what is no sequence is refused where options are checked
        groups = tuple(save_groups) if isinstance(save_groups, Iterable) else save_groups
        return {"save_every": every, "save_groups": groups}
    many = save_every is None and length / every > MANY * (1.0 + 1e-9)
    left = (*(DETAILS if many else ()), *(group for group in OPTIONAL if group not in optional))
    return {"save_every": every, "save_groups": tuple(group for group in GROUPS if group not in left)}


def said(save_every: float, groups: Sequence[str]) -> str:
    """What is kept, in words; what is left out is named."""
    left = [group for group in GROUPS if group not in groups and group not in ("time", *OPTIONAL)]
    words = f"a record every {1e3 * save_every:.4g} ms of bearing time"
    return words + (f", without the groups {', '.join(left)}" if left else ", all groups")
