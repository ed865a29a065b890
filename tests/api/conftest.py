"""A whirling cage with known answers: tests/shared/synthetic.py."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from synthetic import StubScene, Synthetic, make_run

from trbdyn import _core
from trbdyn.results.result import Result


def result_of(run: Synthetic, **changes: Any) -> Result:
    """The run as a result in memory."""
    return run.result(**{"scene": StubScene()} | changes)


@pytest.fixture
def synthetic() -> Synthetic:
    """0.4 s of a whirling cage: records."""
    return make_run()


@pytest.fixture
def whirling(synthetic: Synthetic) -> Result:
    """0.4 s of a whirling cage: result."""
    return result_of(synthetic)


@pytest.fixture
def build() -> Callable[..., tuple[Synthetic, Result]]:
    """Makes other runs: arguments of `make_run`."""

    def make(**arguments: Any) -> tuple[Synthetic, Result]:
        run = make_run(**arguments)
        return run, result_of(run)

    return make


@pytest.fixture
def stub_scene() -> StubScene:
    """A scene that needs no core."""
    return StubScene()


@pytest.fixture
def header_fields() -> list[tuple[str, str, str, str, str]]:
    """The rows of the core's table of fields."""
    return _core.field_table()
