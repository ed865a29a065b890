"""REXS: bearings of a gear unit with their loads in, their ratings out.

REXS (Reusable Engineering EXchange Standard, FVA, www.rexs.info) describes gear units in XML. The names of components, attributes
and their units are those of its database, version 1.4.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final
from xml.etree.ElementTree import Element, SubElement

from trbdyn.base.expected import expect
from trbdyn.base.own_files import file_path, write_whole
from trbdyn.base.reading import MOST_AROUND, MOST_BEARINGS, MOST_LOADS, MOST_PARTS
from trbdyn.base.safe_xml import read_xml, xml_text
from trbdyn.base.version import __version__
from trbdyn.errors import FileError, InputError
from trbdyn.model.bearing import Bearing
from trbdyn.model.lubricants import Lubricant
from trbdyn.model.lubricants.lubricant import Oil
from trbdyn.model.scene import Scene
from trbdyn.model.spectrum import LoadCase, Spectrum
from trbdyn.run.toml_case import lubricant_from_table
from trbdyn.standards.sheet import Rating
from trbdyn.standards.spectrum import SpectrumRating

BEARINGS: Final = ("rolling_bearing_with_catalog_geometry", "rolling_bearing_with_detailed_geometry")
TAPERED: Final = "radial_tapered_roller_bearing"
UNITS: Final = {
    "": 1.0,
    "none": 1.0,
    "mm": 1e-3,
    "m": 1.0,
    "mum": 1e-6,
    "N": 1.0,
    "kN": 1e3,
    "1 / min": 1.0,
    "C": 1.0,
    "%": 1.0,
    "h": 1.0,
    "mm^2 / s": 1.0,
    "kg / dm^3": 1e3,
}
"""Units of the attributes that are read, in those of this package."""
PAGE: Final = {
    "inner_diameter": "bore",
    "outer_diameter": "outside",
    "width": "width",
    "radial_dynamic_load_rating": "C",
    "radial_static_load_rating": "C0",
    "catalogue_value_e": "e",
    "axial_factor_y_2": "Y",
    "axial_factor_y_0": "Y0",
    "fatigue_limit_load": "Cu",
}
"""Attributes by the numbers of a catalogue page."""
WRITTEN: Final[dict[str, tuple[str, float, str]]] = {
    "equivalent_load": ("equivalent_dynamic_bearing_load_iso_281_2007", 1e-3, "kN"),
    "life_hours": ("nominal_rating_life_time_iso_281_2007", 1.0, "h"),
    "reference_life_hours": ("nominal_reference_rating_life_time_din_26281", 1.0, "h"),
    "modified_reference_life_hours": ("modified_reference_rating_life_time_din_26281", 1.0, "h"),
    "static_safety": ("static_load_safety", 1.0, ""),
    "viscosity_ratio": ("viscosity_ratio_according_to_iso_281_2007", 1.0, ""),
}
"""Numbers of a sheet by the attributes that they become, with factor and unit. REXS has no life of ISO 281 that is modified."""


def read_rexs(
    path: str | os.PathLike[str],
    *,
    bearings: Mapping[str, Bearing] | None = None,
    lubricant: Lubricant | str | None = None,
    temperature_c: float | None = None,
) -> dict[str, Spectrum]:
    """Tapered roller bearings of a gear unit with their load cases, from a REXS file.

    Parameters
    ----------
    path : path-like
        A REXS file (XML). Its load cases must have the forces on the bearings, ``axial_force``, ``radial_force_in_v`` and
        ``radial_force_in_w``, as a gear program writes them: the forces of the gears are not computed here.
    bearings : mapping of str to Bearing, optional
        Bearings by the ids of their components, in place of those that follow from the file: from ``catalogue_designation`` by
        the table of designations, or from the dimensions and ratings in the file.
    lubricant : Lubricant or str, optional
        The oil, where the file has no viscosities at 40 and 100 C.
    temperature_c : float, optional
        Its temperature (C), where the file has none.

    Returns
    -------
    dict of str to Spectrum
        Of each tapered roller bearing, by the id of its component; for `trbdyn.rating`. Load cases have the shares of the file.

    Raises
    ------
    FileError
        If the file cannot be read.
    InputError
        If a bearing is not known, or a load case lacks a number; the message names the component.

    Notes
    -----
    Source: REXS database 1.4 (FVA). An axial force counts by its size: a tapered roller bearing bears it in one direction. Its
    direction must be that of ``axial_force_absorption``, else the file is refused.
    """
    root = _root(path)
    parts = _components(root)
    chosen = {
        key: part
        for key, part in parts.items()
        if part.get("type") in BEARINGS and _text(part, "bearing_type") in (TAPERED, None)
    }
    _few(path, "components", len(parts), MOST_PARTS)
    _few(path, "relations", sum(1 for _ in root.iter("relation")), MOST_PARTS)
    _few(path, "load cases of its bearings", len(chosen) * sum(1 for _ in root.iter("load_case")), MOST_LOADS)
    _few(path, "bearings", len(chosen), MOST_BEARINGS)
    _few(path, "casings, oils and units", len(_around(parts)), MOST_AROUND)
    found = {}
    for key, part in chosen.items():
        bearing = (bearings or {}).get(key) or _bearing(part, path)
        found[key] = Spectrum(_cases(root, parts, part, bearing, lubricant, temperature_c, path))
    if not found:
        raise FileError(f"{path}: has no tapered roller bearing ({' or '.join(BEARINGS)}, {TAPERED})")
    return found


def write_rexs(
    source: str | os.PathLike[str],
    path: str | os.PathLike[str],
    ratings: Mapping[str, Rating | SpectrumRating],
    *,
    overwrite: bool = False,
) -> Path:
    """Write the ratings of bearings into a copy of a REXS file.

    Parameters
    ----------
    source : path-like
        The file that the bearings were read from.
    path : path-like
        The file to write, ``NAME.rexs`` or ``NAME.xml``.
    ratings : mapping of str to Rating or SpectrumRating
        By the ids of the components. The lives of a spectrum stand at the bearing, those of its load cases at the bearing in
        these.
    overwrite : bool
        Replace a file that is there; never the source.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        If the source has no such component.
    FileError
        If a file cannot be read or written.
    """
    root = _root(source)
    parts = _components(root)
    for key, found in ratings.items():
        expect(f"ratings[{key!r}]", found, Rating, SpectrumRating)
        if key not in parts or parts[key].get("type") not in BEARINGS:
            raise InputError.of(("ratings", key), key, "must be the id of a rolling bearing of the file")
        _add(parts[key], found)
        if isinstance(found, SpectrumRating):
            by_name = {str(case.get("id")): case for case in root.iter("load_case")}
            for name, sheet in found.cases.items():
                if name in by_name:
                    _add(_in_case(by_name[name], parts[key]), sheet)
    root.set("applicationId", "trbdyn")
    root.set("applicationVersion", __version__)
    how: dict[str, Any] = {"overwrite": overwrite, "endings": (".rexs", ".xml"), "reads": [source]}
    return write_whole(path, xml_text(root), **how)


def _root(path: str | os.PathLike[str]) -> Element:
    root = read_xml(file_path(path, "path"))
    if root.tag != "model" or root.find("components") is None:
        raise FileError(f"{path}: is no REXS file: its root is {root.tag[:40]!r}, or it has no components")
    return root


def _components(root: Element) -> dict[str, Element]:
    listed = root.find("components")
    return {} if listed is None else {str(one.get("id")): one for one in listed.findall("component")}


def _around(parts: Mapping[str, Element]) -> list[str]:
    """Ids of what has the numbers of the whole unit."""
    return [one for one, other in parts.items() if other.get("type") in ("gear_casing", "lubricant", "gear_unit")]


def _few(path: object, what: str, count: int, most: int) -> None:
    if count > most:
        raise FileError(f"{path}: has {count} {what}: at most {most} are read")


def _attribute(part: Element | None, name: str) -> Element | None:
    return None if part is None else next((one for one in part.findall("attribute") if one.get("id") == name), None)


def _text(part: Element | None, name: str) -> str | None:
    found = _attribute(part, name)
    return None if found is None or not (found.text or "").strip() else str(found.text).strip()


def _number(part: Element | None, name: str) -> float | None:
    """A number of a component in SI units, rpm, C, mm2/s."""
    found, text = _attribute(part, name), _text(part, name)
    if found is None or text is None or part is None:
        return None
    where = (f"component {part.get('id')}", name)
    unit = found.get("unit") or ""
    if unit not in UNITS:
        raise InputError.of(where, unit, f"must be in one of {', '.join(one for one in UNITS if one)}")
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError.of(where, text[:40], f"must be a finite number ({unit})")
    return value * UNITS[unit]


def _bearing(part: Element, path: object) -> Bearing:
    """The bearing of a component: by its designation, or by the numbers of a page."""
    page: dict[str, Any] = {name: value for key, name in PAGE.items() if (value := _number(part, key)) is not None}
    name = _text(part, "catalogue_designation") or ""
    where = f"component {part.get('id')}"
    try:
        if {"bore", "outside", "width", "C"} <= page.keys() and {"e", "Y"} & page.keys():
            return Bearing.from_catalogue(**page, name=name or str(part.get("name")))
        if name:
            known = {key: value for key, value in page.items() if key not in ("bore", "outside", "width")}
            return Bearing.named(name, **known)
    except InputError as error:
        raise error.under((where,)) from None
    limit = f"must be given in {path}, or {', '.join(list(PAGE)[:4])} and catalogue_value_e"
    raise InputError.of((where, "catalogue_designation"), None, limit)


def _cases(
    root: Element,
    parts: Mapping[str, Element],
    part: Element,
    bearing: Bearing,
    lubricant: Lubricant | str | None,
    temperature_c: float | None,
    path: object,
) -> list[LoadCase]:
    key = str(part.get("id"))
    shafts = [one for one in _beside(root, key) if one in parts and parts[one].get("type") == "shaft"]
    found = []
    for case in root.iter("load_case"):
        name = str(case.get("id"))
        inside = {str(one.get("id")): one for one in case.findall("component")}
        shaft = next(iter(shafts), None)
        where = f"load case {name}, component {key}"

        def number(attribute: str, *places: str | None, inside: Mapping[str, Element] = inside) -> float | None:
            """The attribute of the first of some components that has it, in the load case or outside of it."""
            values = (_number(source.get(place), attribute) for place in places if place for source in (inside, parts))
            return next((value for value in values if value is not None), None)

        forces = [number(one, key) for one in ("axial_force", "radial_force_in_v", "radial_force_in_w")]
        missing = [one for one, force in zip(("axial_force", "radial_force_in_v", "radial_force_in_w"), forces, strict=True)
                   if force is None]  # fmt: skip
        if missing:
            limit = f"must be given in {path}: the gear program that wrote it must write its results, too"
            raise InputError.of((where, missing[0]), None, limit)
        axial, v, w = (float(force or 0.0) for force in forces)
        held = _text(part, "axial_force_absorption")
        if held in ("positive", "negative") and axial * (1.0 if held == "positive" else -1.0) < 0.0:
            limit = f"must be {held} or 0: this bearing bears no axial force in the other direction (N)"
            raise InputError.of((where, "axial_force"), axial, limit)
        speed = number("speed_inner_ring", key)
        speed = number("rotational_speed", shaft) if speed is None else speed
        if speed is None:
            raise InputError.of((where, "rotational_speed"), None, "must be given at the bearing or its shaft (rpm)")
        others = _around(parts)
        warm = number("temperature_lubricant", key, *others)
        share = next((value for one in ("load_duration_fraction", "operating_time_fraction")
                      if (value := number(one, *others)) is not None), None)  # fmt: skip
        if share is None and len(list(root.iter("load_case"))) > 1:
            raise InputError.of((f"load case {name}", "load_duration_fraction"), None, "must be given (%)")
        oil = _oil(parts, lubricant, temperature_c if warm is None else warm, where)
        try:
            scene = Scene(
                bearing,
                speed_rpm=abs(speed),
                axial_load=abs(axial),
                radial_load=math.hypot(v, w),
                radial_direction_deg=math.degrees(math.atan2(w, v)),
                lubricant=oil,
            )
        except InputError as error:
            raise error.under((where,)) from None
        found.append(LoadCase(name, 1.0 if share is None else share, scene))
    if not found:
        raise InputError.of(("load_spectrum",), None, f"must have a load case in {path}")
    return found


def _beside(root: Element, key: str) -> list[str]:
    """Ids of the components that a relation joins to one."""
    listed = ([str(ref.get("id")) for ref in relation.findall("ref")] for relation in root.iter("relation"))
    return [one for ids in listed if key in ids for one in ids if one != key]


def _oil(
    parts: Mapping[str, Element], lubricant: Lubricant | str | None, temperature_c: float | None, where: str
) -> Lubricant:
    """The oil of the file at a temperature, or the one that was given."""
    if isinstance(lubricant, Lubricant):
        return lubricant if temperature_c is None else lubricant.replace(temperature_c=temperature_c)
    if temperature_c is None:
        raise InputError.of(
            (where, "temperature_lubricant"), None, "must be given in the file, or as temperature_c (C)"
        )
    if lubricant is not None:
        return lubricant_from_table({"oil": lubricant, "temperature_c": temperature_c})
    part = next((one for one in parts.values() if one.get("type") == "lubricant"), None)
    nu40, nu100 = (_number(part, f"viscosity_at_{t}_degree_celsius") for t in (40, 100))
    if nu40 is None or nu100 is None:
        limit = "must be given in the file, or as lubricant"
        raise InputError.of(("lubricant", "viscosity_at_40_degree_celsius"), nu40, limit)
    density = _number(part, "density_at_15_degree_celsius")
    oil = Oil(
        name=str(part.get("name")) if part is not None else "oil", nu40=nu40, nu100=nu100, density=density or 880.0
    )
    return oil.at(temperature_c)


def _in_case(case: Element, part: Element) -> Element:
    """A component in a load case; a new one where it is not there."""
    key = part.get("id")
    found = next((one for one in case.findall("component") if one.get("id") == key), None)
    if found is None:
        found = SubElement(
            case, "component", {name: part.attrib[name] for name in ("id", "name", "type") if name in part.attrib}
        )
    return found


def _add(part: Element, found: Rating | SpectrumRating) -> None:
    for name, (attribute, factor, unit) in WRITTEN.items():
        value = getattr(found, name, None)
        if value is None:
            continue
        place = _attribute(part, attribute)
        if place is None:
            place = SubElement(part, "attribute", {"id": attribute})
        place.set("unit", unit)
        place.text = f"{factor * value:.8g}"
