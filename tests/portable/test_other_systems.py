"""The Python part works without what only Unix has. This takes the names and modules away; it is no run on Windows or macOS."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent

IMPORTS = """
import importlib, pkgutil
import trbdyn
names = [entry.name for entry in pkgutil.walk_packages(trbdyn.__path__, "trbdyn.") if not entry.name.endswith("__main__")]
for name in names:
    importlib.import_module(name)
for name in ("fcntl", "resource", "pwd"):
    try:
        exec(f"import {name}", {"__name__": "trbdyn.try"})
    except ImportError:
        continue
    raise AssertionError(f"{name} can be imported")
print(len(names), "modules")
"""

WORK = """
import os
import sys
from pathlib import Path
import trbdyn as trb
from trbdyn import study
from trbdyn.base import locks
from trbdyn.errors import FileError, TrbError

if __name__ == "__main__":
    folder, scene = Path(os.environ["FOLDER"]), trb.cases.paper_30310(3000.0)
    path = folder / "run.h5"
    assert locks._FCNTL is None and not locks.OPEN_FILES_MOVE
    looks = []

    def look(sim):
        looks.append(locks.is_locked(path))
        try:
            locks.take_lock(path)
        except OSError as error:
            assert "another run" in str(error), error
        else:
            raise AssertionError("two locks of one file")

    run = trb.Simulation(scene).run
    result = run(duration=2e-3, save_every=1e-4, output=path, checkpoint_every=5e-4, callback=look)
    assert result.success and looks and all(looks) and not locks.is_locked(path)
    assert run(duration=1e-3, output=path, overwrite=True).success
    try:
        run(duration=1e-3, output=path)
    except FileError as error:
        assert "exists already" in str(error), error
    else:
        raise AssertionError("replaced")

    cut = folder / "cut.h5"
    try:
        run = trb.Simulation(scene).run
        run(duration=4e-3, save_every=1e-4, output=cut, checkpoint_every=1e-3, callback=lambda sim: sim.time > 2e-3 and 1 / 0)
    except ZeroDivisionError:
        pass
    else:
        raise AssertionError("not cut")
    whole = trb.resume(cut)
    assert whole.success and whole.time[-1] == 4e-3

    trb.report(whole, folder / "report.html", pictures=["cage_locus"])
    options = study.RunOptions(duration=5e-4, save_every=1e-4)
    cases = study.grid(scene, {"scene.speed_rpm": [1000.0, 3000.0]}, options, fixed={"effects.n_slices": 4})
    data = study.run(cases, folder / "study", executor="processes", workers=2)
    assert [str(one) for one in data["status"].values] == ["done", "done"], data
    print(*sorted(one.name for one in folder.iterdir()))
"""


def run_without(code: str, folder: Path) -> str:
    """Run code in a process that lacks what Windows lacks."""
    (folder / "path").mkdir()
    (folder / "path" / "sitecustomize.py").write_text((HERE / "as_elsewhere.py").read_text())
    (folder / "work").mkdir()
    (folder / "temporary").mkdir()
    script = folder / "script.py"
    script.write_text(code)
    environment = dict(
        os.environ, PYTHONPATH=str(folder / "path"), FOLDER=str(folder / "work"), TMPDIR=str(folder / "temporary")
    )
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, env=environment, timeout=300)
    assert done.returncode == 0, done.stderr[-4000:]
    return done.stdout


def test_every_module_is_imported_without_what_only_unix_has(tmp_path: Path) -> None:
    said = run_without(IMPORTS, tmp_path)
    assert int(said.split()[0]) > 150


def test_a_scene_a_resumed_run_a_report_and_a_study_in_processes(tmp_path: Path) -> None:
    """Files that are open are not renamed, nobody locks a file twice, and nothing is left behind."""
    assert run_without(WORK, tmp_path).split() == ["cut.h5", "report.html", "run.h5", "study"]
    assert sorted(one.suffix for one in (tmp_path / "work" / "study").iterdir()) == [".h5", ".h5", ".jsonl", ".nc"]
