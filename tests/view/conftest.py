"""Short runs to show, and a browser to show them in."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from browser import Browser, executable

import trbdyn as trb
from trbdyn.results.result import Result


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
    if executable() is None:
        pytest.skip("no Chromium is installed: apt-get install chromium")
    opened = Browser(tmp_path_factory.mktemp("browser"))
    yield opened
    opened.close()
