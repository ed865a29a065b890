"""The order of the test files: those that take longest come first, so that several processes end at about the same time.

Worker processes of studies take seconds to start: their tasks are done in this process, in tests that do not ask for `workers`.

Where rollers vibrate, a run is repeated with tighter tolerances, which takes much longer than a short run: in tests that ask for
`probes` alone.

Bytecode is kept, whatever the environment says: tests start some hundred processes, each of which would compile the package.

Linear algebra takes one thread: several processes with two threads each wait for each other most of the time.

Tests of Ctrl-C send signals: a shell that starts tests in the background lets them ignore it; Python then installs no handler.
"""

from __future__ import annotations

import gc
import importlib.util
import os
import pickle
import signal
import sys
from collections.abc import Callable
from typing import Any, Final

import pytest

LONGEST: Final = (
    "api/test_both_subjects.py",
    "adversary/test_adversary.py",
    "app/test_page.py",
    "readme/test_readme.py",
    "accuracy_and_cost.ipynb",
    "parameter_study.ipynb",
    "paper_figures.ipynb",
    "fuzz/test_files.py",
    "plan/test_plan.py",
    "api/test_results.py",
    "restart/test_checkpoints.py",
    "app/test_tasks.py",
    "api/test_optimise.py",
    "physics/test_audit.py",
    "restart/test_kills.py",
    "report/test_report.py",
    "api/test_study.py",
    "api/test_confidence.py",
    "api/test_uncertainty.py",
)


os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read when NumPy is imported, after this
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


def done_here(work: Callable[..., Any], tasks: Any, count: int) -> Any:
    """In place of worker processes: this one, with what they get and give through pickle."""
    from trbdyn.extras.study import executors

    def through_pickle(task: Any, stopped: Callable[[], bool]) -> Any:
        own, given = pickle.loads(pickle.dumps((work, task)))
        return pickle.loads(pickle.dumps(own(given, stopped)))

    return executors._serial(through_pickle, tasks)


def pytest_collection_finish() -> None:
    """What was collected stays to the end: the collector of garbage need not look at it again and again."""
    gc.collect()
    gc.freeze()


def pytest_sessionstart() -> None:
    """Before the fixtures of modules."""
    from trbdyn.run.vibrations import Vibrations

    JUDGED.append(Vibrations.judge)
    Vibrations.judge = lambda *_: None
    if importlib.util.find_spec("trbdyn.extras") is not None:  # tests/api/test_without_extras.py takes them away
        from trbdyn.extras.study import executors

        WORKERS.append(executors._processes)
        executors._processes = done_here


def pytest_sessionfinish() -> None:
    """Another session may follow in this process."""
    from trbdyn.run.vibrations import Vibrations

    Vibrations.judge = JUDGED.pop()
    if WORKERS:
        from trbdyn.extras.study import executors

        executors._processes = WORKERS.pop()


WORKERS: Final[list[Any]] = []
"""What starts worker processes."""
JUDGED: Final[list[Any]] = []
"""What measures how much steps take from vibrations."""


@pytest.fixture
def probes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs of this test are repeated with tighter tolerances where rollers vibrate."""
    monkeypatch.setattr("trbdyn.run.vibrations.Vibrations.judge", JUDGED[0])


@pytest.fixture
def workers(monkeypatch: pytest.MonkeyPatch) -> None:
    """Studies of this test have worker processes."""
    monkeypatch.setattr("trbdyn.extras.study.executors._processes", WORKERS[0])


@pytest.fixture(autouse=True)
def short_checks(monkeypatch: pytest.MonkeyPatch) -> None:
    """The check of a run that a report asks for takes some tenths of a second."""
    monkeypatch.setattr("trbdyn.run.check.BUDGET_S", 0.1)


@pytest.fixture
def drawn_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures of reports are drawn, but not made into images, which takes most of a report's time: tests/report does that."""
    import matplotlib.pyplot as plt

    def image(draw: Callable[[], object]) -> str:
        draw()
        plt.close("all")
        return ""

    monkeypatch.setattr("trbdyn.reporting.page.image", image)


def pytest_addoption(parser: pytest.Parser) -> None:
    """The option of `api/test_seen.py`."""
    parser.addoption(
        "--keep-pictures", action="store_true", help="keep the descriptions of all pictures as they are now"
    )


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Within a file the order stays."""

    def place(item: pytest.Item) -> int:
        name = item.path.as_posix()
        return next((rank for rank, end in enumerate(LONGEST) if name.endswith(end)), len(LONGEST))

    items.sort(key=place)
