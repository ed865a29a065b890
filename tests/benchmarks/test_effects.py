"""The benchmark of effects runs and writes what it promises; what is off is not evaluated; code can still be taken out.

The benchmark itself is slow: every change runs it once by `make bench SMOKE=1`.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest
from shared import benchmark

ROOT = Path(__file__).resolve().parents[2]
BENCHMARKS = ROOT / "benchmarks"


@pytest.fixture(scope="module")
def effects(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    return benchmark("effects", tmp_path_factory.mktemp("effects"), "--smoke")[0]


@pytest.mark.slow
def test_every_entry_is_described(effects: dict[str, Any]) -> None:
    assert effects["schema"] == "trbdyn-benchmark-1"
    for row in [*effects["results"], effects["summary"]]:
        assert set(row) <= set(effects["columns"])


@pytest.mark.slow
def test_effects_have_their_figures(effects: dict[str, Any]) -> None:
    found = effects["summary"]["effects"]
    assert set(found) == {"thermal", "gravity"}
    for figures in found.values():
        assert set(figures) == {"time_ratio_off", "evaluations_off", "share"}


@pytest.mark.slow
def test_what_is_off_is_not_evaluated(effects: dict[str, Any]) -> None:
    for row in effects["results"]:
        assert row["evaluations_off"] == 0
        assert row["evaluations_on"] > 0


@pytest.fixture
def catalogue() -> Any:
    from effect_cost import build, catalogue

    return build, catalogue


def test_counters_of_all_effects_that_are_off_stay_at_zero(catalogue: Any) -> None:
    from trbdyn import Simulation, cases

    _, effects = catalogue
    for effect in effects.EFFECTS:
        sim = Simulation(effect.switched_off(cases.scene_30310()))
        for _ in range(3):
            sim.step()
        counters = sim.counters
        assert [counters[name] for name in effect.counters] == [0] * len(effect.counters), effect.name


def test_every_switch_has_its_row(catalogue: Any) -> None:
    import trbdyn as trb

    _, effects = catalogue
    for model in (trb.Effects, trb.Scene):
        rows = set().union(*(effect.fields[model.__name__] for effect in effects.EFFECTS))
        numbers = effects.NUMBERS[model.__name__]
        assert numbers <= set(model.model_fields)
        assert not rows & numbers
        assert set(model.model_fields) - numbers == rows, (
            f"{model.__name__}: a switch without a row, or a row without one"
        )


def test_what_is_added_is_evaluated_and_leaves_nothing_where_it_is_off(catalogue: Any) -> None:
    """Counters, fields of a record, and losses in the energy audit, for every row that is off in the scene of the others."""
    import numpy as np

    from trbdyn import Simulation, cases

    _, effects = catalogue
    base = cases.scene_30310()
    off = Simulation(base.replace(effects=effects.EVERYTHING))
    plain, record = off.derivative(), set(off.record())
    for effect in effects.EFFECTS:
        if not effect.is_added:
            continue
        on = Simulation(effect.switched_on(base))
        for _ in range(3):
            on.step()
        counters = on.counters
        assert not effect.counters or any(counters[name] for name in effect.counters), effect.name
        assert all(off.counters[name] == 0 for name in effect.counters), effect.name
        changed = on.derivative()
        differs = changed.shape != plain.shape or not np.array_equal(changed, plain)
        assert differs or set(on.record()) != record, f"{effect.name} does nothing"


def test_code_of_each_effect_is_still_where_it_is_taken_out(catalogue: Any, tmp_path: Path) -> None:
    build, effects = catalogue
    for place, effect in enumerate(effects.EFFECTS):
        if effect.patch is None:
            continue
        sources = tmp_path / str(place)
        shutil.copytree(ROOT / "csrc", sources)
        build.apply(effect.patch, sources)
