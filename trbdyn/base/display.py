"""Units in which numbers are shown to people: those of the field, by the unit in SI that a number has in Python.

Sheets, summaries, reports, the page, pictures and messages of errors take them from this one table.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from typing import Final

Step = tuple[float, float, str]

DISPLAYED: Final[Mapping[str, tuple[Step, ...]]] = {
    "N": ((1e4, 1e-3, "kN"), (0.0, 1.0, "N")),
    "Pa": ((1e9, 1e-9, "GPa"), (0.0, 1e-6, "MPa")),
    "m": ((1e-3, 1e3, "mm"), (0.0, 1e6, "µm")),
    "rad": ((0.0, 1e3, "mrad"),),
    "s": ((1.0, 1.0, "s"), (0.0, 1e3, "ms")),
    "N m": ((1e3, 1e-3, "kN m"), (0.1, 1.0, "N m"), (0.0, 1e3, "N mm")),
    "W": ((1e4, 1e-3, "kW"), (0.0, 1.0, "W")),
    "J": ((1.0, 1.0, "J"), (0.0, 1e3, "mJ")),
    "kg": ((1.0, 1.0, "kg"), (0.0, 1e3, "g")),
    "kg m2": ((1.0, 1.0, "kg m2"), (0.0, 1e6, "kg mm2")),
    "N/m": ((0.0, 1e-6, "N/µm"),),
    "N/rad": ((0.0, 1e-3, "N/mrad"),),
    "N m/m": ((0.0, 1e-3, "N m/mm"),),
    "N m/rad": ((0.0, 1e-3, "N m/mrad"),),
    "Pa s": ((0.0, 1e3, "mPa s"),),
    "1/Pa": ((0.0, 1e9, "1/GPa"),),
}
"""Of each unit in SI: from which size on (in SI), by what factor, and the unit that is shown."""
LARGEST_PLAIN: Final = 1e7
SMALLEST_PLAIN: Final = 1e-4
"""Sizes between which a number is written without a power of ten."""


def step_of(unit: str, values: Iterable[float]) -> tuple[float, str]:
    """Factor and unit in which numbers of one kind are shown, by the largest of them."""
    finite = [abs(value) for value in values if math.isfinite(value)]
    largest = max(finite, default=0.0) * (1.0 + 1e-12)
    return next(((factor, name) for least, factor, name in DISPLAYED.get(unit, ()) if largest >= least), (1.0, unit))


def plain(value: float, digits: int = 4) -> str:
    """A number with so many digits, without a power of ten where it has a usual size: ``286000``, ``0.00123``."""
    text = f"{value:.{digits}g}"
    if "e" not in text or not SMALLEST_PLAIN <= abs(value) < LARGEST_PLAIN:
        return text
    return f"{float(text):.0f}" if abs(value) >= 1.0 else f"{float(text):.{digits + 4}f}".rstrip("0")


def displayed(value: float, unit: str, digits: int = 4, *, like: float | None = None) -> tuple[str, str]:
    """A number and its unit as they are shown, of a number in SI; in the unit of another number of its kind with `like`.

    >>> displayed(286000.0, "N"), displayed(1.2106e9, "Pa"), displayed(0.0123, "rad")
    (('286', 'kN'), ('1.211', 'GPa'), ('12.3', 'mrad'))
    """
    factor, name = step_of(unit, [value if like is None else like])
    return plain(factor * value, digits), name


def amount(value: float, unit: str, digits: int = 4, *, like: float | None = None) -> str:
    """A number in SI with its unit, as `displayed` gives both.

    >>> amount(0.0123, "N m")
    '12.3 N mm'
    """
    return " ".join(displayed(value, unit, digits, like=like))


_NUMBER: Final = r"[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?"
_COMPARED: Final = re.compile(rf"(must be (?:>=|<=|>|<|from|at least|at most) )({_NUMBER})(?: to ({_NUMBER}))?")


def in_unit(text: str, si: str, factor: float, name: str) -> str:
    """What is allowed, as an error says it of a number in SI, in a unit that is `factor` of SI's: ``must be from 0.001 to 2 (m)``
    gives ``must be from 1 to 2000 mm``. Limits at the beginning and numbers with their unit behind are told in this unit;
    examples in SI behind the unit in brackets are left out.
    """
    head, mark, tail = text.partition(f" ({si})")
    if mark and re.match(r": .*\d", tail):
        tail = ""
    found = _COMPARED.match(head) if mark else None
    if found:
        low, high = (None if one is None else plain(float(one) / factor, 6) for one in found.groups()[1:])
        said = f"{found[1]}{low}{f' to {high}' if high is not None else ''} {name}{head[found.end() :]}{tail}"
    else:
        said = f"{head} ({name}){tail}" if mark else head
    return said if name == si else amounts(said, si, factor, name)


def amounts(text: str, si: str, factor: float, name: str) -> str:
    """A text whose numbers with a unit of SI behind them are told in a unit that is `factor` of it."""
    found = re.compile(rf"(?<![\w.])({_NUMBER}) {re.escape(si)}(?![\w/])")
    return found.sub(lambda one: f"{plain(float(one[1]) / factor, 6)} {name}", text)
