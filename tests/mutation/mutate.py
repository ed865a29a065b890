"""Puts small faults into the sources, one at a time, and counts those that the tests notice.

    make mutate                       250 faults, at most an hour; call it again to go on
    make mutate COUNT=400 MINUTES=120 SEED=2
    .venv/bin/python tests/mutation/mutate.py --area results

A fault is one changed operator, number, component or function, or one statement taken away, drawn with a seed from the
sources of an area. The sources are copied to build/mutation; C sources are compiled there again, as far as the fault reaches.
The Python tests of the area and the C tests run until one fails. Each outcome is a line of
build/mutation/outcomes.jsonl. A fault that has one is not tried again; --more tries slower tests on those that the first ones
did not notice. Faults that do not compile are not counted. After a change of the sources, delete build/mutation.
"""

from __future__ import annotations

import argparse
import hashlib
import io
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
import tokenize
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "build" / "mutation"
TREE = WORK / "tree"
BUILD = WORK / "package"
OUTCOMES = WORK / "outcomes.jsonl"
LONGEST_TEST = 240.0
"""Wall time after which a test counts as failed: the fault makes it hang (s)."""

RECORDS = ["physics/test_records.py"]
PHYSICS = [*RECORDS, "physics/test_inputs_act.py", "physics/test_action_reaction.py", "physics/test_contacts.py"]
PHYSICS += ["laws/test_check_values.py"]
MOTION = [
    *RECORDS,
    "physics/test_rigid_body.py",
    "geometry/test_derived.py",
    "geometry/test_pocket.py",
    "physics/test_contacts.py",
]
STEPS = ["convergence/test_determinism.py", "api/test_simulation.py"]
RESULTS = ["api/test_by_hand.py", "api/test_observables.py", "api/test_drawn.py"]
INPUTS = ["api/test_flatten.py", "physics/test_inputs_act.py", "geometry/test_derived.py", "physics/test_start.py"]
RUNS = ["restart/test_checkpoints.py", "fuzz/test_files.py"]
MORE = {
    "laws": ["laws", "geometry", "physics/test_torque.py", "physics/test_gradient.py"],
    "contacts": [
        "physics/test_gradient.py",
        "physics/test_action_reaction.py",
        "physics/test_audit.py",
        "physics/test_effects.py",
    ],
    "records": ["physics/test_audit.py", "physics/test_kinematics.py", "api/test_simulation.py"],
    "motion": [
        "physics/test_audit.py",
        "physics/test_invariance.py",
        "geometry",
        "physics/test_start.py",
        "physics/test_culling.py",
    ],
    "stepping": ["convergence", "physics/test_audit.py", "restart/test_checkpoints.py", "stability"],
    "results": [
        "api/test_results.py",
        "api/test_plotting.py",
        "api/test_cli.py",
        "api/test_study.py",
        "fuzz/test_errors.py",
    ],
    "inputs": ["api", "geometry", "physics/test_effects.py", "physics/test_creep.py"],
    "runs": ["api/test_simulation.py", "fuzz", "restart", "api/test_results.py"],
}
"""Tests for faults that the first ones did not notice: --more."""

AREAS: dict[str, tuple[float, list[str], list[str]]] = {
    "laws": (0.14, ["csrc/laws/*.[ch]"], PHYSICS),
    "contacts": (0.2, ["csrc/contact/*.[ch]"], PHYSICS),
    "records": (0.1, ["csrc/motion/record.c", "csrc/motion/audit.c"], RECORDS),
    "motion": (0.14, ["csrc/bearing/*.[ch]", "csrc/motion/[cder]*.c"], MOTION),
    "stepping": (0.16, ["csrc/stepping/*.c"], STEPS),
    "results": (
        0.14,
        ["trbdyn/observables/*.py", "trbdyn/derived.py", "trbdyn/summary.py", "trbdyn/plotting/*.py"],
        RESULTS,
    ),
    "inputs": (0.06, ["trbdyn/flatten.py", "trbdyn/geometry.py", "trbdyn/start.py", "trbdyn/motion.py"], INPUTS),
    "runs": (0.06, ["trbdyn/running.py", "trbdyn/checkpoint.py", "trbdyn/sources.py", "trbdyn/simulation.py"], RUNS),
}
"""Share of the faults, sources and tests of each area."""

SWAPS = {
    "+": "-", "-": "+", "*": "/", "/": "*", "<": ">=", ">": "<=", "<=": ">", ">=": "<", "==": "!=", "!=": "==",
    "&&": "||", "||": "&&", "+=": "-=", "-=": "+=", "and": "or", "or": "and", "min": "max", "max": "min",
    "trb_min": "trb_max", "trb_max": "trb_min", "fmin": "fmax", "fmax": "fmin", "cos": "sin", "sin": "cos", "cosine": "sine",
    "sine": "cosine", "trb_add": "trb_sub", "trb_sub": "trb_add", "mean": "max", "argmin": "argmax", "argmax": "argmin",
    ".x": ".y", ".y": ".z", ".z": ".x", "inner": "outer", "outer": "inner", "TRB_RACE_OUTER": "TRB_RACE_INNER",
    "TRB_RACE_INNER": "TRB_RACE_OUTER", "True": "False", "False": "True",
}  # fmt: skip
C_TOKEN = re.compile(
    r"(?P<skip>/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'|^[ \t]*#[^\n]*(?:\\\n[^\n]*)*)"
    r"|(?P<number>(?<![\w.])\d+\.\d*(?:e[+-]?\d+)?)|(?P<word>\.[xyz]\b|[A-Za-z_]\w*)"
    r"|(?P<sign>->|\+\+|--|[-+*/&|=<>!]=|&&|\|\||<<|>>|[-+*/<>])",
    re.S | re.M,
)
CALL = re.compile(r"^[ \t]+[\w.\->\[\]]+(?: = | \+= | -= |\()[^;{}=]*;$", re.M)


LOOKS = re.compile(
    r"linewidth|alpha|figsize|fontsize|pad=|zorder|ncols|markersize|shrink|margins|xytext|height=|offset"
)
"""Lines that say how a picture looks, not what it shows."""


@dataclass(frozen=True)
class Fault:
    """One change of one source."""

    area: str
    file: str
    place: int
    old: str
    new: str

    @property
    def key(self) -> str:
        return hashlib.sha256(repr(self).encode()).hexdigest()[:16]

    def line(self) -> int:
        return (TREE / self.file).read_text(encoding="utf-8").count("\n", 0, self.place) + 1


def changed_number(text: str) -> str:
    value = float(text)
    return "1.0" if value == 0.0 else repr(value * 1.5)


def faults_of_c(text: str) -> Iterator[tuple[int, str, str]]:
    skipped: list[tuple[int, int]] = []
    for found in C_TOKEN.finditer(text):
        old, before = found.group(), text[: found.start()].rstrip()[-1:]
        if found.lastgroup == "skip":
            skipped.append(found.span())
        elif found.lastgroup == "number":
            yield found.start(), old, changed_number(old)
        elif old in SWAPS and not (old in ("-", "+", "*") and not (before.isalnum() or before in ")]_")):
            declares = old == "*" and re.search(
                r"(?:\*|const|\w_\w+|double|int|char|void|trb_\w+)\s*$", text[: found.start()]
            )
            if not declares:
                yield found.start(), old, SWAPS[old]
    for found in CALL.finditer(text):
        inside = any(start <= found.start() < end for start, end in skipped)
        if not inside and not re.match(r"\s*(return|const|double|int|static)\b", found.group()):
            yield found.start(), found.group(), ";" if "free(" not in found.group() else found.group()


def faults_of_python(text: str) -> Iterator[tuple[int, str, str]]:
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    tokens = list(tokenize.generate_tokens(io.StringIO(text).readline))
    signature = 0
    for place, token in enumerate(tokens):
        before = tokens[place - 1] if place else token
        if token.string in ("def", "class", "import", "from", "@"):
            signature = token.end[0]
        if token.start[0] == signature or token.line.lstrip().startswith(("def ", "from ", "import ", "@", "class ")):
            continue
        if LOOKS.search(token.line):
            continue
        at = starts[token.start[0] - 1] + token.start[1]
        binary = before.type in (tokenize.NAME, tokenize.NUMBER) or before.string in (")", "]")
        if token.type == tokenize.NUMBER and "." in token.string:
            yield at, token.string, changed_number(token.string)
        elif token.type == tokenize.NUMBER and before.string in ("[", ":") and token.string in ("0", "1", "2"):
            yield at, token.string, {"0": "1", "1": "0", "2": "1"}[token.string]
        elif (
            token.type == tokenize.OP
            and token.string in SWAPS
            and binary
            and before.string not in ("lambda", "return", "in")
        ):
            if "->" not in token.line and not re.search(r"\*\*?\w+[,)]", token.line):
                yield at, token.string, SWAPS[token.string]
        elif (
            token.type == tokenize.NAME
            and token.string in SWAPS
            and tokens[place + 1].string in ("(", " ", "not", "or", "and")
        ) or (token.type == tokenize.NAME and token.string in ("True", "False", "and", "or")):
            yield at, token.string, SWAPS[token.string]


def draw(count: int, seed: int, only: str | None) -> list[Fault]:
    """The faults of a seed, areas mixed; a larger count keeps the first ones."""
    drawn: list[tuple[float, Fault]] = []
    for area, (share, patterns, _) in AREAS.items():
        places: list[Fault] = []
        for file in sorted({path for pattern in patterns for path in TREE.glob(pattern)}):
            text = file.read_text(encoding="utf-8")
            name = str(file.relative_to(TREE))
            found = faults_of_c(text) if file.suffix in (".c", ".h") else faults_of_python(text)
            places += [Fault(area, name, at, old, new) for at, old, new in found if old != new]
        random.Random(f"{seed} {area}").shuffle(places)
        drawn += [((number + 0.5) / share, fault) for number, fault in enumerate(places)]
    drawn.sort(key=lambda pair: (pair[0], pair[1].key))
    faults = [fault for _, fault in drawn if only in (None, fault.area)]
    return faults[: int(1.6 * count)]


def prepare() -> None:
    """A copy of the sources and a build of it, without vectors wider than every machine has: it compiles in half the time."""
    TREE.mkdir(parents=True, exist_ok=True)
    for name in ("csrc", "trbdyn", "tests", "pyproject.toml"):
        source, target = ROOT / name, TREE / name
        if source.is_dir():
            for path in source.rglob("*"):
                other = target / path.relative_to(source)
                if path.is_dir() or "__pycache__" in path.parts or path.suffix == ".so":
                    continue
                if not other.exists() or other.read_bytes() != path.read_bytes():
                    other.parent.mkdir(parents=True, exist_ok=True)
                    shutil.copyfile(path, other)
        elif not target.exists() or target.read_bytes() != source.read_bytes():
            shutil.copyfile(source, target)
    # nothing here needs the last percent of speed
    kernels = TREE / "csrc" / "cmake" / "TrbKernels.cmake"
    kernels.write_text(kernels.read_text(encoding="utf-8").replace("-O3", "-O1"), encoding="utf-8")
    bin_folder = Path(sys.executable).parent
    words = [
        bin_folder / "cmake",
        "-S",
        TREE / "csrc",
        "-B",
        BUILD,
        "-G",
        "Ninja",
        f"-DCMAKE_MAKE_PROGRAM={bin_folder / 'ninja'}",
    ]
    words += [
        "-DCMAKE_BUILD_TYPE=None",
        "-DCMAKE_C_FLAGS=-O1",
        "-DTRB_BUILD_TESTS=ON",
        "-DTRB_FLAG_V3=OFF",
        "-DTRB_FLAG_V4=OFF",
    ]
    words += [f"-DPython_EXECUTABLE={sys.executable}"]
    if not (BUILD / "build.ninja").exists():
        subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)
    compile_tree()


def compile_tree() -> bool:
    done = subprocess.run([Path(sys.executable).parent / "ninja", "-C", BUILD], capture_output=True, check=False)
    for module in BUILD.glob("_core*.so"):
        # a new file each time: the old one may still be mapped
        target = TREE / "trbdyn" / module.name
        target.unlink(missing_ok=True)
        shutil.copyfile(module, target)
    return done.returncode == 0


SLOW_C_TESTS = "test_jacobian|test_coupling|test_clearance|test_interference"


def c_tests(more: bool) -> str:
    words = [
        str(Path(sys.executable).parent / "ctest"),
        "--test-dir",
        str(BUILD),
        "--timeout",
        "60",
        "--stop-on-failure",
    ]
    done = subprocess.run(words if more else [*words, "-E", SLOW_C_TESTS], capture_output=True, text=True, check=False)
    failed = re.findall(r"Test +#\d+: (\w+) .*(?:\*\*\*|Failed)", done.stdout)
    return f"C test {failed[0] if failed else '?'}" if done.returncode else ""


def python_tests(names: list[str], deadline: float) -> str:
    """The first test that fails, or an empty text; in a process that has the large libraries already."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        os.setsid()
        code = 99
        try:
            code = run_pytest(names, writing)
        finally:
            os._exit(code)
    os.close(writing)
    ended = 0
    while not ended:
        ended, status = os.waitpid(child, os.WNOHANG)
        if not ended and time.monotonic() > deadline:
            os.killpg(child, signal.SIGKILL)
            os.waitpid(child, 0)
            os.close(reading)
            return "hangs"
        time.sleep(0.02)
    with os.fdopen(reading, "rb") as stream:
        said = stream.read().decode(errors="replace")
    if os.WIFSIGNALED(status):
        return f"dies of signal {os.WTERMSIG(status)}"
    return said or ("" if os.WEXITSTATUS(status) == 0 else "pytest could not run")


def run_pytest(names: list[str], writing: int) -> int:
    import pytest

    class Reporter:
        def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
            if report.failed:
                os.write(writing, report.nodeid.encode()[:300])

        def pytest_collectreport(self, report: pytest.CollectReport) -> None:
            if report.failed:
                os.write(writing, b"import fails")

    os.chdir(TREE)
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it
    nothing = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(nothing, stream)
    # an editable installation looks at the package of the working tree first
    sys.meta_path[:] = [finder for finder in sys.meta_path if "editable" not in type(finder).__module__]
    sys.path.insert(0, str(TREE))
    os.environ["PYTHONPATH"] = str(TREE)
    os.environ.pop("PYTHONSAFEPATH", None)
    files = [f"tests/{name}" for name in names if (TREE / "tests" / name).exists()]
    return int(pytest.main(["-x", "-q", "-p", "no:cacheprovider", "-p", "no:nbmake", *files], plugins=[Reporter()]))


def attempt(fault: Fault, more: bool) -> str:
    """What notices the fault: a test, 'does not compile', or nothing."""
    file = TREE / fault.file
    text = file.read_text(encoding="utf-8")
    assert text.startswith(fault.old, fault.place)
    file.write_text(text[: fault.place] + fault.new + text[fault.place + len(fault.old) :], encoding="utf-8")
    is_c = fault.file.startswith("csrc")
    try:
        if is_c and not compile_tree():
            return "does not compile"
        if not is_c:
            try:
                compile(file.read_text(encoding="utf-8"), fault.file, "exec")
            except SyntaxError:
                return "does not compile"
        tests = MORE[fault.area] if more else AREAS[fault.area][2]
        deadline = time.monotonic() + (4 if more else 1) * LONGEST_TEST
        if fault.area == "stepping":
            return c_tests(more) or python_tests(tests, deadline)
        return python_tests(tests, deadline) or (c_tests(more) if is_c else "")
    finally:
        file.write_text(text, encoding="utf-8")


def table(outcomes: dict[str, dict[str, str]]) -> str:
    rows = ["area        faults  noticed"]
    counted = [row for row in outcomes.values() if row["noticed"] != "does not compile"]
    for area in (*AREAS, "all"):
        own = [row for row in counted if area in (row["area"], "all")]
        caught = sum(bool(row["noticed"]) for row in own)
        if own:
            rows.append(f"{area:<10} {len(own):>7} {caught:>8}  {100.0 * caught / len(own):.0f} %")
    rows += ["", "not noticed:"]
    rows += [
        f"{row['file']}:{row['line']}: {row['old'].strip()!r} -> {row['new']!r}"
        for row in counted
        if not row["noticed"]
    ]
    return "\n".join(rows)


def read() -> dict[str, dict[str, str]]:
    lines = OUTCOMES.read_text(encoding="utf-8").splitlines() if OUTCOMES.exists() else []
    rows = [json.loads(line) for line in lines]
    return {row["key"]: row for row in rows}


def main() -> int:
    parser = argparse.ArgumentParser(description="How many small faults do the tests notice?")
    parser.add_argument("--count", type=int, default=250, help="faults")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=60.0, help="longest wall time; the next call goes on")
    parser.add_argument("--area", choices=list(AREAS), help="this area only")
    parser.add_argument(
        "--more", action="store_true", help="more tests for the faults that the first ones did not notice"
    )
    parser.add_argument("--report", action="store_true", help="only the table of what is there")
    options = parser.parse_args()
    end = time.monotonic() + 60.0 * options.minutes
    outcomes = read()
    if options.report:
        print(table(outcomes))
        return 0
    prepare()
    import h5py  # noqa: F401  what every test needs is imported once, before the forks
    import hypothesis  # noqa: F401
    import matplotlib.pyplot  # noqa: F401
    import pydantic  # noqa: F401
    import pytest  # noqa: F401
    import scipy.interpolate
    import scipy.signal
    import scipy.spatial.transform  # noqa: F401
    import xarray  # noqa: F401

    sound: set[str] = set()
    done = 0
    for fault in draw(options.count, options.seed, options.area):
        known = outcomes.get(fault.key)
        again = options.more and known is not None and not known["noticed"] and not known.get("more")
        if (known is not None and not again) or (known is None and options.more):
            if known is None:
                continue
            done += known["noticed"] != "does not compile"
            continue
        if time.monotonic() > end or done >= options.count:
            break
        if fault.area not in sound:
            tests = MORE[fault.area] if options.more else AREAS[fault.area][2]
            failed = python_tests(tests, time.monotonic() + 10 * LONGEST_TEST)
            if failed:
                print(f"without any fault, a test of the area {fault.area} fails: {failed}; mend that first")
                return 1
            sound.add(fault.area)
        began = time.monotonic()
        noticed = attempt(fault, options.more)
        row = asdict(fault) | {"key": fault.key, "line": fault.line(), "noticed": noticed, "more": options.more}
        outcomes[fault.key] = row
        done += noticed != "does not compile"
        with OUTCOMES.open("a", encoding="utf-8") as stream:
            stream.write(json.dumps(row) + "\n")
        where = f"{fault.file}:{fault.line()}: {fault.old.strip()[:60]!r} -> {fault.new!r}"
        print(f"{done:4d}  {time.monotonic() - began:5.1f} s  {where}  {noticed or 'NOT NOTICED'}", flush=True)
    compile_tree()
    print(table(outcomes))
    return 0


if __name__ == "__main__":
    sys.exit(main())
