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
        scene = cases.scene_30310(effects=effects.EVERYTHING.replace(**effect.off))
        sim = Simulation(scene)
        for _ in range(3):
            sim.step()
        counters = sim.counters
        assert [counters[name] for name in effect.counters] == [0] * len(effect.counters), effect.name


def test_code_of_each_effect_is_still_where_it_is_taken_out(catalogue: Any, tmp_path: Path) -> None:
    build, effects = catalogue
    for place, effect in enumerate(effects.EFFECTS):
        if effect.patch is None:
            continue
        sources = tmp_path / str(place)
        shutil.copytree(ROOT / "csrc", sources)
        build.apply(effect.patch, sources)
