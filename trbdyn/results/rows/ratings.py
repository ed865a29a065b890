"""Lives and safety of the engineer's sheet, of the whole run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from trbdyn.results.number import Number, Place, Seen

if TYPE_CHECKING:
    from trbdyn.standards.sheet import Rating

IN_SHEET: Final = {"basic_life_hours": "life_hours"}
"""Names in the sheet where they are other ones."""


def of_sheet(sheet: Rating | None, name: str) -> Any:
    """The number of a sheet that a summary has by a name."""
    return None if sheet is None else getattr(sheet, IN_SHEET.get(name, name))


def _row(name: str, words: str, unit: str, meaning: str, *shown: Place, source: str = "ISO 281:2007") -> Number:
    def value(seen: Seen) -> Any:
        return of_sheet(seen.sheet, name)

    kind: Any = "life" if unit == "h" else "largest"
    return Number(name, words, unit, meaning, value, kind, "run", shown=frozenset(shown), source=source)


RATINGS: Final = (
    _row(
        "equivalent_load",
        "equivalent dynamic load P (ISO 281)",
        "N",
        "The radial load that would wear the bearing out as fast, by the factors of the catalogue.",
    ),
    _row(
        "basic_life_hours",
        "basic rating life L10h (ISO 281)",
        "h",
        "Nine of ten bearings last so long, by the catalogue's rating alone.",
        "report",
    ),
    _row(
        "modified_life_hours",
        "modified rating life Lnmh (ISO 281)",
        "h",
        "The same with film and cleanliness of the oil; trb.rating says what is assumed.",
    ),
    _row(
        "reference_life_hours",
        "basic reference rating life L10rh (ISO 16281)",
        "h",
        "The same as the basic life, from the loads along each roller: exponent 4, no allowance for edges.",
        source="ISO/TS 16281:2008",
    ),
    _row(
        "modified_reference_life_hours",
        "modified reference rating life Lnmrh (ISO 16281)",
        "h",
        "The reference life with lubrication, cleanliness and reliability taken into account.",
        "report",
        source="ISO/TS 16281:2008",
    ),
    _row(
        "axial_load_left_out",
        "axial load that no life counts",
        "N",
        "It acts on ribs, which ISO 281 does not rate: give the maker's e and Y, see trb.rating.",
    ),
    _row(
        "permissible_axial_load",
        "axial load that ribs carry for long",
        "N",
        "By heat and strength of the ribs, a law of a maker: see trb.rating.",
        source="trb.rating",
    ),
    _row(
        "smallest_load",
        "smallest load, so that rollers roll",
        "N",
        "Below this load rollers may slide instead of rolling.",
        source="trb.rating",
    ),
    _row(
        "speed_over_limit",
        "speed over the catalogue's limiting speed",
        "",
        "Above 1 the bearing turns faster than its catalogue allows.",
        source="trb.rating",
    ),
    _row(
        "static_safety",
        "static safety C0/P0 (ISO 76)",
        "",
        "Static rating over static load: below 1 the raceways keep dents, normal operation requires 1.5 (ISO 76).",
        "report",
        source="ISO 76:2006",
    ),
    _row(
        "viscosity_ratio",
        "viscosity ratio kappa (ISO 281)",
        "",
        "Viscosity over the one that this bearing needs at its speed: below 1 surfaces touch, 1 to 4 is good.",
    ),
)
"""Rows of the sheet."""
