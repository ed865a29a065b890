"""The commands ``plot`` and ``info``: pictures and contents of a result file, contents of a case."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trbdyn.base.own_files import file_path, output_path
from trbdyn.cli.case import subject_with_changes
from trbdyn.cli.declared import FILE, SET, Options, argument, subcommand
from trbdyn.cli.outcome import DONE, say

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene


@subcommand(
    "plot",
    "draw a result's pictures",
    FILE,
    argument("-o --output", "folder (default: FILE without its ending, + _plots)", "FOLDER"),
    argument("--only", "draw these pictures only", "NAME", nargs="+"),
    argument("--animation", "also write animation.gif"),
    argument("--overwrite", "replace pictures that are there"),
)
def plot(options: Options) -> int:
    from trbdyn import plot
    from trbdyn.plot import animation
    from trbdyn.results.assembly import load

    result = load(options.file)
    folder = Path(f"{Path(options.file).with_suffix('')}_plots" if options.output is None else options.output)
    moving = {folder / name / "animation.gif": one for name, one in result.by_name.items() if options.animation}
    for path in moving:
        if path.parent.is_dir():
            output_path(path, overwrite=options.overwrite)
    written = plot.all(result, folder, options.only, overwrite=options.overwrite)
    for path, one in moving.items():
        written.append(animation.save(animation.animate(one), path, overwrite=options.overwrite))
    for path in written:
        say(path)
    return DONE


@subcommand(
    "info",
    "show what a result file or a case holds",
    argument("file", "a result file, a TOML file or the name of a shipped case", "FILE|CASE"),
    argument("--json", "as JSON"),
    SET,
)
def info(options: Options) -> int:
    from trbdyn.model.scene import Scene

    path = file_path(options.file, "file")
    if path.is_file() and path.suffix != ".toml":
        return _info_result(path, as_json=options.json)
    scene, run = subject_with_changes(options.file, options.changes)
    if options.json:
        say(json.dumps({type(scene).__name__.lower(): scene.to_dict(), "run": run.to_dict()}, indent=2))
    elif isinstance(scene, Scene):
        say(_describe(scene))
        say("\nderived geometry (m, rad, kg)")
        for name, value in asdict(scene.bearing.geometry).items():
            say(f"    {name:<28} {value:.6g}")
    else:
        from trbdyn.statics.assembly import equilibrium

        say(f"{scene._shown().text()}\n\n{equilibrium(scene)}")
    return DONE


def _info_result(path: Path, *, as_json: bool) -> int:
    from trbdyn.results import summary
    from trbdyn.results.assembly import load
    from trbdyn.results.result import Result

    result = load(path)
    if not isinstance(result, Result):
        about = {name: summary.clean(values) for name, values in result.summary().items()}
        say(json.dumps(about, indent=2, allow_nan=False) if as_json else result)
        return DONE
    values = result.summary()
    if as_json:
        about = {"meta": result.meta, "records": len(result), "groups": result.groups, "stats": result.stats}
        say(json.dumps(summary.clean(about | {"summary": values}), indent=2, allow_nan=False))
        return DONE
    say(_describe(result.scene))
    say(f"{len(result)} records, groups {', '.join(result.groups)}")
    say(", ".join(f"{name} {value}" for name, value in result.meta.items() if isinstance(value, str | int)))
    say()
    say(summary.table(values))
    return DONE


def _describe(scene: Scene) -> str:
    """What is run, in a few lines."""
    bearing, cage = scene.bearing, scene.bearing.cage
    effects = scene.effects.to_dict()
    effects.pop("friction")
    return "\n".join(
        (
            f"bearing {bearing.name}: {bearing.n_rollers} rollers, pitch diameter {1e3 * bearing.pitch_diameter:.4g} mm, "
            f"cage play {1e3 * cage.play_radial:.3g} mm radial, {1e3 * cage.play_circumferential:.3g} mm circumferential",
            f"speed {_amount(scene.speed_rpm)} rpm, axial load {_amount(scene.axial_load)} N, "
            f"radial load {_amount(scene.radial_load)} N, oil at {scene.lubricant.temperature_c:g} C, start {scene.start.kind}",
            "effects: " + ", ".join(f"{name} {value}" for name, value in effects.items()),
            *(["defects: " + ", ".join(f"{one.kind} on {one.on}" for one in scene.defects)] if scene.defects else []),
        )
    )


def _amount(quantity: Any) -> str:
    return f"{quantity:g}" if isinstance(quantity, int | float) else "history"
