"""The cases of the accuracy benchmarks and their stored states.

``benchmarks/data/states.npz`` holds, for each case, its scene (JSON) and the states from which trajectories are compared,
each with the length of its window. The file is made by::

    python benchmarks/work_precision.py --make-states        adds cases that the file has not
    python benchmarks/work_precision.py --make-states NAME   makes a case again

Collision states are taken from a whirling cage (start: 0.9 Cpr, 20 turns of the shaft to forget it; 3 at 100 rpm) in the
middle of a collision: a pocket carries more than 5 N. A window is the time of the next 10 impacts and at least 4 ms (1.5 ms at
10 000 rpm); an impact is a roller's first touch of a face of its pocket.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from trbdyn import Scene, Simulation, cases
from trbdyn.model.bearing import Scatter
from trbdyn.model.effects import Effects
from trbdyn.model.scene import Start
from trbdyn.run.simulation import State

Array = NDArray[np.float64]

FILE: Final = Path(__file__).resolve().parents[1] / "data" / "states.npz"

IMPACTS: Final = 10
COLLISION_FORCE: Final = 5.0
"""Force of a pocket on its roller (N) from which a collision is said to go on."""
TOLERANCES_OF_STATES: Final[dict[str, Any]] = {
    "rtol": 1e-5,
    "atol_position": 1e-10,
    "atol_angle": 1e-8,
    "atol_velocity": 1e-6,
    "atol_spin": 1e-4,
}


@dataclass(frozen=True)
class CaseDefinition:
    """How the states of a case come about.

    Attributes
    ----------
    text : str
        What it is.
    speed_rpm, axial_load, radial_load : float
        Operating point of the 30310 rig.
    start : Start
        How the run that gives the states begins.
    settle, between : float
        Turns of the shaft before the first state, and from state to state.
    colliding : bool
        Whether states are taken in the middle of a collision.
    effects : str
        Preset of the effects, 'paper' or 'standard'; each with 8 Gauss nodes along a contact.
    diameter_range : float
        Range of the rollers' diameters (m).
    least_window, longest_window : float
        Shortest window (s); longest window (s), also where fewer impacts happen: rolling without collisions.
    reference : {'erk', 'bdf'}
        Method of the reference trajectories: explicit, or BDF where explicit steps would be far too short.
    timed : float
        Length of timed runs over that of the other cases.
    """

    text: str
    speed_rpm: float
    axial_load: float
    radial_load: float
    start: Start
    settle: float
    between: float
    colliding: bool
    effects: str = "paper"
    diameter_range: float = 0.0
    least_window: float = 4e-3
    longest_window: float = 20e-3
    reference: Literal["erk", "bdf"] = "erk"
    timed: float = 1.0


CASES: Final = {
    "smooth": CaseDefinition(
        "smooth rolling: the cage rides on equally spaced rollers", 3000.0, 4930.0, 0.0, Start.equal(), 5.0, 1.3, False
    ),
    "collision": CaseDefinition(
        "whirling cage that collides with its rollers", 3000.0, 4930.0, 0.0, Start.whirl(0.9), 20.0, 2.3, True
    ),
    "combined": CaseDefinition(
        "combined load, cage whirling at first", 2000.0, 4930.0, 5530.0, Start.whirl(0.9), 10.0, 2.3, True
    ),
    "light": CaseDefinition("light load, colliding cage", 3000.0, 1230.0, 0.0, Start.whirl(0.9), 20.0, 2.3, True),
    "heavy": CaseDefinition(
        "heavy load, colliding cage", 3000.0, 20_000.0, 0.0, Start.whirl(0.9), 20.0, 2.3, True, reference="bdf"
    ),
    "slow": CaseDefinition(
        "slow rotation",
        100.0,
        4930.0,
        0.0,
        Start.whirl(0.9),
        3.0,
        0.7,
        True,
        least_window=40e-3,
        longest_window=100e-3,
        reference="bdf",
        timed=0.1,
    ),
    "fast": CaseDefinition(
        "fast rotation, colliding cage",
        10_000.0,
        4930.0,
        0.0,
        Start.whirl(0.9),
        40.0,
        5.3,
        True,
        least_window=1.5e-3,
        timed=3.0,
    ),
    "scatter": CaseDefinition(
        "rollers of unequal diameter, within 2 um; effects as by default",
        3000.0,
        4930.0,
        0.0,
        Start.whirl(0.9),
        20.0,
        2.3,
        True,
        effects="standard",
        diameter_range=2e-6,
    ),
}
N_STATES: Final = 5


@dataclass(frozen=True)
class Case:
    """A case with its stored states.

    Attributes
    ----------
    name, text : str
        The case.
    scene : Scene
        What is simulated; its start is that of the run which gave the states.
    states : tuple of State
        Where trajectories begin.
    windows : tuple of float
        How long they are compared (s).
    impacts : tuple of int
        Impacts within the windows.
    """

    name: str
    text: str
    scene: Scene
    states: tuple[State, ...]
    windows: tuple[float, ...]
    impacts: tuple[int, ...]

    @property
    def definition(self) -> CaseDefinition:
        """How its states came about."""
        return CASES[self.name]

    @property
    def reference(self) -> Literal["erk", "bdf"]:
        """Method of its reference trajectories."""
        return self.definition.reference

    def first(self, count: int) -> Case:
        """The case with only its first states."""
        first = {name: getattr(self, name)[:count] for name in ("states", "windows", "impacts")}
        return replace(self, **first)


STORED_LAW = "zhou_hoeprich"
"""Law of rolling resistance with which the states were stored, beside the rib's film and friction of then; they are compared with
cores that had no other.
"""


def scene_of(definition: CaseDefinition) -> Scene:
    """The scene of a case, with 8 Gauss nodes along each contact."""
    standard = Effects.standard().replace(
        rolling_law=STORED_LAW,
        rolling_load="slices",
        supply=1.0,
        thermal_law="gupta",
        rib_film="pe",
        friction=Effects.paper().friction,
    )
    effects = {"paper": Effects.paper(), "standard": standard}[definition.effects]
    bearing = cases.rig_30310()
    if definition.diameter_range > 0.0:
        scatter = Scatter(range=definition.diameter_range, seed=1)
        bearing = bearing.replace(roller=bearing.roller.replace(diameter_scatter=scatter))
    return cases.paper_30310(
        definition.speed_rpm,
        definition.axial_load,
        definition.radial_load,
        bearing=bearing,
        start=definition.start,
        effects=effects.replace(quadrature="gauss", n_slices=8),
    )


def at_state(scene: Scene, state: State) -> Scene:
    """The scene started from a state."""
    if scene.housing is not None:
        return scene.replace(start=Start.state(state))
    return scene.replace(start=Start.state(state.vector, time=state.time))


def impact_times(time: Array, pocket_force: Array) -> Array:
    """Times at which some roller begins to touch a face of its pocket, one entry an impact."""
    on = pocket_force > 0.0
    count = (on[1:] & ~on[:-1]).any(axis=2).sum(axis=1)
    return np.repeat(time[1:], count)


def window_of(scene: Scene, state: State, least: float, longest: float) -> tuple[float, int]:
    """Length of a state's window (s), and the impacts in it."""
    sim = Simulation(at_state(scene, state), **TOLERANCES_OF_STATES)
    result = sim.run(duration=longest, save_every=5e-6, save_groups=("time", "pocket"))
    times = impact_times(result.time - result.time[0], result.pocket_force)
    if times.size < IMPACTS:
        return longest, int(times.size)
    window = float(np.ceil(max(times[IMPACTS - 1], least) / 1e-4) * 1e-4)
    return window, int(np.count_nonzero(times <= window))


def make_states(definition: CaseDefinition, count: int = N_STATES) -> list[State]:
    """Run a case and take its states."""
    sim = Simulation(scene_of(definition), **TOLERANCES_OF_STATES)
    states = []
    for i in range(count):
        sim.run(revolutions=definition.between if i else definition.settle, save_every=1e-3, save_groups=("time",))
        sim.set_state(sim.state)
        while definition.colliding and sim.record()["pocket_force"].max() < COLLISION_FORCE:
            sim.step()
        sim.set_state(sim.state)
        states.append(sim.state)
    return states


def make_file(names: Sequence[str] = (), path: Path = FILE) -> None:
    """Write the states of cases into the file; by default of those that it has not. The others stay as they are."""
    arrays: dict[str, Any] = {}
    if path.exists():
        with np.load(path) as data:
            arrays = dict(data)
    for name, definition in CASES.items():
        if name not in names and (names or f"{name}_scene" in arrays):
            continue
        scene, states = scene_of(definition), make_states(definition)
        found = [window_of(scene, state, definition.least_window, definition.longest_window) for state in states]
        arrays[f"{name}_scene"] = json.dumps(scene.to_dict())
        arrays[f"{name}_vector"] = np.array([state.vector for state in states])
        arrays[f"{name}_time"] = np.array([state.time for state in states])
        arrays[f"{name}_window"] = np.array([window for window, _ in found])
        arrays[f"{name}_impacts"] = np.array([impacts for _, impacts in found], dtype=float)
        print(f"{name}: windows {[f'{1e3 * w:.1f} ms, {n} impacts' for w, n in found]}", flush=True)
    path.parent.mkdir(exist_ok=True)
    np.savez_compressed(path, **arrays)


def load_case(name: str, path: Path = FILE) -> Case:
    """A case from the file."""
    with np.load(path) as data:
        scene = json.loads(str(data[f"{name}_scene"]))
        scene["effects"].setdefault("rolling_law", STORED_LAW)
        scene["effects"]["friction"].setdefault("rib_boundary_limit", 0.1)
        scene["effects"].setdefault("thermal_law", "gupta")
        scene["effects"].setdefault("rolling_load", "slices")
        scene["effects"].setdefault("supply", 1.0)
        states = tuple(
            State(float(time), vector)
            for time, vector in zip(data[f"{name}_time"], data[f"{name}_vector"], strict=True)
        )
        return Case(
            name,
            CASES[name].text,
            Scene.from_dict(scene),
            states,
            tuple(map(float, data[f"{name}_window"])),
            tuple(map(int, data[f"{name}_impacts"])),
        )
