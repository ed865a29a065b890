"""The commands ``run`` and ``resume``."""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trbdyn.base.own_files import file_path, output_path
from trbdyn.base.printable import printable
from trbdyn.cli.called import command
from trbdyn.cli.case import add_set, simulate, subject_with_changes
from trbdyn.cli.outcome import DONE, FAILED, say
from trbdyn.errors import InputError

if TYPE_CHECKING:
    from trbdyn.results.assembly import AssemblyResult
    from trbdyn.results.result import Result


def add_run_parsers(
    commands: Any, common: Sequence[argparse.ArgumentParser], length: Sequence[argparse.ArgumentParser]
) -> None:
    """Add the commands ``run`` and ``resume``."""
    run = commands.add_parser("run", parents=[*common, *length], help="run a case")
    run.add_argument("case", metavar="CASE", help="a TOML file, or the name of a shipped case")
    run.add_argument("-o", "--output", metavar="FILE", help="result file (default: CASE.h5 in this folder)")
    run.add_argument("--duration", type=float, metavar="S", help="bearing time (s), in place of revolutions")
    run.add_argument(
        "--until",
        action="append",
        default=[],
        metavar="NAME=SHARE",
        help="end earlier, when this average of the summary is known within this share, for instance torque=0.01 "
        "(may be given several times)",
    )
    run.add_argument(
        "--save-every",
        type=float,
        metavar="S",
        help="time between records (s); default 1e-4, up to 1e-3 in long runs",
    )
    run.add_argument(
        "--checkpoint-every", type=float, metavar="S", help="bearing time between checkpoints (s), to resume from"
    )
    run.add_argument("--overwrite", action="store_true", help="replace result, summary and report if they are there")
    _add_written(run)
    add_set(run)
    run.set_defaults(command=_run)

    resume = commands.add_parser("resume", parents=[*common], help="go on with a run that was cut off")
    resume.add_argument("file", metavar="FILE", help="its result file; the checkpoint lies beside it")
    resume.add_argument("--instruction-set", metavar="NAME", help="kernel variant, in place of the one it began with")
    resume.add_argument("--quiet", action="store_true", help="no progress bar, no summary")
    resume.add_argument("--overwrite", action="store_true", help="replace summary and report if they are there")
    _add_written(resume)
    resume.set_defaults(command=_resume)


def _add_written(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--summary", metavar="FILE", help="write the summary as JSON")
    parser.add_argument("--report", metavar="HTML", help="write the report of the run, with its pictures")


def _wanted(text: str) -> tuple[str, float]:
    name, _, share = text.partition("=")
    try:
        return name.strip(), float(share)
    except ValueError:
        raise InputError.of("--until", text, "must be NAME=SHARE, for instance torque=0.01") from None


def _run(options: argparse.Namespace) -> int:
    subject, run = subject_with_changes(options.case, options.changes)
    changes = {
        name: getattr(options, name)
        for name in ("revolutions", "duration", "save_every", "accuracy", "checkpoint_every")
        if getattr(options, name) is not None
    }
    if options.until:
        changes["until"] = dict(map(_wanted, options.until))
    if "revolutions" in changes and "duration" not in changes:
        changes["duration"] = None
    if "duration" in changes and "revolutions" not in changes:
        changes["revolutions"] = None
    name = f"{Path(options.case).stem}.h5" if options.output is None else options.output
    output = output_path(name, overwrite=options.overwrite, reads=[options.case])
    _check_written(options, [options.case, output])
    given = run.model_fields_set | changes.keys()
    result = simulate(
        subject, run.replace(**changes), output, quiet=options.quiet, overwrite=options.overwrite, given=given
    )
    return _finish(result, output, options)


def _check_written(options: argparse.Namespace, others: Sequence[str | Path]) -> None:
    """See before a run that its summary and its report can be written."""
    from trbdyn.reporting import HTML

    taken = list(others)
    for field, endings in (("summary", ()), ("report", HTML)):
        if (file := getattr(options, field)) is not None:
            taken.append(output_path(file, overwrite=options.overwrite, field=field, endings=endings, reads=taken))


def _resume(options: argparse.Namespace) -> int:
    from trbdyn.run.resume import resume

    _check_written(options, [file_path(options.file, "file")])
    with warnings.catch_warnings(record=True) as notes:
        warnings.simplefilter("always", UserWarning)
        try:
            result = resume(options.file, instruction_set=options.instruction_set, progress=not options.quiet)
        finally:
            for note in notes:
                say(f"trbdyn: {printable(str(note.message))}", file=sys.stderr)
    return _finish(result, Path(options.file), options)


def _how_to_go_on(output: Path) -> str:
    """The command that goes on with a run that was stopped, if it has made checkpoints."""
    from trbdyn.run.checkpoint import checkpoint_path

    return f"; go on with: {command('resume', output)}" if checkpoint_path(output).exists() else ""


def _finish(result: Result | AssemblyResult, output: Path, options: argparse.Namespace) -> int:
    """Write summary and report, print the summary; the exit code says whether the run reached its end."""
    from trbdyn.results import summary

    one = result.parts[0]
    if options.summary is not None:
        summary.write_json(result.summary(), options.summary, overwrite=options.overwrite)
    if options.report is not None:
        from trbdyn.reporting import report

        report(result, options.report, overwrite=options.overwrite)
    if not options.quiet:
        say(result.overview)
        say(f"\n{len(one)} records in {output}: {one.meta.get('kept', '')}")
    if not result.success:
        say(f"trbdyn: {printable(result.message)}{_how_to_go_on(output)}", file=sys.stderr)
    return DONE if result.success else FAILED
