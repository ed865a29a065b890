"""A cage that deforms by its natural modes: limits, vibrations, static bending, energies, forces on the modes."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import trbdyn as trb
from trbdyn import Effects, InputError, Scene, Simulation
from trbdyn.extras.elastic.cage_solid import CageSolid, cage_solid
from trbdyn.extras.elastic.modes import CageModes
from trbdyn.extras.elastic.simulated import _modes, cage_modes
from trbdyn.extras.elastic.stress import cage_stress
from trbdyn.model.pocket import pocket_axes
from trbdyn.results.cage_stress import CageStress

Array = NDArray[np.float64]
BEARING = trb.cases.rig_30310().replace({"cage.body": trb.cases.cage_body_30310()})


@pytest.fixture(scope="module")
def built() -> CageSolid:
    return cage_solid(BEARING)


def scene(elastic: trb.ElasticCage | None, effects: Effects | None = None, **changes: Any) -> Scene:
    given = {"bearing": BEARING, "speed_rpm": 3000.0, "axial_load": 4930.0, "effects": effects or Effects.standard()}
    return Scene(**(given | {"elastic_cage": elastic} | changes))


def accelerations(sim: Simulation, rates: Array) -> Array:
    """Of the amplitudes (m/s2), out of the rates of a state."""
    parts = share_of_scale(cage_modes(sim.scene))
    return np.array([float(sim.view(rates)[f"cage_p{mode}"]) * part for mode, part in enumerate(parts)])


def share_of_scale(modes: CageModes) -> Array:
    """Frequency of each mode over the one that makes a velocity of its amplitude."""
    speeds = 2.0 * np.pi * modes.frequency
    return speeds / np.maximum(speeds, 17000.0)


def squeezed(sim: Simulation, least: float) -> Array:
    """Two opposite rollers pressed against the bars of their pockets by a force at least, the cage undeformed."""
    vector = sim.state.vector
    state = sim.view(vector)
    for roller in (0, 6):
        while sim.record(vector, 0.0)["pocket_force"][roller].sum() < least:
            state["roller_psi"][roller] += 1e-5
    return vector


# ---- limits ----


def test_a_cage_a_hundred_times_as_fast_is_a_rigid_one(tmp_path: Path) -> None:
    """Young's modulus times 1e4, of the modes alone: the contacts keep theirs. The modes come from a file."""
    modes = cage_modes(scene(trb.ElasticCage(n_modes=12)))
    stiff = CageModes(**{**vars(modes), "frequency": 100.0 * modes.frequency})
    path = stiff.save(tmp_path / "stiff.h5")
    start = trb.Start(kind="whirl", eccentricity=0.8)
    runs = [
        Simulation(scene(elastic, start=start), accuracy="reference").run(duration=4e-3)
        for elastic in (None, trb.ElasticCage(n_modes=12, file=str(path)), trb.ElasticCage(n_modes=12))
    ]
    rigid, near, soft = (run["cage_position"] for run in runs)
    play = BEARING.cage.play_radial
    assert runs[0]["pocket_force"].max() > 10.0
    assert np.abs(near - rigid).max() < 1e-4 * play
    assert np.abs(soft - rigid).max() > 1e-3 * play
    assert np.abs(runs[1]["cage_mode"]).max() < 1e-3 * np.abs(runs[2]["cage_mode"]).max()


def test_without_forces_on_it_an_elastic_cage_moves_as_a_rigid_one() -> None:
    effects = Effects.standard().replace(pocket_bars=False, pocket_ends=False)
    rigid, elastic = (
        Simulation(scene(one, effects)).run(duration=2e-3)["cage_position"]
        for one in (None, trb.ElasticCage(n_modes=6))
    )
    np.testing.assert_allclose(elastic, rigid, atol=1e-8)  # steps differ


# ---- vibrations ----


def struck(scene: Scene, mode: int | None = None) -> trb.Result:
    """A run after a blow on the leading bar of pocket 0, or after one on a mode alone; the cage touches nothing."""
    effects = Effects.standard().replace(pocket_bars=False, pocket_ends=False)
    sim = Simulation(scene.replace(effects=effects), accuracy="reference")
    modes, vector = cage_modes(sim.scene), sim.state.vector
    at = list(zip(modes.face_pocket, modes.face_name, strict=True)).index((0, "leading_bar"))
    blow = modes.shape[:, at, 0] if mode is None else np.eye(len(modes.frequency))[mode]
    for number, part in enumerate(1e-2 * blow / modes.modal_mass / share_of_scale(modes)):
        sim.view(vector)[f"cage_p{number}"] = part
    start = trb.Start.state(vector, displacement=sim.state.displacement)
    return Simulation(sim.scene.replace(start=start), accuracy="reference").run(duration=0.04, save_every=1e-5)


def loudest(values: Array, low: float, high: float) -> float:
    """Frequency of the largest peak of a spectrum between two frequencies (Hz)."""
    spectrum = np.abs(np.fft.rfft(values * np.hanning(values.size), 32 * values.size))
    frequency = np.fft.rfftfreq(32 * values.size, 1e-5)
    near = (frequency > low) & (frequency < high)
    return float(frequency[near][np.argmax(spectrum[near])])


def test_a_struck_cage_rings_at_its_first_modes() -> None:
    """The face that was struck moves at the natural frequencies, and vibrations decay."""
    slow = scene(trb.ElasticCage(n_modes=12, damping_ratio=0.005), speed_rpm=100.0)
    result, modes = struck(slow), cage_modes(slow)
    at = list(zip(modes.face_pocket, modes.face_name, strict=True)).index((0, "leading_bar"))
    moved = result["cage_mode"] @ modes.shape[:, at, 0]
    for expected in modes.frequency[[0, 2, 4]]:
        assert loudest(moved, 0.8 * expected, 1.2 * expected) == pytest.approx(expected, rel=0.01)
    speeds = 2.0 * np.pi * modes.frequency
    energy = modes.modal_mass * (result["cage_mode_rate"] ** 2 + (speeds * result["cage_mode"]) ** 2)
    decay = -np.polyfit(result.time, np.log(energy[:, :2].sum(axis=1)), 1)[0]
    assert decay == pytest.approx(2.0 * 0.005 * speeds[0], rel=0.05)
    assert result.energy_closure < 1e-3


def test_coriolis_forces_part_the_frequencies_of_a_cage_that_turns() -> None:
    """Of a pair of modes of a plastic cage at 15 000 rpm, seen from the cage: roots of w^2 -+ 2 g W w - w0^2 = 0."""
    cage = trb.Cage(play_radial=0.25e-3, play_circumferential=0.12e-3, body=BEARING.cage.body)
    bearing = BEARING.replace(cage=cage.replace(material=trb.Material.polyamide()))
    fast = scene(trb.ElasticCage(n_modes=2, damping_ratio=0.002), bearing=bearing, speed_rpm=15000.0)
    modes, result = cage_modes(fast), struck(fast, mode=0)
    still, turn = 2.0 * np.pi * modes.frequency[0], bearing.geometry.cage_speed_ratio * 15000.0 * np.pi / 30.0
    assert modes.coriolis is not None
    shift = 0.5 * turn * modes.coriolis[0, 1] / np.sqrt(modes.modal_mass[0] * modes.modal_mass[1])
    assert 0.15 < abs(shift) / still < 0.25
    for way in (-1.0, 1.0):
        expected = (way * abs(shift) + np.hypot(shift, still)) / (2.0 * np.pi)
        found = loudest(result["cage_mode"][:, 0], 0.95 * expected, 1.05 * expected)
        assert found == pytest.approx(expected, rel=0.01)
    # they do no work
    assert result.energy_closure < 1e-3


# ---- static bending, action and reaction ----


@pytest.mark.parametrize("lubrication", [pytest.param("mixed", marks=pytest.mark.slow), "dry"])
def test_rollers_push_the_modes_with_what_pushes_them(lubrication: str, built: CageSolid) -> None:
    """Generalised forces from the wrench of each roller on the cage, and its face's shape; the amplitudes at which the modes
    would rest bend the cage as its stiffness does under the same wrenches, but for the modes that are left out.
    """
    count = 100 if lubrication == "mixed" else 40
    effects = Effects.standard().replace(lubrication=lubrication, pocket_ends=False)
    sim = Simulation(scene(trb.ElasticCage(n_modes=count), effects))
    modes = cage_modes(sim.scene)
    vector = squeezed(sim, 200.0)
    found, rates = sim.contacts(vector, 0.0), sim.derivative(vector, 0.0)
    force, loads = np.zeros(count), np.zeros(built.solid.nodes.size)
    places = {name: at for at, name in enumerate(zip(modes.face_pocket, modes.face_name, strict=True))}
    leading = next(face for face in BEARING.pocket.faces if face.name == "leading_bar")
    for pocket in (0, 6):
        axes, angle = pocket_axes(BEARING, pocket), 2.0 * np.pi * pocket / BEARING.n_rollers
        origin = 0.5 * BEARING.pitch_diameter * np.array([np.cos(angle), np.sin(angle), 0.0])
        place = origin + leading.vertices.mean(axis=0) @ axes + np.array([0.0, 0.0, -BEARING.cage.offset])
        push = found["cage_force"][pocket]
        moment = found["cage_moment"][pocket] - np.cross(place, push)
        wrench = np.concatenate([axes @ push, axes @ moment])
        at = places[(pocket, "leading_bar")]
        force += modes.shape[:, at] @ wrench
        loads += built.at_faces[6 * at : 6 * at + 6].T @ wrench
    assert np.linalg.norm(found["cage_force"][[0, 6]], axis=1).min() > 100.0
    assert np.linalg.norm(np.delete(found["cage_force"], [0, 6], axis=0)) == 0.0
    assert modes.modal_mass * accelerations(sim, rates) == pytest.approx(force, abs=1e-9 * np.abs(force).max())
    amplitude = force / (modes.modal_mass * (2.0 * np.pi * modes.frequency) ** 2)
    exact = (built.at_faces @ built.solid.static(loads[:, None])[:, 0]).reshape(-1, 6)[:, :3]
    for some, allowed in ((20, 0.2), (40, 0.15), (100, 0.06))[: 3 if count == 100 else 2]:
        bent = np.einsum("m,mfi->fi", amplitude[:some], modes.shape[:some])[:, :3]
        assert np.abs(bent - exact).max() < allowed * np.abs(exact).max(), some


# ---- energy ----


def test_energy_is_conserved_without_losses(kit: SimpleNamespace) -> None:
    sim = Simulation(
        scene(trb.ElasticCage(n_modes=6, damping_ratio=0.0), Effects.frictionless()), **kit.tolerances(1e-8)
    )
    vector = squeezed(sim, 50.0)
    start = trb.Start.state(vector, displacement=sim.state.displacement)
    again = Simulation(sim.scene.replace(start=start), **kit.tolerances(1e-8))
    result = again.run(duration=5e-4)
    put_in = sum(result[f"work_{name}"] for name in ("shaft", "ring", "gravity"))
    total = result["kinetic_energy"] + result["elastic_energy"] - put_in
    within = 0.5 * cage_modes(sim.scene).modal_mass * result["cage_mode_rate"] ** 2
    assert within.sum(axis=1).max() > 1e-8
    assert np.ptp(total) < 1e-3 * within.sum(axis=1).max()


def test_the_audit_closes_with_a_cage_that_knocks() -> None:
    start = trb.Start(kind="whirl", eccentricity=0.9)
    cage = trb.Cage(play_radial=0.25e-3, play_circumferential=0.12e-3, body=BEARING.cage.body)
    soft = BEARING.replace(cage=cage.replace(material=trb.Material.polyamide()))
    for bearing in (BEARING, soft):
        sim = Simulation(scene(trb.ElasticCage(n_modes=20, damping_ratio=0.01), bearing=bearing, start=start))
        result = sim.run(duration=0.02)
        assert result["loss_vibration"][-1] > 0.0
        assert result.energy_closure < 1e-3


# ---- inputs ----


def test_what_does_not_go_together_is_refused(tmp_path: Path) -> None:
    elastic = trb.ElasticCage(n_modes=4)
    with pytest.raises(InputError, match=r"effects\.planar = True : must be False with an elastic_cage"):
        scene(elastic, Effects.minimal())
    with pytest.raises(InputError, match=r"effects\.guidance = 'outer_land'"):
        scene(elastic, Effects.standard().replace(guidance="outer_land"))
    with pytest.raises(InputError, match=r"bearing\.cage\.body = None"):
        scene(elastic, bearing=trb.cases.rig_30310())
    with pytest.raises(InputError, match="fineness = 4 : must be <= 3"):
        trb.ElasticCage(fineness=4)
    with pytest.raises(InputError, match=r"elastic_cage\.file = .*cannot be read"):
        trb.ElasticCage(file=str(tmp_path / "none.h5"))
    modes = cage_modes(scene(trb.ElasticCage(n_modes=6)))
    path = modes.save(tmp_path / "modes.h5")
    with pytest.raises(InputError, match="n_modes = 9 : must be <= 6"):
        Simulation(scene(trb.ElasticCage(n_modes=9, file=str(path))))
    for bars in ((12,), tuple(range(10))):
        with pytest.raises(InputError, match=r"elastic_cage\.cracked_bars = .* from 0 to 11, and leave 3 whole bars"):
            scene(trb.ElasticCage(n_modes=4, cracked_bars=bars))
    with pytest.raises(InputError, match="whose modes know its cracks"):
        trb.ElasticCage(n_modes=4, file=str(path), cracked_bars=(1,))
    known = scene(trb.ElasticCage(n_modes=4, file=str(path)))
    assert Scene.from_json(known.to_json()) == known
    Simulation(known)
    CageModes(**{**vars(modes), "frequency": 2.0 * modes.frequency}).save(path, overwrite=True)
    _modes.cache_clear()
    with pytest.raises(InputError, match="which has changed since"):
        Simulation(known)


def test_a_mass_that_is_not_that_of_the_body_is_said() -> None:
    """Its frequencies would be those of another cage."""
    bearing = trb.cases.rig_30310().replace({"cage.body": trb.cases.cage_body_30310()})
    given = {"speed_rpm": 3000, "axial_load": 4930.0, "elastic_cage": trb.ElasticCage(n_modes=6)}
    heavy = trb.Scene(bearing.replace({"cage.mass": 0.3}), **given)
    with pytest.warns(UserWarning, match=r"cage\.mass = 0\.3 kg, but the rims and bars .* weigh 0\.1998 kg"):
        trb.Simulation(heavy)
    assert not trb.Simulation(trb.Scene(bearing, **given)).warnings


def test_records_keep_the_modes_and_are_evaluated_again(tmp_path: Path) -> None:
    start = trb.Start(kind="whirl", eccentricity=0.95)
    result = Simulation(scene(trb.ElasticCage(n_modes=6), start=start)).run(duration=4e-3, output=tmp_path / "run.h5")
    again = trb.load(tmp_path / "run.h5")
    assert result["cage_mode"].shape == (len(result.time), 6)
    np.testing.assert_allclose(again["cage_mode"], result["cage_mode"], rtol=1e-6, atol=1e-15)
    from trbdyn.run.replay import Replay

    record = Replay(result).record(len(result.time) - 1)
    np.testing.assert_allclose(record["cage_mode_rate"], result["cage_mode_rate"][-1], rtol=1e-12)
    np.testing.assert_allclose(record["pocket_force"], result["pocket_force"][-1], rtol=1e-3, atol=1e-6)


# ---- stress ----


def test_stress_is_that_of_the_elements_where_nothing_vibrates(built: CageSolid) -> None:
    """Forces that rest, and the amplitudes at which the modes rest under them: the static stress, with any number of modes."""
    for count in (6, 20):
        still = scene(trb.ElasticCage(n_modes=count))
        modes = cage_modes(still)
        force = np.zeros((1, 12, 4))
        names = [(pocket, face.name) for pocket, face in built.faces]
        loads = np.zeros((built.solid.nodes.size, 1))
        pull = np.zeros(count)
        for pocket, name, size in ((0, "leading_bar", 50.0), (5, "trailing_bar", 80.0), (6, "large_end_wall", 20.0)):
            at = names.index((pocket, name))
            face = built.faces[at][1]
            force[0, pocket, face.slot] = size
            loads[:, 0] -= size * built.at_faces[6 * at : 6 * at + 3].T @ face.normal
            pull -= size * modes.shape[:, at, :3] @ face.normal
        amplitude = pull / (modes.modal_mass * (2.0 * np.pi * modes.frequency) ** 2)
        found = cage_stress(still, np.zeros(1), amplitude[None, :], force, notch_factor=2.0)
        exact = (built.stress_of @ built.solid.static(loads))[:, 0]
        assert found.stress[0] == pytest.approx(2.0 * exact, abs=1e-6 * np.abs(exact).max())
        assert found.worst[2] == pytest.approx(2.0 * exact[np.argmax(np.abs(exact))])
        assert found.is_complete


def test_damage_of_a_run() -> None:
    """Cycles of a sine are counted as such; a run tells its worst point, and a rigid cage has no stress."""
    sine = np.sin(2.0 * np.pi * np.arange(1001) / 100.0)
    series, force = 5e6 * np.stack([sine, 2.0 * sine], axis=1), np.zeros((1001, 12, 2))
    influence = np.zeros((24, 2))
    influence[7], influence[10] = 1e6, 5e5  # Pa/N: pocket 3, trailing bar; pocket 5, leading bar
    one = CageStress(
        time=np.arange(1001.0),
        stress=series,
        point_name=("a", "b"),
        point_place=np.zeros((2, 3)),
        is_complete=True,
        force=force,
        face_name=("leading_bar", "trailing_bar"),
        influence=influence,
        period=20.0,
    )
    damage = one.damage(reference_range=1e7, reference_cycles=1e4, slope=5.0)
    assert damage == pytest.approx([10.0 / 1e4, 32.0 * 10.0 / 1e4], rel=0.06)  # a half cycle at either end is smaller
    with pytest.raises(InputError, match="slope = 0"):
        one.damage(reference_range=1e7, reference_cycles=1e4, slope=0.0)
    # the largest stress is 10 MPa at 25 s
    assert one.cause.startswith("no contact within a period")
    force[10:15, 3, 1], force[12, 3, 1], force[25, 4, 0] = 5.0, 8.0, 100.0
    hit = "roller 3 on the trailing bar of pocket 3, in contact from 10 s on: its 8 N at 12 s would make 80 %"
    assert one.cause == f"{hit} of the stress at rest; the rest is vibration"
    force[20:40, 5, 0] = 7.0
    assert one.cause.startswith(
        "roller 5 on the leading bar of pocket 5, in contact from 20 s on: its 7 N at 25 s would make 35 %"
    )
    start = trb.Start(kind="whirl", eccentricity=0.95)
    run = Simulation(scene(trb.ElasticCage(n_modes=6), start=start)).run(duration=4e-3, save_every=2e-5)
    found = run.cage_stress()
    assert found.stress.shape == (201, 192)
    name, _, size = found.worst
    assert name.startswith("pocket ")
    assert abs(size) > 1e5
    assert "of pocket" in found.cause
    with pytest.raises(InputError, match="elastic_cage = None"):
        Simulation(scene(None)).run(duration=1e-4).cage_stress()
