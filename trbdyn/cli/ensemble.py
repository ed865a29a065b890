"""The command ``ensemble``: many designs drawn from bands, what decides among them, and how well others can be predicted."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

from trbdyn.cli.called import command
from trbdyn.cli.case import subject_with_changes
from trbdyn.cli.declared import CASE, SET, WORKERS, Options, argument, subcommand
from trbdyn.cli.outcome import DONE, FAILED, INTERRUPTED, say
from trbdyn.errors import InputError


@subcommand(
    "ensemble",
    "run many designs that are drawn from bands",
    CASE,
    argument(
        "--band",
        "an input and its ends, for instance bearing.cage.play_circumferential=6e-5:2e-4 (given several times)",
        "PATH=LOW:HIGH",
        action="append",
        required=True,
    ),
    argument("--designs", "how many are drawn (default: 256)", "N", type=int, default=256),
    argument("--seed", "of the draws (default: 0)", "N", type=int, default=0),
    argument(
        "--predict",
        "observables of the summary (default: torque and orbit_rms_over_cpr, those that the scene has)",
        "NAME",
        nargs="+",
    ),
    WORKERS,
    argument("-o --output", "results and observables.nc (default: CASE_ensemble)", "FOLDER"),
    argument("--quiet", "no progress bar, no tables"),
    SET,
)
def ensemble(options: Options) -> int:
    """Run many designs of a case that are drawn from bands, and tell for each observable its spread, which inputs decide on
    it, and how well designs that were not run can be predicted. The same command goes on with a run that was stopped.
    """
    from trbdyn import surrogate, uncertainty
    from trbdyn.extras.design.surrogate import FEWEST_DRAWS
    from trbdyn.extras.study.bands import Band
    from trbdyn.extras.study.gather import listed_in
    from trbdyn.extras.study.uncertainty import checked_bands
    from trbdyn.results import numbers

    scene, run = subject_with_changes(options.case, options.changes)
    bands = checked_bands([Band(path=path, low=low, high=high) for path, low, high in map(_band, options.band)])
    if options.designs < FEWEST_DRAWS:
        raise InputError.of("--designs", options.designs, f"must be at least {FEWEST_DRAWS}")
    for name in options.predict or ():  # before the runs, which take long
        numbers.check(name, "--predict", bearings=scene.names)
    folder = options.output or f"{Path(options.case).stem}_ensemble"
    try:
        found = uncertainty(
            scene,
            bands,
            samples=options.designs,
            seed=options.seed,
            options=run,
            folder=folder,
            executor="processes",
            workers=options.workers,
            progress=not options.quiet,
        )
    except KeyboardInterrupt:
        again = command(*options.words)
        say(f"trbdyn: stopped; the designs that are done are kept in {folder}. Go on: {again}", file=sys.stderr)
        return INTERRUPTED
    predicted = options.predict or [name for name in listed_in(found.data, "ensemble") if name in found.spreads]
    found = replace(found, shown=tuple(name for name in predicted if name in found.spreads))
    fits: list[object] = []
    for name in predicted:
        try:
            fits.append(surrogate(found, name, seed=options.seed))
        except InputError as error:  # one that is the same in all runs, say; the others are told nevertheless
            fits.append(error)
    if not options.quiet:
        say(found, *fits, f"results and observables.nc in {folder}", sep="\n\n")
    if found.refused:
        say(f"trbdyn: {len(found.refused)} designs could not be run; the first: {found.refused[0]}", file=sys.stderr)
    return FAILED if found.refused else DONE


def _band(text: str) -> tuple[str, float, float]:
    path, _, ends = text.partition("=")
    low, _, high = ends.partition(":")
    try:
        return path.strip(), float(low), float(high)
    except ValueError:
        raise InputError.of("--band", text, "must be PATH=LOW:HIGH, for instance scene.speed_rpm=1000:6000") from None
