"""Whatever is typed: the command line does it, or says in one line for each problem why not, and ends with exit code
2.
"""

from __future__ import annotations

import contextlib
import importlib.util
import io
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import matplotlib.pyplot as plt
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from matplotlib.animation import FuncAnimation
from matplotlib.figure import Figure

import trbdyn as trb
from trbdyn import animation, plot
from trbdyn.cli import FAULT, main
from trbdyn.model.cases import paper_30310
from trbdyn.run import running

paper: ModuleType | None = None
if importlib.util.find_spec("paper"):  # a source distribution has no benchmarks
    paper = importlib.import_module("paper.command")

ODD = [
    "", " ", ".", "..", "/", "-", "--", "\n", "a\nb", "nul\0", "\ud800", "x" * 300, "保" * 100, "/dev/null", "/proc/self/mem",
    "0", "-1", "1e-5", "1e300", "-1e300", "1e400", "nan", "inf", "9" * 5000, "0x10", "1_0", "true", "None",
    "text.h5", "text.txt", "deep.toml", "digits.toml", "study.toml", "bad_study.toml", "folder", "folder/x.h5", "nowhere/x.h5",
    "run.h5", "run.h5.checkpoint", "pipe.h5", "link.h5", "rig_30310", "30310", "nothing",
]  # fmt: skip
SETS = [
    "", "=", "=3", "a", "a=b", ".=1", "scene.=1", "scene=3", "bearing=3", "scene.speed_rpm", "scene.speed_rpm=", "run=[]",
    "scene.speed_rpm.x=1", "scene.speed_rpm=[1]", "scene.speed_rpm={times=[0], values=[1]}", "scene.speed_rpm=1979-05-27",
    "scene.speed_rpm=" + "9" * 400, "scene.speed_rpm=" + "9" * 5000, "scene.speed_rpm=" + "[" * 3000, "start.kind=state",
    "start.state_vector=[1]", "run.save_groups=[]", "run.save_groups=3", "run.duration=1e300", "run.save_every=1e-300",
    "bearing.case=nothing", "bearing.case=[]", "lubricant.oil={}", "effects.preset=1", "bearing.cage.pocket.shape=3",
    "bearing.cage.pocket={shape='drafted'}", "bearing.n_rollers=1e3", "bearing.n_rollers=100000000000000000000",
    "bearing.roller.diameter=1e-300", "scene.axial_load=1e9", "scene.axial_load=-1", "scene.gravity=[0,0]", "a.b.c.d.e=1",
]  # fmt: skip

VALUES = st.one_of(st.sampled_from(ODD), st.text(max_size=6))
OPTIONS = {
    "run": [
        "-o",
        "--output",
        "--duration",
        "--revolutions",
        "--save-every",
        "--checkpoint-every",
        "--accuracy",
        "--summary",
    ],
    "resume": ["--instruction-set", "--summary"],
    "plot": ["-o", "--only"],
    "info": [],
    "demo": ["-o", "--revolutions", "--accuracy"],
    "sweep": ["-o", "--workers"],
    "paper": ["-o", "--workers", "--points", "--starts", "--seeds", "--max-time", "--min-time"],
    "cases": [],
}
FLAGS = ["--quiet", "--json", "--again", "--overwrite", "--animation", "--report", "--help", "--version", "--nonsense"]


@st.composite
def words(draw: st.DrawFn) -> list[str]:
    command = draw(st.sampled_from(sorted(OPTIONS)))
    places = st.one_of(VALUES, st.sampled_from(["rig_30310", "run.h5", "study.toml"]))
    out = [command, *draw(st.lists(places, max_size=1 if command not in ("demo", "paper", "cases") else 0))]
    for option in draw(st.lists(st.sampled_from(OPTIONS[command] or FLAGS), max_size=3)):
        out += [option, draw(VALUES)]
    for change in draw(st.lists(st.sampled_from(SETS), max_size=2)) if command in ("run", "info") else []:
        out += ["--set", change]
    return out + draw(st.lists(st.sampled_from(FLAGS), max_size=1))


@pytest.fixture(scope="module")
def prepared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A folder with all kinds of files, where every run ends at its first look at the callback."""
    import os

    from trbdyn.extras.study import runner

    folder = tmp_path_factory.mktemp("command line")
    patch = pytest.MonkeyPatch()
    patch.chdir(folder)
    with pytest.raises(RuntimeError):
        trb.Simulation(paper_30310()).run(duration=0.02, checkpoint_every=1e-3, output="run.h5", callback=fail)
    case = '[bearing]\ncase = "30310"\n[scene]\nspeed_rpm = 1000\naxial_load = 3000\n[run]\nduration = 1e-4\n[study]\n'
    for name, text in {
        "text.h5": "text",
        "text.txt": "text",
        "deep.toml": "x = " + "[" * 5000,
        "digits.toml": "x = " + "9" * 5000,
        "study.toml": case + "grid = {'scene.speed_rpm' = [1000]}",
        "bad_study.toml": case + "grid = 3",
    }.items():
        Path(name).write_text(text)
    Path("folder").mkdir()
    Path("link.h5").symlink_to("folder/target.h5")
    os.mkfifo("pipe.h5")
    begin, execute = running.Run.__init__, runner.execute

    def short(self: running.Run, *rest: Any, **named: Any) -> None:
        begin(self, *rest, **named)
        self.callback = self.callback or (lambda sim: True)

    patch.setattr(running.Run, "__init__", short)
    patch.setattr(running, "CHUNK_STEPS", 3)
    patch.setattr(runner, "execute", lambda work, tasks, executor, workers: execute(work, tasks, "serial", workers))
    # drawing has tests of its own, and takes seconds each time
    patch.setattr(plot, "PICTURES", {"tilt": (lambda result: plt.figure(), ("cage",))})
    patch.setattr(Figure, "savefig", lambda self, picture, **how: picture.write(b""))
    patch.setattr(animation, "animate", lambda result: FuncAnimation(plt.figure(), lambda frame: [], frames=1))
    patch.setattr(FuncAnimation, "save", lambda self, path, **how: Path(path).write_bytes(b""))
    if paper is not None:
        patch.setattr(paper, "run_points", lambda *rest, **named: {})
    yield folder
    patch.undo()


def fail(sim: trb.Simulation) -> None:
    raise RuntimeError("ended on purpose")


def call(arguments: list[str]) -> tuple[int, str]:
    """Exit code and what stands in the error stream."""
    said = io.StringIO()
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
        try:
            code = paper.main(arguments[1:]) if paper and arguments[:1] == ["paper"] else main(arguments)
        except SystemExit as ended:
            code = ended.code if isinstance(ended.code, int) else 99
    return code, said.getvalue()


def check(arguments: list[str]) -> None:
    code, said = call(arguments)
    assert "Traceback" not in said
    assert code in (0, 1, 2), (code, said)
    assert code != FAULT
    lines = [line for line in said.split("\n") if line and not line.startswith(("\r", " ")) and "%|" not in line]
    assert all(line.startswith(("trbdyn", "python benchmarks/paper")) for line in lines), said
    assert code == 0 or lines
    if code == 2:
        assert 1 <= len(lines) <= 8, said


@settings(
    max_examples=150,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)
@given(arguments=words())
@example(arguments=[])
@example(arguments=["run"])
@example(arguments=["run", "digits.toml"])
@example(arguments=["run", "deep.toml", "--set", "scene.speed_rpm=1"])
@example(arguments=["run", "rig_30310", "-o", "pipe.h5", "--overwrite"])
@example(arguments=["run", "rig_30310", "-o", "", "--quiet"])
@example(arguments=["sweep", "bad_study.toml"])
@example(arguments=["plot", "text.h5"])
def test_any_words(prepared: Path, arguments: list[str]) -> None:
    check(arguments)


@pytest.mark.parametrize("command", ["run", "info"])
def test_every_change_of_a_case(prepared: Path, command: str) -> None:
    for change in SETS:
        check([command, "rig_30310", "--set", change])


QUICK = ("", "-", "nul\0", "1e400", "deep.toml", "run.h5", "pipe.h5", "nothing")
"""Values that are tried in every place each time; the others are tried in all places by the slow tests, and at random by each."""


@pytest.mark.parametrize(
    "value", [value if value in QUICK else pytest.param(value, marks=pytest.mark.slow) for value in ODD]
)
def test_every_odd_value_in_every_place(prepared: Path, value: str) -> None:
    for command, options in OPTIONS.items():
        given = (
            []
            if command in ("demo", "paper", "cases")
            else ["run.h5" if command in ("plot", "resume") else "rig_30310"]
        )
        if given and value != "rig_30310":
            check([command, value])
        for option in options if command != "demo" else ["--revolutions"]:
            check([command, *given, option, value])
