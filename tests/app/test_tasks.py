"""What the page computes, without a browser: runs, plans, sweeps, comparisons, cases of strangers."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

import pytest
from shared import work_undrawn

import trbdyn as trb
from trbdyn.cli import main
from trbdyn.errors import InputError
from trbdyn.extras.app.design import Design, built
from trbdyn.extras.app.forms import open_case
from trbdyn.extras.app.jobs import Bench
from trbdyn.extras.app.outcome import case_of
from trbdyn.extras.app.program import script
from trbdyn.extras.app.tasks import TASKS
from trbdyn.reporting import converter

SHORT = {"scene.speed_rpm": "3000", "scene.axial_load": "4930", "run.revolutions": "0.5", "run.accuracy": "fast"}


def done(kind: str, folder: Path, **arguments: Any) -> tuple[list[Any], dict[str, Any]]:
    """Do a task here; gives what it told and its answer."""
    folder.mkdir(exist_ok=True)
    told: list[Any] = []
    _, answer = TASKS[kind](folder, lambda share, text: told.append((share, text)), **arguments)
    return told, answer


def arguments(design: Design) -> dict[str, Any]:
    made = built(design)
    assert made.problems == {}
    return {"tables": json.loads(json.dumps(made.tables)), "wants": design.wants, "planned": design.planned}


@pytest.mark.slow
@pytest.mark.usefixtures("drawn_only")
def test_a_pair_is_run_and_shown(tmp_path: Path) -> None:
    design = Design(typed={**SHORT, "scene.axial_load": "1000"}, pair=True, wants=["torque", "life", "stiffness"])
    told, answer = done("run", tmp_path, **arguments(design))
    assert told[-1] == (1.0, "report")
    assert set(json.loads((tmp_path / "summary.json").read_text())) == {"left", "right"}
    assert "life" in answer["tables"]["rating"]
    assert "force" in answer["tables"]["stiffness"] or "stiffness" in answer["tables"]["stiffness"]
    assert sorted(path.name for path in (tmp_path / "pictures").glob("*.png")) == [
        "bearing_loads.png",
        "shaft_orbits.png",
    ]
    assert sorted(trb.load(tmp_path / "run.h5")) == ["left", "right"]


@pytest.mark.slow
def test_two_runs_are_compared_and_printed(tmp_path: Path) -> None:
    files = []
    for k, load in enumerate(("4930", "3080")):
        done("run", tmp_path / str(k), **arguments(Design(typed={**SHORT, "scene.axial_load": load})))
        files.append(str(tmp_path / str(k) / "run.h5"))
    done("compare", tmp_path, files=files, names=["first", "second"])
    assert "What differs" in (tmp_path / "report.html").read_text()
    if converter() is not None:
        done("pdf", tmp_path, page="report.html")
        assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF")


def test_a_sweep_gives_what_single_runs_give(tmp_path: Path) -> None:
    designs = [Design(typed={**SHORT, "scene.speed_rpm": speed}) for speed in ("1000", "3000")]
    cases = [built(one).tables for one in designs]
    told, answer = done("sweep", tmp_path, path="speed (rpm)", labels=["1000", "3000"], cases=cases)
    assert told[-1] == (1.0, "2 of 2 cases")
    assert (tmp_path / "sweep.png").stat().st_size > 1000
    for design, row in zip(designs, answer["rows"], strict=True):
        result = trb.Simulation(built(design).subject, accuracy="fast").run(revolutions=0.5)
        assert row[:2] == [design.typed["scene.speed_rpm"], "done"]
        assert row[answer["head"].index("torque")] == f"{result.summary()['torque']:.5g}"


@pytest.mark.slow
def test_a_planned_run_is_the_case_beside_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    design = Design(typed=dict(SHORT), planned=True)
    _, answer = done("run", tmp_path / "run", **arguments(design))
    assert "wanted within" in answer["plan"]
    monkeypatch.chdir(tmp_path / "run")
    names: dict[str, Any] = {}
    text = script(design, built(design)).replace('"run.h5"', '"again.h5"').partition("print(")[0]
    exec(text, names)
    assert names["result"].summary()["torque"] == trb.load("run.h5").summary()["torque"]


def test_a_task_says_what_is_wrong_and_can_be_stopped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("trbdyn.extras.app.jobs.work", work_undrawn)
    bench = Bench.open(tmp_path)
    given = arguments(Design(typed={**SHORT, "scene.axial_load": "1e9"}))
    job = bench.start("run", "too much", given, {})
    assert job is not None
    assert bench.start("run", "another", given, {}) is None  # one at a time
    ended(bench)
    assert job.state == "failed"
    assert bench.kept()[0].about["state"] == "failed"
    assert "1e+09" in job.text or "load" in job.text
    job = bench.start("run", "long", arguments(Design(typed={**SHORT, "run.revolutions": "1e6"})), {})
    assert job is not None
    while job.share in (None, 0.0):
        assert job.running
        bench.look()
        time.sleep(0.05)
    job.stop()
    ended(bench)
    assert job.state == "stopped"
    assert len(trb.load(job.folder / "run.h5")) > 1


@pytest.mark.slow
def test_stop_while_a_report_is_drawn_loses_nothing(tmp_path: Path) -> None:
    bench = Bench.open(tmp_path)
    job = bench.start("run", "drawn", arguments(Design(typed={**SHORT, "run.revolutions": "0.05"})), {})
    assert job is not None
    while job.text not in ("drawing", "3-D view", "report"):
        assert job.running, job.text
        bench.look()
        time.sleep(0.01)
    job.stop()
    ended(bench)
    assert job.state == "done"
    assert job.text.startswith("reached")
    for name in ("run.h5", "report.html", "view.html", "summary.json"):
        assert (job.folder / name).stat().st_size > 100
    assert bench.kept()[0].about["state"] == "done"


def test_a_plan_can_be_stopped(tmp_path: Path) -> None:
    bench = Bench.open(tmp_path)
    job = bench.start("run", "plan", arguments(Design(typed=dict(SHORT), planned=True)), {})
    assert job is not None
    while not job.text.startswith("looking"):
        assert job.running
        bench.look()
        time.sleep(0.05)
    job.stop()
    ended(bench)
    assert (job.state, job.text) == ("stopped", "stopped")
    bench.design.typed["scene.speed_rpm"] = "123"
    bench.changed()
    assert Bench.open(tmp_path).design == bench.design


def test_a_missing_extra_is_named(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr("trbdyn.extras.app.find_spec", lambda name: None)
    assert main(["app", "--no-browser"]) == 2
    assert "pip install 'trbdyn[app]'" in capsys.readouterr().err


def ended(bench: Bench) -> None:
    assert bench.job is not None
    deadline = time.monotonic() + 60.0
    while bench.job.running:
        assert time.monotonic() < deadline
        bench.look()
        time.sleep(0.05)


EVIL = "<script>alert(1)</script>"


def test_a_case_of_a_stranger_is_a_case_or_refused() -> None:
    plain = case_of(built(Design()))
    tables = open_case(plain.encode())
    opened = Design(source="case", case=tables, typed={"scene.speed_rpm": "1000"})
    made = built(opened)
    assert made.problems == {}
    assert made.subject.speed_rpm == 1000.0
    assert "load_case" in script(opened, made)
    for text in (
        plain.replace("speed_rpm = 3000.0", "speed_rpm = 1e308"),
        plain.replace("speed_rpm = 3000.0", f"speed_rpm = {'9' * 5000}"),
        '[bearing]\ncase = "../../../etc/passwd"',
        '[bearing]\ncase = "30310"\n[scene]\nspeed_rpm = 1\naxial_load = 1\nfile = "/etc/passwd"',
        "x = " + "[" * 100_000,
        "\0",
    ):
        with pytest.raises((InputError, ValueError)):
            open_case(text.encode())
    with pytest.raises(ValueError):
        open_case(b"\xff\xfe")


@pytest.mark.usefixtures("drawn_only")
def test_a_script_in_a_name_stays_a_name(tmp_path: Path) -> None:
    design = Design(typed={**SHORT, "bearing.name": EVIL})
    made = built(design)
    names: dict[str, Any] = {}
    exec(script(design, made).partition("result =")[0], names)
    assert names["subject"].bearing.name == EVIL
    assert open_case(case_of(made).encode())["bearing"]["name"] == EVIL
    done("run", tmp_path, **arguments(design))
    for name in ("report.html", "view.html"):
        assert EVIL not in (tmp_path / name).read_text()
    quoted = Design(typed={**SHORT, "bearing.name": "'); import os; ('\n\"\\"})
    made = built(quoted)
    exec(script(quoted, made).partition("result =")[0], names)
    assert names["subject"].bearing.name == quoted.typed["bearing.name"]
    assert open_case(case_of(made).encode())["bearing"]["name"] == quoted.typed["bearing.name"]
