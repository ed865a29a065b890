"""Short runs to show, and a browser to show them in."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import trbdyn as trb
from trbdyn.results.result import Result


def _module(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"trb_test_{name}", Path(__file__).parent / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def whirling() -> Result:
    """The 30310 with a whirling cage, three turns of the shaft."""
    scene = trb.cases.scene_30310(3000.0, 4930.0, effects=trb.Effects.paper(), start=trb.Start.whirl(0.9))
    return trb.Simulation(scene).run(revolutions=3)


@pytest.fixture(scope="session")
def loaded_on_one_side() -> Result:
    """The 32216 with a radial load and a misaligned inner ring, Gauss nodes."""
    effects = trb.Effects.paper().replace(quadrature="gauss", n_slices=8)
    scene = trb.cases.scene_32216(2000.0, 6000.0, 5000.0, effects=effects, misalignment_x=2e-4)
    return trb.Simulation(scene).run(revolutions=2)


@pytest.fixture(scope="session")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    module = _module("browser")
    if module.executable() is None:
        pytest.skip("no Chromium is installed: apt-get install chromium")
    opened = module.Browser(tmp_path_factory.mktemp("browser"))
    yield opened
    opened.close()
