"""What takes time, done in a process of its own that can be stopped: runs, plans, sweeps, comparisons, PDF."""

from __future__ import annotations

import _thread
import contextlib
import json
import os
import signal
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Final, cast

import numpy as np

import trbdyn as trb
from trbdyn.base.display import displayed
from trbdyn.base.own_files import write_whole
from trbdyn.base.shown import Displayed
from trbdyn.errors import InputError, TrbError
from trbdyn.extras.app.questions import OF_SHAFT, QUESTIONS, want_of
from trbdyn.extras.study.gather import listed_in
from trbdyn.extras.study.runner import run as run_study
from trbdyn.model.spectrum import LoadCase, Spectrum
from trbdyn.reporting import judgement, report, save_pdf
from trbdyn.results.assembly import load
from trbdyn.results.numbers import find
from trbdyn.run.case_text import case_text
from trbdyn.run.options import RunOptions
from trbdyn.run.rating import rating
from trbdyn.run.simulation import Simulation
from trbdyn.run.toml_assembly import subject_from_dict
from trbdyn.statics.assembly import stiffness
from trbdyn.statics.fit import Fit
from trbdyn.viewer import view

Say = Callable[[float | None, str], None]
PAUSE: Final = 0.2
"""Least time between two messages about progress (s)."""
LAST_WORDS: Final = 10.0
"""Time that a task has to close its files when the page has ended (s)."""


def work(said: Connection, heard: Connection, kind: str, folder: str, arguments: dict[str, Any]) -> None:
    """Do a task; what is told goes through `said`, and a message from `heard`, or its end, stops it as Ctrl-C does."""
    os.environ["MPLBACKEND"] = "Agg"
    threading.Thread(target=_listen, args=(heard,), daemon=True).start()

    def say(share: float | None, text: str) -> None:
        with contextlib.suppress(OSError):  # the page has ended, and `_listen` ends this process
            said.send(("progress", share, text))

    with contextlib.suppress(OSError, KeyboardInterrupt):
        said.send(_outcome(kind, Path(folder), say, arguments))


def _outcome(kind: str, folder: Path, say: Say, arguments: dict[str, Any]) -> tuple[Any, ...]:
    """Do a task; gives what is told of how it ended."""
    try:
        return ("done", *TASKS[kind](folder, say, **arguments))
    except KeyboardInterrupt:
        return ("stopped", "stopped", {})
    except InputError as error:
        return ("failed", str(error), {".".join(map(str, one.path)): one.allowed for one in error.problems})
    except (TrbError, OSError, MemoryError) as error:
        return ("failed", str(error) or type(error).__name__, {})
    except Exception as error:
        return ("failed", f"a fault of trbdyn itself, please report it: {type(error).__name__}: {error}", {})


def _listen(heard: Connection) -> None:
    """Each message interrupts what goes on; where the page itself has ended, this process ends soon after."""
    try:
        while True:
            heard.recv()
            _interrupt()
    except (EOFError, OSError):
        _interrupt()
        time.sleep(LAST_WORDS)
        os._exit(1)


def _interrupt() -> None:
    """Ctrl-C for the main thread. Where the system has such signals it is a true one, which wakes a thread that waits."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)
    else:
        _thread.interrupt_main()


@dataclass(frozen=True)
class Also:
    """What is computed besides a run."""

    reliability: float = 90.0  # of rating lives (%)
    spectrum: tuple[tuple[str, float, dict[str, Any]], ...] = ()  # name, share of time and tables of load cases
    fits: Fit | None = None  # how the bearings sit
    unseated: Any = None  # the subject with the plays that were typed
    over: tuple[float, ...] = ()  # temperatures at which the preload is wanted (C)

    def tables(self, say: Say, texts: dict[str, str]) -> list[Displayed]:
        """Further tables of the report; as texts for the page, or why there is none."""
        found: list[Displayed] = []

        def add(name: str, make: Callable[[], Displayed]) -> None:
            say(1.0, name)
            try:
                found.append(made := make())
                texts[name] = str(made)
            except TrbError as error:
                texts[name] = str(error)

        if self.fits is not None:
            add("fits", lambda: cast(Displayed, self.fits))
        if self.fits is not None and self.over:
            seats = {name: one.mounting for name, one in self.fits.items()}
            how: dict[str, Any] = {"reliability": self.reliability}
            add(
                "preload over temperature",
                lambda: trb.preload_over(self.unseated, seats.get("", seats), list(self.over), **how),
            )
        if self.spectrum:
            cases = [LoadCase(name, share, subject_from_dict(case)[0]) for name, share, case in self.spectrum]
            add("spectrum", lambda: rating(Spectrum(cases), reliability=self.reliability))
        return found


def _run(
    folder: Path, say: Say, *, tables: dict[str, Any], wants: list[str], planned: bool, also: Also | None = None
) -> tuple[str, dict[str, Any]]:
    """Run a case, planned for some questions where that is wanted; write records, pictures, report and view."""
    subject, options = subject_from_dict(tables)
    extra: dict[str, Any] = {}
    if planned:
        say(None, "looking for the cheapest run that answers the question")
        found = trb.plan(cast(Any, subject), want_of(wants))
        subject = found.scene
        options = RunOptions(accuracy=found.accuracy, duration=found.duration, save_every=found.save_every)
        text = case_text(found.scene, options, title="found by trbdyn.plan")
        write_whole(folder / "case.toml", text, overwrite=True)
        extra["plan"] = str(found)
    say(0.0, "starting")
    simulation = Simulation(subject, **options.of_simulation())
    begin, end = simulation.time, options.end_time(subject, simulation.time)
    last = [0.0]

    def look(running: Simulation) -> None:
        if time.monotonic() - last[0] > PAUSE:
            last[0] = time.monotonic()
            passed, whole = running.time - begin, end - begin
            say(passed / whole, f"{' '.join(displayed(passed, 's', like=whole))} of {' '.join(displayed(whole, 's'))}")

    result = simulation.run(
        revolutions=options.revolutions,
        duration=options.duration,
        save_every=options.save_every,
        output=folder / "run.h5",
        callback=look,
    )
    # what was recorded is shown, whoever stops now: Stop for a second time ends this process
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        return _shown(folder, say, result, subject, wants, extra, also or Also())
    finally:
        signal.signal(signal.SIGINT, before)


def _shown(
    folder: Path, say: Say, result: Any, subject: Any, wants: list[str], extra: dict[str, Any], also: Also
) -> tuple[str, dict[str, Any]]:
    """Everything that the page shows of a result."""
    from trbdyn.plot import all as save_pictures
    from trbdyn.plot import drawable

    parts = result.by_name
    numbers = {name: [list(row) for row in one.summary()._shown().rows] for name, one in parts.items()}
    write_whole(folder / "summary.json", json.dumps(numbers), overwrite=True)
    chosen = [picture for name in wants for picture in QUESTIONS[name].pictures] or ["torque_split"]
    say(1.0, "drawing")
    of_shaft = OF_SHAFT if len(parts) > 1 else ()
    chosen = [*of_shaft, *(name for name in chosen if name in drawable(result.parts[0]))]
    save_pictures(result, folder / "pictures", chosen)
    texts: dict[str, str] = {}
    tables = also.tables(say, texts)
    for table in dict.fromkeys(table for name in wants for table in QUESTIONS[name].tables):
        say(1.0, table)
        try:
            texts[table] = str(
                rating(result, reliability=also.reliability) if table == "rating" else stiffness(subject)
            )
        except TrbError as error:
            texts[table] = str(error)
    say(1.0, "3-D view")
    view(result, folder / "view.html")
    say(1.0, "report")
    report(result, folder / "report.html", pictures=chosen, tables=tables, reliability=also.reliability)
    message = "; ".join(dict.fromkeys(one.message for one in parts.values()))
    judged = {name: judgement(one) for name, one in parts.items()}
    wanted = [*want_of(wants)]
    return message, {**extra, "tables": texts, "wanted": wanted, "success": result.success, "verdict": judged}


def _pdf(folder: Path, say: Say, *, page: str) -> tuple[str, dict[str, Any]]:
    """Print a report."""
    say(None, "printing")
    save_pdf(folder / page, (folder / page).with_suffix(".pdf"), overwrite=True)
    return "printed", {}


def _compare(folder: Path, say: Say, *, files: list[str], names: list[str]) -> tuple[str, dict[str, Any]]:
    """A report of two runs side by side."""
    say(None, "comparing")
    first, second = (load(file) for file in files)
    report(first, folder / "report.html", other=second, names=names, overwrite=True)
    return "compared", {}


class _Counting(ThreadPoolExecutor):
    """Threads that tell how many cases are done."""

    def __init__(self, workers: int, total: int, say: Say) -> None:
        super().__init__(workers)
        self._say, self._total, self._done = say, total, 0

    def submit(self, *given: Any, **named: Any) -> Future[Any]:
        future = super().submit(*given, **named)
        future.add_done_callback(self._count)
        return future

    def _count(self, _: Future[Any]) -> None:
        self._done += 1
        self._say(self._done / self._total, f"{self._done} of {self._total} cases")


def _sweep(
    folder: Path, say: Say, *, path: str, labels: list[str], cases: list[dict[str, Any]]
) -> tuple[str, dict[str, Any]]:
    """Run a design for some values of one input; a table and pictures of what follows."""
    import matplotlib.pyplot as plt

    from trbdyn.plot import save
    from trbdyn.plot.style import plain, styled

    say(0.0, f"0 of {len(cases)} cases")
    with _Counting(2, len(cases), say) as threads:
        data = run_study([subject_from_dict(tables) for tables in cases], folder / "runs", executor=threads)
    names, bearings = listed_in(data, "page"), data.attrs["bearings"].split()
    rows = [[label, str(data["status"].values[k]), *(_cell(data[name].values[k]) for name in names)]
            for k, label in enumerate(labels)]  # fmt: skip
    drawn = [name for name in names if data[name].dtype.kind == "f" and np.isfinite(data[name].values).any()]
    with styled():
        size = (7.0, 2.2 * max(len(drawn), 1))
        figure, axes = plt.subplots(len(drawn) or 1, 1, figsize=size, sharex=True, squeeze=False)
        for name, ax in zip(drawn, axes[:, 0], strict=False):
            number = find(name, bearings)
            assert number is not None
            ax.plot(labels, data[name].values, marker="o")
            ax.set_title(f"{number.words} ({number.unit})" if number.unit else number.words, fontsize=9)
        axes[-1, 0].set_xlabel(plain(path))
        save(figure, folder / "sweep.png", overwrite=True)
    return f"{len(rows)} cases", {"head": [path, "status", *names], "rows": rows}


def _cell(value: Any) -> str:
    return f"{float(value):.5g}" if isinstance(value, float) else str(value)


TASKS: Final[dict[str, Callable[..., tuple[str, dict[str, Any]]]]] = {
    "run": _run,
    "pdf": _pdf,
    "compare": _compare,
    "sweep": _sweep,
}
