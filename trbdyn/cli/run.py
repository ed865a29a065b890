"""The commands ``run`` and ``resume``."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from trbdyn.base.own_files import file_path, output_path
from trbdyn.base.printable import printable
from trbdyn.cli.called import command
from trbdyn.cli.case import named_numbers, simulate, subject_with_changes
from trbdyn.cli.declared import CASE, LENGTH, SET, Options, argument, subcommand
from trbdyn.cli.outcome import DONE, FAILED, say

if TYPE_CHECKING:
    from trbdyn.results.assembly import AssemblyResult
    from trbdyn.results.result import Result


WRITTEN: Final = (
    argument("--summary", "write the summary as JSON", "FILE"),
    argument("--report", "write the report of the run, with its pictures", "HTML"),
)


@subcommand(
    "run",
    "run a case",
    *LENGTH,
    CASE,
    argument("-o --output", "result file (default: CASE.h5 in this folder)", "FILE"),
    argument("--duration", "bearing time (s), in place of revolutions", "S", type=float),
    argument(
        "--until",
        "end earlier, when this average of the summary is known within this share, for instance torque=0.01 "
        "(may be given several times), or the cage's motion has settled within this share of Cpr, cage=0.05",
        "NAME=SHARE",
        action="append",
        default=[],
    ),
    argument("--save-every", "time between records (s); default 1e-4, up to 1e-3 in long runs", "S", type=float),
    argument("--checkpoint-every", "bearing time between checkpoints (s), to resume from", "S", type=float),
    argument("--overwrite", "replace result, summary and report if they are there"),
    *WRITTEN,
    SET,
)
def run(options: Options) -> int:
    subject, run = subject_with_changes(options.case, options.changes)
    changes = {
        name: getattr(options, name)
        for name in ("revolutions", "duration", "save_every", "accuracy", "checkpoint_every")
        if getattr(options, name) is not None
    }
    if options.until:
        changes["until"] = named_numbers("--until", options.until, "NAME=SHARE", "torque=0.01")
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


def _check_written(options: Options, others: Sequence[str | Path]) -> None:
    """See before a run that its summary and its report can be written."""
    from trbdyn.reporting import HTML

    taken = list(others)
    for field, endings in (("summary", ()), ("report", HTML)):
        if (file := getattr(options, field)) is not None:
            taken.append(output_path(file, overwrite=options.overwrite, field=field, endings=endings, reads=taken))


@subcommand(
    "resume",
    "go on with a run that was cut off",
    argument("file", "its result file; the checkpoint lies beside it", "FILE"),
    argument("--instruction-set", "kernel variant, in place of the one it began with", "NAME"),
    argument("--quiet", "no progress bar, no summary"),
    argument("--overwrite", "replace summary and report if they are there"),
    *WRITTEN,
)
def resume(options: Options) -> int:
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


def _finish(result: Result | AssemblyResult, output: Path, options: Options) -> int:
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
