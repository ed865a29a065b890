"""What was typed on the page, and what it means: the tables of a case, scene or assembly, and the Python that does the same."""

from __future__ import annotations

import contextlib
import json
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any, Final

from trbdyn.app import fields as of
from trbdyn.app import units
from trbdyn.app.fields import Field
from trbdyn.app.questions import QUESTIONS, want_of
from trbdyn.errors import InputError, Problem, TrbError, join_path
from trbdyn.model.assembly import Assembly, Shaft, ShaftLoad, Subject
from trbdyn.model.bearing import Bearing
from trbdyn.model.cases import BEARINGS
from trbdyn.model.effects import Effects
from trbdyn.model.pocket_shapes import SHAPES
from trbdyn.model.scene import Scene
from trbdyn.run.options import RunOptions
from trbdyn.run.toml_assembly import subject_from_dict
from trbdyn.run.toml_case import bearing_from_table, build, effects_from_table, lubricant_from_table

FIRST: Final = {"scene.speed_rpm": "3000", "scene.axial_load": "4930", "run.revolutions": "10"}
"""What stands in the fields of a new design."""
POCKET: Final = "bearing.cage.pocket."
_OF_PAIR: Final = {"spread": "spread", "position": "spread", "end_play": "end_play", "arrangement": "arrangement",
                   "mass": "mass", "outer_diameter": "diameter", "length": "length"}  # fmt: skip
"""Fields of a pair by the names that errors have."""
EXAMPLE: Final = Scene(BEARINGS["30310"](), speed_rpm=3000.0, axial_load=4930.0)
"""Where the fields of every scene are taken from."""


@dataclass
class Design:
    """What was typed and chosen."""

    source: str = "30310"  # name of a shipped bearing, ``page`` of a catalogue, or ``case``
    typed: dict[str, str] = field(default_factory=lambda: dict(FIRST))  # texts by the paths of `Field`
    case: dict[str, Any] | None = None  # the tables of a case that was opened
    pair: bool = False  # whether two of the bearings stand on a shaft
    units: dict[str, str] = field(default_factory=dict)  # chosen units by those of SI
    wants: list[str] = field(default_factory=lambda: ["torque"])
    """What the user wants to know, names of `trbdyn.app.questions.QUESTIONS`."""
    planned: bool = False  # whether effects, accuracy and length are found by `trbdyn.plan`

    def to_json(self) -> str:
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text: str) -> Design:
        """A design that was kept; what cannot be read is left out."""
        try:
            values = json.loads(text)
            known = {name: values[name] for name in cls.__dataclass_fields__ if name in values}
            made = cls(**known)
            made.typed = {str(path): str(value) for path, value in made.typed.items()}
            made.wants = [name for name in QUESTIONS if name in made.wants]
            made.units = {si: one for si, one in made.units.items() if one in units.CHOSEN.get(si, ())}
            return made
        except (ValueError, TypeError, AttributeError):
            return cls()

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
    problems: dict[str, str] = field(default_factory=dict)
    """What is wrong, by the path of the field; '' where no field has it."""
    values: dict[str, Any] = field(default_factory=dict)  # what was typed, in SI units

    def note(self, error: Exception, place: Callable[[str], str] = lambda path: path) -> None:
        """Keep what an error says at the fields that it names."""
        problems = error.problems if isinstance(error, InputError) else (Problem((), None, str(error)),)
        for one in problems:
            path = join_path(one.path)
            said = one.allowed if isinstance(one.value, bool | None) else f"{_brief(one.value)}{one.allowed}"
            self.problems.setdefault(place(path), said if place(path) == path or not path else f"{path}: {said}")


def _brief(value: object) -> str:
    return f"{value:g}: " if isinstance(value, int | float) and abs(value) < 1e300 else ""


def all_fields(design: Design, base: Bearing | None) -> dict[str, Field]:
    """All fields of the page by their paths."""
    shape = design.typed.get(of.SHAPE, "default")
    listed = [
        *of.page_fields(),
        *of.pair_fields(),
        *of.oil_fields(),
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
    return [turns, *of.fields_of(RunOptions(), "run.", ("accuracy",))]


def built(design: Design) -> Built:
    """What a design means, with everything that is wrong with it."""
    made = Built()
    try:
        page = _read(made, design, [one for one in of.page_fields() if design.source == "page"])
        if design.source == "case" and design.case is not None:
            subject, made.options = subject_from_dict(design.case)
            made.base = subject.part.bearing
        elif design.source == "page":
            made.base = Bearing.from_catalogue(**{path.removeprefix("page."): value for path, value in page.items()})
        else:
            made.base = BEARINGS[design.source if design.source in BEARINGS else "30310"]()
    except TrbError as error:
        made.note(error, lambda path: f"page.{path}" if path in (*of.PAGE, "name") else path)
        return made
    known = [one for path, one in all_fields(design, made.base).items() if not path.startswith("page.")]
    made.values |= _read(made, design, known)
    try:
        _build(made, design)
    except TrbError as error:
        listed = {one.path for one in known}
        made.note(error, lambda path: _place(path, listed))
    return made


def _place(path: str, listed: set[str]) -> str:
    """The field that has what an error names; '' if there is none."""
    if path in listed:
        return path
    if path.split(".")[0] in ("bearing", "scene", "effects", "lubricant", "run"):
        return of.SHAPE if path.startswith("bearing.cage.pocket") else ""
    last = path.rsplit(".", 1)[-1]
    return next((name for name in (f"pair.{_OF_PAIR.get(last, last)}", f"scene.{last}") if name in listed), "")


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


def _build(made: Built, design: Design) -> None:
    """Put the tables of the case together, and make scene or assembly of them."""
    assert made.base is not None
    opened = design.case if design.source == "case" and design.case is not None else {}
    tables = json.loads(
        json.dumps({"bearing": made.base.inputs(), "lubricant": {}, "effects": {}, "run": {}, **opened})
    )
    pair = design.pair and "assembly" not in tables
    if not pair and "assembly" not in tables:
        tables.setdefault("scene", {})
    for path, value in made.values.items():
        if path.startswith(("pair.", POCKET)) or (path.startswith("scene.") and "scene" not in tables):
            continue
        _put(tables, path, value)
    pocket = _of(made, POCKET)
    if pocket.get("shape", "default") != "default":
        tables["bearing"].setdefault("cage", {})["pocket"] = pocket
    if not opened:
        tables["lubricant"].setdefault("oil", "vg100")
    made.bearing = bearing_from_table(tables["bearing"]) if "bearing" in tables else made.base
    if made.problems:
        return
    if pair:
        made.subject, made.options = _pair(made, tables), build(RunOptions, tables["run"], ("run",))
        made.tables = {**made.subject.tables(), "run": tables["run"]}
    else:
        made.subject, made.options = subject_from_dict(tables)
        made.tables = tables
        if isinstance(made.subject, Scene):
            made.subject.check_capacity()
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


def pair_arguments(values: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers of a pair on a shaft, with the force on it (N), of what was typed."""
    chosen = {name: values.get(f"pair.{name}", default) for name, (_, _, default, _) in of.PAIR.items()}
    radial, direction = (
        values.get("scene.radial_load", 0.0),
        math.radians(values.get("scene.radial_direction_deg", 90.0)),
    )
    force = (radial * math.cos(direction), radial * math.sin(direction), values.get("scene.axial_load", 0.0))
    return chosen | {"force": tuple(round(part, 9) + 0.0 for part in force)}


def _pair(made: Built, tables: dict[str, Any]) -> Assembly:
    assert made.bearing is not None
    given = pair_arguments(made.values)
    return Assembly.pair(
        made.bearing,
        given["arrangement"],
        spread=given["spread"],
        end_play=given["end_play"],
        shaft=Shaft.hollow_cylinder(mass=given["mass"], outer_diameter=given["diameter"], length=given["length"]),
        loads=(ShaftLoad(position=given["position"], force=given["force"]),),
        speed_rpm=made.values.get("scene.speed_rpm", 0.0),
        lubricant=lubricant_from_table(tables["lubricant"]),
        effects=effects_from_table(tables["effects"]),
    )


def script(design: Design, made: Built) -> str:
    """The Python program that does what the page does."""
    run, pair = made.options, "assembly" in made.tables
    lines = ["import trbdyn as trb", ""]
    if design.source == "case" or design.planned:
        if design.planned:
            lines.append(f"# case.toml lies beside the run: what trb.plan(scene, {want_of(design.wants)!r}) has found")
        reads = "subject = trb.load_assembly" if pair else "subject, options = trb.load_case"
        lines.append(f'{reads}("case.toml")')
    else:
        lines += _bearing_lines(design, made)
        lines += _pair_lines(made) if pair else _scene_lines(made)
    of_case = design.planned and not pair
    length = f"revolutions={run.revolutions!r}" if run.duration is None else f"duration={run.duration!r}"
    how = "**options.of_simulation()" if of_case else f'accuracy="{run.accuracy}"'
    keep = "duration=options.duration, save_every=options.save_every" if of_case else length
    if run.save_every is not None and not of_case:
        keep += f", save_every={run.save_every!r}"
    lines += [
        f'result = trb.Simulation(subject, {how}).run({keep}, output="run.h5", overwrite=True)',
        "print(result.summary())",
        'trb.report(result, "report.html", overwrite=True)',
        'trb.view(result, "view.html", overwrite=True)',
    ]
    return "\n".join(lines) + "\n"


def _bearing_lines(design: Design, made: Built) -> list[str]:
    if design.source == "page":
        page = {one.path.removeprefix("page."): one for one in of.page_fields()}
        given = _read(Built(), design, page.values())
        said = ", ".join(f"{path.removeprefix('page.')}={value!r}" for path, value in given.items())
        lines = [f"bearing = trb.Bearing.from_catalogue({said})"]
    else:
        lines = [f"bearing = trb.cases.{BEARINGS[design.source].__name__}()"]
    changes = {path: value for path, value in _of(made, "bearing.").items() if not path.startswith("cage.pocket.")}
    if changes:
        lines.append(f"bearing = bearing.replace({changes!r})")
    pocket = _of(made, POCKET)
    shape = pocket.pop("shape", "default")
    if shape != "default":
        said = "".join(f", {name}={value!r}" for name, value in pocket.items())
        call = f"trb.pocket_shapes.{SHAPES[shape].__name__}(bearing{said})"
        lines.append(f'bearing = bearing.replace({{"cage.pocket": {call}}})')
    return lines


def _of(made: Built, prefix: str) -> dict[str, Any]:
    return {path.removeprefix(prefix): value for path, value in made.values.items() if path.startswith(prefix)}


def _conditions(made: Built) -> list[str]:
    """Oil and effects, as arguments."""
    oil = _of(made, "lubricant.")
    lines = [f"lubricant=trb.lubricants.{oil.get('oil', 'vg100')}({oil.get('temperature_c', 60.0)!r}),"]
    effects = _of(made, "effects.")
    return lines + ([f"effects=trb.Effects().replace({effects!r}),"] if effects else [])


def _scene_lines(made: Built) -> list[str]:
    given = [f"{name}={value!r}," for name, value in _of(made, "scene.").items()]
    return ["subject = trb.Scene(", "    bearing,", *(f"    {line}" for line in (*given, *_conditions(made))), ")"]


def _pair_lines(made: Built) -> list[str]:
    given = pair_arguments(made.values)
    size = f"mass={given['mass']!r}, outer_diameter={given['diameter']!r}, length={given['length']!r}"
    arguments = [
        "bearing,",
        f"{given['arrangement']!r},",
        f"spread={given['spread']!r},",
        f"end_play={given['end_play']!r},",
        f"shaft=trb.Shaft.hollow_cylinder({size}),",
        f"loads=[trb.ShaftLoad(position={given['position']!r}, force={given['force']!r})],",
        f"speed_rpm={made.values.get('scene.speed_rpm', 0.0)!r},",
        *_conditions(made),
    ]
    return ["subject = trb.Assembly.pair(", *(f"    {line}" for line in arguments), ")"]
