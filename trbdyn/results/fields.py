"""The table of recorded quantities, seen from Python.

The core owns the table (``csrc/motion/fields.h``); here a row becomes a `Field`, and a kind becomes a shape and the names of
its dimensions. Files, plots and results all take their units and texts from it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

from trbdyn import _core
from trbdyn.errors import InputError, unknown_name

Layout = Sequence[tuple[str, int, tuple[int, ...]]]
"""Places of the fields in a record: (name, offset, shape) each."""

DIMENSIONS: dict[str, tuple[str, ...]] = {
    "scalar": (),
    "vec2": ("xy",),
    "vec3": ("xyz",),
    "quaternion": ("wxyz",),
    "roller": ("roller",),
    "roller_vec3": ("roller", "xyz"),
    "roller_quat": ("roller", "wxyz"),
    "pocket_face": ("roller", "slot"),
    "mode": ("mode",),
}
"""Names of the dimensions of each kind of field, without time."""

ALWAYS: Final = ("outer", "inner", "rib")
"""Contacts that are shown whether they carry a load or not."""

_FIXED_SIZES = {"xy": 2, "xyz": 3, "wxyz": 4}


@dataclass(frozen=True, slots=True)
class Field:
    """One recorded quantity.

    Attributes
    ----------
    name : str
        Name of the field: an attribute of `Result` and a dataset of the file.
    group : str
        Group by which output is selected, such as ``"cage"`` or ``"contacts"``.
    kind : str
        Kind of its shape, a key of `DIMENSIONS`.
    unit : str
        SI unit; ``"1"`` for pure numbers.
    text : str
        What it is.
    """

    name: str
    group: str
    kind: str
    unit: str
    text: str

    def __post_init__(self) -> None:
        if self.kind not in DIMENSIONS:
            raise InputError.of(("fields", self.name, "kind"), self.kind, f"must be one of {', '.join(DIMENSIONS)}")

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the dimensions of one record of this field; time comes before them."""
        return DIMENSIONS[self.kind]

    def shape(self, n_rollers: int, n_slots: int, n_modes: int = 0) -> tuple[int, ...]:
        """Shape of one record of this field: ``()`` for a scalar, ``(Z, 3)`` for a vector a roller, and so on."""
        sizes = _FIXED_SIZES | {"roller": n_rollers, "slot": n_slots, "mode": n_modes}
        return tuple(sizes[dim] for dim in self.dims)


def from_rows(rows: Iterable[tuple[str, str, str, str, str]]) -> tuple[Field, ...]:
    """Fields from rows (name, group, kind, unit, text), as the core lists them."""
    return tuple(Field(*row) for row in rows)


@cache
def table() -> tuple[Field, ...]:
    """Every recorded quantity of the core, in the order of the record."""
    return from_rows(_core.field_table())


@cache
def contacts() -> dict[str, str]:
    """Contacts of the rollers with the rings, by the beginning of their fields' names, and where each is: "outer raceway"."""
    start = "normal load at the "
    found = {
        field.name.removesuffix("_load"): field.text.removeprefix(start)
        for field in table()
        if field.text.startswith(start)
    }
    assert set(ALWAYS) <= set(found), "texts of loads in the table of fields begin in another way"
    return found


def carrying(values: Any, suffix: str = "_load") -> list[str]:
    """Contacts that have a load in a result or peaks, but for ribs where it is zero throughout; those of `ALWAYS` are kept."""
    found = ((side, side + suffix) for side in contacts())
    return [side for side, name in found if name in values and (side in ALWAYS or values[name].any())]


def groups(fields: Iterable[Field]) -> tuple[str, ...]:
    """Names of the groups, in the order in which they first appear."""
    return tuple(dict.fromkeys(field.group for field in fields))


def select(fields: Iterable[Field], chosen: Iterable[str] | None) -> tuple[Field, ...]:
    """Fields of the chosen groups (all: None) in their old order; those of the group ``"time"`` are always kept. An unknown
    group is an InputError.
    """
    fields = tuple(fields)
    if chosen is None:
        return fields
    if isinstance(chosen, str):
        raise InputError.of("groups", chosen, "must be a sequence of names")
    wanted, known = list(chosen), groups(fields)
    for name in wanted:
        if name not in known:
            raise InputError.of("groups", name, unknown_name(name, known))
    return tuple(field for field in fields if field.group == "time" or field.group in wanted)
