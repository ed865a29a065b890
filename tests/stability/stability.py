"""The table of all hard scenes: `python tests/stability/stability.py [--json FILE] [NAME...]`."""

from __future__ import annotations

import argparse
import json
import sys
import time
from dataclasses import asdict
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from hard_pairs import PAIRS
from hard_runs import Verdict, judge
from hard_scenes import HARD

HEAD = (
    f"{'scene':<28} {'status':<7} {'steps':>8} {'smallest':>9} {'s/rev':>8} {'steps x':>8} {'energy':>8} {'twin':>8} "
    f"{'2 tol.':>8} {'2 meth.':>8}"
)

MANY = 50.0
"""Steps over those of the smooth scene from which the reason is told."""


def line(verdict: Verdict) -> str:
    numbers = (verdict.closure, verdict.twin, verdict.tolerances, verdict.path)
    if verdict.status == "error":
        return f"{verdict.name:<28} {verdict.status:<7} {verdict.message}"
    text = f"{verdict.name:<28} {verdict.status:<7} {verdict.steps:>8} {verdict.smallest_step:>9.1e} "
    text += f"{verdict.wall_s_per_revolution:>8.2g} {verdict.ratio:>8.2f} "
    return text + " ".join(f"{number:>8.1e}" for number in numbers)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="these scenes only")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the table as JSON")
    parser.add_argument("--quick", action="store_true", help="leave out the slow scenes")
    options = parser.parse_args()
    every = (*HARD, *PAIRS)
    unknown = set(options.names) - {hard.name for hard in every}
    if unknown:
        parser.error(f"no such scene: {', '.join(sorted(unknown))}")
    print(HEAD)
    verdicts, rows = [], []
    for hard in every:
        if (options.names and hard.name not in options.names) or (options.quick and hard.slow and not options.names):
            continue
        began = time.perf_counter()
        verdict = judge(hard)
        verdicts.append(verdict)
        of_hard = {"why": hard.why, "reason": hard.reason, "duration_s": hard.duration}
        rows.append(of_hard | asdict(verdict) | {"wall_s": time.perf_counter() - began})
        print(line(verdict), flush=True)
        for trouble in verdict.broken:
            print(f"    {trouble}", flush=True)
        if verdict.ratio > MANY:
            print(f"    more than {MANY:g} times the steps: {hard.reason or 'NO REASON IS KNOWN'}", flush=True)
    if options.json:
        clean = [{name: None if value != value else value for name, value in row.items()} for row in rows]
        options.json.parent.mkdir(parents=True, exist_ok=True)
        options.json.write_text(json.dumps(clean, indent=2) + "\n", encoding="utf-8")
    failed = sum(verdict.status == "failed" for verdict in verdicts)
    promised = sum(verdict.status == "error" for verdict in verdicts)
    print(f"status error: {promised} scenes that are impossible, and end with the error that is promised")
    print(f"{len(verdicts) - failed} passed, {failed} failed")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
