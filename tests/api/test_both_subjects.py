"""What works for one bearing works for bearings on a shaft: one table of both, and of what is done with them. Those that are
slow as a whole have tests of their own for a single bearing: test_uncertainty.py, test_optimise.py and so on.
"""

from __future__ import annotations

import json
import signal
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shared import assert_same_fields

import trbdyn as trb
from trbdyn.cli import main
from trbdyn.errors import InputError, StepError
from trbdyn.extras.design.planning import candidates, ground, looking
from trbdyn.extras.heat import thermal
from trbdyn.extras.maps import torque_map, whirl
from trbdyn.extras.study.definition import Base
from trbdyn.model.lubricants import REPLENISHMENT
from trbdyn.run import memory, running
from trbdyn.run.case_text import case_text
from trbdyn.run.checkpoint import checkpoint_path

SCENE = trb.cases.scene_30310(3000.0, 4930.0)
PAIR = trb.load_assembly("pair_30310")
SUBJECTS = {"scene": SCENE, "pair": PAIR}
PREFIX = {"scene": "", "pair": "bearings[1]."}
SHORT = trb.RunOptions(duration=5e-4, accuracy="fast", save_groups=("contacts", "torque"))


@pytest.fixture(params=SUBJECTS)
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def simulation(name: str, **options: Any) -> Any:
    return trb.Simulation(SUBJECTS[name], accuracy="fast", **options)


def each(given: Any) -> list[Any]:
    """What is given for each bearing, by its name where there are several."""
    return list(given.values()) if isinstance(given, Mapping) and set(given) == {"left", "right"} else [given]


def test_contacts_records_systems_and_states(name: str) -> None:
    sim = simulation(name)
    sim.step()
    for contacts, record, state in zip(each(sim.contacts()), each(sim.record()), each_view(sim), strict=True):
        assert contacts["raceway_load"].shape[:2] == (2, 12)
        assert contacts["raceway_load"].sum(axis=2)[1] == pytest.approx(record["inner_load"], rel=1e-9)
        assert state["roller_psi"].shape == (12,)
    other = sim.copy()
    assert other.run(duration=1e-4).success
    assert sim.time < other.time
    other.set_state(sim.state)
    assert np.array_equal(other.state.vector, sim.state.vector)
    assert other.derivative() == pytest.approx(sim.derivative())
    with pytest.raises(InputError, match="state"):
        sim.derivative(np.zeros(3))
    assert "rollers" in str(sim.system)
    assert "accuracy 'fast'" in repr(sim)
    assert sim._shown().text()


def test_a_run_goes_on_from_a_state(name: str, tmp_path: Path) -> None:
    """The same bits as the simulation that the state is from, started again there; also through a file and a checkpoint."""
    sim = simulation(name)
    sim.run(duration=1e-3)
    subject = SUBJECTS[name].replace(start=trb.Start.state(sim.state))
    sim.restart()
    assert type(subject).from_json(subject.to_json()) == subject
    other = trb.Simulation(subject, accuracy="fast")
    assert other.time == sim.time == 1e-3
    assert other.state.shaft_angle == pytest.approx(sim.state.shaft_angle, rel=1e-12)
    how: dict[str, Any] = {"duration": 1e-3, "checkpoint_every": 5e-4}
    one, two = sim.run(**how), other.run(**how, output=tmp_path / "run.h5")
    assert np.array_equal(sim.state.vector, other.state.vector)
    assert np.array_equal(sim.state.vector, other.state.vector)
    for first, second in zip(one.parts, two.parts, strict=True):
        assert np.array_equal(first["time"], second["time"])
        assert first["cage_position"] == pytest.approx(second["cage_position"], rel=1e-12)  # a file has 12 digits of it


def test_a_pair_goes_on_from_a_state_of_its_own_alone() -> None:
    sim = simulation("pair")
    sim.run(duration=2e-4)
    state = trb.Start.state(sim.state)
    for change, said in (
        ({"state_vector": state.state_vector[1:]}, "must have"),
        ({"time": -1.0}, "where the bearings start"),
        ({"shaft_angle": 1.0}, "began otherwise"),
        ({"displacement": (1e-5, 0.0, 0.0, 0.0, 0.0)}, "began otherwise"),
    ):
        with pytest.raises(InputError, match=said):
            trb.Simulation(PAIR.replace(start=state.replace(**change)))
    with pytest.raises(InputError, match="start of each bearing"):
        PAIR.replace(start=trb.Start.whirl(0.5))


def each_view(sim: Any) -> list[Any]:
    view = sim.view()
    return list(view.values()) if isinstance(view, dict) else [view]


def test_a_callback_ends_a_run(name: str) -> None:
    seen: list[float] = []

    def look(sim: Any) -> bool:
        seen.append(sim.time)
        with pytest.raises(InputError, match="while a run goes on"):
            sim.step()
        return sim.time > 1e-3

    result = simulation(name).run(duration=0.05, save_every=1e-5, callback=look)
    assert seen
    assert not result.success
    assert "ended by the callback" in result.message
    assert len(result.time) < 5000


def test_what_a_callback_raises_has_the_result(name: str) -> None:
    def fail(_: Any) -> bool:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError) as caught:
        simulation(name).run(duration=0.05, save_every=1e-5, callback=fail)
    result = caught.value.result  # type: ignore[attr-defined]
    assert result.time.size > 0
    assert all(np.isfinite(one.cage_position).all() for one in result.parts)


def test_until(name: str) -> None:
    """A run that is too short says so for each bearing."""
    with pytest.warns(trb.RunWarning, match="without the confidence"):
        result = simulation(name).run(revolutions=0.25, until={"torque": 1e-4})
    assert result.success
    assert all("without the confidence" in " ".join(one.warnings) for one in result.parts)
    with pytest.raises(InputError, match="until"):
        simulation(name).run(revolutions=1.0, until={"orbit": 1e-3})


def test_turns_are_not_counted_where_a_torque_drives_the_shaft(name: str) -> None:
    """Its speed follows from the run: a number of turns at the speed of the start would be another number of turns."""
    driven = {
        "scene": SCENE.replace(
            ring="free", ring_body=trb.RingBody.hollow_cylinder(mass=2.0, outer_diameter=0.06, length=0.09), torque=9.0
        ),
        "pair": PAIR.replace(torque=9.0),
    }[name]
    sim = trb.Simulation(driven, accuracy="fast")
    for call in (sim.run, sim.estimate):
        with pytest.raises(InputError, match=r"run\.revolutions = 0\.01 : .*torque.*give duration"):
            call(revolutions=0.01)
    assert np.isnan(sim.run(duration=2e-4).stats["revolutions"])


def test_a_step_that_fails_names_the_body(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    from trbdyn import _core

    sim = simulation(name)
    core = sim._core

    class Failing:
        def run(self, *_: Any) -> Any:
            raise _core.CoreStepError("no step; largest error: roller 3, v_t")

        def __getattr__(self, attribute: str) -> Any:
            return getattr(core, attribute)

    sim._core = Failing()
    with pytest.raises(StepError) as caught:
        sim.run(duration=1e-3)
    assert (caught.value.body, caught.value.quantity) == ("roller 3", "v_t")
    assert not caught.value.result.success


def test_a_full_memory_ends_a_run(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "LOOK_EVERY", 0)
    monkeypatch.setattr(memory, "available", lambda: 0)
    result = simulation(name).run(duration=0.02, save_every=1e-5)
    assert not result.success
    assert "memory is nearly full" in result.message


def test_a_run_that_was_cut_off_goes_on(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-C in the middle, then a resumed run: the same bits as a run without a break."""
    how: dict[str, Any] = {"duration": 5e-4, "save_every": 2e-5, "checkpoint_every": 2e-4}
    how["save_groups"] = ("cage", "contacts", "energy", "peaks")
    whole = simulation(name).run(**how, output=tmp_path / "whole.h5")
    keep = running.Run._keep

    def interrupted(self: running.Run, records: Any) -> None:
        keep(self, records)
        if self.sim.time > 3e-4:
            signal.raise_signal(signal.SIGINT)

    path = tmp_path / "cut.h5"
    with monkeypatch.context() as patch:
        patch.setattr(running.Run, "_keep", interrupted)
        cut = simulation(name).run(**how, output=path)
    assert not cut.success
    assert checkpoint_path(path).exists()
    resumed: Any = trb.resume(path)
    assert resumed.success
    for one, other in zip(whole.parts, resumed.parts, strict=True):
        assert_same_fields(one, other)
    again: Any = trb.resume(path)
    assert np.array_equal(again.time, whole.time)
    simulation(name).run(duration=1e-4, output=path, overwrite=True)
    assert sorted(place.name for place in tmp_path.iterdir()) == ["cut.h5", "whole.h5"]


def test_estimate(name: str) -> None:
    sim = simulation(name)
    found = sim.estimate(revolutions=2)
    assert found.steps > 100
    assert found.wall_s > 0.0
    assert sim.time == 0.0


def test_stiffness_and_modes(name: str) -> None:
    """The matrix is the slope of the force: compared with equilibria under slightly different forces."""
    found = trb.stiffness(SUBJECTS[name])
    assert found.matrix == pytest.approx(found.matrix.T, rel=1e-3, abs=1e-3 * np.abs(found.matrix).max())
    assert np.linalg.eigvalsh(0.5 * (found.matrix + found.matrix.T))[0] > 0.0
    body = trb.RingBody.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    assert (np.diff(found.modes(body).frequencies) >= 0.0).all()


def test_the_stiffness_of_a_shaft_is_the_slope_of_its_force() -> None:
    found, step = trb.stiffness(PAIR), 1.0
    mass = PAIR.shaft.mass_position
    moved = []
    for sign in (-1.0, 1.0):
        load = trb.ShaftLoad(position=mass, force=(0.0, 0.0, sign * step))
        moved.append(trb.equilibrium(PAIR.replace(loads=(*PAIR.loads, load))).displacement(mass))
    slope = np.linalg.solve(found.matrix, [0.0, 0.0, step, 0.0, 0.0])[:3]
    assert 0.5 * (moved[1] - moved[0]) == pytest.approx(slope, rel=2e-3, abs=1e-3 * np.abs(slope).max())
    same = trb.equilibrium(PAIR).modes()
    body = trb.RingBody(
        mass=PAIR.shaft.mass,
        inertia_axial=PAIR.shaft.inertia_axial,
        inertia_transverse=PAIR.shaft.inertia_transverse,
    )
    assert found.modes(body).frequencies == pytest.approx(same.frequencies)


@pytest.mark.slow
def test_uncertainty(name: str) -> None:
    path = f"{PREFIX[name]}lubricant.temperature_c"
    found = trb.uncertainty(SUBJECTS[name], {path: (50.0, 70.0)}, samples=8, options=SHORT, workers=2)
    assert found.draws == 8
    assert found["torque"].low < found["torque"].value < found["torque"].high
    colder = np.argmin(found.data[path].values[1:]) + 1
    warmer = np.argmax(found.data[path].values[1:]) + 1
    films = found.data["film_parameter_inner" if name == "scene" else "right_film_parameter_inner"].values
    assert films[colder] > films[warmer]
    if name == "pair":
        others = found.data["left_film_parameter_inner"].values
        assert np.ptp(others[1:]) < 0.01 * np.ptp(films[1:])
        assert found["torque"].value == pytest.approx(found["left_torque"].value + found["right_torque"].value)
    assert all(band.low < band.high for band in trb.study.open_inputs(SUBJECTS[name]))


def test_open_inputs_are_inputs_of_the_subject(name: str) -> None:
    """Also that of the film's replenishment, whose path was that of no bearing of a pair."""
    on = {"replenishment": next(one.value for one in REPLENISHMENT.values() if one.value > 0.0), "oil_fill": 0.2}
    changes = {f"{prefix}effects.{key}": value for prefix in SUBJECTS[name].parts for key, value in on.items()}
    base = Base.of(Base.of(SUBJECTS[name]).build(changes)[0])
    subject, _ = base.build({})
    bands = trb.study.open_inputs(subject)
    assert sum(band.path.endswith(tuple(on)) for band in bands) == len(changes)
    for band in bands:
        assert base.build({band.path: band.high})[0] != subject, band.path


def test_torque_map(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(torque_map, "TURNS", (0.5,))
    how: dict[str, Any] = {"temperatures": [60.0], "tolerance": 0.3, "workers": 2}
    found = trb.torque_map(SUBJECTS[name], [3000.0], [3000.0], **how)
    torque = found.data["torque"].values.ravel()
    assert (torque > 0.0).all()
    shares = found.data["share"].sum("source").values.ravel()
    assert shares == pytest.approx(torque, rel=0.15)  # what is stored still changes in half a turn
    assert "Friction torque of the shaft" in str(found)


@pytest.mark.parametrize("name", ["scene", pytest.param("pair", marks=pytest.mark.slow)])
def test_sensitivity(name: str, tmp_path: Path) -> None:
    bearing = trb.Bearing.from_catalogue(bore=0.050, outside=0.110, width=0.02925, C=125e3, e=0.35, name="30310")
    subject = SUBJECTS[name].with_part(next(reversed(SUBJECTS[name].parts)), bearing=bearing)
    path = "cup_half_angle_deg" if name == "scene" else "bearings[1].bearing.cup_half_angle_deg"
    quantity = "outer_load_mean" if name == "scene" else "right_outer_load_mean"
    how: dict[str, Any] = {"revolutions": 0.01, "paths": [path], "starts": 2, "folder": tmp_path}
    found = trb.sensitivity(subject, quantity, **how)
    assert found.influences[0].estimated.path == path
    assert found.influences[0].span > 0.0
    kept = (tmp_path / "index.jsonl").read_text()
    assert trb.sensitivity(subject, quantity, **how) == found
    assert (tmp_path / "index.jsonl").read_text() == kept  # nothing was run again
    with pytest.raises(InputError, match=r"quantity = .* must give a number"):
        trb.sensitivity(subject, type, **how)
    with pytest.raises(InputError, match="paths"):
        trb.sensitivity(subject, paths=["nothing"])


@pytest.mark.slow
def test_the_best_design(name: str) -> None:
    """Each bearing has its own answer to whether the longer runs have settled; runs of half a millisecond have not."""
    subject, play = SUBJECTS[name], f"{PREFIX[name]}bearing.cage.play_radial"
    found = trb.optimise(subject, {play: (1e-4, 3e-4)}, {"torque": "least"}, designs=10, confirm=2.0, options=SHORT)
    assert found.chosen.confirmed
    assert "1 of 1 longer runs of the chosen design are not known to have settled" in " ".join(str(found).split())
    assert "front of the designs with longer runs" in [
        text.get_text() for text in found._draw().axes[0].get_legend().texts
    ]


def test_whirl_onset(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(whirl, "TURNS", (1.0,))
    found = trb.whirl_onset(SUBJECTS[name], [3000.0], starts=["equal"], longest=1.0, workers=2)
    assert str(found.data["message"].values[0, 0]) == ""
    assert float(found.data["orbit"].values[0, 0]) >= 0.0


@pytest.mark.slow
def test_thermal(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each bearing gives off the heat that it makes, at temperatures that a run of its own confirms. Runs are short."""
    for setting, value in {"CURVE": 3, "TURNS": (1.0,), "SETTLED": 1.0, "CLOSE": 0.1}.items():
        monkeypatch.setattr(thermal, setting, value)
    paths = trb.HeatPaths.reference(bore=0.050, outside=0.110, width=0.02925, oil_flow=15.0, oil_inlet_c=40.0)
    given: Any = paths if name == "scene" else {"left": paths, "right": paths.replace(oil_flow=30.0)}
    found: Any = trb.thermal(SUBJECTS[name], given, workers=2)
    balances = each(found)
    assert all(abs(one.balance) < 0.01 for one in balances)
    subject = SUBJECTS[name]
    for prefix, one in zip(subject.parts, balances, strict=True):
        assert one.bands["film"][0] < one.temperatures["film"] < one.bands["film"][1]
        subject = subject.with_part(prefix, lubricant=one.scene.lubricant)
    result = trb.Simulation(subject, accuracy="fast").run(revolutions=1.0)
    for one, alone in zip(balances, result.parts, strict=True):
        assert alone.summary()["power_loss"] == pytest.approx(one.power, rel=0.05)
    if name == "pair":
        assert found["right"].temperatures["film"] < found["left"].temperatures["film"] - 1.0
    assert str(found).count("Thermal balance") == len(balances)
    assert len(found.picture().axes) == 2 * len(balances)
    with pytest.raises(InputError, match="paths"):
        trb.thermal(SUBJECTS[name], {"nothing": paths})  # type: ignore[arg-type]


@pytest.mark.slow
def test_a_plan(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Few candidates, so that it takes seconds; what is proposed runs, and has the averages that were promised."""
    chosen = tuple(
        switch for switch in candidates.SWITCHES if switch.name in ("front rib", "thermal reduction of films")
    )
    for module, setting, value in (
        (candidates, "SWITCHES", chosen),
        (candidates, "NODES", (8,)),
        (ground, "LEAST_RECORDS", 60),
        (looking, "PATIENCE", 40.0),
    ):
        monkeypatch.setattr(module, setting, value)
    slip = "cage_slip" if name == "scene" else "left_cage_slip"
    found = trb.plan(SUBJECTS[name], {"torque": 0.05, slip: 0.5}, effort=2.0 if name == "scene" else 5.0)
    assert {row.name for row in found.rows} >= {"front rib", "thermal reduction of films", "8 nodes"}
    assert all(part.effects.thermal for part in found.scene.parts.values())
    values = found.averages(found.run(duration=found.settle + 5e-3))
    assert values["torque"] == pytest.approx(found.value["torque"], rel=0.2)
    assert all(f"{100.0 * found.promised[name]:.2g} %" in str(found) for name in found.want)
    text = case_text(found.scene, found.options)
    (tmp_path / "case.toml").write_text(text)
    read = trb.load_case if name == "scene" else trb.load_assembly
    read(tmp_path / "case.toml")
    with pytest.raises(InputError, match="want"):
        trb.plan(SUBJECTS[name], {"middle_torque": 0.1})


@pytest.mark.usefixtures("workers")
@pytest.mark.parametrize("name", [pytest.param("scene", marks=pytest.mark.slow), "pair"])
def test_a_study_over_workers(name: str, tmp_path: Path) -> None:
    speed = "scene.speed_rpm" if name == "scene" else "assembly.speed_rpm"
    warm = f"{PREFIX[name]}lubricant.temperature_c"
    made = trb.study.grid(SUBJECTS[name], {speed: [1000.0, 2000.0], warm: [50.0]}, SHORT)
    data = trb.study.run(made, tmp_path / "study", workers=2)
    assert (data["status"] == "done").all()
    assert (data["torque"].values > 0.0).all()
    assert data["temperature_c" if "temperature_c" in data.dims else warm].attrs["units"] == "C"
    files = [str(file) for file in data["file"].values.ravel()]
    assert len({*files}) == 2
    assert len(trb.load(tmp_path / "study" / files[0]).parts) == len(SUBJECTS[name].parts)
    again = trb.study.run(made, tmp_path / "study", workers=2)
    assert np.array_equal(again["torque"], data["torque"])
    strange = trb.study.cases(SUBJECTS[name], [{warm: 50.0}, {f"{PREFIX[name]}lubricant.warmth": 1.0}], SHORT)
    assert "warmth" in strange.cases[1].error


def test_a_base_builds_what_it_was_made_of(name: str) -> None:
    built, _ = Base.of(SUBJECTS[name], SHORT).build({})
    assert built == SUBJECTS[name]
    assert built.fingerprint == SUBJECTS[name].fingerprint


@pytest.mark.usefixtures("drawn_only")
@pytest.mark.slow
def test_the_command_line_report_and_view(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    case = "rig_30310" if name == "scene" else "pair_30310"
    assert main(["run", case, "-o", "run.h5", "--revolutions", "0.05", "--quiet", "--summary", "run.json"]) == 0
    assert json.loads(Path("run.json").read_text())
    assert main(["info", "run.h5"]) == 0
    assert "orbit radius" in capsys.readouterr().out.lower()
    assert main(["info", case]) == 0
    assert main(["new", "mine.toml", "--case", case]) == 0
    assert main(["info", "mine.toml"]) == 0
    assert main(["report", "run.h5", "-o", "run.html"]) == 0
    assert "<h1>" in Path("run.html").read_text()
    assert main(["view", "run.h5", "-o", "view.html", "--no-open"]) == 0
    assert Path("view.html").stat().st_size > 10_000
    assert main(["resume", "run.h5"]) == 0
