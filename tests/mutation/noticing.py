"""Which test notices a fault: tests run in a forked process, which imports the package of the copy."""

from __future__ import annotations

import contextlib
import json
import os
import re
import resource
import select
import shutil
import signal
import subprocess
import sys
import time
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from sandbox import BUILD, TOOLS, TREE, WORK

TESTS = tomllib.loads(Path(__file__).with_name("tests.toml").read_text(encoding="utf-8"))
FIRST: dict[str, list[str]] = TESTS["first"]
THEN: dict[str, list[str]] = TESTS["then"]
QUICK_C_TESTS: dict[str, list[str]] = TESTS["c"]


def near(file: str) -> list[str]:
    """The tests that look at a source more closely."""
    return next(tests for start, tests in TESTS["near"].items() if file.startswith(start))


NOT_HERE = (
    "report/test_report.py::test_pdf",
    "fuzz/test_process.py::test_out_of_memory_is_a_memory_error_and_the_process_goes_on",
)
"""Tests that cannot pass where a process has a bound of its memory: Chromium and the test of such a bound itself."""
MEMORY = 8 << 30
"""Address space of a process with a fault (byte)."""


@dataclass
class Notice:
    """What noticed a fault, or nothing."""

    test: str = ""
    kind: str = ""
    """assertion, error, crash, hang or import; the type of the exception follows."""
    message: str = ""
    seconds: float = 0.0

    def __bool__(self) -> bool:
        return bool(self.test)


@dataclass
class Baseline:
    """Tests that pass without a fault, and how long each takes (s); only they can notice one."""

    sources: str = ""
    seconds: dict[str, float] = field(default_factory=dict)
    files: dict[str, str] = field(default_factory=dict)
    """Fingerprints of the test files and folders that were run."""

    @classmethod
    def read(cls, sources: str) -> Baseline:
        """That of the same sources and tests, or an empty one."""
        path = WORK / "baseline.json"
        found = cls(**json.loads(path.read_text())) if path.exists() else cls()
        return found if found.sources == sources else cls(sources)

    def write(self) -> None:
        (WORK / "baseline.json").write_text(json.dumps(asdict(self), indent=1))

    def limit(self, test: str) -> float:
        """Wall time after which a test hangs; the machine may be busy with other work (s)."""
        return 30.0 + 10.0 * self.seconds.get(test, 5.0)


def _say(stream: int, *words: Any) -> None:
    os.write(stream, json.dumps(words).encode() + b"\n")


class Reporter:
    """A plugin of pytest: tells the parent what starts, passes and fails; tests that noticed faults of this source come first."""

    def __init__(self, stream: int, favourites: Sequence[str], seconds: Mapping[str, float]) -> None:
        self.stream, self.favourites, self.seconds, self.errors = stream, list(favourites), seconds, {}

    def pytest_collection_modifyitems(self, items: list[Any]) -> None:
        """Favourites first, then the quick ones; those of one module stay together, as they share what is made for them."""
        rank = {name: place for place, name in enumerate(self.favourites)}
        of_module: dict[str, list[float]] = {}
        for item in items:
            of_module.setdefault(item.nodeid.split("::")[0], []).append(self.seconds.get(item.nodeid, 0.0))
        mean = {name: sum(found) / len(found) for name, found in of_module.items()}
        items.sort(key=lambda item: (rank.get(item.nodeid, len(rank)), mean[item.nodeid.split("::")[0]]))

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        _say(self.stream, "start", nodeid)

    def pytest_runtest_makereport(self, item: Any, call: Any) -> None:
        """Before pytest's own, which makes the report."""
        if call.excinfo is not None:
            kind = call.excinfo.type
            wrong = issubclass(kind, AssertionError) or kind.__name__ == "Failed"
            text = next(iter(str(call.excinfo.value).splitlines()), "")[:200]
            self.errors[item.nodeid] = (f"{'assertion' if wrong else 'error'} {kind.__name__}", text)

    def pytest_runtest_logreport(self, report: Any) -> None:
        if report.failed:
            _say(self.stream, "failed", report.nodeid, *self.errors.get(report.nodeid, ("assertion", report.when)))
        elif report.passed:
            _say(self.stream, "passed", report.nodeid, report.duration, report.when)

    def pytest_collectreport(self, report: Any) -> None:
        if report.failed:
            _say(self.stream, "failed", report.nodeid, "import", str(report.longrepr)[-200:])


def _child(
    names: Sequence[str], stream: int, favourites: Sequence[str], stop: bool, seconds: Mapping[str, float]
) -> int:
    import pytest

    os.chdir(TREE)
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    nothing = os.open(os.devnull, os.O_RDWR)
    for number in (0, 1, 2):
        os.dup2(nothing, number)
    os.environ["PATH"] = f"{TOOLS}{os.pathsep}{os.environ['PATH']}"
    for name in ("PYTHONPATH", "PYTHONHOME"):
        os.environ.pop(name, None)
    import hypothesis

    # the same examples with and without a fault, and no time spent on shrinking them
    phases = (hypothesis.Phase.explicit, hypothesis.Phase.generate)
    hypothesis.settings.register_profile("faults", derandomize=True, database=None, phases=phases, deadline=None)
    hypothesis.settings.load_profile("faults")
    import trbdyn
    from trbdyn import _core

    for module in (trbdyn, _core):
        if not str(module.__file__).startswith(str(TREE)):
            _say(stream, "failed", "", "setup", f"{module.__file__} is not the copy")
            return 98
    paths = [name if name.startswith("tests/") else f"tests/{name}" for name in names]
    words = ["-q", "-p", "no:cacheprovider", "-p", "no:nbmake", "-p", "no:xdist", f"--basetemp={WORK / 'tmp'}", *paths]
    words += [f"--deselect=tests/{name}" for name in NOT_HERE]
    return int(pytest.main([*(["-x"] if stop else []), *words], plugins=[Reporter(stream, favourites, seconds)]))


@dataclass
class Outcome:
    """Of one run of pytest."""

    failed: list[Notice] = field(default_factory=list)
    seconds: dict[str, float] = field(default_factory=dict)
    ended: bool = False
    """All tests had their turn."""


def run_tests(
    names: Sequence[str],
    *,
    baseline: Baseline | None,
    longest: float,
    favourites: Sequence[str] = (),
    stop: bool = True,
) -> Outcome:
    """Tests of the copy in a process of their own; `longest` (s) ends them all."""
    shutil.rmtree(WORK / "tmp", ignore_errors=True)
    reading, writing = os.pipe()
    began = time.monotonic()
    child = os.fork()
    if child == 0:
        os.close(reading)
        os.setsid()
        code = 99
        try:
            code = _child(names, writing, favourites, stop, baseline.seconds if baseline else {})
        except BaseException as error:
            # the package cannot even be imported
            _say(writing, "failed", "", f"import {type(error).__name__}", str(error)[:200])
        finally:
            os._exit(code)
    os.close(writing)
    outcome, rest, current, since, stopped = Outcome(), b"", "", began, ""
    status: int | None = None
    while True:
        ready, _, _ = select.select([reading], [], [], 1.0 if status is None else 0.0)
        data = os.read(reading, 65536) if ready else b""
        *lines, rest = (rest + data).split(b"\n")
        for word, *about in map(json.loads, lines):
            if word == "start":
                current, since = about[0], time.monotonic()
            elif word == "passed":
                outcome.seconds[about[0]] = outcome.seconds.get(about[0], 0.0) + about[1]
            else:
                outcome.failed.append(Notice(about[0] or "import trbdyn", about[1], about[2]))
        if not data and (ready or status is not None):
            break
        if status is None:
            # a process that a test started may hold the pipe open for longer than the test's own
            ended, found = os.waitpid(child, os.WNOHANG)
            status = found if ended else None
        now = time.monotonic()
        if baseline is not None and current and now - since > baseline.limit(current):
            stopped = "hang"
        elif now - began > longest:
            stopped = "time"
        if stopped:
            break
    os.close(reading)
    with contextlib.suppress(ProcessLookupError):
        if stopped or status is not None:
            os.killpg(child, signal.SIGKILL)
    if status is None:
        status = os.waitpid(child, 0)[1]
    code = os.waitstatus_to_exitcode(status)
    outcome.ended = not stopped and code in (0, 1)
    if stopped == "hang":
        outcome.failed.append(Notice(current, "hang", f"longer than {time.monotonic() - since:.0f} s"))
    elif not stopped and code < 0:
        outcome.failed.append(Notice(current or "import trbdyn", "crash", f"signal {-code}"))
    elif not stopped and code != 0 and not outcome.failed:
        outcome.failed.append(Notice("pytest", "import", f"pytest cannot run: it ends with {code}"))
    for notice in outcome.failed:
        notice.seconds = time.monotonic() - began
    return outcome


def run_c_tests(names: Sequence[str] = ()) -> Notice:
    """The first C test that fails, of those named or of all."""
    which = ["-R", "|".join(f"^{name}$" for name in names)] if names else []
    words = [str(TOOLS / "ctest"), "--test-dir", str(BUILD), "--timeout", "180", "--stop-on-failure", *which]
    began = time.monotonic()
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    failed = re.findall(r"Test +#\d+: (\w+) .*?\*\*\*(\w+)", done.stdout)
    if done.returncode == 0:
        return Notice()
    name, how = failed[0] if failed else ("?", "")
    kind = {"Failed": "assertion", "Timeout": "hang"}.get(how, "crash")
    return Notice(f"C test {name}", f"{kind} {how}", "", time.monotonic() - began)


def preload() -> None:
    """What every test needs is imported once, before the forks; the package itself is not."""
    import h5py  # noqa: F401
    import hypothesis  # noqa: F401
    import matplotlib.pyplot  # noqa: F401
    import pydantic  # noqa: F401
    import pytest  # noqa: F401
    import scipy.interpolate
    import scipy.signal
    import scipy.spatial.transform  # noqa: F401
    import xarray  # noqa: F401

    if any(name.split(".")[0] == "trbdyn" for name in sys.modules):
        raise RuntimeError("the package was imported before the fault was planted")
