"""A case as commented TOML: every number with its unit and meaning, as it is given in the docstrings of the models."""

from __future__ import annotations

import json
import re
import textwrap
from typing import TYPE_CHECKING, Any, Final

from trbdyn.base.shown import described_fields
from trbdyn.base.validation import Model
from trbdyn.model.lubricants import OILS
from trbdyn.model.scene import Scene
from trbdyn.run.options import GROUPS

if TYPE_CHECKING:
    from trbdyn.model.assembly import Subject
    from trbdyn.run.options import RunOptions

WIDTH: Final = 118

_HEADS: Final = {
    "bearing": "The bearing. Lines marked 'assumed' give what follows from its size; write your own number there.",
    "lubricant": "The oil at its temperature.",
    "effects": "What is simulated: switches and choices.",
    "scene": "Speed, loads, and what the ring does. What changes in time is a table { times = [...], values = [...] }.",
    "start": "How the run starts.",
    "run": "How long to run, how accurately, and what to keep.",
}
_TABLES: Final = tuple(_HEADS)


def case_text(scene: Subject, run: RunOptions, *, title: str = "") -> str:
    """A complete case as TOML that reads back to the same scene, or assembly, and run options; with comments where it is one of
    one bearing. `title` is its first line.
    """
    if not isinstance(scene, Scene):
        return tables_text(scene.tables() | {"run": run.to_dict()}, title=title)
    lines = [f"# {title}"] if title else []
    lines += ["# Units: m, kg, s, N, Pa; angles in keys ..._deg in degrees.", ""]
    for name in _TABLES:
        model = {"scene": scene, "run": run}.get(name) or getattr(scene, name)
        lines += [f"# {part}" for part in textwrap.wrap(_HEADS[name], WIDTH - 2)]
        lines += [f"[{name}]", *_table(name, model, scene), ""]
    return "\n".join(lines).rstrip() + "\n"


def tables_text(tables: dict[str, Any], *, title: str = "") -> str:
    """Tables of a case or of an assembly, and lists of tables, by their names, as TOML without comments and without what is
    None; `title` is its first line.
    """
    lines = [f"# {title}"] if title else []
    for name, value in tables.items():
        several = isinstance(value, list)
        for table in value if several else [value]:
            lines += ["", f"[[{name}]]" if several else f"[{name}]"]
            lines += [f"{key} = {_toml(entry)}" for key, entry in table.items() if entry is not None]
    return "\n".join(lines).lstrip() + "\n"


def _table(name: str, model: Model, scene: Scene) -> list[str]:
    values = model.to_dict()
    skip = set(_TABLES) if name == "scene" else {"assumed"}
    assumed = set(values["assumed"]) if name == "bearing" else set()
    if name == "lubricant" and scene.lubricant.oil is not None:
        known = {key for key, make in OILS.items() if make().oil == scene.lubricant.oil}
        if known:
            values["oil"] = min(known)
            oils = ", ".join(repr(key) for key in OILS)
            return [
                f'oil = "{values["oil"]}"',
                f"    # one of {oils};",
                "    # or a table of your own: oil = { name = 'own', nu40 = 68.0, nu100 = 8.7, density = 880.0 }",
                f"temperature_c = {scene.lubricant.temperature_c!r}",
                "    # temperature of the oil (C)",
                *_changed_fields(scene),
            ]
    return _lines(model, values, skip, "", assumed)


def _changed_fields(scene: Scene) -> list[str]:
    """Fields of a lubricant that differ from what its oil gives."""
    oil = scene.lubricant
    assert oil.oil is not None
    plain = oil.oil.at(oil.temperature_c).to_dict()
    changed = {key: value for key, value in oil.to_dict().items() if key != "oil" and plain.get(key) != value}
    return _lines(oil, changed, {"temperature_c"}, "", set())


def _lines(model: Model, values: dict[str, Any], skip: set[str], prefix: str, assumed: set[str]) -> list[str]:
    texts, lines = _meanings(type(model)), []
    for key, value in values.items():
        if key in skip:
            continue
        field, path = getattr(model, key, None), f"{prefix}{key}"
        if isinstance(field, Model) and not _inline(field):
            lines += _lines(field, value, set(), f"{path}.", assumed)
            continue
        text = texts.get(key, "")
        if path in assumed:
            lines.append(f"# {path} = {_toml(rounded(value))}  # assumed")
        elif value is None or value == [] or (path == "save_groups" and tuple(value) == GROUPS):
            lines.append(f"# {path} =")  # all groups: a run then chooses by its length and by what there is
        else:
            lines.append(f"{path} = {_toml(value)}")
        lines += [f"    # {part}" for part in textwrap.wrap(text, WIDTH - 6)]
    return lines


def rounded(value: Any, digits: int = 6) -> Any:
    """Numbers in tables and lists with so many digits: what follows from rounded numbers is not known to sixteen of them."""
    if isinstance(value, float):
        return float(f"{value:.{digits}g}")
    if isinstance(value, dict):
        return {key: rounded(entry, digits) for key, entry in value.items()}
    return [rounded(entry, digits) for entry in value] if isinstance(value, list) else value


def _inline(model: Model) -> bool:
    """Models that are lists of things rather than tables of numbers."""
    return type(model).__name__ in ("History", "Pocket", "RotatingLoad")


def _toml(value: Any) -> str:
    if value is None:
        return '"free"'
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")  # TOML has the escapes of JSON
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, dict):
        inside = ", ".join(f"{key} = {_toml(entry)}" for key, entry in value.items() if entry is not None)
        return f"{{ {inside} }}"
    return f"[{', '.join(_toml(entry) for entry in value)}]"


def _meanings(model: type[Model]) -> dict[str, str]:
    """What each field means and, where it is one of some words, which."""
    found = {}
    for name, (values, text) in described_fields(model).items():
        choices = re.search(r"\{(.*)\}", values)
        found[name] = f"One of {choices[1]}. {text}".strip() if choices else text
    return found
