"""A short run with a schedule of checkpoints, and what it gives when nothing interrupts it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import trbdyn as trb
from trbdyn.model.cases import paper_30310

SCHEDULE: dict[str, Any] = {"duration": 0.06, "save_every": 1e-4, "checkpoint_every": 4e-3}

RUN = """
import sys
import trbdyn as trb
from trbdyn.results import result_file
from trbdyn.model.cases import paper_30310

result_file.FLUSH_SECONDS = 0.02
scene = paper_30310(3000.0, 4930.0, start=trb.Start.whirl(0.9))
print("ready", flush=True)
trb.Simulation(scene).run(duration=0.06, save_every=1e-4, checkpoint_every=4e-3, output=sys.argv[1])
"""

RESUME = """
import sys
import trbdyn as trb
from trbdyn.results import result_file

result_file.FLUSH_SECONDS = 0.02
print("ready", flush=True)
trb.resume(sys.argv[1])
"""


def whirl() -> trb.Scene:
    """The scene of all runs here: chaotic enough that one bit more or less shows at its end."""
    return paper_30310(3000.0, 4930.0, start=trb.Start.whirl(0.9))


@pytest.fixture(scope="session")
def uninterrupted(tmp_path_factory: pytest.TempPathFactory) -> trb.Result:
    """The run without an interruption."""
    path: Path = tmp_path_factory.mktemp("uninterrupted") / "run.h5"
    return trb.Simulation(whirl()).run(**SCHEDULE, output=path)
