"""The C core. Everything is SI; arrays are C-contiguous float64. Users reach it through trbdyn's classes."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

class CoreError(Exception):
    """Base of the core's errors; `args[0]` is a sentence for a person. Subclasses follow the C status codes."""

class CoreInputError(CoreError, ValueError): ...
class CoreLoadError(CoreError): ...
class CoreStepError(CoreError): ...

def parameter_table() -> list[tuple[str, str, float, float, str, str]]:
    """(name, unit, lower, upper, text) of every entry of the parameter block, in order."""

def face_table() -> list[tuple[str, int, str, str]]:
    """(name, count, unit, text) of the columns of a pocket face's row, in order."""

def motion_table() -> list[tuple[str, str, str]]:
    """(name, unit, text) of the channels of prescribed motion, in order."""

def field_table() -> list[tuple[str, str, str, str, str]]:
    """(name, group, kind, unit, text) of every recorded quantity, in order; kind is scalar, vec2, vec3, quaternion,
    roller, roller_vec3, roller_quat or pocket_face."""

def peak_table() -> list[tuple[str, str, str, str, str, str]]:
    """(name, group, kind, unit, text, how two intervals are joined) of every peak, in order; joined is largest, smallest, time
    (of the extreme before it), mean or sum."""

least_mode_frequency: float
"""Least angular frequency that makes a velocity of the amplitude of a mode in a state (rad/s)."""

def geometry_table() -> list[tuple[str, str, str]]:
    """(name, unit, text) of every derived geometric quantity."""

def quadrature_table() -> list[str]:
    """Names of the energy quadratures, as record fields."""

def counter_table() -> list[tuple[str, str]]:
    """(name, text) of the evaluation counters."""

def law_table() -> list[tuple[str, str, str]]:
    """(name, arguments separated by spaces, text) of the laws callable through `law`."""

def setting_table() -> list[tuple[str, float, float, float, str]]:
    """(name, default, lower, upper, text) of the settings of an integration."""

def law(name: str, arguments: Array) -> Array:
    """A law of the core: arguments (number of arguments, n), gives (n,)."""

def geometry(params: Array) -> Array:
    """Derived geometry, in the order of geometry_table(), of a parameter block."""

def state_layouts(models: tuple[Model, ...]) -> tuple[int, list[list[tuple[str, int, tuple[int, ...]]]]]:
    """Length of the state of bearings that are simulated together, and the layout of each one's part, as
    `Model.state_layout`.
    """

def instruction_sets() -> list[str]:
    """Kernel variants that this machine can run, slowest first: 'scalar', 'base', 'avx2', 'avx512'."""

def sundials_version() -> str: ...
def version() -> str: ...

class Model:
    """One bearing with its lubricant and effects; immutable."""

    def __init__(
        self,
        params: Array,
        diameter_deviation: Array,
        faces: Array,
        instruction_set: str = "",
        modes: Array = ...,
        form: Array = ...,
        drops: Array = ...,
    ) -> None: ...
    n_rollers: int
    n_slots: int
    n_state: int
    record_length: int
    peak_length: int
    instruction_set: str
    def equilibrium(
        self,
        load: Array,
        fixed: Array,
        displacement: Array,
        shaft_speed: float,
        angles: Array,
        rollers: Array | None = None,
        loads: bool = False,
        stiffness: bool = False,
        outer_speed: float = 0.0,
        rough: bool = False,
    ) -> dict[str, Any]:
        """Static equilibrium at speed. load (5,): force (3) and moment about x, y (2) on the ring; fixed (5,): 1 where
        `displacement` (dx, dy, dz, rx, ry) is prescribed; angles (Z,) of the rollers; rollers (4 Z,): with `displacement` a
        guess close to the solution, from which loads are given as 0 without `loads`, or with `rough` any guess. Gives
        displacement (5,), reaction (5,):
        what holds the ring against its rollers, on_other (5,): their force and moment on the other ring, energy:
        the ring's potential; rollers (Z, 4: r, z, tilt, skew offsets), loads (Z, 3:
        outer, inner, rib), residual, iterations; with `stiffness` that of the ring (5, 5) and follow (Z, 20): slopes of each
        roller's four offsets with the ring's five coordinates; else zeros."""
    def record_layout(self) -> list[tuple[str, int, tuple[int, ...]]]:
        """(name, offset, shape) of every field of a record."""
    def peak_layout(self) -> list[tuple[str, int, tuple[int, ...]]]:
        """(name, offset, shape) of every field of a row of peaks."""
    def system_table(self) -> dict[str, list[Any]]:
        """bodies: (name, kind, number of coordinates); surfaces: (name, body); pairs: (name, text, surface, surface, on)."""
    def state_layout(self) -> list[tuple[str, int, tuple[int, ...]]]:
        """(name, offset, shape) of the parts of a state vector."""

class Simulation:
    """One integration: bearings with what is prescribed for each, state, integrator."""

    def __init__(
        self,
        models: tuple[Model, ...],
        motions: tuple[Array | tuple[Array, float, float, float, float], ...],
        time: float,
        state: Array,
        settings: dict[str, float | str],
    ) -> None:
        """Bearings that are simulated together, and for each of them a motion (K, C): knot time, then value and slope of each
        channel. It may come with four numbers: after the last knot the last period repeats (0: everything stays); a time, and
        the angles of shaft and outer ring then (without them they are zero at the first knot). settings: integrator ('auto',
        'multirate', 'bdf', 'erk') and those of setting_table()."""
    time: float
    integrator: str
    """The one that is used."""
    reason: str
    """Why it is not the first choice, where none was asked for; or empty."""
    row_length: int
    def run(
        self, times: Array, records: Array, max_steps: int, stop_after: float = ..., beside: bool = ...
    ) -> tuple[int, int]:
        """Integrate until every time in `times` is passed, filling a row of `records` (a record, and after it the peaks since the
        row before, if they are kept) for each; stop after max_steps, or at
        the first step's end at or after `stop_after`, once the records up to there are filled. Gives (rows filled, steps
        taken). With `beside`, a second thread computes records and peaks, to the same bits. Raises CoreStepError; what was filled
        stays. Releases the GIL."""
    def step(self) -> float:
        """One step of the integrator; gives the new time."""
    def state(self) -> Array: ...
    def state_at(self, time: float) -> Array:
        """The state at an instant of the last step."""
    def begin_peaks(self, time: float) -> None:
        """Keep peaks from an instant of the last step on."""
    def end_peaks(self) -> None: ...
    def save_peaks(self) -> Array:
        """All that restore_peaks needs; empty if no peaks are kept."""
    def restore_peaks(self, saved: Array) -> None:
        """Go on with peaks that were saved at this time."""
    def whole_peaks(self, time: float) -> Array:
        """Rows of peaks, bearing by bearing, from their beginning to an instant of the last step; empty if none are kept."""
    def set_state(self, time: float, state: Array) -> None:
        """Restart the integrator at this state."""
    def restart(self) -> None:
        """Restart the integrator where it is (a checkpoint)."""
    def observe(self, time: float, state: Array) -> Array:
        """A record of each bearing, one after the other, at any time and state."""
    def derivative(self, time: float, state: Array) -> Array: ...
    def contacts(self, time: float, state: Array, bearing: int = 0) -> dict[str, Array]:
        """Every intermediate quantity of every contact of a bearing."""
    def counters(self) -> dict[str, int]: ...
    def statistics(self) -> dict[str, float]: ...
