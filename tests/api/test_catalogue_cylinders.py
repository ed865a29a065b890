"""Cylindrical bearings from a catalogue page."""

from __future__ import annotations

import math
import warnings
from pathlib import Path
from typing import Any

import pytest

import trbdyn as trb
from trbdyn.model.catalogue_rollers import CYLINDRICAL
from trbdyn.model.ratings import rating_iso76, rating_iso281

ROWS = [
    line.split(",")
    for line in (Path(__file__).parent / "cylindrical_rows.csv").read_text(encoding="utf-8").splitlines()[4:]
]
TYPES = ("NU", "NJ", "NUP", "N")


def page(row: list[str], *more: str) -> dict[str, float]:
    d, outside, width, rating, static, inner, outer = (1e-3 * float(cell) for cell in row[1:])
    known = {"C0": 1e6 * static, "F": inner, "E": outer}
    given = {"bore": d, "outside": outside, "width": width, "C": 1e6 * rating}
    return given | {name: known[name] for name in more}


def sizes(bearing: trb.Bearing) -> dict[str, Any]:
    return {
        "n_rollers": bearing.n_rollers,
        "roller_diameter": bearing.roller.diameter,
        "roller_length": bearing.roller.effective_length,
        "pitch_diameter": bearing.pitch_diameter,
        "contact_angle_deg": 0.0,
    }


@pytest.mark.parametrize(
    "more", [(), ("C0",), ("C0", "F"), ("C0", "E"), ("F",)], ids=lambda names: "-".join(names) or "C"
)
def test_rows_of_catalogues(more: tuple[str, ...]) -> None:
    """What the page tells or not: the true sizes lie in the bands, none is refused or warned of what nobody gave."""
    for row in ROWS[::3]:
        true_sizes_lie_in_the_bands(row, more)


def true_sizes_lie_in_the_bands(row: list[str], more: tuple[str, ...]) -> None:
    whole = page(row, "C0", "F", "E")
    flanges = TYPES[(ROWS.index(row) + len(more)) % 4]
    bearing = trb.Bearing.from_catalogue(**page(row, *more), flanges=flanges, name=row[0])
    assert bearing.is_cylindrical
    assert bearing.ribs.flanges == flanges
    bands = {one.path: one for one in bearing.estimated}
    assert all(one.low <= one.value <= one.high for one in bands.values())
    assert "radial_clearance" in bands
    assert bands["roller.diameter"].low <= 0.5 * (whole["E"] - whole["F"]) <= bands["roller.diameter"].high
    assert bands["pitch_diameter"].low <= 0.5 * (whole["E"] + whole["F"]) <= bands["pitch_diameter"].high
    around = math.pi * bearing.pitch_diameter / bearing.roller.diameter
    assert CYLINDRICAL.fill.low * around - 1.0 < bearing.n_rollers < CYLINDRICAL.fill.high * around
    if "C0" in more:
        assert rating_iso76(**sizes(bearing)) == pytest.approx(whole["C0"], rel=1e-9)
    load = 0.1 * whole["C"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        axial = 0.1 * load if flanges in ("NJ", "NUP") else 0.0
        found = trb.Simulation(trb.Scene(bearing, speed_rpm=1000.0, radial_load=load, axial_load=axial))
    assert found.equilibrium.outer_load.max() > load / bearing.n_rollers


def test_both_raceways_tell_the_rollers() -> None:
    """With F, E and C0 the maker's C is that of ISO 281 within 1 %: sizes that were found have both ratings of the page."""
    for row in ROWS:
        given = page(row, "C0", "F", "E")
        bearing = trb.Bearing.from_catalogue(**given, flanges="NU")
        assert bearing.roller.diameter == pytest.approx(0.5 * (given["E"] - given["F"])), row
        assert bearing.pitch_diameter == pytest.approx(0.5 * (given["E"] + given["F"])), row
        assert rating_iso281(**sizes(bearing)) == pytest.approx(given["C"], rel=0.01), row
        assert {"roller.diameter", "pitch_diameter"}.isdisjoint(one.path for one in bearing.estimated), row


def test_the_shipped_bearing_from_its_page() -> None:
    shipped = trb.cases.bearing_nj210()
    page = {"bore": 0.05, "outside": 0.09, "width": 0.02, "C": 64.4e3, "C0": 69.5e3, "F": 0.0595, "E": 0.0815}
    found = trb.Bearing.from_catalogue(**page, flanges="NJ", n_rollers=16, radial_clearance=20e-6)
    assert found.roller.effective_length == pytest.approx(shipped.roller.effective_length, rel=0.01)
    assert (found.roller.diameter, found.radial_clearance) == (pytest.approx(11e-3), 20e-6)
    again = trb.Bearing.from_dict(found.to_dict())
    assert again == found
    loads = {"speed_rpm": 3000.0, "axial_load": 500.0, "radial_load": 5000.0}
    pressures = [trb.Simulation(trb.Scene(one, **loads)).equilibrium.outer_load.max() for one in (found, shipped)]
    assert pressures[0] == pytest.approx(pressures[1], rel=0.01)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"flanges": "NX"}, r"one of NU, NJ, NUP, N.*howto/cylindrical"),
        ({"contact_angle_deg": 10.0}, r"a cylindrical bearing has none .docs/howto/cylindrical.md"),
        ({"cup_width": 0.015}, "a cylindrical bearing has none"),
        ({"flanges": None, "e": 0.37}, r"F = 0\.0595 : must not be given without flanges.*howto/cylindrical"),
        ({"F": 0.03}, r"F = 0\.03 : must be from 0\.05 to 0\.07"),
        ({"F": None, "E": 0.1}, r"E = 0\.1 : must be from 0\.07 to 0\.09"),
        ({"E": 0.0815, "roller_diameter": 0.012}, r"roller_diameter = 0\.012 : must be 0\.011, as E and F say"),
        ({"C0": 76.5}, "76.5 kN are 76500 N"),
        ({"C": 38e3, "C0": 30e3}, r"C0 = 30000(\.0)? : must be from"),
        ({"C": 30e3, "C0": 76.5e3}, r"C = 30000(\.0)? : must be from"),
        ({"n_rollers": 25, "F": None}, "n_rollers = 25 : must be from"),
        ({"B": 0.02}, "of a cylindrical bearing width is B"),
    ],
)
def test_what_a_page_can_hardly_mean(changes: dict[str, Any], said: str) -> None:
    given = {"flanges": "NU", "bore": 0.05, "outside": 0.09, "width": 0.02, "C": 69e3, "C0": 76.5e3, "F": 0.0595}
    with pytest.raises(trb.InputError, match=said):
        trb.Bearing.from_catalogue(**given | changes)


CATALOGUE = [
    line.split(",")
    for line in (Path(__file__).parent / "cylindrical_catalogue.csv").read_text(encoding="utf-8").splitlines()[4:]
]
"""Rows of two makers: series 10, 2, 22, 3, 23 and others, types with and without E."""


def refused(rows: list[list[str]]) -> list[str]:
    """Rows of which a page with C, with C0 or with the raceway is refused; bands hold the values of the others."""
    found = []
    for name, d, outside, width, rating, static, inner, _ in rows:
        page = {"bore": d, "outside": outside, "width": width}
        whole = {key: 1e-3 * float(value) for key, value in page.items()} | {"C": 1e3 * float(rating)}
        more = {"C0": 1e3 * float(static)} | ({"F": 1e-3 * float(inner)} if inner else {})
        for given in ({}, {"C0": more["C0"]}, more):
            try:
                bearing = trb.Bearing.from_catalogue(**whole, **given, flanges="NU", name=name)
            except trb.InputError as error:
                found.append(f"{name}: {error}")
                continue
            assert all(one.low <= one.value <= one.high for one in bearing.estimated), name
            if "C0" in given:
                assert rating_iso76(**sizes(bearing)) == pytest.approx(given["C0"], rel=1e-9), name
    return found


def test_rows_of_makers_are_taken() -> None:
    """Those that a band of 28 rows refused, and every tenth of the others."""
    once = ("NU1005", "NU1010", "NU1026", "NU203", "NU205", "NU211", "NU304", "NU2204", "NU2307", "NU202EC")
    assert refused([row for row in CATALOGUE if row[0] in once] + CATALOGUE[::10]) == []


@pytest.mark.slow
def test_at_most_one_row_of_a_hundred_is_refused() -> None:
    assert len(CATALOGUE) == 300
    assert len(refused(CATALOGUE)) <= 9


def test_the_series_10() -> None:
    """NU 1010, 80 x 16 mm with F 57.5, C 33.6 and C0 36.8 kN: about 17 rollers of 8 x 6.9 mm; C0 fixes number times length."""
    page = {"bore": 0.05, "outside": 0.08, "width": 0.016, "C": 33.6e3, "C0": 36.8e3, "F": 0.0575}
    bearing = trb.Bearing.from_catalogue(flanges="NU", **page)
    assert abs(bearing.n_rollers - 17) <= 1
    assert bearing.roller.diameter == pytest.approx(8e-3, rel=0.03)
    assert bearing.n_rollers * bearing.roller.effective_length == pytest.approx(17 * 6.9e-3, rel=0.03)
    count = {one.path: one for one in bearing.estimated}["n_rollers"]
    assert count.low <= 17 <= count.high


def test_a_draw_of_uncertain_inputs_can_be_built() -> None:
    bearing = trb.Bearing.from_catalogue(**page(ROWS[6], "C0", "F"), flanges="NU")
    scene = trb.Scene(bearing, speed_rpm=1000.0, radial_load=6900.0)
    options = trb.RunOptions(revolutions=0.02)
    found = trb.uncertainty(scene, samples=8, options=options, quantities=["torque"])
    assert (found.draws, found.refused) == (8, ())
