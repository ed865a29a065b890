"""What was typed on the page, and what it means: the tables of a case, scene or assembly."""

from __future__ import annotations

import contextlib
import json
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any, Final

from trbdyn.base.display import amounts, in_unit, plain
from trbdyn.errors import InputError, Problem, TrbError, join_path
from trbdyn.extras.app import fields as of
from trbdyn.extras.app import units
from trbdyn.extras.app.fields import Field
from trbdyn.extras.app.questions import QUESTIONS
from trbdyn.model.assembly import Assembly, Shaft, ShaftLoad, Subject
from trbdyn.model.bearing import Bearing
from trbdyn.model.cases import BEARINGS
from trbdyn.model.designations import designation
from trbdyn.model.effects import Effects
from trbdyn.model.material import Material
from trbdyn.model.mounting import Mounting, Temperatures
from trbdyn.model.on_shaft import MAX_END_PLAY
from trbdyn.model.pocket_shapes import SHAPES
from trbdyn.model.scene import Scene
from trbdyn.run.options import RunOptions
from trbdyn.run.toml_assembly import subject_from_dict
from trbdyn.run.toml_case import bearing_from_table, build, effects_from_table, lubricant_from_table
from trbdyn.statics.fit import Fit, fit

FIRST: Final = {"scene.speed_rpm": "3000", "scene.axial_load": "4930", "run.revolutions": "10"}
"""What stands in the fields of a design of a bearing that ships."""
POCKET: Final = "bearing.cage.pocket."
_OF_PAIR: Final = {"spread": "spread", "position": "spread", "end_play": "end_play", "arrangement": "arrangement",
                   "mass": "mass", "outer_diameter": "diameter", "length": "length"}  # fmt: skip
"""Fields of a pair by the names that errors have."""
EXAMPLE: Final = Scene(BEARINGS["30310"](), speed_rpm=3000.0, axial_load=4930.0)
"""Where the fields of every scene are taken from."""
CASE_SOURCES: Final = ("named", "page", "case", *BEARINGS)
MATERIALS: Final[dict[str, Callable[[], Material]]] = {"steel": Material.steel, "aluminium": Material.aluminium}


@dataclass
class Design:
    """What was typed and chosen."""

    source: str = "30310"  # name of a shipped bearing, ``named`` of the table of designations, ``page``, or ``case``
    typed: dict[str, str] = field(default_factory=lambda: dict(FIRST))  # texts by the paths of `Field`
    case: dict[str, Any] | None = None  # the tables of a case that was opened
    pair: bool = False  # whether two bearings stand on a shaft
    acts: str = ""  # what acts on the shaft besides a force: ``gear``, ``wheel`` or nothing
    units: dict[str, str] = field(default_factory=dict)  # chosen units by those of SI
    wants: list[str] = field(default_factory=lambda: ["torque"])
    """What the user wants to know, names of `trbdyn.extras.app.questions.QUESTIONS`."""
    planned: bool = False  # whether effects, accuracy and length are found by `trbdyn.plan`
    spectrum: str = ""  # table of load cases, as it was typed or read

    @classmethod
    def first(cls) -> Design:
        """The design of a new page, which asks for a designation."""
        return cls(source="named", typed={"run.revolutions": FIRST["run.revolutions"]}, wants=["torque", "life"])

    def to_json(self) -> str:
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text: str) -> Design:
        """A design that was kept; what cannot be used is left out."""
        try:
            values = json.loads(text)
        except (ValueError, RecursionError):
            return cls.first()
        if not isinstance(values, dict):
            return cls.first()
        made = cls.first()
        kinds = {"source": str, "typed": dict, "case": dict, "pair": bool, "acts": str, "units": dict, "wants": list,
                 "planned": bool, "spectrum": str}  # fmt: skip
        for name, kind in kinds.items():
            if isinstance(values.get(name), kind):
                setattr(made, name, values[name])
        if made.source not in CASE_SOURCES or (made.source == "case" and made.case is None):
            made.source = "named"
        made.acts = made.acts if made.acts in of.ACTS else ""
        made.typed = {str(path): text for path, text in made.typed.items() if isinstance(text, str)}
        made.wants = [name for name in QUESTIONS if name in made.wants]
        made.units = {si: one for si, one in made.units.items() if one in units.CHOSEN.get(si, ())}
        return made

    def unit(self, si: str) -> str:
        """The unit in which a quantity is shown."""
        return units.usual(si, self.units)

    def unit_of(self, one: Field) -> str:
        """The unit in which a field is shown: ratings of a catalogue page in kN where loads are in N."""
        unit = self.unit(one.unit) if one.unit else ""
        return "kN" if unit == "N" and one.path.startswith("page.") else unit

    def change_unit(self, si: str, unit: str, listed: Iterable[Field]) -> None:
        """Show all numbers of a kind in another unit; what was typed stays the same quantity."""
        found = {}
        for one in listed:
            if one.unit == si and one.path in self.typed:
                with contextlib.suppress(ValueError):
                    found[one] = units.read(self.typed[one.path], si, self.unit_of(one))
        self.units[si] = unit
        for one, value in found.items():
            self.typed[one.path] = f"{value / float(units.UNITS[si][self.unit_of(one)]):.12g}"


@dataclass
class Built:
    """What a design means."""

    bearing: Bearing | None = None  # the bearing with all changes; None where it cannot be made
    base: Bearing | None = None  # the bearing before the changes: what is estimated of it, and which fields it has
    subject: Subject | None = None
    options: RunOptions = field(default_factory=RunOptions)
    tables: dict[str, Any] = field(default_factory=dict)  # the case
    unseated: Subject | None = None  # the subject with the plays that were typed
    fits: Fit | None = None  # how it sits, where tolerances were typed; the subject has its play of operation
    problems: dict[str, str] = field(default_factory=dict)
    """What is wrong, by the path of the field; '' where no field has it."""
    values: dict[str, Any] = field(default_factory=dict)  # what was typed, in SI units

    def note(
        self,
        error: Exception,
        design: Design,
        listed: Mapping[str, Field],
        place: Callable[[str], str] = lambda path: path,
    ) -> None:
        """Keep what an error says at the fields that it names, in the units of the page."""
        problems = error.problems if isinstance(error, InputError) else (Problem((), None, str(error)),)
        for one in problems:
            path = join_path(one.path)
            where = place(path)
            field = listed.get(where)
            self.problems.setdefault(
                where, _said(one, design, field) if field or not path else f"{path}: {one.allowed}"
            )


def _said(one: Problem, design: Design, field: Field | None) -> str:
    """What is wrong at a field, in its unit."""
    unit = design.unit_of(field) if field is not None else ""
    known = field is not None and field.unit in units.UNITS
    factor = float(units.UNITS[field.unit][unit]) if field is not None and known else 1.0
    said = in_unit(one.allowed, field.unit, factor, unit) if field is not None and field.unit else one.allowed
    length = design.unit("m")
    said = amounts(said, "m", float(units.UNITS["m"][length]), length) if length != "m" else said
    if isinstance(one.value, int | float) and not isinstance(one.value, bool) and abs(one.value) < 1e300:
        said = f"{plain(one.value / factor, 6)}{f' {unit}' if unit else ''}: {said}"
    elif isinstance(one.value, str) and one.value:
        said = f"{one.value[:40]!r}: {said}"
    return said


def all_fields(design: Design, base: Bearing | None) -> dict[str, Field]:
    """All fields of the page by their paths."""
    shape = design.typed.get(of.SHAPE, "default")
    listed = [
        *of.page_fields(),
        *of.named_fields(),
        *of.pair_fields(),
        *of.fit_fields(),
        *of.oil_fields(),
        *of.rating_fields(),
        *scene_fields(),
        *of.fields_of(Effects(), "effects."),
    ]
    listed += of.pocket_fields(shape if shape in SHAPES else "default")
    listed += run_fields()
    return {one.path: one for one in (*listed, *(of.bearing_fields(base) if base is not None else ()))}


def scene_fields() -> list[Field]:
    """Speed and loads, with the values that they have where nothing is typed."""
    found = []
    for one in of.fields_of(EXAMPLE, "scene.", of.SCENE):
        info = Scene.model_fields[one.path.removeprefix("scene.")]
        found.append(replace(one, default=None if info.is_required() else info.default))
    return found


def run_fields() -> list[Field]:
    """Length and accuracy of a run."""
    turns = Field("run.revolutions", "turns of the shaft", default=5.0, meaning="Length of the run.")
    (accuracy,) = of.fields_of(RunOptions(), "run.", ("accuracy",))
    return [turns, replace(accuracy, meaning="Preset of the tolerances.")]


def built(design: Design) -> Built:
    """What a design means, with everything that is wrong with it."""
    made = Built()
    of_page = {one.path: one for one in (*of.page_fields(), *of.named_fields())}
    try:
        page = _read(made, design, [one for one in of_page.values() if design.source in ("page", "named")])
        known = {path.removeprefix("page."): value for path, value in page.items() if path.startswith("page.")}
        if design.source == "case" and design.case is not None:
            subject, made.options = subject_from_dict(design.case)
            made.base = subject.part.bearing
        elif design.source == "page":
            made.base = Bearing.from_catalogue(**known)
        elif design.source == "named":
            made.base = _named(page.get("named.designation", ""), known)
        else:
            made.base = BEARINGS[design.source if design.source in BEARINGS else "30310"]()
    except TrbError as error:
        made.note(error, design, of_page, lambda path: _place_of_page(path, design.source))
        return made
    listed = {path: one for path, one in all_fields(design, made.base).items() if path not in of_page}
    made.values |= _read(made, design, listed.values())
    try:
        _build(made, design)
    except TrbError as error:
        made.note(error, design, listed, lambda path: _place(path, listed))
    return made


def _named(name: str, known: Mapping[str, Any]) -> Bearing:
    if not name:
        raise InputError.of("designation", None, "must be given, for instance 32208")
    return Bearing.named(name, **known)


def _place_of_page(path: str, source: str) -> str:
    if path in (*of.PAGE, "name"):
        return f"page.{path}"
    return f"named.{path}" if source == "named" and path == "designation" else path


def _place(path: str, listed: Mapping[str, Field]) -> str:
    """The field that has what an error names; '' if there is none."""
    if path in listed:
        return path
    if path.split(".")[0] in ("bearing", "scene", "effects", "lubricant", "run"):
        return of.SHAPE if path.startswith("bearing.cage.pocket") else ""
    if path == "designation":
        return "pair.other"
    last = path.rsplit(".", 1)[-1]
    own = ("fit",) if path.startswith("mounting") else ("pair", "gear", "wheel", "fit", "scene")
    last = _OF_PAIR.get(last, last) if own[0] == "pair" else last
    return next((f"{prefix}.{last}" for prefix in own if f"{prefix}.{last}" in listed), "")


def _read(made: Built, design: Design, listed: Iterable[Field]) -> dict[str, Any]:
    """What was typed into fields, in SI units; what cannot be read is noted."""
    found: dict[str, Any] = {}
    for one in listed:
        text = design.typed.get(one.path, "")
        if text.strip() == "":
            continue
        if one.choices or one.text:
            found[one.path] = one.value(text)
            continue
        try:
            value: float = units.read(text, one.unit or "1", design.unit_of(one) or "1")
        except ValueError as error:
            made.problems[one.path] = str(error)
            continue
        if one.whole and math.isfinite(value) and value.is_integer():
            value = int(value)
        found[one.path] = value
    return found


_OWN: Final = ("pair.", "gear.", "wheel.", "fit.", "rating.", POCKET)
"""Beginnings of the paths that no table of a case has as they are."""


def _build(made: Built, design: Design) -> None:
    """Put the tables of the case together, and make scene or assembly of them."""
    assert made.base is not None
    opened = design.case if design.source == "case" and design.case is not None else {}
    tables = json.loads(
        json.dumps({"bearing": made.base.inputs(), "lubricant": {}, "effects": {}, "run": {}, **opened}, default=str)
    )
    pair = design.pair and "assembly" not in tables
    if not pair and "assembly" not in tables:
        tables.setdefault("scene", {})
    for path, value in made.values.items():
        if path.startswith(_OWN) or (path.startswith("scene.") and "scene" not in tables):
            continue
        _put(tables, path, value)
    pocket = part_of(made, POCKET)
    if pocket.get("shape", "default") != "default":
        tables["bearing"].setdefault("cage", {})["pocket"] = pocket
    if not opened:
        tables["lubricant"].setdefault("oil", "vg100")
    made.bearing = bearing_from_table(tables["bearing"]) if "bearing" in tables else made.base
    if made.problems:
        return
    if pair:
        made.subject, made.options = _pair(made, design, tables), build(RunOptions, tables["run"], ("run",))
        made.tables = {**made.subject.tables(), "run": tables["run"]}
    else:
        made.subject, made.options = subject_from_dict(tables)
        made.tables = tables
        if isinstance(made.subject, Scene):
            made.subject.check_capacity()
    _sit(made, design)
    if made.options.revolutions is None and made.options.duration is None:
        raise InputError.of(("run", "revolutions"), None, "must be given: how long the run is")
    made.options.end_time(made.subject)


def _put(tables: dict[str, Any], path: str, value: Any) -> None:
    *parts, last = path.split(".")
    place = tables
    for part in parts:
        if not isinstance(place.get(part), dict):
            place[part] = {}
        place = place[part]
    place[last] = value


def part_of(made: Built, prefix: str) -> dict[str, Any]:
    """What was typed whose paths have a prefix."""
    return {path.removeprefix(prefix): value for path, value in made.values.items() if path.startswith(prefix)}


def pair_arguments(values: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers of a pair on a shaft, with the force on it (N), of what was typed."""
    chosen = {name: values.get(f"pair.{name}", default) for name, (_, _, default, _) in of.PAIR.items()}
    if abs(chosen["end_play"]) > 2.0 * MAX_END_PLAY:
        limit = f"must be from {-2.0 * MAX_END_PLAY:g} to {2.0 * MAX_END_PLAY:g} (m)"
        raise InputError.of(("pair", "end_play"), chosen["end_play"], limit)
    radial, direction = (
        values.get("scene.radial_load", 0.0),
        math.radians(values.get("scene.radial_direction_deg", 90.0)),
    )
    force = (radial * math.cos(direction), radial * math.sin(direction), values.get("scene.axial_load", 0.0))
    return chosen | {"force": tuple(round(part, 9) + 0.0 for part in force)}


def load_arguments(values: Mapping[str, Any], acts: str) -> dict[str, Any]:
    """Arguments of `ShaftLoad.gear` or `ShaftLoad.wheel`; what must be given is asked for."""
    table = of.GEAR if acts == "gear" else of.WHEEL
    found: dict[str, Any] = {}
    for name, (words, si, default, _) in table.items():
        value = values.get(f"{acts}.{name}", default)
        if value is None and name != "track":
            raise InputError.of((acts, name), None, f"must be given: {words}{'' if si == '1' else f' ({si})'}")
        if value is not None:
            found[name] = value
    return found


def _pair(made: Built, design: Design, tables: dict[str, Any]) -> Assembly:
    assert made.bearing is not None
    given = pair_arguments(made.values)
    other = made.values.get("pair.other")
    loads = [ShaftLoad(position=given["position"], force=given["force"])] if any(given["force"]) else []
    if design.acts:
        make = ShaftLoad.gear if design.acts == "gear" else ShaftLoad.wheel
        loads.append(make(**load_arguments(made.values, design.acts)))
    return Assembly.pair(
        made.bearing,
        given["arrangement"],
        other=Bearing.named(other) if other else None,
        spread=given["spread"],
        end_play=given["end_play"],
        shaft=Shaft.hollow_cylinder(mass=given["mass"], outer_diameter=given["diameter"], length=given["length"]),
        loads=tuple(loads),
        speed_rpm=made.values.get("scene.speed_rpm", 0.0),
        outer_speed_rpm=made.values.get("scene.outer_speed_rpm", 0.0),
        lubricant=lubricant_from_table(tables["lubricant"]),
        effects=effects_from_table(tables["effects"]),
    )


def mounting_arguments(made: Built, design: Design) -> dict[str, dict[str, Any]] | None:
    """Arguments of the `Mounting` of each bearing by its name; None where no tolerance was typed."""
    given = part_of(made, "fit.")
    if not ({"shaft", "housing", "over", "inner_c", "outer_c"} & given.keys()) or made.subject is None:
        return None
    for name in ("shaft", "housing"):
        if name not in given:
            raise InputError.of(("fit", name), None, "must be given: a tolerance by ISO 286")
    named = {"left": design.typed.get("named.designation", "") if design.source == "named" else ""}
    named["right"] = str(made.values.get("pair.other", "")) or named["left"]
    found = {}
    for name in made.subject.names:
        page = Built()
        sizes = {path.removeprefix("page."): value for path, value in _read(page, design, of.page_fields()).items()}
        key = named.get(name or "left", "")
        row = designation(key) if key else None
        own: dict[str, Any] = {key: given[key] for key in ("shaft", "housing", "set") if key in given}
        for size in ("bore", "outside", "width"):
            value = given.get(size) or (getattr(row, size) if row is not None else sizes.get(size))
            if value is None:
                raise InputError.of(("fit", size), None, "must be given (m)")
            own[size] = value
        if given.get("housing_material", "steel") != "steel":
            own["housing_material"] = MATERIALS[given["housing_material"]]()
        found[name] = own
    return found


def temperatures_of(made: Built) -> dict[str, float]:
    """Arguments of the `Temperatures` of operation."""
    inner, outer = (made.values.get(f"fit.{name}", 20.0) for name in ("inner_c", "outer_c"))
    return {"shaft_c": inner, "inner_ring_c": inner, "rollers_c": 0.5 * (inner + outer), "outer_ring_c": outer,
            "housing_c": outer}  # fmt: skip


def over_of(made: Built) -> list[float]:
    """Temperatures at which the preload is wanted (C)."""
    text = str(made.values.get("fit.over", ""))
    try:
        found = [float(part) for part in text.replace(";", ",").split(",") if part.strip()]
    except ValueError:
        found = [math.nan]
    if len(found) > 40 or not all(-100.0 <= one <= 300.0 for one in found):
        raise InputError.of(
            ("fit", "over"), text, "must be up to 40 temperatures from -100 to 300 with commas between (C)"
        )
    return found


def _sit(made: Built, design: Design) -> None:
    """Give the subject the play of operation that its fits leave, where tolerances were typed."""
    over_of(made)
    mountings = mounting_arguments(made, design)
    if mountings is None or made.subject is None:
        return
    seats = {name: build(Mounting, own, ("mounting",)) for name, own in mountings.items()}
    made.unseated = made.subject
    made.fits = fit(made.subject, seats.get("", seats), temperatures=Temperatures(**temperatures_of(made)))
    sits = made.fits.subject
    if sits != made.subject and not isinstance(sits, Bearing):
        made.subject = sits
        made.tables = {**sits.tables(), "run": made.tables.get("run", {})}
