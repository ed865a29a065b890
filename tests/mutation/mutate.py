"""Puts small faults into a copy of the sources, one at a time, and counts those that the tests notice; see README.md beside this.

make mutate                       250 faults; call it again to go on, or after new tests
make mutate COUNT=400 MINUTES=120 SEED=2
.venv/bin/python tests/mutation/mutate.py --area results
.venv/bin/python tests/mutation/mutate.py --report
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
import tomllib
from collections import Counter
from pathlib import Path
from typing import Any

from faults import AREAS, Fault, draw
from noticing import FIRST, QUICK_C_TESTS, THEN, Baseline, Notice, near, preload, run_c_tests, run_tests
from sandbox import PYTHON, TREE, VENV, WORK, Snapshot, compile_c_tests, fingerprint, planted, prepare

OUTCOMES = WORK / "outcomes.jsonl"
JUDGED = Path(__file__).with_name("judged.toml")
LONGEST = 600.0
"""Wall time for the tests of a fault (s). A fault that outlives them is not noticed."""

PLANTED = (
    "trbdyn/cli/__init__.py",
    'prog="trbdyn"',
    'prog="trbdyn!"',
    "api/test_cli.py::test_the_module_runs_as_a_program",
)
"""A fault that only a process can meet that a test starts: file, text, other text, the test that must notice it."""

TURNS = ("first", "near", "then")
"""Quick tests of the area, tests that look at the source more closely, and wider ones."""

Row = dict[str, Any]


def read_outcomes() -> dict[str, Row]:
    lines = OUTCOMES.read_text(encoding="utf-8").splitlines() if OUTCOMES.exists() else []
    return {row["key"]: row for row in map(json.loads, lines)}


def write_outcome(outcomes: dict[str, Row], fault: Fault, notice: Notice, **more: Any) -> Row:
    row = vars(fault) | {"key": fault.key, "test": notice.test, "kind": notice.kind, "message": notice.message} | more
    outcomes[fault.key] = row
    with OUTCOMES.open("a", encoding="utf-8") as stream:
        stream.write(json.dumps(row) + "\n")
    return row


def judgements() -> list[Row]:
    """Faults that no test notices, judged by hand."""
    return tomllib.loads(JUDGED.read_text(encoding="utf-8"))["fault"]


def judgement(row: Row, judged: list[Row]) -> Row | None:
    names = ("file", "text", "column", "new")
    found = [entry for entry in judged if all(entry[name] == row[name] for name in names)]
    return next((entry for entry in found if entry.get("nth", 1) == row.get("nth", 1)), None)


# ---- what holds without a fault ----


def check_baseline(names: list[str], baseline: Baseline) -> bool:
    """Tests that were not run yet on the copy without a fault, or changed since, must pass there."""
    marks = {name: fingerprint(f"tests/{name.split('::')[0]}") for name in names}
    missing = [name for name in names if baseline.files.get(name) != marks[name]]
    if missing:
        print(f"without any fault: {' '.join(missing)}", flush=True)
        outcome = run_tests(missing, baseline=None, longest=3600.0, stop=False)
        for notice in outcome.failed:
            print(f"without any fault, {notice.test} fails: {notice.kind} {notice.message}")
        failed = {notice.test.split("::")[0].removeprefix("tests/") for notice in outcome.failed}
        whole = [name for name in missing if not any(one.startswith(name.split("::")[0]) for one in failed)]
        baseline.files |= {name: marks[name] for name in (whole if outcome.ended else [])}
        baseline.seconds |= outcome.seconds
        baseline.write()
        if outcome.failed or not outcome.ended:
            return False
    if "C tests" not in baseline.files:
        notice = run_c_tests()
        if notice:
            print(f"without any fault, {notice.test} fails: {notice.kind}")
            return False
        baseline.files["C tests"] = "pass"
        baseline.write()
    return True


def check_planted(baseline: Baseline, snapshot: Snapshot) -> bool:
    """A process that a test starts runs the copy: a fault of the command line that only such a process can meet is noticed."""
    words = [str(PYTHON), "-P", "-c", "import trbdyn, trbdyn._core as core; print(trbdyn.__file__, core.__file__)"]
    found = subprocess.run(words, capture_output=True, text=True, check=True, cwd="/").stdout.split()
    file, old, new, test = PLANTED
    fault = Fault("", file, (TREE / file).read_text(encoding="utf-8").index(old), old, new, 0, "", 0, 1, "")
    before = run_tests([test], baseline=baseline, longest=120.0)
    with planted(fault, snapshot):
        after = run_tests([test], baseline=baseline, longest=120.0)
    fine = all(name.startswith(str(TREE)) for name in found) and not before.failed and bool(after.failed)
    print(f"a fault planted in {file}, which only a process that a test starts can meet, is", end=" ")
    print(
        f"noticed: {after.failed[0].message}" if fine else "NOT NOTICED: the process does not run the copy", flush=True
    )
    return fine


# ---- one fault ----


def covers(names: list[str], test: str) -> bool:
    return any(test.removeprefix("tests/").startswith(name) for name in names)


def favourites_of(fault: Fault, outcomes: dict[str, Row], baseline: Baseline) -> list[str]:
    """Tests that noticed other faults of this source, the most successful ones first."""
    seen = Counter(row["test"] for row in outcomes.values() if row["file"] == fault.file)
    return [test for test, _ in seen.most_common(6) if test in baseline.seconds]


def tests_of(turn: str, fault: Fault) -> list[str]:
    """The tests that a turn asks about a fault."""
    return {"first": FIRST[fault.area], "near": near(fault.file), "then": THEN[fault.area]}[turn]


def attempt(fault: Fault, turn: str, baseline: Baseline, snapshot: Snapshot, liked: list[str]) -> tuple[Notice, str]:
    """What notices the fault; or why it does not count; else an empty notice."""
    is_c = fault.file.startswith("csrc")
    with planted(fault, snapshot) as compiles:
        if not compiles:
            return Notice(), "does not compile"
        if is_c and snapshot.same_program():
            return Notice(), "same program"
        own, wider = tests_of(turn, fault), turn != "first"
        names = own if wider else [*own, *(name for name in liked if not covers(own, name))]
        # the programs of all C tests are linked again: where they seldom notice first, that waits
        notice = _c_tests(fault, wider) if turn == "near" else Notice()
        if not notice:
            outcome = run_tests(names, baseline=baseline, longest=LONGEST, favourites=liked)
            # a test that is skipped or fails without the fault proves nothing
            kinds = ("import", "crash", "hang")
            found = [one for one in outcome.failed if one.test in baseline.seconds or one.kind.startswith(kinds)]
            notice = found[0] if found else Notice()
        if not notice and not wider:
            notice = _c_tests(fault, wider)
        return notice, ""


def _c_tests(fault: Fault, wider: bool) -> Notice:
    names = () if wider else QUICK_C_TESTS.get(fault.area, ())
    if not fault.file.startswith("csrc") or not (wider or names) or not compile_c_tests(names):
        return Notice()
    return run_c_tests(names)


def recheck(rows: list[Row], outcomes: dict[str, Row], baseline: Baseline) -> bool:
    """Tests that noticed faults must still pass without one; else what they noticed is forgotten, to be tried again."""
    tests = sorted({row["test"] for row in rows if row["test"] in baseline.seconds})
    if not tests:
        return True
    outcome = run_tests(tests, baseline=None, longest=3600.0, stop=False)
    wrong = {notice.test for notice in outcome.failed}
    print(f"the {len(tests)} tests that noticed faults, run again without one: {len(wrong)} fail", flush=True)
    for row in [row for row in rows if row["test"] in wrong]:
        print(f"not counted: {row['test']} fails without a fault, too: {row['file']}:{row['line']}")
        del outcomes[row["key"]]
    if wrong:
        OUTCOMES.write_text("".join(json.dumps(row) + "\n" for row in outcomes.values()), encoding="utf-8")
    return not wrong and outcome.ended


# ---- all of them ----


def table(rows: list[Row]) -> str:
    """Noticed by area, and every fault that was not."""
    judged = judgements()
    equivalent = [row for row in rows if row["why"] == "same program" or (not row["test"] and judgement(row, judged))]
    counted = [row for row in rows if row not in equivalent and row["why"] != "does not compile"]
    lines = ["area       faults  equivalent  counted  noticed"]
    for area in (*AREAS, "all"):
        apart = [row for row in equivalent if area in (row["area"], "all")]
        own = [row for row in counted if area in (row["area"], "all")]
        noticed = sum(bool(row["test"]) for row in own)
        if own:
            share = 100.0 * noticed / len(own)
            lines.append(
                f"{area:<10} {len(own) + len(apart):>6} {len(apart):>11} {len(own):>8} {noticed:>8}  {share:.0f} %"
            )
    kinds = Counter(row["kind"].split()[0] for row in counted if row["test"])
    lines += ["", "noticed by: " + ", ".join(f"{kind} {number}" for kind, number in kinds.most_common())]
    lines += [f"the compiler makes the same program: {sum(row['why'] == 'same program' for row in rows)}"]
    lines += [f"do not compile, not counted: {sum(row['why'] == 'does not compile' for row in rows)}"]
    for title, some in (("judged", [row for row in equivalent if not row["why"]]), ("not noticed", counted)):
        lines += ["", f"{title}:"]
        for row in some:
            if not row["test"]:
                entry = judgement(row, judged)
                old, new = " ".join(row["old"].split()), " ".join(row["new"].split())
                lines.append(f"  {row['file']}:{row['line']}:{row['column']}: {old!r} -> {new!r} in {row['text']!r}")
                lines += [f"      {entry['reason']}"] if entry else []
    return "\n".join(lines)


def chosen(outcomes: dict[str, Row], seed: int, count: int, only: str | None) -> tuple[list[Fault], list[Row]]:
    """The first faults of a seed, `count` of them without those that do not count; and what is known of them."""
    faults, rows, number = [], [], 0
    for fault in draw(seed, only):
        row = outcomes.get(fault.key)
        number += not (row and row["why"])
        if number > count:
            break
        faults.append(fault)
        rows += [row] if row else []
    return faults, rows


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="How many small faults do the tests notice?")
    parser.add_argument("--count", type=int, default=250, help="faults")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=90.0, help="longest wall time; the next call goes on")
    parser.add_argument("--area", choices=list(AREAS), help="this area only")
    parser.add_argument("--again", action="store_true", help="only those that no test noticed so far")
    parser.add_argument("--report", action="store_true", help="only the table of what is there")
    return parser.parse_args()


def main() -> int:
    options = arguments()
    outcomes = read_outcomes()
    if options.report:
        print(table(chosen(outcomes, options.seed, options.count, options.area)[1]))
        return 0
    end = time.monotonic() + 60.0 * options.minutes
    if Path(sys.prefix) != VENV:
        prepare()
        os.execv(PYTHON, [str(PYTHON), *sys.argv])
    os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", MPLBACKEND="Agg", PYTHONDONTWRITEBYTECODE="1")
    sys.dont_write_bytecode = True
    preload()
    snapshot, tests = Snapshot(), fingerprint("tests")
    baseline = Baseline.read(fingerprint("csrc", "trbdyn"))
    for turn in TURNS:
        if time.monotonic() >= end:
            break
        left = open_faults(turn, outcomes, options, tests)
        names = list(dict.fromkeys(name for fault in left for name in tests_of(turn, fault)))
        if not check_baseline([*names, PLANTED[3].split("::")[0]], baseline) or not check_planted(baseline, snapshot):
            print("mend that first: what a fault changes cannot be told from what fails without it")
            return 1
        while time.monotonic() < end:
            left = open_faults(turn, outcomes, options, tests)
            if not left:
                break
            fault, began = left[0], time.monotonic()
            notice, why = attempt(fault, turn, baseline, snapshot, favourites_of(fault, outcomes, baseline))
            seconds = time.monotonic() - began
            write_outcome(outcomes, fault, notice, why=why, turn=turn, tests=tests, seconds=round(seconds, 1))
            said = f"{notice.test} {notice.kind}" if notice else why or "NOT NOTICED"
            print(f"{len(left):4d} left {seconds:6.1f} s  {fault}\n{'':20}{said}", flush=True)
    faults, rows = chosen(outcomes, options.seed, options.count, options.area)
    fine = recheck(rows, outcomes, baseline)
    print(table(chosen(outcomes, options.seed, options.count, options.area)[1]))
    print("" if len(rows) == len(faults) else f"{len(faults) - len(rows)} faults are left: call it again")
    return 0 if fine else 1


def open_faults(turn: str, outcomes: dict[str, Row], options: argparse.Namespace, tests: str) -> list[Fault]:
    """What is left to do in a turn, new faults first."""
    faults, _ = chosen(outcomes, options.seed, options.count, options.area)
    left = [fault for fault in faults if is_open(turn, outcomes.get(fault.key), tests)]
    left = [fault for fault in left if fault.key in outcomes or not options.again]
    return sorted(left, key=lambda fault: fault.key in outcomes)


def is_open(turn: str, row: Row | None, tests: str) -> bool:
    """In the first turn new faults, and those that no test noticed before tests changed; then those that the turn before left."""
    if row is None or (not row["test"] and not row["why"] and row["tests"] != tests):
        return turn == "first"
    if turn == "first" or row["test"] or row["why"]:
        return False
    return row["turn"] == TURNS[TURNS.index(turn) - 1]


if __name__ == "__main__":
    sys.exit(main())
