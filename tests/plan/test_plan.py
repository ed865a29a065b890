"""Plans of whole scenes: what they promise holds, what is refused, what the command writes."""

from __future__ import annotations

import html
import math
import warnings
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import observables
from trbdyn.cli import main
from trbdyn.extras.design.planning import ground
from trbdyn.extras.design.planning.averaged import Records, check_names, joined, least_size, size_of
from trbdyn.extras.design.planning.candidates import SWITCHES, Candidate, candidates
from trbdyn.extras.design.planning.deciding import USUAL, decide, unseen_of
from trbdyn.extras.design.planning.looking import Looker, Seen, Tried, thrown
from trbdyn.extras.design.planning.probes import (
    TOO_LONG,
    Influence,
    Length,
    Probe,
    carried_over,
    in_batches,
    influence,
    run_quietly,
)
from trbdyn.extras.design.planning.proposal import Plan, words
from trbdyn.extras.design.planning.wishes import changed, checked, with_effects
from trbdyn.model.cases import paper_30310
from trbdyn.model.motion import History
from trbdyn.results.numbers import all_averages

WANT = {"torque": 0.05}


def rolling(**changes: object) -> trb.Scene:
    return paper_30310(3000.0, 4930.0, effects=trb.Effects().replace(**changes), start=trb.Start.equal())


@pytest.fixture(scope="module")
def proposal() -> Plan:
    return trb.plan(rolling(), WANT, effort=5.0)


class TestInfluence:
    """On made-up batches."""

    def of(self, other: list[float], base: list[float]) -> Influence:
        probes = [Probe({"torque": np.array(values)}, 1.0) for values in (other, base)]
        return influence(probes[0], probes[1], {"torque": -2.0}, "torque")

    def test_by_hand(self) -> None:
        base = [2.0, 2.1, 1.9, 2.2, 2.0] * 4
        found = self.of([2.1, 2.24, 2.0, 2.34, 2.12] * 4, base)  # differences .1 .14 .1 .14 .12, over 2
        assert found.change == pytest.approx(0.06)
        assert found.half_width == pytest.approx(observables.half_width([0.05, 0.07, 0.05, 0.07, 0.06] * 4))
        assert found.bound == pytest.approx(found.change + found.half_width)

    def test_a_difference_that_grows_has_no_bound(self) -> None:
        """Where it ends is not known: what makes it is not left out."""
        assert math.isinf(self.of([2.0 + 0.01 * k for k in range(20)], [2.0] * 20).bound)

    def test_what_could_not_be_run_has_no_bound(self) -> None:
        lost = Probe({}, math.nan, "the rollers fell out")
        found = influence(lost, Probe({"torque": np.ones(5)}, 1.0), {"torque": 1.0}, "torque")
        assert math.isinf(found.bound)
        assert words(found) == "-"

    def test_words(self) -> None:
        assert words(Influence(-0.9876, 0.0033)) == "-99 ± 0.33 %"
        assert words(Influence(0.0012, 0.2)) == "+0.12 ± 20 %"


class TestCandidates:
    def test_every_switch_is_an_effect_that_may_be_left_out(self) -> None:
        scene = rolling(oil_fill=0.1, pocket_film=1e-5)
        kinds = {one.name: one.kind for one in candidates(scene, wants_cage=False)}
        ours = {switch.name for switch in SWITCHES} - {"land that guides the cage"}
        assert {name for name, kind in kinds.items() if kind == "effect"} == ours
        least = scene.replace(effects=trb.Effects.minimal())
        on = {one.name for one in candidates(least, wants_cage=False) if one.kind == "effect"}
        assert not on & {"tilt and axial motion", "front rib", "pocket ends", "damping of contacts"}
        assert "cage" in on

    def test_averages_of_the_cage_need_it(self) -> None:
        assert "cage" not in {one.name for one in candidates(rolling(), wants_cage=True)}

    def test_each_changes_the_scene(self) -> None:
        scene = rolling(oil_fill=0.1)
        for one in candidates(scene, wants_cage=False):
            if one.kind != "tolerances":
                assert scene.effects.replace(**one.effects) != scene.effects, one.name

    def test_a_state_is_carried_over_to_other_switches(self) -> None:
        """Also where the state vector has another length: drag has a loss of its own."""
        with_drag, without = rolling(oil_fill=0.1), rolling()
        simulation = trb.Simulation(with_drag)
        simulation.run(duration=1e-3)
        state = simulation.state
        start = trb.Start.state(state.vector, time=state.time, shaft_angle=state.shaft_angle)
        other = trb.Simulation(carried_over(without, start, with_drag))
        assert other.state.vector.size < state.vector.size
        assert other.time == state.time
        for name in ("roller_r", "roller_z", "cage_x"):
            np.testing.assert_array_equal(other.view()[name], simulation.view()[name])


@pytest.mark.slow
def test_what_is_promised_is_within_the_wish(proposal: Plan) -> None:
    assert proposal.reached
    assert 0.0 < proposal.promised["torque"] <= 0.05
    parts = proposal.parts["torque"]
    assert sum(parts.values()) == pytest.approx(proposal.promised["torque"])
    assert proposal.settle < proposal.duration
    assert proposal.computing_s < proposal.computing_s_everything


def test_the_promise_holds(proposal: Plan) -> None:
    """Against a longer run with everything on."""
    found = proposal.averages(proposal.run())["torque"]
    truth = rolling(quadrature="gauss", n_slices=32)
    result = trb.Simulation(truth, accuracy="reference").run(duration=0.12, save_every=5e-4)
    window = result.window(0.06)
    true = float(window["inner_torque"].mean())
    own = observables.half_width(in_batches(Records({"": window}), ["torque"], 0.0)["torque"]) / true
    assert abs(found / true - 1.0) <= proposal.promised["torque"] + own
    assert abs(proposal.value["torque"] / true - 1.0) < 0.02


@pytest.mark.slow
def test_the_promise_holds_where_the_simplified_model_would_go_elsewhere_from_the_start() -> None:
    """The cage begins in the middle, which is not stable: gravity alone moves it away. Without gravity it stays there."""
    scene = rolling(guidance="outer_land", oil_fill=0.2).replace(speed_rpm=6000.0)
    want = {"torque": 0.02, "orbit_rms_over_cpr": 0.2}
    found = trb.plan(scene, want, effort=8.0)
    assert found.reached
    values = found.averages(found.run())
    result = trb.Simulation(scene).run(duration=5.0, save_every=5e-4)
    window = all_averages(result.window(4.5))
    for name, promised in found.promised.items():
        assert abs(values[name] / window[name] - 1.0) <= promised + 0.002, name
    simplified = found.scene.replace(effects=found.scene.effects.replace(gravity=False, planar=True), start=scene.start)
    still = all_averages(trb.Simulation(simplified).run(duration=0.5, save_every=5e-4))
    assert still["orbit_rms_over_cpr"] < 1e-3 < 0.1 < window["orbit_rms_over_cpr"]


def test_effects_that_matter_are_kept(proposal: Plan) -> None:
    rows = {row.name: row for row in proposal.rows}
    for name in ("rolling resistance", "thermal reduction of films"):
        assert not rows[name].chosen
        assert "it matters for torque" in rows[name].decision
        assert abs(rows[name].influence["torque"].change) > 0.05
    assert proposal.scene.effects.rolling_resistance
    for row in proposal.rows:
        assert row.decision
        if row.kind == "effect":
            assert row.chosen == (row.name in proposal.left_out)


def test_it_is_ready_to_run(proposal: Plan) -> None:
    assert proposal.options.duration == proposal.duration
    simulation = trb.Simulation(proposal.scene, **proposal.options.of_simulation())
    assert simulation.options.accuracy == proposal.accuracy


def test_its_words(proposal: Plan) -> None:
    text = str(proposal)
    assert "wanted within" in text
    assert f"{proposal.value['torque']:.4g}" in text
    assert "5 %" in text
    for part in proposal.parts["torque"]:
        assert part in text
    for row in proposal.rows:
        assert row.decision in text
    assert "the rollers creep within" in text
    assert repr(proposal) == text
    page = html.unescape(proposal._repr_html_())
    assert "wanted within" in page
    for row in proposal.rows:
        assert row.decision in page


def test_its_picture_shows_every_row_that_could_be_run(proposal: Plan, tmp_path: Path) -> None:
    figure = proposal.picture(tmp_path / "plan.png")
    left, right = figure.axes
    rows = [row for row in proposal.rows if math.isfinite(row.time_ratio)]
    assert [bar.get_width() for bar in right.patches] == pytest.approx([row.time_ratio for row in rows][::-1])
    assert len(left.get_yticklabels()) == len(rows)
    names = [label.get_text() for label in left.get_yticklabels()][::-1]
    assert all(row.name in name for row, name in zip(rows, names, strict=True))
    assert [("✓" in name) for name in names] == [row.chosen for row in rows]
    assert (tmp_path / "plan.png").stat().st_size > 10_000


def test_a_budget_is_kept() -> None:
    found = trb.plan(rolling(), WANT, budget=0.1, effort=1.0)
    assert found.computing_s <= 0.11 or not found.reached
    assert found.budget == 0.1


@pytest.mark.parametrize(
    ("want", "changes", "said"),
    [
        ({}, {}, "must name an average"),
        ({"torqe": 0.1}, {}, "did you mean torque"),
        ({"torque": 1.5}, {}, "want.torque = 1.5"),
        ({"torque": math.nan}, {}, "want.torque = nan"),
        ({"torque": True}, {}, "must be a number"),
        ({"torque": "0.1"}, {}, "must be a number"),
        ({"torque": 0.1}, {"budget": True}, "budget = True"),
        ({"torque": 0.1}, {"budget": 0.0}, "budget = 0.0"),
        ({"torque": 0.1}, {"effort": math.inf}, "effort = inf"),
    ],
)
def test_what_cannot_be_wanted(want: dict[str, float], changes: dict[str, float], said: str) -> None:
    with pytest.raises(trb.InputError, match=said):
        trb.plan(rolling(), want, **changes)


@pytest.mark.parametrize(("inner", "outer"), [(0.0, 3000.0), pytest.param(-500.0, 2500.0, marks=pytest.mark.slow)])
def test_an_outer_ring_that_turns_is_planned(inner: float, outer: float, proposal: Plan) -> None:
    """In a wheel hub the shaft rests: turns are those of the outer ring."""
    found = trb.plan(rolling().replace(speed_rpm=inner, outer_speed_rpm=outer), WANT, effort=1.0)
    assert found.scene.outer_speed_rpm == outer
    assert abs(found.value["torque"]) == pytest.approx(abs(proposal.value["torque"]), rel=0.1)


def test_scenes_that_cannot_be_planned() -> None:
    with pytest.raises(trb.InputError, match="speed_rpm"):
        trb.plan(rolling().replace(speed_rpm=0.0), WANT)
    body = trb.RingBody.hollow_cylinder(mass=2.0, outer_diameter=0.06, length=0.09)
    with pytest.raises(trb.InputError, match="torque = 9"):
        trb.plan(rolling().replace(ring="free", ring_body=body, torque=9.0), WANT)
    ramp = History.ramp(0.0, 1.0, 100.0, 200.0)
    with pytest.raises(trb.InputError, match="must be constant"):
        trb.plan(rolling().replace(speed_rpm=ramp), WANT)
    with pytest.raises(trb.InputError, match="needs a cage"):
        trb.plan(rolling(bodies="rollers"), {"pocket_duty": 0.1})


@pytest.mark.slow
def test_the_command_writes_a_case_and_a_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = str(tmp_path / "mine")
    call = ["plan", "rig_30310", "--want", "torque=0.05", "--effort", "2", "-o", name]
    assert main(call) == 0
    said = capsys.readouterr().out
    assert "promised within" in said
    scene, options = trb.load_case(tmp_path / "mine.toml")
    assert options.duration is not None
    assert scene.speed_rpm == 3000.0
    assert (tmp_path / "mine.png").exists()
    assert main(call) == 2
    assert "mine.toml" in capsys.readouterr().err


@pytest.mark.parametrize("words_", ["torque", "torque=", "torque=a", "torque=nan", "=0.1", "torqe=0.1", "torque=2"])
def test_bad_wishes_end_with_one_line(words_: str, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["plan", "rig_30310", "--want", words_, "-o", str(tmp_path / "x")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "Traceback" not in said


def test_a_proposed_scene_that_starts_from_a_state_can_be_simulated() -> None:
    """The state belongs to the scene with everything on; without drag there is a loss less in it, without a cage no whirl."""
    scene = rolling(oil_fill=0.1)
    simulation = trb.Simulation(scene)
    simulation.run(duration=1e-3)
    state = simulation.state
    begun = scene.replace(start=trb.Start.state(state.vector, time=state.time, shaft_angle=state.shaft_angle))
    for effects in ({"oil_fill": 0.0}, {"bodies": "rollers"}, {"planar": True, "oil_fill": 0.0}):
        other = trb.Simulation(changed(begun, effects, begun.start))
        assert other.time == state.time
        np.testing.assert_array_equal(other.view()["roller_r"], simulation.view()["roller_r"])
        other.run(duration=1e-4)
    whirling = scene.replace(start=trb.Start.whirl(0.9))
    assert with_effects(whirling, {"bodies": "rollers"}).part.start.kind == "equal"


def test_a_probe_that_takes_too_long_is_told_from_one_that_failed() -> None:
    hurried = Length(1.0, 1e-3, ("cage", "rollers", "torque"), patience=1e-3)
    ran = run_quietly(rolling(), "standard", hurried)
    assert ran.failure == TOO_LONG
    assert ran.records is not None
    assert 0.0 < ran.rate < 1e3
    assert 0.0 < ran.records.time[-1] < 1.0


def test_an_average_is_wanted_once_and_the_folder_is_there(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """Both are told before any probe is run."""
    twice = ["plan", "rig_30310", "--want", "torque=0.02", "--want", "torque=0.5", "-o", str(tmp_path / "x")]
    assert main(twice) == 2
    assert "was given before" in capsys.readouterr().err
    assert main(["plan", "rig_30310", "--want", "torque=0.02", "-o", str(tmp_path / "no" / "x")]) == 2
    said = capsys.readouterr().err
    assert "there is no" in said
    assert said.count("\n") == 1


def test_a_choice_whose_run_gives_no_averages_is_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    """The most exact choice is left, which is the probe that errors are counted from; no number is nan."""
    real = Looker.probe

    def probe(self: Looker, effects: Any, accuracy: str, cost: float = 1.0) -> Probe:
        lost = "n_slices" in effects and accuracy != "reference"
        return Probe({}, math.nan, "the rollers fell out") if lost else real(self, effects, accuracy, cost)

    monkeypatch.setattr(Looker, "probe", probe)
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        found = trb.plan(rolling(), {"torque": 0.1}, effort=1.5)
        assert "nan" not in str(found)
    assert (found.left_out, found.accuracy, found.scene.part.effects.n_slices) == ((), "reference", 32)
    assert math.isfinite(found.promised["torque"])
    assert found.computing_s > 0.0


@pytest.mark.parametrize(("of_the_whole", "kept"), [(0.02, True), (0.2, False)])
def test_where_simplifications_act_together_none_is_made(of_the_whole: float, kept: bool) -> None:
    """Without gravity the torque is off by 1 %, and the whole choice by more: it is taken where this is within the wish."""
    base, truth = Probe({"torque": np.ones(20)}, 1.0), Probe({"torque": np.ones(20)}, 4.0)
    whole = Probe({"torque": np.full(20, 1.0 + of_the_whole)}, 0.5)
    gravity = Candidate("gravity", "effect", {"gravity": False})
    nothing, one = {"torque": Influence(0.0, 0.0)}, {"torque": Influence(0.01, 0.0)}
    wishes = checked(rolling(), {"torque": 0.1}, None, 5.0)
    zeros = np.zeros(1)
    made: Any = SimpleNamespace(drift=zeros, scatter=np.array([0.01]), window=1.0)
    seen = Seen(made, base, truth, [Tried(gravity, base, one, 0.5)], nothing, 0.03)
    looker: Any = SimpleNamespace(
        settle=0.1,
        probe=lambda *_: whole,
        influences=lambda other, base: {"torque": influence(other, base, {"torque": 1.0}, "torque")},
    )
    found = decide(wishes, seen, looker)
    assert found.made == ((gravity,) if kept else ())
    assert found.rejected == (frozenset() if kept else {"gravity", USUAL})
    assert found.choice.within
    assert found.choice.bounds[0] == pytest.approx(0.001 + 1.5 * of_the_whole if kept else 0.001)


def test_time_that_is_spent_ends_the_probes(monkeypatch: pytest.MonkeyPatch) -> None:
    looker = Looker(checked(rolling(), WANT, None, 5.0))
    looker.began -= 8.0
    assert "allow more effort" in looker._alone(candidates(rolling(), wants_cage=False)[0]).failure


def test_a_probe_without_an_average_is_no_base() -> None:
    looker = Looker(checked(rolling(), WANT, None, 5.0))
    short = Probe({"torque": np.array([1.0, math.nan])}, 1.0)
    with pytest.raises(trb.InputError, match="too short for averages"):
        looker._usable("usual", short)


class TestPromise:
    """What a promise has room for, and what it is a share of."""

    def test_sizes(self) -> None:
        assert size_of("torque", -1.5) == 1.5
        assert size_of("orbit_rms_over_cpr", 0.3) == 0.3
        assert size_of("orbit_rms_over_cpr", 1e-5) == 0.01
        assert least_size("power_loss") == 0.0
        assert least_size("left_skew_rms") == 1e-5

    def test_room_for_what_probes_do_not_see(self) -> None:
        """With drag, torque was 0.27 % off where the probes showed 0.23 %, the film 0.14 % where they showed 0.06 %."""
        seen = np.array([0.0023, 0.0006])
        assert np.all(seen + unseen_of(seen) >= [0.0027, 0.0014])

    def test_a_cage_that_hardly_moves_has_an_absolute_bound(self) -> None:
        """A share of an orbit of nearly nothing is no promise."""
        scene = rolling(guidance="outer_land", gravity=False).replace(speed_rpm=500.0)
        length = Length(0.2, 1e-3, ("cage", "rollers"), 1.0)
        found = ground.run_ground(scene, {"orbit_rms_over_cpr": 0.1}, 0.02, length, 60.0)
        assert found.value["orbit_rms_over_cpr"] < 0.01
        assert found.size["orbit_rms_over_cpr"] == 0.01
        assert max(found.scatter[0], found.drift[0]) < 1.0

    def test_an_orbit_that_grows_may_become_as_large_as_the_play(self) -> None:
        """Without gravity an orbit of 1e-4 grows within seconds: its mean may still change by all of the play, not by more."""
        scene = rolling(guidance="outer_land", gravity=False)
        length = Length(0.2, 1e-3, ("cage", "rollers"), 60.0)
        turn = 15.0 / ground.MOST_TURNS  # so that the run is 15 s long on any machine
        found = ground.run_ground(scene, {"orbit_rms_over_cpr": 0.1}, turn, length, 60.0)
        assert any("grows" in note for note in found.notes)
        assert 0.5 < found.drift[0] * found.size["orbit_rms_over_cpr"] < 1.5

    def test_a_bound_that_is_absolute_says_so(self, proposal: Plan) -> None:
        assert "means nothing" not in str(proposal)
        assert "% of 5, as a smaller torque means nothing" in str(replace(proposal, size={"torque": 5.0}))
        assert proposal.parts["torque"]["not seen by a probe"] >= 0.001

    def test_another_start_fits_between_the_lands(self) -> None:
        """With a clearance of its own, a start thrown to 0.9 of Cpr was refused, and the plan with it."""
        scene = rolling(guidance="outer_land")
        looker = Looker(checked(scene, WANT, None, 5.0))
        assert trb.Simulation(scene.replace(start=thrown(looker.usual.part))).scene.start.kind == "whirl"


def test_averages_of_several_bearings_have_their_names() -> None:
    pair = trb.load_assembly("pair_30310")
    found = joined({"left_": {"torque": 1.0, "cage_slip": 0.1}, "right_": {"torque": 2.0, "cage_slip": None}})
    assert found == {
        "left_torque": 1.0,
        "left_cage_slip": 0.1,
        "right_torque": 2.0,
        "right_cage_slip": None,
        "torque": 3.0,
    }
    assert joined({"": {"torque": 1.0}}) == {"torque": 1.0}
    check_names(pair, ["torque", "power_loss", "left_torque_outer", "right_cage_slip"])
    for name, said in (
        ("cage_slip", "begin with the name of a bearing"),
        ("middle_torque", "left_"),
        ("left_torqe", "must name"),
    ):
        with pytest.raises(trb.InputError, match=said):
            check_names(pair, [name])
    with pytest.raises(trb.InputError, match="there is one bearing"):
        check_names(rolling(), ["left_torque"])


def test_a_state_of_a_pair_is_carried_over_to_other_switches() -> None:
    pair = with_effects(trb.load_assembly("pair_30310"), {"oil_fill": 0.1})
    simulation = trb.Simulation(pair)
    simulation.run(duration=2e-4)
    start = trb.Start.state(simulation.state).replace(displacement=None, housing_load=None)
    other = trb.Simulation(changed(pair, {"oil_fill": 0.0, "gravity": False}, start))
    assert other.time == simulation.time
    for name, view in simulation.view().items():
        for part in ("roller_r", "roller_z", "cage_x"):
            np.testing.assert_array_equal(other.view()[name][part], view[part])


@pytest.mark.parametrize("kind", ["steady", "creeping"])
def test_what_still_changes_goes_on_for_its_time_scale(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A torque that climbs to 1 with a time scale of twice the run: at the end of the run 0.61 of the change is still to come."""
    time = np.linspace(0.0, 1.0, 2001)
    left = np.exp(-time / 2.0) if kind == "creeping" else np.zeros_like(time)
    made = Climbing(time, 1.0 - 0.1 * left + 1e-4 * np.random.default_rng(3).normal(size=time.size))
    settling = observables.MotionSettling("drifting", 0, 0.0, 2.0, "it creeps", math.nan)
    monkeypatch.setattr(ground, "in_batches", lambda part, *_: {"torque": in_parts(part.torque)})
    (drift,) = ground._drift(made, ["torque"], {"torque": 1.0}, settling)  # type: ignore[arg-type]
    if kind == "creeping":
        assert 0.06 <= drift <= 0.09
    else:
        assert drift < 1e-4


def in_parts(values: np.ndarray) -> np.ndarray:
    """Means of five parts."""
    return np.array([part.mean() for part in np.array_split(values, 5)])


class Climbing:
    """A torque in time."""

    groups = ("torque",)
    has_cage = False

    def __init__(self, time: np.ndarray, torque: np.ndarray) -> None:
        self.time, self.torque = time, torque

    def __getitem__(self, name: str) -> np.ndarray:
        return self.time

    def window(self, start: float, stop: float = math.inf) -> Climbing:
        inside = (self.time >= start) & (self.time <= stop)
        return Climbing(self.time[inside], self.torque[inside])
