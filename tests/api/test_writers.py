"""Everything that writes a file writes it in one way: what is there is replaced only if that is asked for, and stays whole if it
cannot be written. The functions and commands are found by looking through the package, so that a new one is not forgotten.
"""

from __future__ import annotations

import argparse
import ast
import importlib
import inspect
import pkgutil
import resource
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import pytest

import trbdyn
import trbdyn as trb
from trbdyn.cli import main, make_parser
from trbdyn.extras.elastic.modes import CageModes
from trbdyn.extras.sound import forces
from trbdyn.extras.study import gather
from trbdyn.extras.study.answer import Answer
from trbdyn.model.cases import paper_30310
from trbdyn.plot import animation
from trbdyn.reporting import save_pdf
from trbdyn.results import summary
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.export import export
from trbdyn.viewer import View, save_gltf

FOREIGN = b"days of work of somebody else\n"
SPAN = {"duration": 4e-4, "save_every": 1e-5}


@pytest.fixture(scope="module")
def run_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("writers") / "run.h5"
    trb.Simulation(paper_30310()).run(output=path, **SPAN)
    return path


# ---- functions ----


class Drawn(Answer):
    """An answer of a study with an empty picture."""

    def _draw(self, **how: Any) -> Any:
        return plt.figure()


def dataset() -> Any:
    import xarray

    return xarray.Dataset({"torque": ("case", [1.0, 2.0])})


def caged() -> trb.Bearing:
    return trb.cases.rig_30310().replace({"cage.body": trb.cases.cage_body_30310()})


@cache
def cage_modes() -> CageModes:
    return CageModes.of_body(caged(), 2)


class Named(dict[str, trb.Result]):
    """Results by names, as those of an assembly are."""

    assembly = None


def moving(run: trb.Result) -> Any:
    return animation.animate(run, last=1.0, frames=2)


STUDY = "trbdyn.extras.study."
WRITERS: dict[str, tuple[str, Callable[..., Any]]] = {
    "trbdyn.reporting.report": ("a.html", lambda run, path, **how: trb.report(run, path, pictures=[], **how)),
    "trbdyn.viewer.view": ("a.html", lambda run, path, **how: trb.view(run, path, max_frames=3, **how)),
    "trbdyn.viewer.View.save": ("a.html", lambda run, path, **how: View("<html>" * 100).save(path, **how)),
    "trbdyn.viewer.gltf.save_gltf": ("a.glb", lambda run, path, **how: save_gltf(run, path, max_frames=3, **how)),
    "trbdyn.plot.save": ("a.png", lambda run, path, **how: trb.plot.save(trb.plot.tilt(run), path, **how)),
    "trbdyn.plot.all": ("tilt.png", lambda run, path, **how: trb.plot.all(run, path.parent, ["tilt"], **how)),
    "trbdyn.plot.animation.save": ("a.gif", lambda run, path, **how: animation.save(moving(run), path, dpi=20, **how)),
    "trbdyn.plot.style.write": ("a.pdf", lambda run, path, **how: trb.plot.style.write(plt.figure(), path, **how)),
    "trbdyn.plot.style.kept": ("a.svg", lambda run, path, **how: trb.plot.style.kept(plt.figure(), path, **how)),
    "trbdyn.results.summary.write_json": (
        "a.json",
        lambda run, path, **how: summary.write_json(summary.clean(dict(run.summary())), path, **how),
    ),
    "trbdyn.extras.elastic.modes.CageModes.save": (
        "a.h5",
        lambda run, path, **how: cage_modes().save(path, **how),
    ),
    "trbdyn.extras.sound.forces.sound": (
        "a.wav",
        lambda run, path, **how: forces.sound(run, path, "cage", "x", None, 1.0, **how),
    ),
    "trbdyn.results.derived.Derived.sound": ("a.wav", lambda run, path, **how: run.sound(path, **how)),
    "trbdyn.results.export.export": ("a.csv", lambda run, path, **how: export(run, path, **how)),
    "trbdyn.results.result.Result.export": ("a.mat", lambda run, path, **how: run.export(path, **how)),
    "trbdyn.results.assembly.AssemblyResult.export": (
        "a.csv",
        lambda run, path, **how: AssemblyResult.export(Named({"left": run}), path, **how),  # type: ignore[arg-type]
    ),
    "trbdyn.extras.study.gather.save": ("a.nc", lambda run, path, **how: gather.save(dataset(), path, **how)),
    "trbdyn.run.simulation.Simulation.run": (
        "a.h5",
        lambda run, path, **how: trb.Simulation(paper_30310()).run(output=path, **SPAN, **how),
    ),
    f"{STUDY}answer.Answer.picture": ("a.png", lambda run, path, **how: Drawn().picture(path, **how)),
}
RUNS = {name for name in WRITERS if name.endswith("Simulation.run")}
"""Runs have tests of their own for a full disk: tests/restart and tests/api/test_results.py."""
NEEDS_A_PROGRAM = {
    "trbdyn.reporting.save_pdf",
    "trbdyn.extras.exchange.fmu.write_fmu",
    "trbdyn.extras.exchange.rexs.write_rexs",
}
"""Or a file of their own to begin with: tests/physics/test_fmu.py, tests/api/test_rexs.py."""
FOLDERS = {
    f"{STUDY}{name}"
    for name in (
        "runner.run",
        "cage_map.cage_map",
        "optimise.optimise",
        "thermal.thermal",
        "torque_map.torque_map",
        "uncertainty.uncertainty",
        "whirl.whirl_onset",
        "index.Index",
    )
}
"""These own a folder, in which every file has the fingerprint of its case in its name."""
READERS = {
    "trbdyn.extras.exchange.rexs.read_rexs",
    "trbdyn.extras.elastic.modes.CageModes.load",
    "trbdyn.results.assembly.load",
    "trbdyn.results.file_source.assembly_in",
    "trbdyn.results.file_source.names_in",
    "trbdyn.model.cage.Cage.from_step",
    "trbdyn.extras.cad.opened.opened",
    "trbdyn.extras.cad.read.read_cage",
    "trbdyn.model.roller.Profile.from_csv",
    "trbdyn.results.result.load_bearing",
    "trbdyn.extras.cad.trace_file.points_of",
    "trbdyn.model.roller.Profile.from_trace",
    "trbdyn.extras.cad.read_trace.read_trace",
    "trbdyn.results.file_source.FileSource",
    "trbdyn.results.file_source.open_to_read",
    "trbdyn.run.resume.resume",
    "trbdyn.run.toml_assembly.load_assembly",
    "trbdyn.run.toml_case.load_case",
    "trbdyn.extras.study.definition.read_toml",
    "trbdyn.extras.study.gather.load",
    "trbdyn.extras.study.runner.collect",
    "trbdyn.extras.study.study_file.load_study",
}
MECHANISM = ("trbdyn.base.", "trbdyn.run.checkpoint.", "trbdyn.results.hdf5_file.")
TAKES_A_PATH = ("PathLike", "str | Path", "FilePath")


def public() -> Iterator[tuple[str, inspect.Signature]]:
    """Every function, class and method of the package that has no underscore before its name."""
    for found in pkgutil.walk_packages(trbdyn.__path__, "trbdyn."):
        if any(part.startswith("_") for part in found.name.split(".")):
            continue
        for name, entry in vars(importlib.import_module(found.name)).items():
            if name.startswith("_") or getattr(entry, "__module__", "") != found.name or not callable(entry):
                continue
            for own in (name, *([f"{name}.{part}" for part in vars(entry)] if inspect.isclass(entry) else [])):
                member = getattr(entry, own.partition(".")[2]) if "." in own else entry
                if callable(member) and not own.rpartition(".")[2].startswith("_"):
                    try:
                        yield f"{found.name}.{own}", inspect.signature(member)
                    except (ValueError, TypeError):
                        continue


def test_every_function_that_takes_the_path_of_a_file_is_known() -> None:
    known = {*WRITERS, *NEEDS_A_PROGRAM, *FOLDERS, *READERS}
    found = {}
    for name, signature in public():
        if name.startswith(MECHANISM):
            continue
        for field, parameter in signature.parameters.items():
            kind = str(parameter.annotation)
            file = field in ("path", "output", "folder") and any(part in kind for part in TAKES_A_PATH)
            if field == "overwrite" or file:
                found[name] = signature
    inner = {
        "trbdyn.cli.case.simulate",
        "trbdyn.plot.make_folder",
        "trbdyn.results.result_file.ResultWriter",
        "trbdyn.run.running.Run.write_to",
    }
    assert set(found) - known - inner == set(), "a new function takes a file: say here whether it writes, and how"
    for name in (*WRITERS, *NEEDS_A_PROGRAM):
        assert found[name].parameters["overwrite"].default in (False, inspect.Parameter.empty), name


WRITING = {
    "write_text",
    "write_bytes",
    "to_netcdf",
    "tofile",
    "to_csv",
    "touch",
    "rename",
    "symlink_to",
    "copyfile",
    "copy2",
}
MAY_WRITE = {
    "base/own_files.py": "the one way",
    "base/locks.py": "opens what is there",
    "results/hdf5_file.py": "fills a draft",
    "results/result_file.py": "has the system put its draft on the disk",
    "results/export.py": "fills memory",
    "extras/elastic/modes.py": "fills memory",
    "run/checkpoint.py": "moves its own checkpoints",
    "extras/study/gather.py": "fills memory",
    "extras/study/index.py": "adds lines to the index of its folder",
    "plot/style.py": "fills memory",
    "reporting/page.py": "fills memory",
    "extras/exchange/fmu.py": "fills a folder of its own, which is then gone",
}


def writes(call: ast.Call) -> bool:
    """Whether a call writes a file, or gives one another name."""
    function = call.func
    name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
    module = getattr(function.value, "id", "") if isinstance(function, ast.Attribute) else ""
    texts = [
        entry.value for entry in (*call.args, *(key.value for key in call.keywords)) if isinstance(entry, ast.Constant)
    ]
    if name in ("open", "File", "fdopen"):
        return any(isinstance(text, str) and len(text) < 4 and set(text) & set("wax+") for text in texts)
    return name in WRITING or name == "savefig" or (module == "os" and name in ("replace", "link", "rename", "open"))


def test_there_is_no_other_way_to_write() -> None:
    root = Path(trb.__file__).parent
    found = {}
    for path in root.rglob("*.py"):
        lines = [
            node.lineno for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Call) and writes(node)
        ]
        if lines:
            found[path.relative_to(root).as_posix()] = lines
    assert {name: lines for name, lines in found.items() if name not in MAY_WRITE} == {}
    assert set(MAY_WRITE) == set(found)


@contextmanager
def full_disk(room: int) -> Iterator[None]:
    """No file grows beyond some bytes, as on a full disk (the error is EFBIG in place of ENOSPC)."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (room, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_run_begins_only_where_the_disk_has_room_for_a_record(tmp_path: Path) -> None:
    """A short run is written at its end: on a full disk it would be lost, and could not be resumed."""
    steps: list[float] = []
    sim = trb.Simulation(trb.cases.paper_30310(3000.0), accuracy="fast")
    how: Any = {"duration": 1e-3, "output": tmp_path / "run.h5", "callback": lambda now: steps.append(now.time)}
    with full_disk(500_000), pytest.raises(trb.FileError, match=r"run\.h5: the result file cannot be written"):
        sim.run(**how)
    assert sim.time == 0.0
    assert not steps
    assert list(tmp_path.iterdir()) == []
    assert len(sim.run(**how)) > 1


@pytest.mark.usefixtures("drawn_only")
@pytest.mark.parametrize("name", sorted(WRITERS))
def test_a_file_is_replaced_only_if_asked_and_stays_whole(name: str, run_file: Path, tmp_path: Path) -> None:
    ending, call = WRITERS[name]
    run = trb.load(run_file)
    folder, elsewhere = tmp_path / "here", tmp_path / "there"
    folder.mkdir()
    elsewhere.mkdir()
    path, target = folder / ending, elsewhere / f"target{Path(ending).suffix}"
    for there in (path, target):
        there.write_bytes(FOREIGN)
        if there is target:
            path.unlink()
            path.symlink_to(target)
        with pytest.raises(trb.FileError, match="exists already; give another name, or overwrite=True"):
            call(run, path, overwrite=False)
        assert there.read_bytes() == FOREIGN
        if there is path and name not in RUNS:
            with full_disk(20), pytest.raises(trb.FileError, match="cannot be written"):
                call(run, path, overwrite=True)
            assert there.read_bytes() == FOREIGN
    call(run, path, overwrite=True)
    assert len(target.read_bytes()) > len(FOREIGN)
    assert path.is_symlink()
    assert [entry.name for entry in (*folder.iterdir(), *elsewhere.iterdir())] == [ending, target.name], "drafts stay"
    if name != "trbdyn.plot.all":
        with pytest.raises(trb.FileError, match="there is no folder"):
            call(run, tmp_path / "none" / ending, overwrite=False)
    plt.close("all")


@pytest.mark.parametrize("write", [trb.report, trb.view, save_gltf])
def test_the_file_that_is_read_is_never_replaced(write: Callable[..., Any], run_file: Path, tmp_path: Path) -> None:
    ending = ".glb" if write is save_gltf else ".html"
    own = tmp_path / f"run{ending}"
    trb.Simulation(paper_30310()).run(output=own, **SPAN)
    link = tmp_path / f"link{ending}"
    link.symlink_to(run_file)
    before = own.read_bytes(), run_file.read_bytes()
    for result in (trb.load(own), trb.load(own).select(["cage", "rollers"]), trb.load(own).window(1e-4)):
        with pytest.raises(trb.InputError, match="must be another file than the one that is read"):
            write(result, own, overwrite=True)
    for path in (run_file, link):
        with pytest.raises(trb.InputError, match="must end in"):
            write(trb.load(run_file), path, overwrite=True)
    assert (own.read_bytes(), run_file.read_bytes()) == before


def test_a_pdf_replaces_nothing_unasked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page, path = tmp_path / "a.html", tmp_path / "a.pdf"
    page.write_text("<p>page</p>")
    path.write_bytes(FOREIGN)
    script = tmp_path / "printer"
    script.write_text('#!/bin/sh\nfor word; do case $word in --print-to-pdf=*) echo pdf >"${word#*=}";; esac; done\n')
    script.chmod(0o755)
    monkeypatch.setattr("trbdyn.reporting.converter", lambda: str(script))
    with pytest.raises(trb.FileError, match="exists already"):
        save_pdf(page, path)
    assert path.read_bytes() == FOREIGN
    assert save_pdf(page, path, overwrite=True).read_text() == "pdf\n"
    with pytest.raises(trb.InputError, match=r"must end in \.pdf"):
        save_pdf(page, page, overwrite=True)


# ---- commands ----

COMMANDS: dict[str, tuple[list[str], list[str]]] = {
    "run": (["rig_30310", "-o", "a.h5", "--summary", "a.json", "--report", "a.html"], ["a.h5", "a.json", "a.html"]),
    "resume": (["cut.h5", "--summary", "a.json", "--report", "a.html"], ["a.json", "a.html"]),
    "plot": (["run.h5", "-o", ".", "--only", "tilt"], ["tilt.png"]),
    "report": (["run.h5", "-o", "a.html"], ["a.html"]),
    "view": (["run.h5", "-o", "a.html", "--gltf", "a.glb", "--no-open"], ["a.html", "a.glb"]),
    "demo": (["-o", "."], ["run.h5", "report.html", "view.html", "summary.json", "cage_locus.png"]),
    "plan": (["rig_30310", "--want", "torque=0.1", "-o", "a"], ["a.toml", "a.png"]),
    "torque": (["rig_30310", "--speeds", "100", "-o", "a"], ["a.nc", "a.png"]),
    "thermal": (["rig_30310", "--heat", "outer_ring_to_surroundings=3", "-o", "a.png"], ["a.png"]),
    "new": (["a.toml"], ["a.toml"]),
    "export": (["run.h5", "a.csv"], ["a.csv"]),
    "fmu": (["rig_30310", "-o", "a.fmu"], ["a.fmu"]),
}
"""Words of each command, and the files that it would write."""
WRITE_A_STUDY = {"sweep", "ensemble"}
ONLY_PRINT = {"info", "cases", "rating", "check", "fit", "spectrum", "stiffness"}
OWNS_A_FOLDER = {"app"}


def commands() -> dict[str, argparse.ArgumentParser]:
    (found,) = (action for action in make_parser()._actions if isinstance(action, argparse._SubParsersAction))
    return dict(found.choices)


def test_every_command_is_known_and_can_be_asked_to_replace() -> None:
    found = commands()
    assert set(found) == {*COMMANDS, *WRITE_A_STUDY, *ONLY_PRINT, *OWNS_A_FOLDER}
    for name, parser in found.items():
        options = {text for action in parser._actions for text in action.option_strings}
        assert ("--overwrite" in options) == (name in COMMANDS), name


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_a_command_replaces_only_if_asked(
    name: str, run_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    words, files = COMMANDS[name]
    for there in files:
        if "run.h5" in words:
            Path("run.h5").write_bytes(run_file.read_bytes())
        Path(there).write_bytes(FOREIGN)
        before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
        assert main([name, *words]) == 2
        said = capsys.readouterr().err
        assert f"{there}: the file exists already" in said
        assert "--overwrite" in said
        assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
        Path(there).unlink()


@pytest.mark.usefixtures("drawn_only")
@pytest.mark.parametrize("words", [["report"], ["view", "--no-open"]])
@pytest.mark.parametrize("again", [[], ["--overwrite"]])
def test_a_report_never_replaces_its_result(
    words: list[str], again: list[str], run_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    link = tmp_path / "link.h5"
    link.symlink_to(run_file)
    before = run_file.read_bytes()
    for output in (run_file, link):
        assert main([*words, str(run_file), "-o", str(output), *again]) == 2
        assert "must end in .html" in capsys.readouterr().err
    assert run_file.read_bytes() == before


def test_a_command_never_replaces_its_case(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    case = tmp_path / "a.toml"
    assert main(["new", str(case)]) == 0
    before = case.read_bytes()
    for words in (
        ["run", str(case), "-o", str(case)],
        ["run", str(case), "-o", str(tmp_path / "a.h5"), "--summary", str(case)],
        ["plan", str(case), "--want", "torque=0.1", "-o", str(tmp_path / "a")],
    ):
        assert main([*words, "--overwrite"]) == 2
        assert "must be another file than the one that is read" in capsys.readouterr().err
    assert case.read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["a.toml"]
