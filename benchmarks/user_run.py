"""What a user's run takes beside the bare steps: records of all groups, peaks, a file.

    python benchmarks/user_run.py [--quick] [--json FILE]
    python benchmarks/user_run.py --write-readme         puts the table into benchmarks/README.md

The colliding cage with 24 slices a contact, run for as many turns as ``make demo``: the steps alone, the default run in memory,
the default run with a file; each several times in turns. Medians; a ratio is the median of
the ratios within a repeat. Ratios of the processor time of all threads are printed below the table.
"""

from __future__ import annotations

from collections.abc import Sequence

import common
from accuracy import states, user
from accuracy.tables import user_table

from trbdyn.run.options import ACCURACY

COLUMNS = {
    "case": "text: name of the scene",
    "preset": "text: preset of accuracy",
    "n_slices": "1: slices of a contact, uniform",
    "turns": "1: turns of the shaft of each run",
    **user.COLUMNS,
}


def run(report: common.Report, case: states.Case, turns: float, repeats: int) -> None:
    """A row for each preset."""
    report.inputs = {"turns": turns, "repeats": repeats, "n_slices": user.SLICES}
    report.notes = ["Wall times: on a machine with other work they are too large, those with records most."]
    for preset in ACCURACY:
        times = user.times_of(case, preset, turns, repeats)
        report.add(case=case.name, preset=preset, n_slices=user.SLICES, turns=turns, **user.columns_of(times))


def main(arguments: Sequence[str] | None = None) -> common.Report:
    parser = common.parser(__doc__)
    parser.add_argument("--turns", type=float, help="turns of the shaft of each run")
    options = parser.parse_args(arguments)
    report = common.Report("user_run", options, COLUMNS)
    turns = options.turns or (10.0 if options.quick else user.TURNS)
    run(report, states.load_case("collision"), turns, 3 if options.quick else 11)
    report.readme = user_table(report.results)
    print("\n" + report.readme)
    print("\n" + common.table(report.results, ("preset", "process_memory_over_bare", "process_file_over_bare")))
    report.finish()
    return report


if __name__ == "__main__":
    main()
