"""Instructions of one force evaluation, counted by callgrind: what a busy machine does not change.

The scenes are made here; a process under valgrind loads the core alone with NumPy, evaluates each scene's forces once to warm up,
and some times more while callgrind counts. Valgrind has no AVX-512, so that the kernels are those of AVX2. What Python takes
for a call, some thousand instructions, is in all counts. The first scene of a process takes some percent more; give it twice.
"""

from __future__ import annotations

import pickle
import re
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import trbdyn as trb
from trbdyn import Simulation, _core
from trbdyn.extras.elastic.simulated import mode_rows
from trbdyn.model.defect_rows import form_rows
from trbdyn.model.flatten import diameter_deviation, face_rows, parameter_block
from trbdyn.model.profiles import drop_rows
from trbdyn.statics.core_model import build_model
from trbdyn.statics.ring_motion import ring_motion

EVALUATIONS: Final = 3
MANY: Final = 50
"""Evaluations that tell a difference of a thousandth."""
VARIANT: Final = "avx2"
HEADER: Final = Path("/usr/include/valgrind/callgrind.h")

REQUESTS: Final = """
#include <valgrind/callgrind.h>
void begin(void) { CALLGRIND_START_INSTRUMENTATION; CALLGRIND_ZERO_STATS; }
void end(void) { CALLGRIND_DUMP_STATS; CALLGRIND_STOP_INSTRUMENTATION; }
"""

COUNTED: Final = """
import ctypes, importlib.util, pickle, sys
place, requests, scenes, evaluations = sys.argv[1:]
found = importlib.util.spec_from_file_location("trbdyn._core", place)
core = importlib.util.module_from_spec(found)
found.loader.exec_module(core)
ask = ctypes.CDLL(requests)
for arguments, motion, vector in pickle.load(open(scenes, "rb")):
    simulation = core.Simulation((core.Model(*arguments),), (motion,), 0.0, vector, {})
    simulation.derivative(0.0, vector)
    ask.begin()
    for _ in range(int(evaluations)):
        simulation.derivative(0.0, vector)
    ask.end()
"""


class CannotCount(Exception):
    """Why nothing is counted here."""


def described(scene: trb.Scene, vector: Any = None) -> tuple[Any, Any, Any]:
    """A scene as the core takes it: arguments of its model, the prescribed motion, and a state; by default that of the start."""
    motion, _ = ring_motion(build_model(scene), scene)
    state = Simulation(scene).state.vector
    if vector is not None and len(vector) == len(state):
        state = vector
    rows = (mode_rows(scene), form_rows(scene), drop_rows(scene))
    arguments = (parameter_block(scene), diameter_deviation(scene), face_rows(scene), VARIANT, *rows)
    return arguments, motion.prescribed, state


def counted(
    scenes: Sequence[tuple[Any, Any, Any]], folder: Path, core: Path | None = None, evaluations: int = EVALUATIONS
) -> list[float]:
    """Instructions of one evaluation of each scene, in thousands.

    Parameters
    ----------
    scenes : sequence
        As `described` gives them.
    folder : Path
        For files in between.
    core : Path, optional
        Another build of the core; by default the installed one.
    evaluations : int
        How many are counted.

    Raises
    ------
    CannotCount
        If valgrind or a compiler is missing, or the process fails.
    """
    valgrind, compiler = shutil.which("valgrind"), shutil.which("gcc") or shutil.which("cc")
    if valgrind is None or not HEADER.exists():
        raise CannotCount("valgrind is not installed")
    if compiler is None:
        raise CannotCount("there is no compiler")
    if VARIANT not in _core.instruction_sets():
        raise CannotCount("the processor has no AVX2")
    source, requests, data = folder / "requests.c", folder / "requests.so", folder / "scenes.pickle"
    source.write_text(REQUESTS, encoding="utf-8")
    subprocess.run([compiler, "-shared", "-fPIC", "-O1", str(source), "-o", str(requests)], check=True)
    data.write_bytes(pickle.dumps(list(scenes)))
    out = folder / "callgrind.out"
    for old in folder.glob("callgrind.out*"):
        old.unlink()
    command = [valgrind, "--tool=callgrind", "--instr-atstart=no", f"--callgrind-out-file={out}", sys.executable]
    command += ["-E", "-c", COUNTED, str(core or _core.__file__), str(requests), str(data), str(evaluations)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=folder, check=False)
    if done.returncode:
        raise CannotCount(f"the process under valgrind failed: {done.stderr.strip().splitlines()[-1]}")
    counts = _totals(folder)
    if len(counts) != len(scenes):
        raise CannotCount(f"valgrind gave {len(counts)} counts for {len(scenes)} scenes")
    return [count / evaluations / 1000.0 for count in counts]


def _totals(folder: Path) -> list[float]:
    """Counts in the files that callgrind wrote, in their order; a last one without instructions is that of the end."""
    found: Mapping[int, float] = {
        int(path.suffix[1:]): float(total[1])
        for path in folder.glob("callgrind.out.*")
        if (total := re.search(r"^(?:totals|summary): (\d+)", path.read_text(encoding="utf-8"), re.MULTILINE))
    }
    return [found[place] for place in sorted(found) if found[place] > 0.0]
