"""Bearings of a gear unit from a REXS file, and their ratings back into it."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

import trbdyn as trb

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
A = '<attribute id="{}" unit="{}">{}</attribute>'
MODEL = f"""<model applicationId="other" applicationVersion="1" date="2024-01-01T00:00:00+01:00" version="1.4">
<relations><relation id="1" type="side"><ref hint="rolling_bearing" id="34" role="assembly"/>
<ref hint="shaft" id="12" role="inner_part"/><ref hint="gear_casing" id="2" role="outer_part"/></relation></relations>
<components>
<component id="1" type="gear_unit"/><component id="2" type="gear_casing"/><component id="12" type="shaft"/>
<component id="34" name="A" type="rolling_bearing_with_catalog_geometry">{A.format("catalogue_designation", "", 33014)}
{A.format("bearing_type", "", "radial_tapered_roller_bearing")}{A.format("axial_force_absorption", "", "negative")}</component>
<component id="33" type="rolling_bearing_with_catalog_geometry">{A.format("bearing_type", "", "deep_groove_ball_bearing")}
</component>
<component id="56" name="Lubricant" type="lubricant">{A.format("viscosity_at_40_degree_celsius", "mm^2 / s", 100)}
{A.format("viscosity_at_100_degree_celsius", "mm^2 / s", 11)}
{A.format("density_at_15_degree_celsius", "kg / dm^3", 0.88)}</component>
</components><load_spectrum id="1">{{cases}}</load_spectrum></model>"""
CASE = f"""<load_case id="{{id}}"><component id="1" type="gear_unit">{A.format("load_duration_fraction", "%", "{share}")}
</component><component id="12" type="shaft">{A.format("rotational_speed", "1 / min", "-{speed}")}</component>
<component id="2" type="gear_casing">{A.format("temperature_lubricant", "C", 70)}</component>
<component id="34" type="rolling_bearing_with_catalog_geometry">{A.format("axial_force", "kN", "{axial}")}
{A.format("radial_force_in_v", "kN", 3)}{A.format("radial_force_in_w", "N", -4000)}</component></load_case>"""
CASES = CASE.format(id=1, share=20, speed=543, axial=-6) + CASE.format(id=2, share=80, speed=1456, axial=-2)


def file(folder: Path, text: str) -> Path:
    path = folder / "unit.rexs"
    path.write_text(text)
    return path


def test_bearings_and_loads_come_in_and_ratings_go_out(tmp_path: Path) -> None:
    source = file(tmp_path, HEAD + MODEL.format(cases=CASES))
    ((key, spectrum),) = trb.read_rexs(source).items()
    assert (key, spectrum.shares) == ("34", (0.2, 0.8))
    scene = spectrum.cases[0].subject
    assert (scene.bearing.name, scene.axial_load, scene.radial_load, scene.speed_rpm) == (
        "33014",
        6000.0,
        5000.0,
        543.0,
    )
    assert scene.radial_direction_deg == pytest.approx(-53.1301, abs=1e-3)
    assert (scene.lubricant.temperature_c, scene.lubricant.oil.nu40) == (70.0, 100.0)
    found = trb.rating(spectrum)
    assert found.cases["1"].equivalent_load == pytest.approx(
        0.4 * 5000.0 + scene.bearing.ratings.Y * 6000.0 if scene.bearing.ratings.Y else found.cases["1"].equivalent_load
    )
    out = trb.write_rexs(source, tmp_path / "rated.rexs", {key: found})
    root = ElementTree.parse(out).getroot()
    value = ".//components/component[@id='34']/attribute[@id='{}']"
    life = root.find(value.format("nominal_rating_life_time_iso_281_2007"))
    assert (float(life.text), life.get("unit")) == (pytest.approx(found.life_hours, rel=1e-6), "h")
    load = root.find(value.format("equivalent_dynamic_bearing_load_iso_281_2007"))
    assert (float(load.text), load.get("unit")) == (pytest.approx(1e-3 * found.equivalent_load, rel=1e-6), "kN")
    of_case = root.find(".//load_case[@id='2']/component[@id='34']/attribute[@id='static_load_safety']")
    assert float(of_case.text) == pytest.approx(found.cases["2"].static_safety, rel=1e-6)
    assert trb.read_rexs(out)["34"].shares == spectrum.shares  # what was there stays
    with pytest.raises(trb.InputError, match="another file"):
        trb.write_rexs(source, source, {key: found}, overwrite=True)
    with pytest.raises(trb.InputError, match="must be the id of a rolling bearing"):
        trb.write_rexs(source, tmp_path / "x.rexs", {"12": found})


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (('id="axial_force" unit="kN">-6', 'id="axial_force" unit="kN">6'), "must be negative or 0"),
        (('id="axial_force" unit="kN">-6', 'id="axial_force" unit="furlong">-6'), "must be in one of"),
        (('id="axial_force" unit="kN">-6', 'id="axial_force" unit="kN">inf'), "must be a finite number"),
        (('id="axial_force" unit="kN">-6<', 'id="other" unit="kN">-6<'), "axial_force : must be given|axial_force"),
        (("33014", "99999"), "is not in the table"),
        (('<attribute id="temperature_lubricant" unit="C">70</attribute>', ""), "temperature_lubricant"),
        (("radial_tapered_roller_bearing", "spherical_roller_bearing"), "has no tapered roller bearing"),
    ],
)
def test_what_is_missing_or_wrong_is_named(tmp_path: Path, change: tuple[str, str], said: str) -> None:
    text = (HEAD + MODEL.format(cases=CASES)).replace(*change)
    with pytest.raises((trb.InputError, trb.FileError), match=said):
        trb.read_rexs(file(tmp_path, text))


@pytest.mark.parametrize(
    "text",
    [
        '<!DOCTYPE a [<!ENTITY b "' + "c" * 1000 + '">]><model>' + "&b;" * 1000 + "</model>",
        '<!DOCTYPE a [<!ENTITY b SYSTEM "file:///etc/passwd">]><model>&b;</model>',
        "<a>" * 100_000,
        "<model>" + "<a/>" * 200_000 + "</model>",
        "<model/>",
        "\0",
        "",
    ],
)
def test_xml_of_a_stranger_is_refused(tmp_path: Path, text: str) -> None:
    with pytest.raises(trb.FileError):
        trb.read_rexs(file(tmp_path, text))
    path = tmp_path / "wide.rexs"
    path.write_bytes(text.encode("utf-16"))
    with pytest.raises(trb.FileError):
        trb.read_rexs(path)
