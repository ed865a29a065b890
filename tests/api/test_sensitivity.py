"""The sensitivity study: what is varied, how runs are read, how effects and statements are told from noise."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("xarray")
pytest.importorskip("matplotlib")

pytest.importorskip("paper", reason="the benchmarks are not part of a source distribution")

from paper.sensitivity import command, effects, indicators, plan
from paper.sensitivity.inputs import inputs
from paper.sensitivity.plan import NOMINAL, PLACES, Plan, case

ENTRIES = inputs()
LEVELS = [(entry, level) for entry in ENTRIES for level in entry.levels]
COMBINED = next(place for place in PLACES if place.condition.radial_load)


class TestInputs:
    def test_a_level_builds_a_scene_of_its_own(self) -> None:
        of_place = {place: case(place, "full", 0, None, None, 1e-3) for place in (COMBINED, PLACES[0])}
        for entry, level in LEVELS:
            place = COMBINED if entry.combined_only else PLACES[0]
            nominal, other = of_place[place], case(place, "full", 0, entry, level, 1e-3)
            assert other.error == "", (entry.name, level.label)
            assert other.fingerprint != nominal.fingerprint, (entry.name, level.label)
            same_scene = other.scene.fingerprint == nominal.scene.fingerprint  # type: ignore[union-attr]
            assert same_scene == (entry.name in ("tolerances", "run time")), (entry.name, level.label)

    def test_names_tell_inputs_and_levels_apart(self) -> None:
        assert len({entry.name for entry in ENTRIES}) == len(ENTRIES)
        assert len({(entry.name, level.label) for entry, level in LEVELS}) == len(LEVELS)

    def test_what_is_run(self) -> None:
        chosen = tuple(entry for entry in ENTRIES if entry.name in ("cage mass", "start", "load direction"))
        study = plan.study(Plan(inputs=chosen, seeds=1, nominal_seeds=2))
        found = [tuple(c.parameters[key] for key in ("point", "start", "input")) for c in study.cases]
        assert sum(name == NOMINAL for *_, name in found) == 2 * 7
        assert sum(name == "cage mass" for *_, name in found) == 2 * 7
        assert {start for _, start, name in found if name == "start"} == {"full"}
        assert {point for point, _, name in found if name == "load direction"} == {COMBINED.name}
        assert len({c.fingerprint for c in study.cases}) == len(study)


class TestIndicators:
    """A circle of 0.6 Cpr that turns with the cage, about a place 0.2 Cpr off the axis."""

    def test_orbit(self, build: Callable[..., Any]) -> None:
        play = build()[1].clearances.radial
        run, result = build(radius=0.6 * play, centre=(0.0, -0.2 * play))
        assert indicators.orbit(result) == pytest.approx(0.6, abs=2e-3)
        assert indicators.hang(result) == pytest.approx(0.2, abs=5e-3)
        assert indicators.orbit_growth(result) == pytest.approx(0.0, abs=0.1)
        assert indicators.whirl_order(result) == pytest.approx(1.0, abs=0.01)
        assert indicators.whirl_radius(result) > 0.6
        low, high = indicators.whirl_radius_range(result)
        assert 0.4 < low < indicators.whirl_radius(result) < high < 0.8
        force = run.column("pocket_force")[run.column("time") >= 0.4 / 3]
        assert indicators.pocket_force(result) == pytest.approx(np.percentile(force[force > 0.0], 95.0), rel=0.01)

    @pytest.mark.parametrize("growth", [3.0, -3.0])
    def test_growth(self, build: Callable[..., Any], growth: float) -> None:
        run, result = build()
        position, angle = run.column("cage_position"), run.column("cage_angle")
        factor = np.exp(0.01 * growth * angle / (2.0 * math.pi))
        circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        position[:, :2] = 0.5 * result.clearances.radial * factor[:, np.newaxis] * circle
        position[:, 1] -= 0.3 * result.clearances.radial
        assert indicators.orbit_growth(run.result(result.scene)) == pytest.approx(growth, abs=0.2)

    def test_too_short_a_run_has_no_growth(self, build: Callable[..., Any]) -> None:
        assert math.isnan(indicators.orbit_growth(build(n=401, duration=0.04)[1]))


def made_runs(change: float, scatter: float = 0.2) -> tuple[dict[Any, Any], Plan]:
    """Growth of 1 % a turn in eight seeds, and `change` by the first level of the cage's mass in two."""
    entry = ENTRIES[0]
    offsets = scatter * np.array([1, -1, 1, -1, 1, -1, 1, -1])
    point = PLACES[0].name
    runs: dict[Any, Any] = {
        (point, "small", NOMINAL, NOMINAL): {k: {"orbit_growth": 1.0 + offset} for k, offset in enumerate(offsets)},
        (point, "small", entry.name, entry.levels[0].label): {
            k: {"orbit_growth": 1.0 + offsets[k] + change} for k in (0, 1)
        },
    }
    for entries in runs.values():
        for values in entries.values():
            values |= {i.name: math.nan for i in indicators.INDICATORS if i.name != "orbit_growth"}
    return runs, Plan((PLACES[0],), (entry,), 2)


class TestEffects:
    @pytest.mark.parametrize(("change", "beyond"), [(0.3, False), (0.7, True), (-0.7, True)])
    def test_change_and_noise(self, change: float, beyond: bool) -> None:
        (effect,) = effects.effects(*made_runs(change))
        assert effect.change == pytest.approx(change)
        assert effect.value == pytest.approx(1.0 + change)
        assert effect.count == 2
        # Student's t for seven degrees of freedom, 97.5 %; two means over two seeds
        assert effect.noise == pytest.approx(2.3646 * 0.2 * math.sqrt(8 / 7) * math.sqrt(2 / 2), rel=1e-3)
        assert effect.beyond is beyond

    @pytest.mark.parametrize(("change", "outcome"), [(0.5, "holds"), (-0.9, "open"), (-3.0, "fails")])
    def test_statements(self, change: float, outcome: str) -> None:
        nominal, first, second = effects.judge(*made_runs(change))
        assert (nominal.statement, nominal.outcome) == ("grows at 4930 N", "holds")
        assert first.outcome == outcome
        assert (second.level, second.outcome) == (ENTRIES[0].levels[1].label, "-")

    def test_an_input_without_any_effect_is_judged_as_the_nominal_one(self) -> None:
        nominal, first, _ = effects.judge(*made_runs(0.0))
        assert (first.margin, first.noise, first.outcome) == (nominal.margin, nominal.noise, nominal.outcome)
        assert effects.judge(*made_runs(1e-9))[1].noise == pytest.approx(2.0 * nominal.noise)

    def test_one_nominal_seed_tells_no_noise(self) -> None:
        runs, chosen = made_runs(5.0)
        nominal = runs[PLACES[0].name, "small", NOMINAL, NOMINAL]
        del runs[PLACES[0].name, "small", ENTRIES[0].name, ENTRIES[0].levels[0].label][1]
        for seed in range(1, 8):
            del nominal[seed]
        (effect,) = effects.effects(runs, chosen)
        assert math.isnan(effect.noise)
        assert not effect.beyond
        assert effects.judge(runs, chosen)[1].outcome == "open"


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Plan, dict[str, Any]]:
    folder = tmp_path_factory.mktemp("sensitivity")
    entry = replace(ENTRIES[0], levels=ENTRIES[0].levels[:1])
    chosen = Plan((replace(PLACES[0], duration=0.16, small=0.3, small_duration=0.16),), (entry,), 1, 2)
    return folder, chosen, command.run(chosen, folder, executor="serial")


class TestCommand:
    def test_a_sweep(self, swept: tuple[Path, Plan, dict[str, Any]]) -> None:
        folder, _, values = swept
        assert values["schema"] == "trbdyn-sensitivity-1"
        assert values["runs"]["planned"] == values["runs"]["done"] == 6
        assert values == json.loads((folder / command.JSON).read_text(encoding="utf-8"))
        found = {entry["indicator"]: entry for entry in values["effects"]}
        assert found.keys() == {indicator.name for indicator in indicators.INDICATORS}
        nominal = values["nominal"][PLACES[0].name]
        assert nominal["torque"]["mean"] == pytest.approx(1.24, abs=0.1)
        assert 0.5 < nominal["orbit"]["mean"] < 1.0
        assert all(entry["count"] == 1 and entry["noise"] > 0.0 for entry in found.values())
        assert (folder / f"sensitivity_{PLACES[0].name}.png").stat().st_size > 10_000
        assert "| cage mass | 0.20 kg | 0.12 kg | - |" in (folder / command.TABLES).read_text(encoding="utf-8")

    def test_a_report_runs_nothing(self, swept: tuple[Path, Plan, dict[str, Any]], tmp_path: Path) -> None:
        folder, chosen, values = swept
        before = (folder / command.RUNS / "index.jsonl").read_bytes()
        more = replace(chosen, nominal_seeds=3)
        again = command.run(more, folder, tmp_path / "other.json", run_cases=False)
        assert again["runs"]["planned"] == 8
        assert again["effects"] == values["effects"]
        assert again == json.loads((tmp_path / "other.json").read_text(encoding="utf-8"))
        assert (folder / command.RUNS / "index.jsonl").read_bytes() == before

    @pytest.mark.parametrize(
        "arguments", [["--points", "3000rpm_1N"], ["--inputs", "cage weight"], ["--seeds", "0"]], ids=str
    )
    def test_wrong_arguments(self, arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
        with pytest.raises(SystemExit) as stop:
            command.main(["--report", *arguments])
        assert stop.value.code == 2
        assert "must be" in capsys.readouterr().err
