"""Thousands of random scenes, judged; failures are shrunk to small scenes and kept.

python tests/adversary/adversary.py --count 1000             a number of scenes
python tests/adversary/adversary.py --minutes 20             for a time
python tests/adversary/adversary.py --count 12 --check       the check of each run is asked, too
"""

from __future__ import annotations

import argparse
import json
import multiprocessing as mp
import sys
import time as clock
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

from judge import Verdict, judge
from random_scenes import KINDS, ORDINARY, Table, draw

FOUND = Path(__file__).with_name("found")
BAD = ("wrong", "hanging", "crashed")


def one(job: tuple[str, int, bool]) -> dict[str, Any]:
    kind, seed, checked = job
    began = clock.process_time()
    try:
        verdict = judge(draw(kind, seed), checked=checked).to_dict()
    except Exception as error:  # whatever it is: it is a finding
        verdict = Verdict(draw(kind, seed), "crashed", [f"{type(error).__name__}: {error}"]).to_dict()
    return verdict | {"kind": kind, "seed": seed, "cpu_s": clock.process_time() - began}


def shrink(table: Table, status: str) -> Table:
    """The same failure with as many entries as ordinary as possible."""
    small = dict(table)
    for name in list(table):
        rest = {key: value for key, value in small.items() if key != name}
        if judge_quietly(rest) == status:
            small = rest
    for name in ("speed_rpm", "axial_load", "temperature_c", "radial_share", "direction_deg"):
        if name in small and isinstance(small[name], float):
            rounded = small | {name: float(f"{small[name]:.2g}")}
            if judge_quietly(rounded) == status:
                small = rounded
    return small


def judge_quietly(table: Table) -> str:
    try:
        return judge(table).status
    except Exception:
        return "crashed"


def jobs(args: argparse.Namespace) -> Iterator[tuple[str, int, bool]]:
    kinds = sorted(KINDS) if args.kind == "all" else [args.kind]
    seed = args.seed
    while args.count is None or seed < args.seed + args.count:
        for kind in kinds:
            yield kind, seed, args.check
        seed += 1


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, help="scenes of each kind")
    parser.add_argument("--minutes", type=float, help="for this time")
    parser.add_argument("--seed", type=int, default=0, help="first seed")
    parser.add_argument("--kind", choices=["all", *KINDS], default="all")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--check", action="store_true", help="ask the check of each run, too")
    parser.add_argument("--json", type=Path, help="every verdict")
    parser.add_argument("--keep", action="store_true", help="shrink failures and keep them in tests/adversary/found")
    args = parser.parse_args()
    if args.count is None and args.minutes is None:
        args.count = 100
    until = clock.monotonic() + 60.0 * args.minutes if args.minutes else float("inf")
    verdicts: list[dict[str, Any]] = []
    began = clock.monotonic()
    with ProcessPoolExecutor(args.jobs, mp_context=mp.get_context("spawn")) as pool:
        pending, source = set(), jobs(args)
        from concurrent.futures import FIRST_COMPLETED, wait

        while True:
            while len(pending) < 2 * args.jobs and clock.monotonic() < until:
                job = next(source, None)
                if job is None:
                    break
                pending.add(pool.submit(one, job))
            if not pending:
                break
            done, pending = wait(pending, return_when=FIRST_COMPLETED)
            for future in done:
                verdict = future.result()
                verdicts.append(verdict)
                if verdict["status"] in BAD:
                    say(verdict)
    report(verdicts, clock.monotonic() - began)
    if args.json:
        args.json.parent.mkdir(parents=True, exist_ok=True)
        args.json.write_text(json.dumps(verdicts, indent=1, default=str))
    bad = [v for v in verdicts if v["status"] in BAD]
    if args.keep:
        for verdict in bad:
            small = shrink(verdict["table"], verdict["status"])
            FOUND.mkdir(exist_ok=True)
            path = FOUND / f"{verdict['kind']}_{verdict['seed']}.json"
            path.write_text(
                json.dumps({"status": verdict["status"], "broken": verdict["broken"], "scene": small}, indent=1) + "\n"
            )
            print(f"kept {path.name}: {small}")
    return 1 if bad else 0


def say(verdict: dict[str, Any]) -> None:
    said = {name: value for name, value in verdict["table"].items() if ORDINARY.get(name) != value}
    text = {name: f"{value:.4g}" if isinstance(value, float) else value for name, value in said.items()}
    print(
        f"{verdict['status']}: {verdict['kind']} {verdict['seed']}: {'; '.join(verdict['broken'])}; {text}", flush=True
    )


def report(verdicts: list[dict[str, Any]], seconds: float) -> None:
    counts = Counter((v["kind"], v["status"]) for v in verdicts)
    statuses = ["right", "warned", "told", "chance", "unjudged", "stopped", "refused", "wrong", "hanging", "crashed"]
    print(f"\n{len(verdicts)} scenes in {seconds / 60:.1f} min")
    print("kind      " + "".join(f"{s:>10}" for s in statuses))
    for kind in sorted({v["kind"] for v in verdicts}):
        print(f"{kind:10}" + "".join(f"{counts[kind, s]:10d}" for s in statuses))
    right = [v for v in verdicts if v["status"] == "right" and v["run"]["warnings"]]
    vibrating = sum(any("vibrate" in text for text in v["run"]["warnings"]) for v in right)
    print(f"of the right ones {len(right)} were warned, {vibrating} of vibrations")
    asked = [v for v in verdicts if v["status"] == "right" and "answer" in v["check"]]
    if asked:
        answers = Counter(v["check"]["answer"] for v in asked)
        print(
            f"of the right ones {len(asked)} were checked: " + ", ".join(f"{n} {name}" for name, n in answers.items())
        )
        print(f"a check took at most {max(v['check']['spent_s'] for v in asked):.1f} s of processor time")
    bad = sum(v["status"] in BAD for v in verdicts)
    begun = sum(v["status"] != "refused" for v in verdicts)
    print(f"wrong, hanging or crashed: {bad} of {begun} runs, {1000 * bad / max(begun, 1):.3g} per thousand")


if __name__ == "__main__":
    sys.exit(main())
