"""The Python program that does what the page does."""

from __future__ import annotations

from typing import Any

from trbdyn.extras.app import fields as of
from trbdyn.extras.app.design import (
    POCKET,
    Built,
    Design,
    _read,
    load_arguments,
    mounting_arguments,
    over_of,
    pair_arguments,
    part_of,
    temperatures_of,
)
from trbdyn.extras.app.questions import want_of
from trbdyn.model.cases import BEARINGS
from trbdyn.model.material import Material
from trbdyn.model.pocket_shapes import SHAPES


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
        lines += _pair_lines(design, made) if pair else _scene_lines(made)
        lines += _fit_lines(design, made)
    of_case = design.planned and not pair
    length = f"revolutions={run.revolutions!r}" if run.duration is None else f"duration={run.duration!r}"
    how = "**options.of_simulation()" if of_case else f'accuracy="{run.accuracy}"'
    keep = "duration=options.duration, save_every=options.save_every" if of_case else length
    if run.save_every is not None and not of_case:
        keep += f", save_every={run.save_every!r}"
    lines += [
        f'result = trb.Simulation(subject, {how}).run({keep}, output="run.h5", overwrite=True)',
        "print(result.summary())",
        *_rating_lines(made),
        f'trb.report(result, "report.html"{_further(made)}, overwrite=True)',
        'trb.view(result, "view.html", overwrite=True)',
    ]
    return "\n".join(lines) + "\n"


def _bearing_lines(design: Design, made: Built) -> list[str]:
    if design.source in ("page", "named"):
        page = {one.path.removeprefix("page."): one for one in of.page_fields()}
        given = _read(Built(), design, page.values())
        said = ", ".join(f"{path.removeprefix('page.')}={value!r}" for path, value in given.items())
        if design.source == "named":
            name = design.typed.get("named.designation", "")
            lines = [f"bearing = trb.Bearing.named({', '.join(part for part in (repr(name), said) if part)})"]
        else:
            lines = [f"bearing = trb.Bearing.from_catalogue({said})"]
    else:
        lines = [f"bearing = trb.cases.{BEARINGS[design.source].__name__}()"]
    changes = {path: value for path, value in part_of(made, "bearing.").items() if not path.startswith("cage.pocket.")}
    if changes:
        lines.append(f"bearing = bearing.replace({changes!r})")
    pocket = part_of(made, POCKET)
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
    oil = part_of(made, "lubricant.")
    more = ", ".join(f"{name}={oil[name]!r}" for name in ("cleanliness", "filtered") if name in oil)
    lines = [f"lubricant=trb.lubricants.{oil.get('oil', 'vg100')}({oil.get('temperature_c', 60.0)!r})"]
    lines = [f"{lines[0]}{f'.replace({more})' if more else ''},"]
    effects = part_of(made, "effects.")
    return lines + ([f"effects=trb.Effects().replace({effects!r}),"] if effects else [])


def _scene_lines(made: Built) -> list[str]:
    given = [f"{name}={value!r}," for name, value in part_of(made, "scene.").items()]
    return ["subject = trb.Scene(", "    bearing,", *(f"    {line}" for line in (*given, *_conditions(made))), ")"]


def _pair_lines(design: Design, made: Built) -> list[str]:
    given = pair_arguments(made.values)
    size = f"mass={given['mass']!r}, outer_diameter={given['diameter']!r}, length={given['length']!r}"
    loads = [f"trb.ShaftLoad(position={given['position']!r}, force={given['force']!r})"] if any(given["force"]) else []
    if design.acts:
        said = ", ".join(f"{name}={value!r}" for name, value in load_arguments(made.values, design.acts).items())
        loads.append(f"trb.ShaftLoad.{design.acts}({said})")
    other = made.values.get("pair.other")
    arguments = [
        "bearing,",
        f"{given['arrangement']!r},",
        *([f"other=trb.Bearing.named({other!r}),"] if other else []),
        f"spread={given['spread']!r},",
        f"end_play={given['end_play']!r},",
        f"shaft=trb.Shaft.hollow_cylinder({size}),",
        f"loads=[{', '.join(loads)}],",
        f"speed_rpm={made.values.get('scene.speed_rpm', 0.0)!r},",
        f"outer_speed_rpm={made.values.get('scene.outer_speed_rpm', 0.0)!r},",
        *_conditions(made),
    ]
    return ["subject = trb.Assembly.pair(", *(f"    {line}" for line in arguments), ")"]


def _fit_lines(design: Design, made: Built) -> list[str]:
    """Seats, temperatures, and the play that they leave."""
    mountings = mounting_arguments(made, design)
    if mountings is None:
        return []
    lines = ["seats = {"]
    for name, own in mountings.items():
        said = ", ".join(
            f"{key}={'trb.Material.aluminium()' if isinstance(value, Material) else repr(value)}"
            for key, value in own.items()
        )
        lines.append(f"    {name!r}: trb.Mounting({said}),")
    warm = ", ".join(f"{name}={value!r}" for name, value in temperatures_of(made).items())
    which = 'seats[""]' if "" in mountings else "seats"
    lines += ["}", f"fits = trb.fit(subject, {which}, temperatures=trb.Temperatures({warm}))"]
    over = over_of(made)
    return [
        *lines,
        *([f"over = trb.preload_over(subject, {which}, {over!r})"] if over else []),
        "subject = fits.subject",
    ]


def _rating_lines(made: Built) -> list[str]:
    reliability = float(made.values.get("rating.reliability", 90.0))
    return [f"print(trb.rating(result{f', reliability={reliability!r}' if reliability != 90.0 else ''}))"]


def _further(made: Built) -> str:
    """Further tables of the report."""
    if made.fits is None:
        return ""
    return ", tables=[fits, over]" if over_of(made) else ", tables=[fits]"
