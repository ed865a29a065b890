"""Units in which numbers are typed and shown: those of a catalogue page beside SI."""

from __future__ import annotations

import math
import re
from decimal import Decimal, InvalidOperation
from typing import Final

UNITS: Final[dict[str, dict[str, str]]] = {
    "m": {"mm": "0.001", "inch": "0.0254", "m": "1", "µm": "0.000001"},
    "N": {"N": "1", "kN": "1000", "lbf": "4.4482216152605"},
    "deg": {"deg": "1", "rad": str(180.0 / math.pi)},
    "rad": {"mrad": "0.001", "rad": "1", "deg": str(math.pi / 180.0)},
    "kg": {"kg": "1", "g": "0.001", "lb": "0.45359237"},
    "Pa": {"MPa": "1000000", "GPa": "1000000000", "Pa": "1"},
    "N m": {"N m": "1", "N mm": "0.001"},
    "kg m2": {"kg mm2": "0.000001", "kg m2": "1"},
    "kg m": {"g mm": "0.000001", "kg m": "1"},
    "s": {"s": "1", "ms": "0.001"},
}
"""Units of each quantity, by its unit in SI: how large each is; the first one is used where none is chosen."""
CHOSEN: Final = {"m": ("mm", "inch", "m"), "N": ("N", "kN", "lbf"), "deg": ("deg", "rad")}
"""Units that the page lets choose for all numbers of a kind."""
SAME: Final = {
    "in": "inch",
    '"': "inch",
    "um": "µm",
    "μm": "µm",
    "°": "deg",
    "degree": "deg",
    "degrees": "deg",
    "inches": "inch",
}
"""Other ways to write a unit."""
_NUMBER: Final = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
LONGEST: Final = 40
"""Most characters of a number."""


def usual(si: str, chosen: dict[str, str]) -> str:
    """The unit in which a quantity is shown: the chosen one, or the usual one of its kind."""
    return chosen.get(si) or next(iter(UNITS.get(si, {si: "1"})))


def read(text: str, si: str, unit: str) -> float:
    """A number in SI units out of what was typed, for instance ``40`` or ``1.5 inch``; in `unit` where none is typed.

    A `ValueError` says what is allowed.
    """
    sizes = UNITS.get(si, {si: "1"})
    found = _NUMBER.fullmatch(text)
    if found is None or len(text) > LONGEST or found[2].startswith(","):
        comma = ", with a point in place of the comma" if "," in text else ""
        raise ValueError(f"must be a number{comma}, for instance 12.5{'' if si in ('', '1') else f' {unit}'}")
    typed = SAME.get(found[2], found[2]) or unit
    if typed not in sizes:
        raise ValueError(
            f"must be in {' or '.join(sizes)}, not in {typed}" if sizes.keys() - {"", "1"} else "has no unit"
        )
    try:
        return float(Decimal(found[1]) * Decimal(sizes[typed]))
    except (InvalidOperation, OverflowError):
        raise ValueError("must be a finite number") from None


def show(value: float, si: str, unit: str, digits: int = 6) -> str:
    """A number of SI units in another unit, with so many digits."""
    return f"{value / float(UNITS.get(si, {si: '1'})[unit]):.{digits}g}"
