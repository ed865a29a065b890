"""Limits of shafts and housing bores (ISO 286), of bores and outside diameters of bearings (ISO 492, of inch series of tapered
ones ISO 578), and of the radial clearance of cylindrical bearings (ISO 5753-1); docs/theory/fits.md#tolerances.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from typing import Final, Literal

from trbdyn.errors import InputError

Limits = tuple[float, float]
"""Lower and upper limit (m)."""
BearingClass = Literal["normal", "6", "5", "4", "2", "3", "0", "00"]
"""Classes of ISO 492 (normal, 6, 5, 4) and of ISO 578 (4, 2, 3, 0, 00)."""
Series = Literal["metric", "inch"]

SIZES: Final = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500)
"""Nominal sizes go from above one of these to the next one (mm)."""
GRADES: Final[dict[int, tuple[float, ...]]] = {
    3: (2.5, 2.5, 3, 4, 4, 5, 6, 8, 10, 12, 13, 15),
    4: (4, 4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20),
    5: (5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27),
    6: (8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40),
    7: (12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63),
    8: (18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97),
    9: (30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155),
    10: (48, 58, 70, 84, 100, 120, 140, 160, 185, 210, 230, 250),
}
"""Standard tolerances IT by grade and size (um): ISO 286-1:2010, table 1."""
BELOW: Final[dict[str, tuple[int, ...]]] = {
    "e": (20, 25, 32, 40, 50, 60, 72, 85, 100, 110, 125, 135),
    "f": (10, 13, 16, 20, 25, 30, 36, 43, 50, 56, 62, 68),
    "g": (4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 18, 20),
    "h": (0,) * 12,
}
"""How far below the nominal size the upper limit of a shaft lies, and above it the lower limit of a hole (um): ISO 286-1:2010,
table 4."""
ABOVE: Final[dict[str, tuple[int, ...]]] = {
    "k": (1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5),
    "m": (4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23),
    "n": (8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40),
    "p": (12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68),
}
"""How far above the nominal size the lower limit of a shaft lies (um): ISO 286-1:2010, table 5; k of the grades 4 to 7."""
R_SIZES: Final = (3, 6, 10, 18, 30, 50, 65, 80, 100, 120, 140, 160, 180, 200, 225, 250, 280, 315, 355, 400, 450, 500)
R_ABOVE: Final = (15, 19, 23, 28, 34, 41, 43, 51, 54, 63, 65, 68, 77, 80, 84, 94, 98, 108, 114, 126, 132)
"""The same of r, whose sizes are closer (um)."""
J_SHAFT: Final[dict[int, tuple[int, ...]]] = {
    5: (-2, -2, -3, -4, -5, -7, -9, -11, -13, -16, -18, -20),
    6: (-2, -2, -3, -4, -5, -7, -9, -11, -13, -16, -18, -20),
    7: (-4, -5, -6, -8, -10, -12, -15, -18, -21, -26, -28, -32),
}
"""Lower limit of shafts j by grade (um): ISO 286-1:2010, table 5."""
J_HOLE: Final[dict[int, tuple[int, ...]]] = {
    6: (5, 5, 6, 8, 10, 13, 16, 18, 22, 25, 29, 33),
    7: (6, 8, 10, 12, 14, 18, 22, 26, 30, 36, 39, 43),
    8: (10, 12, 15, 20, 24, 28, 34, 41, 47, 55, 60, 66),
}
"""Upper limit of holes J by grade (um): ISO 286-1:2010, table 3."""
LETTERS: Final = ("e", "f", "g", "h", "j", "js", "k", "m", "n", "p", "r")

BORES: Final[dict[bool, dict[BearingClass, tuple[int, ...]]]] = {
    True: {
        "normal": (12, 12, 12, 15, 20, 25, 30, 35, 40, 45),
        "5": (7, 8, 10, 12, 15, 18, 22, 25, 30, 35),
        "4": (5, 6, 8, 9, 10, 13, 15, 18, 23, 27),
    },
    False: {
        "normal": (8, 10, 12, 15, 20, 25, 30, 35, 40, 45),
        "6": (7, 8, 10, 12, 15, 18, 22, 25, 30, 35),
        "5": (5, 6, 8, 9, 10, 13, 15, 18, 23),
        "4": (4, 5, 6, 7, 8, 10, 12),
    },
}
"""How far below the nominal size the mean bore may lie (um), of tapered (True) and other radial bearings, by class and size from
10 mm on: ISO 492:2014. The upper limit is the nominal size."""
OUTSIDE_SIZES: Final = (18, 30, 50, 80, 120, 150, 180, 250, 315, 400, 500, 630)
OUTSIDES: Final[dict[bool, dict[BearingClass, tuple[int, ...]]]] = {
    True: {
        "normal": (12, 14, 16, 18, 20, 25, 30, 35, 40, 45, 50),
        "5": (8, 9, 11, 13, 15, 18, 20, 25, 28, 33, 38),
        "4": (6, 7, 9, 10, 11, 13, 15, 18, 20, 23, 28),
    },
    False: {
        "normal": (9, 11, 13, 15, 18, 25, 30, 35, 40, 45, 50),
        "6": (8, 9, 11, 13, 15, 18, 20, 25, 28, 33, 38),
        "5": (6, 7, 9, 10, 11, 13, 15, 18, 20, 23, 28),
        "4": (5, 6, 7, 8, 9, 10, 11, 13, 15),
    },
}
"""The same of the mean outside diameter."""

INCH_SIZES: Final = (0.0, 76.2, 266.7, 304.8, 609.6, 914.4)
INCH_BORES: Final[dict[BearingClass, tuple[int, ...]]] = {
    "4": (13, 25, 25, 51, 76),
    "2": (13, 25, 25, 51, 76),
    "3": (13, 13, 13, 25, 38),
    "0": (13, 13, 13, 25, 38),
    "00": (8, 8),
}
"""How far above the nominal size the bore of a tapered bearing of an inch series may lie (um), by class and size; the lower limit
is the nominal size: ISO 578 as the tables of SKF (Tolerances for inch tapered roller bearings) and NTN (Large Bearings, table
3.5) have it. That of class 00 up to 76.2 mm is recalled.
"""
INCH_OUTSIDES: Final[dict[BearingClass, tuple[int, ...]]] = {
    "4": (25, 25, 25, 51, 76),
    "2": (25, 25, 25, 51, 76),
    "3": (13, 13, 13, 25, 38),
    "0": (13, 13, 13, 25, 38),
    "00": (8, 8),
}
"""The same of the outside diameter: the table of SKF; class 00 is recalled."""
_INCH_NAME: Final = re.compile(r"(?!J)[A-Z]{0,4}\d{2,6}[A-Z]{0,3}[/-][A-Z]{0,4}\d{2,6}[A-Z]{0,3}")
_METRIC_NAME: Final = re.compile(r"(?:HR|4T-?|H-E|H-|ET-|E)?[23]\d{4}(?!\d|[/-]\d).*")
WHOLE: Final = 1e-6
"""How far a diameter of a metric series may be off whole millimetres (m)."""

CLEARANCE_SIZES: Final = (24, 30, 40, 50, 65, 80, 100, 120, 140, 160, 180, 200, 225, 250, 280, 315, 355, 400, 450, 500)
CLEARANCES: Final[dict[str, tuple[tuple[int, ...], tuple[int, ...]]]] = {
    "C2": (
        (0, 0, 5, 5, 10, 10, 15, 15, 15, 20, 25, 35, 45, 45, 55, 55, 65, 100, 110, 110),
        (25, 25, 30, 35, 40, 45, 50, 55, 60, 70, 75, 90, 105, 110, 125, 130, 145, 190, 210, 220),
    ),
    "CN": (
        (20, 20, 25, 30, 40, 40, 50, 50, 60, 70, 75, 90, 105, 110, 125, 130, 145, 190, 210, 220),
        (45, 45, 50, 60, 70, 75, 85, 90, 105, 120, 125, 145, 165, 175, 195, 205, 225, 280, 310, 330),
    ),
    "C3": (
        (35, 35, 45, 50, 60, 65, 75, 85, 100, 115, 120, 140, 160, 170, 190, 200, 225, 280, 310, 330),
        (60, 60, 70, 80, 90, 100, 110, 125, 145, 165, 170, 195, 220, 235, 260, 275, 305, 370, 410, 440),
    ),
    "C4": (
        (50, 50, 60, 70, 80, 90, 105, 125, 145, 165, 170, 195, 220, 235, 260, 275, 305, 370, 410, 440),
        (75, 75, 85, 100, 110, 125, 140, 165, 190, 215, 220, 250, 280, 300, 330, 350, 385, 460, 510, 550),
    ),
}
"""Least and largest radial clearance of cylindrical bearings with a cylindrical bore before mounting, by group and bore (um):
ISO 5753-1:2009."""

_CODE: Final = re.compile(r"([A-Za-z]{1,2})(\d{1,2})")


def limits(code: str, size: float, *, field: str = "tolerance") -> Limits:
    """Deviations of a shaft (small letters) or a hole (capital letters) from its nominal size.

    Parameters
    ----------
    code : str
        Tolerance class, as m6 or N7: letters e to r, grades 4 to 10 as far as the standard has them.
    size : float
        Nominal size, above 3 and up to 500 mm (m).
    field : str
        Name of the field in messages.

    Returns
    -------
    tuple of float
        Lower and upper deviation (m).

    Raises
    ------
    InputError
        If the class is unknown, or the size lies outside of the table.

    Notes
    -----
    Source: ISO 286-1:2010, tables 1 to 5, the rules of 4.3.2.5 for holes K to R of fine grades included.

    Examples
    --------
    >>> from trbdyn.model.tolerances import limits
    >>> [round(1e6 * end) for end in limits("m6", 0.050)], [round(1e6 * end) for end in limits("N7", 0.110)]
    ([9, 25], [-45, -10])
    """
    found = _CODE.fullmatch(code)
    letter, grade = (found[1], int(found[2])) if found else ("", 0)
    small = letter.lower()
    hole = letter != small
    known = small in LETTERS and (letter in (small, small.upper())) and 4 <= grade <= 10
    if small == "j":
        known = known and grade in (J_HOLE if hole else J_SHAFT)
    if (small == "k" and not hole) or (small in ("k", "m", "n") and hole):
        known = known and grade <= (8 if hole else 7)
    if not known:
        limit = "must be a tolerance class of ISO 286 such as k5, m6, H7 or N7: a letter from e to r and a grade from 4 to 10"
        raise InputError.of(field, code, limit)
    at = _row(SIZES, size, field)
    wide = GRADES[grade][at]
    if small == "js":
        ends = (-0.5 * wide, 0.5 * wide)
    elif small == "j":
        ends = (
            (J_HOLE[grade][at] - wide, J_HOLE[grade][at]) if hole else (J_SHAFT[grade][at], J_SHAFT[grade][at] + wide)
        )
    elif small in BELOW:
        away = BELOW[small][at]
        ends = (away, away + wide) if hole else (-away - wide, -away)
    else:
        above = R_ABOVE[_row(R_SIZES, size, field)] if small == "r" else ABOVE[small][at]
        if not hole:
            ends = (above, above + wide)
        else:
            fine = grade <= (7 if small in ("p", "r") else 8)
            top = (wide - GRADES[grade - 1][at] if fine else 0) - above
            if letter == "M" and grade == 6 and SIZES[at] == 250:
                top = -9  # the one exception that ISO 286-1 makes
            ends = (top - wide, top)
    return 1e-6 * ends[0], 1e-6 * ends[1]


def series_of(name: str, bore: float, outside: float) -> tuple[Series, str]:
    """The series of a tapered bearing, and what tells it: its designation, or its bore and outside diameter (m).

    Cone and cup, as LM67048/LM67010, are an inch series, whose designations with a J have metric sizes; five digits from 20000 on
    are a metric one. Other names tell nothing: both diameters of a metric series are whole millimetres.

    Examples
    --------
    >>> from trbdyn.model.tolerances import series_of
    >>> series_of("LM67048/LM67010", 0.03175, 0.059131), series_of("hub", 0.050, 0.110)
    (('inch', 'its designation LM67048/LM67010'), ('metric', 'its diameters 50 and 110 mm'))
    """
    asked = name.upper().replace(" ", "")
    if _INCH_NAME.fullmatch(asked):
        return "inch", f"its designation {name}"
    if _METRIC_NAME.fullmatch(asked):
        return "metric", f"its designation {name}"
    off = max(abs(size - 1e-3 * round(1e3 * size)) for size in (bore, outside))
    return "metric" if off <= WHOLE else "inch", f"its diameters {1e3 * bore:.6g} and {1e3 * outside:.6g} mm"


def bore_limits(size: float, *, tapered: bool, accuracy: BearingClass = "normal", series: Series = "metric") -> Limits:
    """Deviations of a bearing's bore from its nominal size (m): ISO 492:2014, mean in a plane; of an inch series of tapered
    bearings ISO 578, whose class 4 is the normal one.

    Raises
    ------
    InputError
        If the standard has no such class, or the size lies outside of the table.
    """
    if tapered and series == "inch":
        return _of_inch(INCH_BORES, size, accuracy, "bore")
    return _of_bearing(BORES[tapered], SIZES[2:], size, accuracy, "bore")


def outside_limits(
    size: float, *, tapered: bool, accuracy: BearingClass = "normal", series: Series = "metric"
) -> Limits:
    """Deviations of a bearing's outside diameter from its nominal size (m), as `bore_limits`.

    Raises
    ------
    InputError
        If the standard has no such class, or the size lies outside of the table.
    """
    if tapered and series == "inch":
        return _of_inch(INCH_OUTSIDES, size, accuracy, "outside")
    return _of_bearing(OUTSIDES[tapered], OUTSIDE_SIZES, size, accuracy, "outside")


def standard_of(*, tapered: bool, accuracy: BearingClass, series: Series) -> str:
    """Standard and class of the tolerances of a bearing, in words."""
    if tapered and series == "inch":
        return f"ISO 578, class {_inch_class(accuracy)}"
    return "ISO 492, class normal" if accuracy == "normal" else f"ISO 492, class {accuracy}"


def clearance_limits(group: str, bore: float) -> Limits:
    """Least and largest radial clearance of a cylindrical bearing before mounting (m); ISO 5753-1:2009.

    Raises
    ------
    InputError
        If the group is unknown, or the bore lies outside of the table.
    """
    if group not in CLEARANCES:
        raise InputError.of("clearance", group, f"must be one of {', '.join(CLEARANCES)}, or two limits (m)")
    at = _row((0, *CLEARANCE_SIZES), bore, "bore")
    least, most = CLEARANCES[group]
    return 1e-6 * least[at], 1e-6 * most[at]


def _inch_class(accuracy: BearingClass) -> BearingClass:
    """The normal class of inch series is 4."""
    return "4" if accuracy == "normal" else accuracy


def _of_inch(classes: dict[BearingClass, tuple[int, ...]], size: float, accuracy: BearingClass, field: str) -> Limits:
    if (named := _inch_class(accuracy)) not in classes:
        limit = f"must be normal, which is 4, or one of {', '.join(classes)}: ISO 578 has no other for inch series"
        raise InputError.of("accuracy", accuracy, limit)
    widths = classes[named]
    return 0.0, 1e-6 * widths[_row(INCH_SIZES[: len(widths) + 1], size, field)]


def _of_bearing(
    classes: dict[BearingClass, tuple[int, ...]],
    sizes: tuple[int, ...],
    size: float,
    accuracy: BearingClass,
    field: str,
) -> Limits:
    if accuracy not in classes:
        limit = (
            f"must be one of {', '.join(classes)}: ISO 492 has no other here; 2, 3, 0 and 00 are classes of inch series"
        )
        raise InputError.of("accuracy", accuracy, limit)
    widths = classes[accuracy]
    return -1e-6 * widths[_row(sizes[: len(widths) + 1], size, field)], 0.0


def _row(sizes: tuple[float, ...], size: float, field: str) -> int:
    """Which row of a table a size (m) lies in: above one of its sizes (mm) up to the next one."""
    millimetres = round(1e3 * size, 9)
    if not sizes[0] < millimetres <= sizes[-1]:
        limit = (
            f"must be above {1e-3 * sizes[0]:g} and at most {1e-3 * sizes[-1]:g}, the sizes of the standard's table (m)"
        )
        raise InputError.of(field, size, limit)
    return bisect_left(sizes, millimetres) - 1
