"""The paper's operating points: what is run, when it has settled, going on, what is written, how statements are
judged.
"""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import h5py
import numpy as np
import pytest
from paper import command, files, point_numbers, settle
from paper.command import main
from paper.movable import Pockets
from paper.point_numbers import Run, Runs
from paper.points import FIGURES, Condition, Inputs, Point, conditions, points
from paper.settle import Plan, PointTask, Verdict, is_done, judge, run_point
from paper.statements import STATEMENTS, Judged, by_inputs, judge_all, judge_statement, markdown

import trbdyn as trb
from trbdyn.errors import InputError

POINT = Point(Condition(3000.0, 4930.0), "whirl")
PLAN = Plan(0.02, 0.01, 0.03, 0.03, 0.03, 0.03, 1e-3, 2e-4, "fast")
PROMISED = ("whirl_ratio", "axial_over_clearance", "tilt_rms", "spacing_std_deg", "pocket_force_p95")


class TestPoints:
    def test_the_conditions_of_section_8(self) -> None:
        names = {condition.name for condition in conditions()}
        axial = {"1000rpm_3080N", "2000rpm_3080N", "3000rpm_3080N", "3000rpm_1230N", "3000rpm_4930N", "1000rpm_1230N"}
        combined = {f"{speed}rpm_4930N_5530N" for speed in (1000, 2000, 3000)}
        combined |= {f"2000rpm_4930N_{load}N" for load in (2780, 8380)}
        assert names == axial | combined | {"3000rpm_1230N_scatter"}
        assert len(conditions(every=True)) == 19

    def test_starts_and_seeds(self) -> None:
        listed = points(seeds=(1, 2))
        assert len({point.name for point in listed}) == len(listed)
        of = [point.name for point in listed if point.condition == POINT.condition]
        assert sorted(of) == [f"3000rpm_4930N_{start}" for start in ("equal", "unequal1", "unequal2", "whirl")]
        assert [point.name for point in points(["3000rpm_4930N_wh*"])] == ["3000rpm_4930N_whirl"]
        assert {point.condition.name for point in points(["2000rpm_*"])} == {
            c.name for c in conditions() if c.speed_rpm == 2000.0
        }
        with pytest.raises(InputError, match="fits no point"):
            points(["4000rpm_*"])

    def test_directions_and_scatters(self) -> None:
        asked = [Inputs(direction, scatter) for direction in (90.0, 180.0) for scatter in (0.0, 0.2e-6)]
        names = [point.name for point in points(starts=["equal"], seeds=[1], inputs=asked)]
        assert len(set(names)) == len(names) == 5 * 4 + 6 * 2 + 1
        assert {"3000rpm_4930N_5530N_180deg_scatter0.2um_equal1", "1000rpm_3080N_scatter0.2um_equal1"} <= set(names)
        scene = next(p for p in points(inputs=asked) if p.name == "2000rpm_4930N_8380N_180deg_equal").scene()
        assert scene.radial_direction_deg == 180.0

    def test_scenes(self) -> None:
        scene = Point(Condition(3000.0, 1230.0, scatter=1e-6), "unequal", 3).scene()
        assert scene.effects == trb.Effects.paper().replace(quadrature="gauss", n_slices=8)
        assert (scene.speed_rpm, scene.axial_load, scene.start.kind, scene.start.seed) == (3000.0, 1230.0, "unequal", 3)
        assert 0.3e-6 < np.ptp(scene.bearing.diameter_deviation) <= 1e-6
        combined = Point(Condition(2000.0, 4930.0, 5530.0), "equal").scene()
        assert (combined.radial_load, combined.radial_direction_deg) == (5530.0, 90.0)
        assert not np.any(combined.bearing.diameter_deviation)


class TestSettling:
    time = np.linspace(0.0, 10.0, 10001)
    flat = np.full(10001, 0.5)

    def judged(self, radius: Any, spacing: Any = None, turns: float = 200.0) -> Verdict:
        noise = 0.02 * np.sin(2 * np.pi * turns / 10.0 * self.time)
        return judge(self.time, radius + noise, self.flat if spacing is None else spacing, turns)

    def test_settled(self) -> None:
        assert self.judged(self.flat).settled
        verdict = self.judged(0.9 - 0.5 * np.exp(-self.time / 0.5))
        assert verdict.settled
        assert 0.5 < verdict.since <= 5.0

    @pytest.mark.parametrize("rate", [0.2, 0.5])
    def test_growth_has_not_settled(self, rate: float) -> None:
        assert not self.judged(0.3 * np.exp(rate * (self.time - 5.0) / 2)).settled
        assert not self.judged(0.4 + 0.01 * self.time).settled

    def test_drifting_spacing_has_not_settled(self) -> None:
        assert not self.judged(self.flat, 0.9 - 0.04 * self.time).settled

    def test_few_turns_are_not_enough(self) -> None:
        verdict = self.judged(self.flat, turns=9.0)
        assert not verdict.settled
        assert "turns" in verdict.reason


def path_of_cage(direction: float, *, gravity: bool = True, sense: float = 1.0) -> Any:
    """Way of the cage's centre under combined load in the first 20 ms from equal spacing, x + i y (m)."""
    scene = Point(Condition(2000.0, 4930.0, 5530.0, direction), "equal").scene()
    scene = scene.replace({"effects.gravity": gravity, "speed_rpm": sense * scene.speed_rpm})
    options = {"duration": 0.02, "save_every": 1e-3, "save_groups": ("cage",)}
    position = trb.Simulation(scene, accuracy="reference").run(**options)["cage_position"]
    return position[:, 0] + 1j * position[:, 1]


def test_the_direction_of_the_load_matters_by_gravity_and_the_sense_of_rotation_alone() -> None:
    """Without gravity the scene has no direction but the load's. With it, the mirror image of a load where rollers descend is one
    where they rise, with the ring turning the other way.
    """
    assert not np.any(path_of_cage(90.0, gravity=False))
    assert not np.any(path_of_cage(180.0, gravity=False))
    descending, rising = path_of_cage(180.0), path_of_cage(0.0)
    mirrored = -np.conj(path_of_cage(0.0, sense=-1.0))
    assert np.abs(mirrored - descending).max() < 5e-7
    assert np.abs(rising - descending).max() > 5e-5


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, PointTask]:
    path = tmp_path_factory.mktemp("point") / "a.h5"
    task = PointTask(POINT, PLAN, str(path))
    report = run_point(task, lambda: False)
    assert (report.status, report.file) == ("done", "a.h5")
    return path, task


def contents(path: Path) -> dict[str, np.ndarray]:
    """Every number of a point's file."""
    out: dict[str, np.ndarray] = {}
    with h5py.File(path) as file:
        names = [name for name, entry in file.items() if isinstance(entry, h5py.Dataset)]
        names += [*(f"history/{name}" for name in file["history"]), "run/final_state"]
        out |= {name: file[name][()] for name in names if file[name].dtype.kind in "fi"}
    return out


def assert_same(one: Path, other: Path) -> None:
    first, second = contents(one), contents(other)
    assert first.keys() == second.keys()
    for name, values in first.items():
        assert np.array_equal(values, second[name], equal_nan=True), name


class TestRun:
    def test_a_point_is_a_result_file(self, done: tuple[Path, PointTask]) -> None:
        path, task = done
        result = trb.load(path)
        assert result.success
        assert result.scene == POINT.scene()
        assert result.duration == pytest.approx(0.02)
        assert np.diff(result.time) == pytest.approx(2e-4)
        assert result.summary()["axis_distance_over_cpr"] > 0.5
        history = files.read_history(path, task.fingerprint)
        assert history is not None
        assert history["time"][0] == 0.0
        assert np.all(np.diff(history["time"]) > 0.0)
        assert 0.03 <= history.end < 0.031
        assert result.time[0] == history.reached
        assert files.read_history(path, "other") is None

    def test_a_stopped_point_goes_on_to_the_same_numbers(self, done: tuple[Path, PointTask], tmp_path: Path) -> None:
        task = replace(done[1], path=str(tmp_path / "a.h5"))
        for calls in (0, 1, 2):
            seen = iter(range(calls))
            with pytest.raises(KeyboardInterrupt):
                run_point(task, lambda seen=seen: next(seen, None) is None)
            assert not Path(task.path).exists()
        run_point(task, lambda: False)
        assert [path.name for path in tmp_path.iterdir()] == ["a.h5"]
        assert_same(done[0], Path(task.path))

    def test_a_longer_plan_goes_on_from_the_file(self, done: tuple[Path, PointTask], tmp_path: Path) -> None:
        longer = replace(PLAN, least_time=0.06, most_time=0.06)
        straight, later = (PointTask(POINT, longer, str(tmp_path / name)) for name in ("b.h5", "c.h5"))
        run_point(straight, lambda: False)
        Path(later.path).write_bytes(done[0].read_bytes())
        assert is_done(done[1])
        assert is_done(replace(later, plan=PLAN))
        assert not is_done(later)
        run_point(later, lambda: False)
        assert is_done(later)
        assert_same(Path(straight.path), Path(later.path))

    def test_another_plan_or_point_starts_anew(self, done: tuple[Path, PointTask]) -> None:
        path = str(done[0])
        assert not is_done(PointTask(POINT, replace(PLAN, window=0.03), path))
        assert not is_done(PointTask(replace(POINT, start="equal"), PLAN, path))

    def test_a_failure_is_reported(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        def failing(*_: Any) -> None:
            raise trb.LoadError("no equilibrium")

        monkeypatch.setattr(settle, "_Run", failing)
        report = run_point(PointTask(POINT, PLAN, str(tmp_path / "a.h5")), lambda: False)
        assert (report.status, report.message) == ("failed", "no equilibrium")

    def test_numbers(self, done: tuple[Path, PointTask]) -> None:
        run = point_numbers.read_run(done[0])
        assert run is not None
        assert run.point == POINT
        radius = run.numbers["whirl_radius_over_cpr"]
        assert radius["p5"] <= radius["mean"] <= radius["p95"]
        assert radius["mean"] == pytest.approx(trb.load(done[0]).axis_distance_over_cpr.mean())
        assert {*PROMISED, "seeds", "start", "settled", "bearing_time"} <= set(run.numbers)
        assert run.numbers["bearing_time"] == pytest.approx(0.05, abs=1e-3)
        json.dumps(run.numbers, allow_nan=False)
        assert point_numbers.read_run(done[0].with_name("none.h5")) is None


class TestSignals:
    angle = np.linspace(0.0, 6.3 * 2 * np.pi, 4001)

    def test_orders(self) -> None:
        values = np.cos(self.angle + 0.3) + 0.5 * np.sin(3 * self.angle) + 7.0
        assert point_numbers.order_share(values, self.angle) == pytest.approx(0.8, abs=0.01)
        assert point_numbers.order_share(values, self.angle, 3) == pytest.approx(0.2, abs=0.01)
        assert point_numbers.peak_order(values, self.angle) == 1
        assert math.isnan(point_numbers.order_share(values[:100], self.angle[:100]))

    def test_standard_error(self) -> None:
        rng = np.random.default_rng(0)
        values = np.repeat(rng.normal(size=50), 80)
        angle = np.linspace(0.0, 50 * 2 * np.pi + 1e-6, values.size)
        assert point_numbers.standard_error(values, angle) == pytest.approx(1 / math.sqrt(50), rel=0.25)
        assert math.isnan(point_numbers.standard_error(values, angle / 40))


@pytest.fixture(scope="module")
def pockets() -> Pockets:
    return Pockets(trb.cases.paper_30310())


class TestMovableDistance:
    def test_gap_of_the_centred_cage(self, pockets: Pockets) -> None:
        assert pockets.interference(0.0, 0.0, 0.0, 0.0) == pytest.approx(-0.1074e-3, abs=1e-7)

    def test_equal_spacing_and_free_rollers(self, pockets: Pockets) -> None:
        directions = np.radians(np.linspace(0.0, 30.0, 13))
        equal, free = pockets.held(0.0, directions).distance, pockets.free(directions).distance
        assert 0.1082e-3 - 2e-7 <= equal.min() <= equal.max() <= 0.1101e-3 + 2e-7
        assert 0.2495e-3 <= free.min() <= free.max() <= 0.259e-3


def made_up(values: dict[tuple[Condition, str], dict[str, Any]]) -> Runs:
    """Runs with numbers only."""
    bearing = trb.cases.rig_30310()
    result = SimpleNamespace(
        scene=SimpleNamespace(bearing=bearing), clearances=SimpleNamespace(radial=0.25e-3, circumferential=0.12e-3)
    )
    runs = []
    for (condition, start), table in values.items():
        point = Point(condition, start)  # type: ignore[arg-type]
        runs.append(Run(point, result, None, {"settled": table.pop("settled", True)}, table))  # type: ignore[arg-type]
    return Runs(runs)


def orbit(mean: float, error: float = 0.01, **more: Any) -> dict[str, Any]:
    """Numbers of a cage that circles the axis."""
    table = {"whirl_ratio": 1.0, "cage_motion": "circling", "whirl_radius_over_cpr": {"mean": mean, "p95": mean}}
    return table | {"orbit_over_cpr": mean, "orbit_standard_error": error} | more


def judged(key: str, runs: Runs) -> Judged:
    return judge_statement(runs, next(statement for statement in STATEMENTS if statement.key == key))


class TestStatements:
    def verdict(self, key: str, runs: Runs) -> tuple[str, dict[str, Any]]:
        found = judged(key, runs)
        return found.verdict, found.findings

    @pytest.mark.parametrize(
        ("radii", "error", "verdict"),
        [
            ((0.3, 0.6, 0.9), 0.01, "agrees"),
            ((0.3, 0.6, 0.9), 0.2, "disagrees"),
            ((0.9, 0.6, 0.9), 0.01, "disagrees"),
            ((0.3, 0.92, 0.91), 0.01, "agrees"),
            ((0.3, 0.97, 0.89), 0.01, "disagrees"),
            ((0.3, 0.6, 0.6), 0.01, "disagrees"),
            ((0.3, 0.6, 0.9), math.nan, "open"),
        ],
    )
    def test_growth_must_stand_out_of_the_noise(self, radii: Any, error: float, verdict: str) -> None:
        given = {(c, "whirl"): orbit(r, error) for c, r in zip(FIGURES["12b"], radii, strict=True)}
        assert self.verdict("8b-load", made_up(given))[0] == verdict

    def test_starts_that_differ(self) -> None:
        condition = FIGURES["12b"][-1]
        runs = made_up({(condition, "whirl"): orbit(0.98), (condition, "equal"): orbit(0.3)})
        assert self.verdict("8b-one", runs)[0] == "depends on the start"
        assert self.verdict("8b-one", made_up({(condition, "equal"): orbit(0.3)}))[0] == "disagrees"

    def test_frequency(self) -> None:
        def runs(ratio: float, kind: str) -> Runs:
            table = {"whirl_ratio": ratio, "cage_motion": kind}
            return made_up({(c, "whirl"): dict(table) for c in FIGURES["12a"]})

        assert self.verdict("8a-measured", runs(1.01, "circling"))[0] == "agrees"
        assert self.verdict("8a-measured", runs(1.2, "circling"))[0] == "disagrees"
        assert self.verdict("8a-measured", runs(1.0, "stable"))[0] == "disagrees"

    def test_frequency_of_a_cage_that_hangs_to_one_side(self) -> None:
        def verdict(ratio: float, amplitude: float) -> str:
            table = orbit(0.3) | {"cage_motion": "rocking", "whirl_ratio": ratio, "whirl_amplitude_over_cpr": amplitude}
            return judged("8a-measured", made_up({(c, "equal"): dict(table) for c in FIGURES["12a"]})).verdict

        assert verdict(1.0, 0.28) == "agrees"
        assert verdict(1.0, 0.15) == "disagrees"
        assert verdict(1.2, 0.28) == "disagrees"

    def test_what_is_in_a_file_is_judged_as_the_runs_were(self, tmp_path: Path) -> None:
        """Points that are added to a file take their place beside the others; the same point again changes nothing."""
        from paper import keep

        file = tmp_path / "paper.json"
        kept = json.loads((Path(keep.__file__).with_name("paper.json")).read_text(encoding="utf-8"))
        file.write_text(json.dumps(kept), encoding="utf-8")
        keep.keep(file, keep.runs_of(kept["points"]))
        again = json.loads(file.read_text(encoding="utf-8"))
        assert again == kept
        first = next(iter(kept["points"]))
        other = keep.runs_of({first: kept["points"][first] | {"orbit_over_cpr": 9.0}})
        assert keep.keep(file, other).startswith("| Fig. |")
        changed = json.loads(file.read_text(encoding="utf-8"))["points"]
        assert [name for name, numbers in changed.items() if numbers != kept["points"][name]] == [first]

    def test_most_conditions_are_more_than_half(self) -> None:
        conditions = list(dict.fromkeys((*FIGURES["12a"], *FIGURES["12b"])))

        def runs(circling: int) -> Runs:
            kinds = ["circling"] * circling + ["stable"] * (len(conditions) - circling)
            tables = [{"whirl_ratio": 1.0, "cage_motion": kind} for kind in kinds]
            return made_up(dict(zip([(c, "equal") for c in conditions], tables, strict=True)))

        assert self.verdict("12-simulated", runs(3))[0] == "agrees"
        assert self.verdict("12-simulated", runs(2))[0] == "disagrees"

    def test_statements_are_judged_for_each_of_the_inputs_left_open(self) -> None:
        """Reach under combined load by direction: those of one are not mixed with those of another."""
        combined = tuple(dict.fromkeys((*FIGURES["16a"], *FIGURES["16b"])))
        other, scattered = Inputs(180.0), Inputs(180.0, 0.2e-6)
        given = {(c, "equal"): orbit(0.9) for c in combined}
        given |= {(c.within(other), "equal"): orbit(0.47) for c in combined}
        given |= {(c.within(scattered), "equal"): orbit(0.1) for c in combined}
        runs = made_up(given)
        assert set(runs.inputs) == {Inputs(), other, scattered}
        sets = {inputs: [judged("16-size", runs.within(inputs))] for inputs in runs.inputs}
        found = [sets[inputs][0].verdict for inputs in (Inputs(), other, scattered)]
        assert found == ["disagrees", "agrees", "disagrees"]
        table = by_inputs(sets)
        size = next(line for line in table.splitlines() if "about Cpc/Cpr" in line)
        assert size == "| 11 / 16 | It is about Cpc/Cpr there. | **no** | yes | **no** |"
        assert "| agree, of those judged |" in table

    def test_scatter_of_figure_15_beside_every_scatter_but_its_own(self) -> None:
        even, scattered = FIGURES["15"]
        fine = even.within(Inputs(scatter=0.2e-6))
        given = {(even, "equal"): orbit(0.03), (fine, "equal"): orbit(0.05), (scattered, "equal"): orbit(0.18)}
        verdicts = [judged("15-scatter", made_up(given).within(Inputs(scatter=s))) for s in (0.0, 0.2e-6, 1e-6)]
        assert [entry.verdict for entry in verdicts] == ["agrees", "agrees", "open"]

    def test_equalising(self) -> None:
        condition = FIGURES["18"][0]

        def runs(start: str, before: float, after: float) -> Runs:
            return made_up({(condition, start): {"spacing_std_start_deg": before, "spacing_std_deg": after}})

        assert self.verdict("18-equalises", runs("unequal", 0.12, 0.03))[0] == "agrees"
        assert self.verdict("18-equalises", runs("unequal", 0.12, 0.10))[0] == "disagrees"
        assert self.verdict("18-equalises", runs("equal", 0.0, 0.02))[0] == "open"

    def test_what_was_not_run_is_open(self) -> None:
        entries = judge_all(Runs([]))
        assert {entry.verdict for entry in entries} == {"open"}
        assert len(entries) == len(STATEMENTS)
        table = markdown(entries)
        assert table.count("not run") == len(STATEMENTS)
        assert all(entry.statement.text in table for entry in entries)

    def test_what_had_not_settled_is_marked(self) -> None:
        condition = FIGURES["12b"][-1]
        entry = judged("8b-one", made_up({(condition, "whirl"): orbit(0.98, settled=False)}))
        assert entry.to_dict()["unsettled"] == ["3000rpm_4930N_whirl"]
        assert "| **agrees**\\* | whirl\\* |" in markdown([entry])


class TestCommand:
    @pytest.mark.slow
    def test_quick(self, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
        words = ["-o", str(tmp_path), "--smoke", "--starts", "whirl", "unequal", "--quiet"]
        words += ["--points", "3000rpm_4930N", "3000rpm_1230N*", "--seeds", "0", "1"]
        assert main(words) == 0
        values = json.loads((tmp_path / "paper.json").read_text())
        assert set(values["points"]) == {
            *("3000rpm_4930N_whirl", "3000rpm_4930N_unequal0", "3000rpm_4930N_unequal1"),
            *("3000rpm_1230N_whirl", "3000rpm_1230N_unequal0", "3000rpm_1230N_unequal1"),
            *(f"3000rpm_1230N_scatter_{start}{seed}" for start in ("whirl", "unequal") for seed in (0, 1)),
        }
        point = values["points"]["3000rpm_4930N_unequal1"]
        assert {*PROMISED, "whirl_radius_over_cpr"} <= set(point)
        assert set(point["whirl_radius_over_cpr"]) == {"mean", "p5", "p95"}
        assert (point["seeds"], point["start"], point["settled"]) == ([1], "unequal", False)
        assert values["movable_over_cpr"]["equal"]["max"] < values["movable_over_cpr"]["free"]["min"]
        assert (tmp_path / "statements.md").read_text().startswith("| Fig. |")
        assert {path.stem for path in (tmp_path / "figures").iterdir()} >= {
            *("fig_08a_12a", "fig_08b_12b", "fig_09", "fig_10", "fig_11a_16a", "fig_11b_16b", "fig_13", "fig_14"),
            *("fig_15", "fig_17", "fig_18"),
        }
        ran: list[str] = []
        monkeypatch.setattr("paper.command.run_point", lambda task, _: ran.append(task.point.name))
        assert main(words) == 2
        assert "--resume" in capsys.readouterr().err
        assert main([*words, "--resume"]) == 0
        assert ran == []
        assert main([*words, "--report"]) == 0

    def test_a_point_that_fails(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        def failing(task: PointTask, stopped: Any) -> Any:
            raise trb.StepError("roller 3 went astray", time=0.1)

        monkeypatch.setattr(command, "run_point", failing)
        failures = command.run_points([POINT], tmp_path, PLAN, executor="serial")
        assert failures == {"3000rpm_4930N_whirl": "roller 3 went astray"}

    def test_words_that_cannot_be_used(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["-o", str(tmp_path), "--points", "nothing"]) == 2
        assert "fits no point" in capsys.readouterr().err
