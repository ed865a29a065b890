"""The command line: run cases, draw pictures, look into files and cases.

Exit codes: 0 done; 1 a run failed or was stopped by Ctrl-C (what it recorded is kept); 2 input, case or file that
cannot be used; 3 a fault of trbdyn itself; 130 stopped by Ctrl-C outside of a run.
"""

from __future__ import annotations

import argparse
import io
import json
import os
import sys
import tomllib
import traceback
import warnings
from collections.abc import Callable, Collection, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NoReturn

from trbdyn.errors import FileError, InputError, LoadError, TrbError
from trbdyn.own_files import file_path, output_path

if TYPE_CHECKING:
    from trbdyn.results import Result
    from trbdyn.run_options import RunOptions
    from trbdyn.scene import Scene

DONE, FAILED, BAD_INPUT, FAULT, INTERRUPTED = 0, 1, 2, 3, 130

DEMO_PICTURES: Final = ("cage_locus", "spacing_angles", "tilt", "pocket_forces")
DEMO_REPORT: Final = (
    "cage_locus",
    "orbit_radius",
    "load_zone",
    "pressure_map",
    "film_map",
    "pocket_polar",
    "torque_split",
    "energy_audit",
)
DEMO_WORDS: Final = (
    "A tapered roller bearing 30310 turns at 3000 rpm under 4930 N axial load, for {turns:g} turns of the shaft.\n"
    "Its cage starts off centre. Will it whirl, how hard do the rollers strike it, and what does the bearing cost in torque?\n"
    "Everything is written to {folder}."
)

_SIMULATION_OPTIONS: Final = (
    "accuracy",
    "integrator",
    "rtol",
    "atol_position",
    "atol_angle",
    "atol_velocity",
    "atol_spin",
    "max_order",
    "max_step",
    "first_step",
    "rings_share",
    "impact_share",
    "checkpoint_every",
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        Words after the program's name; those of the process by default.

    Returns
    -------
    int
        Exit code.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # names of files may hold any bytes
    options = _parser().parse_args(arguments)
    command: Callable[[argparse.Namespace], int] = options.command
    try:
        return command(options)
    except (InputError, LoadError, FileError) as error:
        return _report(error, BAD_INPUT, options.debug)
    except TrbError as error:
        return _report(error, FAILED, options.debug)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    except KeyboardInterrupt:
        print("trbdyn: stopped", file=sys.stderr)
        return INTERRUPTED
    except (OSError, MemoryError) as error:
        return _report(error, BAD_INPUT, options.debug)
    except Exception as error:
        return _report(error, FAULT, options.debug)


def _report(error: Exception, code: int, debug: bool) -> int:
    """Say what went wrong, with one line for each problem."""
    if debug:
        traceback.print_exception(error)
    lines = [str(error)]
    if isinstance(error, InputError):
        lines = [problem.line(error.root) for problem in error.problems]
    elif isinstance(error, MemoryError):
        lines = [f"there is not enough memory {error}".strip()]
    elif code == FAULT:
        lines = [f"a fault of trbdyn itself, please report it: {type(error).__name__}: {error} (--debug shows where)"]
    for line in lines:
        print(f"trbdyn: {one_line(line)}", file=sys.stderr)
    return code


def one_line(text: str) -> str:
    """A text with everything escaped that would end a line or move a terminal's cursor."""
    return "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in text)


class _Parser(argparse.ArgumentParser):
    """A parser that says what is wrong in one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(BAD_INPUT, f"{self.prog}: {one_line(message)} (--help shows what is allowed)\n")


def _parser() -> argparse.ArgumentParser:
    from trbdyn import __version__

    parser = _Parser(prog="trbdyn", description="Dynamics of tapered roller bearings.")
    parser.add_argument("--version", action="version", version=f"trbdyn {__version__}")
    common = _Parser(add_help=False)
    common.add_argument("--debug", action="store_true", help="show where an error arose")
    length = _Parser(add_help=False)
    length.add_argument("--revolutions", type=float, metavar="N", help="turns of the shaft")
    length.add_argument("--accuracy", choices=("fast", "standard", "reference"), help="preset of the tolerances")
    length.add_argument("--quiet", action="store_true", help="no progress bar, no summary")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    run = commands.add_parser("run", parents=[common, length], help="run a case")
    run.add_argument("case", metavar="CASE", help="a TOML file, or the name of a shipped case")
    run.add_argument("-o", "--output", metavar="FILE", help="result file (default: CASE.h5 in this folder)")
    run.add_argument("--duration", type=float, metavar="S", help="bearing time (s), in place of revolutions")
    run.add_argument(
        "--save-every",
        type=float,
        metavar="S",
        help="time between records (s); default 1e-4, up to 1e-3 in long runs",
    )
    run.add_argument(
        "--checkpoint-every", type=float, metavar="S", help="bearing time between checkpoints (s), to resume from"
    )
    run.add_argument("--summary", metavar="FILE", help="write the summary as JSON")
    run.add_argument("--overwrite", action="store_true", help="replace result and summary if they are there")
    _add_set(run)
    run.set_defaults(command=_run)

    resume = commands.add_parser("resume", parents=[common], help="go on with a run that was cut off")
    resume.add_argument("file", metavar="FILE", help="its result file; the checkpoint lies beside it")
    resume.add_argument("--instruction-set", metavar="NAME", help="kernel variant, in place of the one it began with")
    resume.add_argument("--quiet", action="store_true", help="no progress bar, no summary")
    resume.add_argument("--summary", metavar="FILE", help="write the summary as JSON")
    resume.add_argument("--overwrite", action="store_true", help="replace the summary if it is there")
    resume.set_defaults(command=_resume)

    plot = commands.add_parser("plot", parents=[common], help="draw a result's pictures")
    plot.add_argument("file", metavar="FILE", help="a result file")
    plot.add_argument("-o", "--output", metavar="FOLDER", help="folder (default: FILE without its ending, + _plots)")
    plot.add_argument("--only", nargs="+", metavar="NAME", help="draw these pictures only")
    plot.add_argument("--animation", action="store_true", help="also write animation.gif")
    plot.set_defaults(command=_plot)

    info = commands.add_parser("info", parents=[common], help="show what a result file or a case holds")
    info.add_argument("file", metavar="FILE|CASE", help="a result file, a TOML file or the name of a shipped case")
    info.add_argument("--json", action="store_true", help="as JSON")
    _add_set(info)
    info.set_defaults(command=_info)

    demo = commands.add_parser(
        "demo", parents=[common, length], help="the 30310 at 3000 rpm and 4930 N, from a whirling start"
    )
    demo.add_argument("-o", "--output", metavar="FOLDER", default="demo", help="folder (default: demo)")
    demo.add_argument("--overwrite", action="store_true", help="replace the run that is in the folder")
    demo.set_defaults(command=_demo)

    from trbdyn.paper.command import add_paper_parser
    from trbdyn.reporting.command import add_report_parser
    from trbdyn.study.command import add_sweep_parser
    from trbdyn.viewer.command import add_view_parser

    add_report_parser(commands, [common])
    add_view_parser(commands, [common])
    add_sweep_parser(commands, [common])
    add_paper_parser(commands, [common])

    cases = commands.add_parser("cases", parents=[common], help="list the cases that ship with the package")
    cases.add_argument(
        "--print", dest="name", metavar="NAME", help="print this case with every number and what it means"
    )
    cases.set_defaults(command=_cases)

    new = commands.add_parser(
        "new", parents=[common], help="write a case with every number, to change for your own bearing"
    )
    new.add_argument("file", metavar="FILE", help="a TOML file that does not exist yet")
    new.add_argument("--case", default="rig_30310", metavar="NAME", help="the case to begin with (default: rig_30310)")
    new.set_defaults(command=_new)
    return parser


def _add_set(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        dest="changes",
        metavar="KEY=VALUE",
        help="change a value of the case, for instance scene.speed_rpm=1000 (may be given several times)",
    )


def _load_case(name: str, changes: Sequence[str]) -> tuple[Scene, RunOptions]:
    """A case, with ``table.key=value`` changes put in."""
    from trbdyn.toml_case import case_from_dict, find_case, load_case, read_tables

    if not changes:
        return load_case(name)
    path = file_path(name, "case")
    values = read_tables(path if path.exists() else find_case(name))
    for change in changes:
        key, equals, text = change.partition("=")
        *tables, last = key.strip().split(".")
        if not equals or not last:
            raise InputError.of("--set", change, "must be KEY=VALUE, for instance scene.speed_rpm=1000")
        table = values
        for part in tables:
            table = table.setdefault(part, {})
            if not isinstance(table, dict):
                raise InputError.of("--set", change, f"{part!r} is a value, not a table")
        table[last] = _toml_value(text)
    return case_from_dict(values)


def _toml_value(text: str) -> Any:
    """A TOML value; what is none is text."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text.strip()
    except (ValueError, RecursionError):
        raise InputError.of("--set", text, "must be a TOML value that is not that long or deep") from None


def _run(options: argparse.Namespace) -> int:
    scene, run = _load_case(options.case, options.changes)
    changes = {
        name: getattr(options, name)
        for name in ("revolutions", "duration", "save_every", "accuracy", "checkpoint_every")
        if getattr(options, name) is not None
    }
    if "revolutions" in changes and "duration" not in changes:
        changes["duration"] = None
    if "duration" in changes and "revolutions" not in changes:
        changes["revolutions"] = None
    name = f"{Path(options.case).stem}.h5" if options.output is None else options.output
    output = output_path(name, overwrite=options.overwrite)
    _check_summary(options.summary, output, overwrite=options.overwrite)
    given = run.model_fields_set | changes.keys()
    result = _simulate(
        scene, run.replace(**changes), output, quiet=options.quiet, overwrite=options.overwrite, given=given
    )
    return _finish(result, output, options.summary, quiet=options.quiet)


def _check_summary(summary_file: str | None, output: Path, *, overwrite: bool) -> None:
    """See before a run that its summary can be written."""
    if summary_file is None:
        return
    path = output_path(summary_file, overwrite=overwrite, field="summary")
    if path.absolute() == output.absolute():
        raise InputError.of("summary", summary_file, "must be another file than the result")
    if not path.parent.is_dir():
        raise FileError(f"{path}: cannot be written: there is no folder {path.parent}")


def _resume(options: argparse.Namespace) -> int:
    from trbdyn.resuming import resume

    _check_summary(options.summary, file_path(options.file, "file"), overwrite=options.overwrite)
    with warnings.catch_warnings(record=True) as notes:
        warnings.simplefilter("always", UserWarning)
        try:
            result = resume(options.file, instruction_set=options.instruction_set, progress=not options.quiet)
        finally:
            for note in notes:
                print(f"trbdyn: {one_line(str(note.message))}", file=sys.stderr)
    return _finish(result, Path(options.file), options.summary, quiet=options.quiet)


def _simulate(
    scene: Scene, run: RunOptions, output: Path, *, quiet: bool, overwrite: bool, given: Collection[str] = ()
) -> Result:
    """Run a case; what is not given of what to keep is chosen by the length of the run."""
    from trbdyn.run_options import RunOptions
    from trbdyn.simulation import Simulation

    run.end_time(scene.speed_rpm)
    default = RunOptions()
    settings = {
        name: getattr(run, name) for name in _SIMULATION_OPTIONS if getattr(run, name) != getattr(default, name)
    }
    with warnings.catch_warnings(record=True) as notes:
        warnings.simplefilter("always", UserWarning)
        simulation = Simulation(scene, **settings)
    for note in notes:
        print(f"trbdyn: warning: {note.message}", file=sys.stderr)
    return simulation.run(
        revolutions=run.revolutions,
        duration=run.duration,
        save_every=run.save_every if "save_every" in given else None,
        save_groups=run.save_groups if "save_groups" in given else None,
        progress=not quiet,
        output=output,
        overwrite=overwrite,
    )


def _finish(result: Result, output: Path, summary_file: str | Path | None, *, quiet: bool) -> int:
    """Write and print the summary; the exit code says whether the run reached its end."""
    from trbdyn import summary

    values = result.summary()
    if summary_file is not None:
        summary.write_json(values, summary_file)
    if not quiet:
        print(summary.table(values))
        print(f"\n{len(result)} records in {output}: {result.meta.get('kept', '')}")
    if not result.success:
        print(f"trbdyn: {one_line(result.message)}", file=sys.stderr)
    return DONE if result.success else FAILED


def _plot(options: argparse.Namespace) -> int:
    from trbdyn import plotting
    from trbdyn.results import load

    result = load(options.file)
    folder = Path(f"{Path(options.file).with_suffix('')}_plots" if options.output is None else options.output)
    written = plotting.all(result, folder, options.only)
    if options.animation:
        from trbdyn import animation

        written.append(animation.save(animation.animate(result), folder / "animation.gif"))
    for path in written:
        print(path)
    return DONE


def _info(options: argparse.Namespace) -> int:
    path = file_path(options.file, "file")
    if path.is_file() and path.suffix != ".toml":
        return _info_result(path, as_json=options.json)
    scene, run = _load_case(options.file, options.changes)
    if options.json:
        print(json.dumps({"scene": scene.to_dict(), "run": run.to_dict()}, indent=2))
        return DONE
    print(_describe(scene))
    print("\nderived geometry (m, rad, kg)")
    for name, value in asdict(scene.bearing.geometry).items():
        print(f"    {name:<28} {value:.6g}")
    return DONE


def _info_result(path: Path, *, as_json: bool) -> int:
    from trbdyn import summary
    from trbdyn.results import load

    result = load(path)
    values = result.summary()
    if as_json:
        about = {"meta": result.meta, "records": len(result), "groups": result.groups, "stats": result.stats}
        print(json.dumps(summary.clean(about | {"summary": values}), indent=2, allow_nan=False))
        return DONE
    print(_describe(result.scene))
    print(f"{len(result)} records, groups {', '.join(result.groups)}")
    print(", ".join(f"{name} {value}" for name, value in result.meta.items() if isinstance(value, str | int)))
    print()
    print(summary.table(values))
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
        )
    )


def _amount(quantity: Any) -> str:
    return f"{quantity:g}" if isinstance(quantity, int | float) else "history"


def _demo(options: argparse.Namespace) -> int:
    from trbdyn import plotting, summary
    from trbdyn.cases import scene_30310
    from trbdyn.effects import Effects
    from trbdyn.reporting import report
    from trbdyn.reporting.verdict import what_matters
    from trbdyn.run_options import RunOptions
    from trbdyn.scene import Start
    from trbdyn.viewer import view

    revolutions = 50.0 if options.revolutions is None else options.revolutions
    run = RunOptions(revolutions=revolutions, accuracy=options.accuracy or "standard")
    scene = scene_30310(3000.0, 4930.0, effects=Effects.paper(), start=Start.whirl(0.9))
    run.end_time(scene.speed_rpm)
    folder = plotting.make_folder(options.output)
    if not options.quiet:
        print(DEMO_WORDS.format(turns=revolutions, folder=folder))
    result = _simulate(scene, run, folder / "run.h5", quiet=options.quiet, overwrite=options.overwrite)
    plotting.all(result, folder, DEMO_PICTURES)
    numbers = result.summary()
    summary.write_json(numbers, folder / "summary.json")
    page = report(result, folder / "report.html", pictures=DEMO_REPORT)
    moving = folder / "view.html"
    view(result, moving)
    if not options.quiet:
        print("\n" + "\n".join(f"{number}. {text}" for number, text in enumerate(what_matters(result, numbers), 1)))
        print(f"\nreport: {page}\n3-D view: {moving}")
    if not result.success:
        print(f"trbdyn: {result.message}", file=sys.stderr)
    return DONE if result.success else FAILED


def _new(options: argparse.Namespace) -> int:
    from trbdyn.case_text import case_text

    path = Path(options.file)
    if path.suffix != ".toml":
        raise InputError.of("FILE", options.file, "must end in .toml")
    text = case_text(*_load_case(options.case, ()), title=f"Begun from the case {options.case}.")
    try:
        with path.open("x", encoding="utf-8") as stream:
            stream.write(text)
    except FileExistsError:
        raise FileError(f"{path}: exists already; choose another name, nothing was written") from None
    except OSError as error:
        raise FileError(f"{path}: {error.strerror or error}") from None
    print(f"{path} written: change its numbers, then run it with: trbdyn run {path}")
    return DONE


def _cases(options: argparse.Namespace) -> int:
    from trbdyn.case_text import case_text
    from trbdyn.toml_case import find_case, shipped_cases

    if options.name is not None:
        first = find_case(options.name).read_text(encoding="utf-8").partition("\n")[0].lstrip("# ")
        print(case_text(*_load_case(options.name, ()), title=first), end="")
        return DONE
    for name in shipped_cases():
        first = find_case(name).read_text(encoding="utf-8").partition("\n")[0]
        print(f"{name:<16} {first.lstrip('# ')}")
    return DONE
