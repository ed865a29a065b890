"""How bearings are called: what of a designation is the bearing, and what kind it is where it is none of this package's."""

from __future__ import annotations

import re
from typing import Final

_PREFIX: Final = re.compile(r"^(?:HR|4T-?|H-E|H-|ET-|E)(?=\d{5})")
_SUFFIX: Final = re.compile(r"(?<=\d{5})(?:-?(?:XU|X|A|JR|J2?|U|Q|P[056]|XL|/Q|/P[056]))*$")
_CYLINDER: Final = re.compile(
    r"^(NUP|NU|NJ|N)-?(\d{3,4})[-/.]?"
    r"(E?)[-/.]?(?:(?:C|CP|CJ|CM\w{0,2}|CPH\w?|T2?|T7|M\w?|W|G15?|XL|TVP\d?|M1?A?|J\d{0,2}|P\w?|PH|W|C[2-5]|P[456]|VA\d+|K)[-/.]?)*$"
)
"""Type and number of a cylindrical bearing, whether it is of the reinforced design E, letters of cage, clearance and maker."""
_GOST: Final = (
    (re.compile(r"^7([23])(\d\d)[AА]\w{0,2}$"), r"30\1\2"),
    (re.compile(r"^7([56])(\d\d)[AА]?\w{0,2}$"), None),
    (re.compile(r"^273(\d\d)[AА]?\w{0,2}$"), r"313\1"),
    (re.compile(r"^20071(\d\d)[AА]?\w{0,2}$"), r"320\1"),
    (re.compile(r"^20079(\d\d)[AА]?\w{0,2}$"), r"329\1"),
    (re.compile(r"^30071(\d\d)[AА]?\w{0,2}$"), r"330\1"),
    (re.compile(r"^30077(\d\d)[AА]?\w{0,2}$"), r"331\1"),
    (re.compile(r"^30072(\d\d)[AА]?\w{0,2}$"), r"332\1"),
    (re.compile(r"^10273(\d\d)[AА]?\w{0,2}$"), r"313\1"),
)
"""Designations of GOST 27365 and 333, with the A of their present design in Latin or Cyrillic, and those of ISO 355."""
_KINDS: Final = (
    (r"^(?:6\d|16)\d{2,3}(?!\d)", "a deep groove ball bearing"),
    (r"^7[23]\d\d$", "an angular contact ball bearing of ISO; with an A, as 7208A, the tapered bearing of GOST"),
    (r"^7\d{3}(?!\d)", "an angular contact ball bearing"),
    (r"^3[23]\d\d(?!\d)", "a double-row angular contact ball bearing"),
    (r"^(?:1[0-4]\d\d|2[23]\d\d|1[01]\d)(?!\d)", "a self-aligning ball bearing"),
    (r"^(?:213|22[23]|23[01289]|24[01])\d\d(?!\d)", "a spherical roller bearing"),
    (r"^(?:NNU|NN|NNF|NNCF|SL0)-?\d", "a cylindrical bearing of two rows"),
    (r"^(?:NCF|NJG|NUB|NH|NF|RNU|SL1)-?\d", "a cylindrical bearing of a type that is not simulated here"),
    (r"^(?:HK|BK|NK|NKI|NKIS|NA|RNA|K)-?\d", "a needle roller bearing"),
    (r"^5[123]\d{3}(?!\d)", "a thrust ball bearing"),
    (r"^(?:8[179]|29[234])\d{2,3}(?!\d)", "a thrust roller bearing"),
)
"""Beginnings of designations of other kinds of bearings (ISO 15, ISO 104, makers' catalogues)."""


def plain_tapered(name: str) -> str:
    """A metric designation without letters of a maker that change neither size nor angle; by ISO 355 where it is one of GOST."""
    for pattern, put in _GOST:
        found = pattern.match(name)
        if found:
            # 75.. and 76.. of GOST are the wide series 322 and 323
            return {"5": "322", "6": "323"}[found[1]] + found[2] if put is None else found.expand(put)
    return _SUFFIX.sub("", _PREFIX.sub("", name))


def cylinder(name: str) -> tuple[str, str, bool] | None:
    """Type and number of a cylindrical bearing, and whether it is named as the reinforced design E; None if it is none."""
    found = _CYLINDER.match(name)
    return (found[1], found[2], bool(found[3])) if found else None


def other_kind(name: str) -> str | None:
    """What kind of bearing a designation is, where it is none that this package simulates."""
    return next((words for pattern, words in _KINDS if re.match(pattern, name)), None)
