"""The command line: files written, exit codes, one clear line for every error of a user."""

from __future__ import annotations

import importlib
import json
import math
import os
import pkgutil
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import trbdyn
from trbdyn.cli import main
from trbdyn.cli.called import command
from trbdyn.cli.demo import TURNS
from trbdyn.errors import LoadError, StepError
from trbdyn.results.assembly import load
from trbdyn.results.result import Result
from trbdyn.results.result_file import Part, ResultWriter


class FakeSimulation:
    """Stands for the simulation: writes the made-up run."""

    run_data: Any = None
    calls: list[dict[str, Any]] = []
    error: Exception | None = None
    success = True

    def __init__(self, scene: Any, **settings: Any) -> None:
        self.scene = scene
        self.calls.append({"scene": scene, "settings": settings})

    def run(self, *, output: Path, **options: Any) -> Result:
        self.calls[-1]["run"] = options
        if self.error is not None:
            raise self.error
        run = self.run_data
        ending = run.ending() | {"success": self.success}
        with ResultWriter(output, Part(self.scene, run.layout, run.fields, geometry=run.geometry)) as writer:
            writer.append(run.records)
            writer.finish(ending)
        return load(output)


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, synthetic: Any) -> type[FakeSimulation]:
    monkeypatch.setattr("trbdyn.results.derived.creep_time", lambda scene: math.nan)  # needs a simulation that steps
    # whatever takes the class when it is imported must have taken the real one before
    for module in pkgutil.walk_packages(trbdyn.__path__, "trbdyn."):
        if not module.name.endswith("__main__"):
            importlib.import_module(module.name)
    kind = type("Simulation", (FakeSimulation,), {"run_data": synthetic, "calls": [], "error": None})
    monkeypatch.setattr("trbdyn.run.simulation.Simulation", kind)
    monkeypatch.chdir(tmp_path)
    return kind


def test_demo_writes_everything(
    fake: type[FakeSimulation], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    # the stub of a simulation has no scene that could be drawn: tests/report/test_demo.py runs the real thing
    import trbdyn.reporting
    import trbdyn.viewer

    for module, name in ((trbdyn.reporting, "report"), (trbdyn.viewer, "view")):
        monkeypatch.setattr(module, name, lambda result, path, **options: Path(path))
    monkeypatch.setattr("trbdyn.reporting.verdict.what_matters", lambda result, numbers: ["It turns."])
    assert main(["demo", "-o", "out/demo"]) == 0
    folder = tmp_path / "out" / "demo"
    names = {path.name for path in folder.iterdir()}
    pictures = {"cage_locus.png", "spacing_angles.png", "tilt.png", "pocket_forces.png"}
    assert names == {"run.h5", "summary.json"} | pictures
    values = json.loads((folder / "summary.json").read_text())
    promised = ("cage_speed_ratio", "orbit_rms_over_cpr", "outer_load_mean", "inner_load_mean", "rib_load_mean")
    promised += ("film_parameter_outer", "film_parameter_inner", "torque", "energy_closure", "wall_s_per_revolution")
    for name in (*promised, "steps", "rhs_evaluations"):
        assert isinstance(values[name], float | int), name
    call = fake.calls[0]
    assert call["run"]["revolutions"] == TURNS
    assert call["scene"].start.kind == "whirl"
    assert call["scene"].start.eccentricity == 0.9
    assert call["scene"].speed_rpm == 3000.0
    assert call["scene"].axial_load == 4930.0
    said = capsys.readouterr().out
    assert said.startswith("A tapered roller bearing 30310 turns at 3000 rpm")
    assert "1. It turns." in said


@pytest.mark.usefixtures("drawn_only")
def test_run_of_a_shipped_case_with_changes(fake: type[FakeSimulation], tmp_path: Path) -> None:
    words = [
        "run",
        "rig_30310",
        "-o",
        "a.h5",
        "--duration",
        "0.1",
        "--accuracy",
        "fast",
        "--quiet",
        "--summary",
        "s.json",
        "--report",
        "r.html",
    ]
    words += ["--set", "scene.speed_rpm=1000", "--set", "start.kind=equal", "--set", "run.integrator='erk'"]
    words += ["--set", "bearing.cage.mass=0.3"]
    assert main(words) == 0
    call = fake.calls[0]
    assert call["scene"].speed_rpm == 1000.0
    assert call["scene"].bearing.cage.mass == 0.3
    assert call["scene"].start.kind == "equal"
    assert call["settings"] == {"accuracy": "fast", "integrator": "erk"}
    assert call["run"]["duration"] == 0.1
    assert call["run"]["revolutions"] is None
    assert call["run"]["progress"] is False
    assert load(tmp_path / "a.h5").scene.speed_rpm == 1000.0
    assert json.loads((tmp_path / "s.json").read_text())["success"] is True
    assert (tmp_path / "r.html").read_text().startswith("<!")


def test_a_report_that_could_not_be_written_is_refused_before_the_run(fake: type[FakeSimulation]) -> None:
    assert main(["run", "rig_30310", "--report", "r.pdf"]) == 2
    assert main(["run", "rig_30310", "--summary", "one.html", "--report", "one.html"]) == 2
    assert fake.calls == []


def test_run_names_its_file_after_the_case(fake: type[FakeSimulation], tmp_path: Path) -> None:
    case = tmp_path / "mine.toml"
    case.write_text('[bearing]\ncase = "30310"\n[scene]\nspeed_rpm = 3000\naxial_load = 4930\n[run]\nrevolutions = 2\n')
    assert main(["run", str(case), "--quiet"]) == 0
    assert load(tmp_path / "mine.h5").success


def test_plot_and_info_of_a_file(
    fake: type[FakeSimulation], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", "rig_30310", "-o", "a.h5", "--quiet"]) == 0
    assert main(["plot", "a.h5", "--only", "tilt", "cage_locus"]) == 0
    assert {path.name for path in (tmp_path / "a_plots").iterdir()} == {"tilt.png", "cage_locus.png"}
    assert main(["info", "a.h5"]) == 0
    text = capsys.readouterr().out
    assert "bearing 30310: 12 rollers" in text
    assert "4001 records" in text
    assert main(["info", "a.h5", "--json"]) == 0
    about = json.loads(capsys.readouterr().out)
    assert about["summary"]["axis_distance_over_cpr"] == pytest.approx(0.9)
    assert main(["plot", "a.h5", "-o", "b", "--only", "tilts"]) == 2
    assert "did you mean 'tilt'" in capsys.readouterr().err


def test_info_of_a_case_and_the_list_of_cases(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cases"]) == 0
    assert {line.split()[0] for line in capsys.readouterr().out.splitlines()} >= {"rig_30310", "bearing_32216"}
    assert main(["info", "bearing_32216"]) == 0
    text = capsys.readouterr().out
    assert "16 rollers" in text
    assert "roller_half_angle" in text
    assert main(["info", "rig_30310", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["scene"]["axial_load"] == 4930.0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["run", "nothing.toml"], "nothing.toml"),
        (["run", "rig_30310", "--set", "scene.speed_rpm=fast"], "scene.speed_rpm = 'fast'"),
        (["run", "rig_30310", "--set", "scene.speed=1"], "did you mean 'speed_rpm'"),
        (["run", "rig_30310", "--set", "scene.speed_rpm"], "KEY=VALUE"),
        (["run", "rig_30310", "--set", "scene.speed_rpm.x=1"], "is a value, not a table"),
        (["run", "rig_30310", "--revolutions", "-3"], "revolutions = -3.0 : must be > 0"),
        (["run", "rig_30310", "--revolutions", "nan"], "revolutions"),
        (["run", "rig_30310", "--set", "scene.axial_load=-1"], "axial_load"),
        (["run", "rig_30310", "--set", "scene.speed_rpm=0"], "is at rest"),
        (["plot", "nothing.h5"], "there is no such file"),
        (["info", "nothing"], "cases that ship with the package"),
    ],
)
def test_user_errors_are_one_clear_line(
    fake: type[FakeSimulation], capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    assert main(words) == 2
    captured = capsys.readouterr()
    assert captured.err.startswith("trbdyn: ")
    assert said in captured.err
    assert captured.err.count("\n") == 1
    assert "Traceback" not in captured.err
    assert not fake.calls


def test_damaged_case_and_result_files(
    fake: type[FakeSimulation], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "bad.toml").write_text("[bearing\n")
    assert main(["run", "bad.toml"]) == 2
    assert "not a TOML file" in capsys.readouterr().err
    assert main(["run", "bad.toml", "--set", "scene.speed_rpm=1"]) == 2
    (tmp_path / "bad.h5").write_bytes(b"\x00" * 1000)
    for name in ("plot", "info"):
        assert main([name, "bad.h5"]) == 2
        assert "not an HDF5 file" in capsys.readouterr().err


def test_exit_codes_of_failed_runs(fake: type[FakeSimulation], capsys: pytest.CaptureFixture[str]) -> None:
    words = ["run", "rig_30310", "-o", "a.h5", "--quiet"]
    fake.error = StepError("roller 3: the velocity is not finite at t = 0.1 s", time=0.1)
    assert main(words) == 1
    assert "roller 3" in capsys.readouterr().err
    assert main([*words, "--debug"]) == 1
    assert "Traceback" in capsys.readouterr().err
    fake.error = LoadError("no equilibrium")
    assert main(words) == 2
    fake.error = KeyboardInterrupt()  # type: ignore[assignment]
    assert main(words) == 130
    fake.error = None
    fake.success = False
    assert main(words) == 1
    assert "reached the end" in capsys.readouterr().err


def test_the_module_runs_as_a_program() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "trbdyn", "info", "nothing"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    done = subprocess.run([sys.executable, "-m", "trbdyn"], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("trbdyn: the following arguments are required: COMMAND")
    assert len(done.stderr.splitlines()) == 1


def test_advice_can_be_typed_as_it_stands(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It printed `python -m trbdyn` and `trbdyn`, where the Python of an environment was needed."""
    monkeypatch.chdir(tmp_path)
    assert main(["new", "my own.toml"]) == 0
    advice = capsys.readouterr().out.partition("run it with: ")[2].strip()
    assert shlex.split(advice)[-2:] == ["run", "my own.toml"]
    done = subprocess.run(f"{advice} --duration 1e-4 --quiet", shell=True, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_a_program_is_named_as_it_was_called(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    place = tmp_path / ".venv" / "bin"
    place.mkdir(parents=True)
    for name in ("python", "trbdyn"):
        (place / name).write_text("")
        (place / name).chmod(0o755)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", os.defpath)
    monkeypatch.setattr(sys, "executable", str(place / "python"))
    monkeypatch.setattr(sys, "argv", ["/somewhere/trbdyn/__main__.py"])
    assert command("resume", "a b.h5") == ".venv/bin/python -m trbdyn resume 'a b.h5'"
    monkeypatch.setattr(sys, "argv", [".venv/bin/trbdyn"])
    assert command("run", "x") == ".venv/bin/trbdyn run x"
    monkeypatch.setenv("PATH", str(place))
    assert command("run", "x") == "trbdyn run x"
    monkeypatch.setattr(sys, "argv", ["-c"])
    assert command("run", "x") == "python -m trbdyn run x"


def test_a_stopped_run_says_how_to_go_on(fake: type[FakeSimulation], capsys: pytest.CaptureFixture[str]) -> None:
    fake.success = False
    assert main(["run", "rig_30310", "-o", "a.h5", "--quiet"]) == 1
    assert "go on with" not in capsys.readouterr().err
    Path("b.h5.checkpoint").write_text("")
    assert main(["run", "rig_30310", "-o", "b.h5", "--quiet"]) == 1
    assert "-m trbdyn resume b.h5" in capsys.readouterr().err


def test_rating_prints_lives_of_cases_pairs_and_results(tmp_path, capsys):
    assert main(["rating", "bearing_32216"]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "Which life to use" in said
    assert main(["rating", "bearing_32216", "--json"]) == 0
    numbers = json.loads(capsys.readouterr().out)
    assert numbers["life_hours"] == pytest.approx(trbdyn.rating(trbdyn.load_case("bearing_32216")[0]).life_hours)
    assert main(["rating", "pair_30310"]) == 0
    rows = capsys.readouterr().out.splitlines()
    assert [row.split()[0] for row in rows[2:5]] == ["left", "right", "all"]
    path = tmp_path / "run.h5"
    trbdyn.Simulation(trbdyn.cases.scene_30310(3000.0, 4930.0)).run(revolutions=0.2, output=path)
    assert main(["rating", str(path)]) == 0
    assert "Lnmrh" in capsys.readouterr().out
    assert main(["rating", str(path), "--set", "scene.speed_rpm=10"]) == 2
    assert "must not be given with a result" in capsys.readouterr().err


def test_a_life_that_means_endless_has_no_digits():
    light = trbdyn.rating(trbdyn.cases.scene_30310(3000.0, 300.0))
    assert light.life_hours > 1e6
    shown = {row.symbol: row.shown for row in light.rows}
    assert shown["L10h"] == ">1e6"
