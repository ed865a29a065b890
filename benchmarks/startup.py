"""What the start takes: processor time of new processes from nothing to the first simulation, and of the command line's help.

    python benchmarks/startup.py [--quick] [--json FILE]

Each row is the least of several new processes, user and system time together with that of their children: other work
on the machine disturbs it least.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence

import common

COLUMNS = {
    "process": "text: what the new process does",
    "cpu_s": "s: processor time, the least of the repeats",
    "modules": "1: modules that are imported in the end",
}

FIRST = "import trbdyn as trb; trb.Simulation(trb.cases.paper_30310(3000.0)).run(duration=1e-4, save_every=1e-5)"
PROCESSES = {
    "Python alone": "pass",
    "import numpy": "import numpy",
    "trbdyn --help": "import sys; sys.argv[1:] = ['--help']; from trbdyn.__main__ import main; main()",
    "first simulation, in memory": FIRST,
}

TAIL = """
import atexit, sys, os
def told():
    spent = os.times()
    print("SPENT", sum(spent[:4]), len(sys.modules), file=sys.stderr)
atexit.register(told)
"""


def measure(code: str) -> tuple[float, int]:
    """Processor time (s) of a new process, and its number of modules."""
    done = subprocess.run([sys.executable, "-c", TAIL + code], capture_output=True, text=True, check=True)
    words = done.stderr.rpartition("SPENT")[2].split()
    return float(words[0]), int(words[1])


def main(arguments: Sequence[str] | None = None) -> common.Report:
    options = common.parser(__doc__).parse_args(arguments)
    report = common.Report("startup", options, COLUMNS)
    repeats = 1 if options.smoke else 5 if options.quick else 15
    report.inputs = {"repeats": repeats}
    for name, code in PROCESSES.items():
        found = [measure(code) for _ in range(repeats)]
        report.add(process=name, cpu_s=min(cpu for cpu, _ in found), modules=found[-1][1])
    print(common.table(report.results, COLUMNS))
    report.finish()
    return report


if __name__ == "__main__":
    main()
