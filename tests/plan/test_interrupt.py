"""Ctrl-C ends a plan as it ends a study."""

from __future__ import annotations

import os
import signal
from typing import Any

import pytest

import trbdyn as trb
from trbdyn.extras.design.planning import probes
from trbdyn.model.cases import scene_30310


def test_ctrl_c_ends_a_plan_with_keyboard_interrupt(monkeypatch: pytest.MonkeyPatch) -> None:
    """It was an error of the package, which `except trb.TrbError` took for a scene that cannot be run."""
    run = trb.Simulation.run

    def interrupted(self: trb.Simulation, *rest: Any, **named: Any) -> Any:
        named["callback"] = lambda _: os.kill(os.getpid(), signal.SIGINT)
        return run(self, *rest, **named)

    monkeypatch.setattr(probes.Simulation, "run", interrupted)
    with pytest.raises(KeyboardInterrupt):
        trb.plan(scene_30310(), {"torque": 0.1}, effort=2.0)
