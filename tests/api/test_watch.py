"""The watch over a run: what is wrong is said, in the result, on the screen and in the file, and ends the run."""

from __future__ import annotations

import math
import re
from types import SimpleNamespace
from typing import Any

import pytest

import trbdyn as trb
from trbdyn.model.cases import paper_30310
from trbdyn.run.energies import LEAST_STORED_SHARE
from trbdyn.run.options import ACCURACY
from trbdyn.run.vibrations import Seen as Vibrating
from trbdyn.run.vibrations import Vibrations
from trbdyn.run.watch import LOST_SHARE, STOP, WARN, WINDOWS, Watch

LOOSE: dict[str, Any] = {
    "rtol": 0.1,
    "atol_position": 1e-6,
    "atol_angle": 1e-4,
    "atol_velocity": 1.0,
    "atol_spin": 100.0,
    "max_order": 4,
}
"""Tolerances that bind nothing, and formulas that make energy out of lightly damped vibrations."""


@pytest.mark.usefixtures("probes")
def test_a_run_that_is_right_has_no_warnings(recwarn):
    result = trb.Simulation(paper_30310()).run(duration=0.01)
    assert result.success
    assert result.warnings == ()
    assert not [w for w in recwarn if issubclass(w.category, trb.RunWarning)]


def test_a_run_that_is_wrong_ends_and_says_so(tmp_path):
    path = tmp_path / "run.h5"
    scene = paper_30310(500.0, 4930.0, 20_000.0)
    with pytest.warns(trb.RunWarning, match="the energy does not add up"):
        result = trb.Simulation(scene, **LOOSE).run(duration=0.03, output=path)
    assert not result.success
    assert "the energy does not add up" in result.message
    assert "when_wrong='go_on'" in result.message
    assert result.warnings
    assert trb.load(path).warnings == result.warnings
    assert trb.load(path).message == result.message


@pytest.mark.slow
def test_it_can_go_on_on_purpose():
    scene = paper_30310(500.0, 4930.0, 20_000.0)
    with pytest.warns(trb.RunWarning):
        result = trb.Simulation(scene, when_wrong="go_on", **LOOSE).run(
            duration=0.012
        )  # the other run ended at 0.011 s
    assert result.success
    assert any("the energy does not add up" in text for text in result.warnings)
    assert result.warnings


class _Core:
    """A core whose energies are given: what the watch reads of it."""

    def __init__(self) -> None:
        self.time, self.steps = 0.0, 0.0
        self.row = [0.0, 0.0, 0.0, 0.0]

    def observe(self, time: float, state: object) -> list[float]:
        return list(self.row)

    def state(self) -> None:
        return None

    def statistics(self) -> dict[str, float]:
        return {"steps": self.steps, "error_failures": 0.0, "nonlinear_failures": 0.0}


NAMES = ("work_shaft", "loss_rib", "kinetic_energy", "elastic_energy")
BEARING: Any = SimpleNamespace(
    name="",
    said="",
    seat=None,
    scene=SimpleNamespace(ring_body=None, housing=None, effects=SimpleNamespace(bodies="rollers_and_cage")),
    record_layout=[(name, place, ()) for place, name in enumerate(NAMES)],
)


class _Sim:
    def __init__(self) -> None:
        self._core, self._accounts = _Core(), dict[str, Any]()
        self.options = SimpleNamespace(tolerances=SimpleNamespace(rtol=1e-6))
        self.subject = SimpleNamespace(quantities=dict)


def _window(work: float, loss: float, kinetic: float, elastic: float, **options: Any) -> tuple[str | None, list[str]]:
    sim, found = _Sim(), []
    watch = Watch(sim, BEARING, WINDOWS * 1e-3, found, **options)  # type: ignore[arg-type]
    sim._core.time, sim._core.row = 5e-4, [work, loss, kinetic, elastic]
    return watch.look(final=True), found


@pytest.mark.parametrize(
    ("work", "loss", "warned", "ended"),
    [
        (1.0, 1.0 - 0.9 * WARN, False, False),
        (1.0, 1.0 - 1.2 * WARN, True, False),
        (1.0, 1.0 + 1.2 * WARN, True, False),
        (1.0, 1.0 + 1.2 * STOP, True, True),
        (1.0, 1.0 - 1.2 * STOP, True, True),
        (1e-12, 5e-12, False, False),
        (math.nan, 1.0, True, True),
    ],
)
@pytest.mark.filterwarnings("ignore::trbdyn.errors.RunWarning")
def test_bounds(work, loss, warned, ended):
    reason, found = _window(work, loss, 0.0, 0.0)
    assert bool(found) is warned
    assert (reason is not None) is ended


QUIET = [1.0] * (WINDOWS - 2) + [0.1, 0.1]


@pytest.mark.parametrize(
    ("turned_over", "off", "said"),
    [
        (QUIET, [0.0] * (WINDOWS - 2) + [3.0 * WARN, 3.0 * WARN], ""),
        (QUIET, [0.0] * (WINDOWS - 2) + [2.0 * STOP, 0.0], "from 0.018 s to 0.019 s"),
        (QUIET, [1.2 * WARN] * WINDOWS, "from 0 s to 0.02 s"),
        (QUIET, [1.2 * WARN, -1.2 * WARN] * (WINDOWS // 2), "from 0 s to 0.02 s"),
        ([100.0] * (WINDOWS // 2) + [1.0] * (WINDOWS // 2), [0.0] * 10 + [1.5 * WARN] * 10, "from 0.01 s to 0.02 s"),
    ],
    ids=["quiet", "far off", "everywhere", "either sign", "after the transient"],
)
@pytest.mark.filterwarnings("ignore::trbdyn.errors.RunWarning")
def test_windows_are_judged_by_what_they_do_to_averages(turned_over, off, said):
    """Averages are made over the whole run or over what follows its transient. What is off in windows that turn over little
    does nothing to them; in a part of its own, or with signs that cancel, it does.
    """
    sim, found = _Sim(), []
    watch = Watch(sim, BEARING, WINDOWS * 1e-3, found, going_on=True)  # type: ignore[arg-type]
    for number, (turned, share) in enumerate(zip(turned_over, off, strict=True), start=1):
        before = sim._core.row
        # all that is put in is lost, but for the residual
        sim._core.time = number * 1e-3 * (1.0 + 1e-9)
        sim._core.row = [before[0] + turned, before[1] + turned - share * turned, 0.0, 0.0]
        watch.look()
    watch.judge_averages()
    assert [said in text for text in found] == [True] * bool(said)


@pytest.mark.parametrize(
    ("loss", "missing", "said"),
    [
        (8e-4, 3.8e-4, "took 0.00038 J"),
        (8e-4, -3.8e-4, "made 0.00038 J"),
        (8e-4, 0.9 * LOST_SHARE * 8e-4, ""),
        (1e-6, 3e-5, "took 3e-05 J"),
        (1e-6, 0.9 * LEAST_STORED_SHARE * 38.7, ""),
        (0.0, 3e-4, ""),
    ],
)
@pytest.mark.filterwarnings("ignore::trbdyn.errors.RunWarning")
def test_what_is_missing_beside_the_losses_is_said(loss, missing, said):
    """Also where it is less than a millionth of the energy that is stored, 38.7 J; the run goes on."""
    sim, found = _Sim(), []
    sim._core.row = [0.0, 0.0, 38.0, 0.7]
    watch = Watch(sim, BEARING, 1.0, found)  # type: ignore[arg-type]
    sim._core.time, sim._core.row = 1.0, [loss + missing, loss, 38.0, 0.7]
    assert watch.look(final=True) is None
    assert [said in text for text in found] == [True] * bool(said)


@pytest.mark.filterwarnings("ignore::trbdyn.errors.RunWarning")
def test_vibrations_that_die_away_end_no_run():
    """Elastic energy that is lost where nothing else takes energy: said, no more."""
    reason, found = _window(0.0, 0.0, 0.0, -1.0)
    assert found
    assert reason is None
    reason, found = _window(0.0, 0.0, 0.0, 1.0)
    assert reason is not None, "energy that nobody put in"


@pytest.mark.filterwarnings("ignore::trbdyn.errors.RunWarning")
def test_steps_that_lead_nowhere_end_a_run():
    sim, found = _Sim(), []
    watch = Watch(sim, BEARING, 1.0, found)  # type: ignore[arg-type]
    reasons = []
    for _ in range(60):
        sim._core.steps += 4000.0
        sim._core.time += 4000 * 1e-9
        reasons.append(watch.look())
    assert any("steps are" in text for text in found)
    assert reasons[0] is None
    assert reasons[-1] is not None


def loose_scene(**effects: Any) -> trb.Scene:
    """A 30310 held with 5 um of axial clearance: vibrate on their raceways."""
    return trb.Scene(
        trb.cases.rig_30310(),
        speed_rpm=3000.0,
        displacement=(0.0, 0.0, 5e-6),
        lubricant=paper_30310().lubricant,
        effects=trb.Effects.paper().replace(quadrature="gauss", n_slices=8, **effects),
    )


def hardly_loaded(seed: int = 1) -> trb.Scene:
    """Rollers that a light combined load hardly holds, in oil that drags at them: they vibrate, and damping is on."""
    return trb.Scene(
        trb.cases.bearing_32216().replace({"roller.profile": trb.Profile.logarithmic(1391.0)}),
        speed_rpm=914.0,
        axial_load=534.0,
        radial_load=1488.0,
        lubricant=trb.lubricants.vg100(48.0),
        effects=trb.Effects.standard().replace(oil_fill=0.2, damping="hunt_crossley"),
        start=trb.Start.unequal(seed),
    )


@pytest.mark.usefixtures("probes")
def test_what_the_steps_take_from_vibrations_is_seen_and_measured():
    """With 'fast' the load is too low, by tight runs by 6.5 % from 10 to 30 ms, and by half of it in all, as vibrations grow for
    10 ms: the steps take what should vibrate, and little is left to see."""
    with pytest.warns(trb.RunWarning, match="in place of damping"):
        result = trb.Simulation(hardly_loaded(), accuracy="fast").run(duration=0.03, save_every=1e-3)
    (text,) = result.warnings
    low = re.search(r"the load of a roller is (\S+) to (\S+) % too low", text)
    assert low is not None, text
    assert 1.5 < float(low[1]) < float(low[2]) < 7.0
    assert "effects.damping" not in text, "damping is on"


@pytest.mark.usefixtures("probes")
def test_vibrations_that_the_steps_follow_are_no_reason_to_warn():
    """The rollers vibrate here as well, but damping takes what feeds it, and the numbers are right. With 'reference' the steps
    take 6 % of it."""
    finer = {name: 0.4 * value for name, value in ACCURACY["reference"].model_dump().items()}
    result = trb.Simulation(hardly_loaded(), accuracy="reference", **finer).run(duration=0.015, save_every=1e-3)
    assert result.warnings == ()


@pytest.mark.usefixtures("probes")
def test_a_run_in_short_pieces_is_watched_as_one():
    sim = trb.Simulation(loose_scene())
    with pytest.warns(trb.RunWarning, match="vibrate") as said:
        warned = [bool(sim.run(duration=3e-3).warnings) for _ in range(4)]
    assert all(warned[2:])
    assert sum("vibrate" in str(one.message) for one in said) == 1, "once on the screen, in each result"


@pytest.mark.filterwarnings("ignore::trbdyn.errors.RunWarning")
def test_energy_that_is_off_by_little_in_each_piece_is_seen_over_all_of_them():
    """0.9 % of what counts is missing in each piece: 36 % in all of them."""
    sim, found = _Sim(), []
    sim._core.row = [0.0, 0.0, 0.0, 1.0]
    for piece in range(1, 41):
        watch = Watch(sim, BEARING, sim._core.time + 1e-3, found)  # type: ignore[arg-type]
        sim._core.time, sim._core.row = piece * 1e-3, [piece * 9e-6, 0.0, 0.0, 1.0]
        watch.look(final=True)
    assert any("from 0 s to" in text for text in found)


@pytest.mark.usefixtures("probes")
def test_rollers_that_bounce_without_damping_are_said():
    """Losses are 9, 11, 22 and 31 W with finer and finer tolerances: the integration decides about the vibrations."""
    with pytest.warns(trb.RunWarning, match="vibrate on their raceways"):
        result = trb.Simulation(loose_scene()).run(duration=0.012)
    assert result.success
    assert any("effects.damping" in text for text in result.warnings)


@pytest.mark.usefixtures("probes")
def test_of_a_run_that_takes_too_many_steps_a_stretch_is_repeated(monkeypatch):
    """Twice at least, though the first pair takes all the steps that there are."""
    for name, steps in {"STEPS_OF_WHOLE": 1, "STEPS_OF_STRETCH": 1500, "STEPS_IN_ALL": 2500}.items():
        monkeypatch.setattr(f"trbdyn.run.vibrations.{name}", steps)
    with pytest.warns(trb.RunWarning, match="vibrate on their raceways"):
        result = trb.Simulation(loose_scene()).run(duration=0.012)
    (text,) = (text for text in result.warnings if "vibrate" in text)
    said = re.search(r"([\d.]+) ms from (\S+) s on were repeated (\d) times", text)
    assert said is not None, text
    assert float(said[1]) < 8.0
    assert float(said[2]) > 0.0


@pytest.mark.usefixtures("probes")
def test_what_was_right_before_is_not_taken_for_right_where_no_steps_are_left(monkeypatch):
    """The first 8 ms are known to be right; then vibrations grow, and the steps of all checks are used up."""
    monkeypatch.setattr("trbdyn.run.vibrations.STEPS_OF_SIMULATION", 3000)
    sim = trb.Simulation(hardly_loaded(), accuracy="fast")
    assert [sim.run(duration=4e-3).warnings for _ in range(2)] == [(), ()]
    with pytest.warns(trb.RunWarning, match="could not be measured"):
        sim.run(duration=4e-3)


def test_the_damping_that_the_warning_names_makes_presets_agree():
    losses = []
    for accuracy in ("standard", "reference"):
        scene = loose_scene(damping="hunt_crossley", damping_race=1.0, damping_cage=1.0)
        result = trb.Simulation(scene, accuracy=accuracy).run(duration=0.015, save_every=1e-3)
        names = [field.name for field in result.fields if field.name.startswith("loss_")]
        losses.append(sum(float(result[name][-1] - result[name][5]) for name in names))
    # other roundings (instruction sets, -O1) give 1 to 15 %; without damping the presets differ by 37 to 41 %
    assert losses[0] == pytest.approx(losses[1], rel=0.25)


@pytest.mark.usefixtures("probes")
@pytest.mark.parametrize("loads", [(1230.0, 0.0), (4930.0, 12_000.0)], ids=["light", "combined"])
def test_rollers_that_carry_are_not_called_vibrating(loads):
    """Not in the unloaded zone of a combined load, either: the others carry."""
    result = trb.Simulation(paper_30310(2000.0, *loads), accuracy="reference").run(duration=0.015)
    assert result.warnings == ()


@pytest.mark.parametrize(
    ("damped", "size", "seen"),
    [(True, 1e-3, False), (True, 0.02, True), (False, 1e-4, False), (False, 1e-3, True)],
)
def test_vibrations_without_damping_matter_from_smaller_sizes_on(damped, size, seen, monkeypatch):
    """What is missing counts from a hundredth of the elastic energy on, where nothing damps from two ten-thousandths on."""
    monkeypatch.setattr("trbdyn.run.vibrations._taken", lambda span, now, time: (0.5, size))
    monkeypatch.setattr(Vibrations, "_damped", lambda self, now: damped)
    looked: Any = Vibrations.__new__(Vibrations)
    looked._seen = Vibrating()
    looked._suspect(SimpleNamespace(since=0.0), {}, 1.0)
    assert (looked._seen.suspect is not None) is seen
