"""How a run starts."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Any, Literal, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trbdyn.base.validation import Model, Number, Whole, unit
from trbdyn.errors import InputError
from trbdyn.model.motion import MAX_TIME


@dataclass(frozen=True)
class State:
    """A state of a simulation: what is needed to go on from it.

    Attributes
    ----------
    time : float
        Time (s).
    vector : ndarray, shape (n_state,)
        The core's state vector.
    shaft_angle : float, optional
        Angle of the shaft (rad).
    displacement : ndarray, shape (5,), optional
        Where the inner ring stands: translation along x, y, z (m), rotation about x, y (rad). Of a free ring, whose place is in
        the vector: where it began, and its support is without force.
    housing_load : ndarray, shape (5,), optional
        What the support of a housing carried where the run began: force along x, y, z (N), moment about x, y (N m).
    inputs : object, optional
        What was in force where inputs were given between steps; `Simulation.set_state` puts it in force again.
    memory : dict
        What a callback keeps in `Simulation.memory`, a copy.
    """

    time: float
    vector: NDArray[np.float64]
    shaft_angle: float | None = None
    displacement: NDArray[np.float64] | None = None
    housing_load: NDArray[np.float64] | None = None
    inputs: Any = None
    memory: dict[str, Any] = field(default_factory=dict)


class Start(Model):
    """How a run starts; made by `equal`, `unequal`, `whirl` or `state`. Rollers and cage start in pure rolling unless `slip` says
    otherwise.

    Parameters
    ----------
    kind : {'equal', 'unequal', 'whirl', 'state'}
        Equal: rollers equally spaced. Unequal: seeded random spacing. Whirl: the cage off centre and whirling, rollers
        centred in their pockets. State: a saved state.
    seed : int
        Unequal: seed of the random numbers.
    spread : float
        Unequal: each roller is off its even place by up to this share of the circumferential play, either way (1).
    eccentricity : float
        Whirl: distance of the cage's centre from the bearing axis, in units of the radial play Cpr (1).
    direction_deg : float
        Whirl: where the cage's centre starts, from +x towards +y (deg).
    slip : float
        Equal, unequal and whirl: share by which rollers and cage turn slower than in pure rolling, both around the bearing and
        each roller about its axis: 0 in pure rolling, 1 where they stand (1).
    time : float
        When the run starts (s). Start state, loads and the ring's place belong to this time, and the shaft's angle is
        zero then unless the start is from a state.
    state_vector : sequence of float
        State: the numbers of the core's state vector.
    shaft_angle : float, optional
        State: angle of the shaft at that time (rad); by default what it has turned by since t = 0.
    displacement : tuple of float, shape (5,), optional
        State: where the inner ring stands then (m, rad). A ring that is held stays there, as it does in the run that goes on.
        Of a free ring: where its support is without force.
    housing_load : tuple of float, shape (5,), optional
        State: what the support of a housing carried where the run began (N, N m); by default what it carries in the
        equilibrium at this start.
    """

    kind: Literal["equal", "unequal", "whirl", "state"] = "equal"
    seed: Annotated[Whole, unit("1", ge=0)] = 0
    spread: Annotated[Number, unit("1", ge=0, le=1)] = 0.8
    eccentricity: Annotated[Number, unit("1", ge=0, le=1)] = 0.9
    direction_deg: Annotated[Number, unit("deg")] = -90.0
    slip: Annotated[Number, unit("1", ge=0, le=1)] = 0.0
    time: Annotated[Number, unit("s", ge=-MAX_TIME, le=MAX_TIME)] = 0.0
    state_vector: tuple[Number, ...] = ()
    shaft_angle: Annotated[Number, unit("rad", ge=-1e9, le=1e9)] | None = None
    displacement: tuple[Number, Number, Number, Number, Number] | None = None
    housing_load: tuple[Number, Number, Number, Number, Number] | None = None

    def _check(self) -> None:
        if (self.kind == "state") != bool(self.state_vector):
            allowed = (
                "must be given for a start from a state"
                if self.kind == "state"
                else "belongs to a start from a state only"
            )
            raise InputError.of("state_vector", self.state_vector, allowed)
        if self.kind == "state" and self.slip != 0.0:
            raise InputError.of("slip", self.slip, "must be 0 with a start from a state, which has its own speeds (1)")
        for name, of in (("shaft_angle", "rad"), ("displacement", "m"), ("housing_load", "N")):
            given = getattr(self, name)
            if self.kind != "state" and given is not None:
                raise InputError.of(name, given, f"belongs to a start from a state only ({of})")

    @classmethod
    def equal(cls) -> Self:
        """Rollers equally spaced, the cage at rest on them."""
        return cls(kind="equal")

    @classmethod
    def unequal(cls, seed: int, *, spread: float = 0.8) -> Self:
        """Rollers at random places within their pockets, the cage at rest on them.

        Parameters
        ----------
        seed : int
            Seed of the random numbers.
        spread : float
            Largest share of the circumferential play that a roller is off its even place (1).
        """
        return cls(kind="unequal", seed=seed, spread=spread)

    @classmethod
    def whirl(cls, eccentricity: float = 0.9, *, direction_deg: float = -90.0) -> Self:
        """The cage whirling with its own rotation, rollers centred in their pockets.

        Parameters
        ----------
        eccentricity : float
            Distance of the cage's centre from the bearing axis, in units of Cpr (1).
        direction_deg : float
            Direction of the cage's centre from +x towards +y (deg).
        """
        return cls(kind="whirl", eccentricity=eccentricity, direction_deg=direction_deg)

    @classmethod
    def state(
        cls,
        vector: ArrayLike | State,
        *,
        time: float | None = None,
        shaft_angle: float | None = None,
        displacement: ArrayLike | None = None,
        housing_load: ArrayLike | None = None,
    ) -> Self:
        """A saved state: ``Start.state(sim.state)`` goes on where a simulation is, with its loads and its ring.

        Where speed and loads are constant the run has the bits of the simulation that goes on. Where they change, the ring's path
        and the speed are computed again from that time on, and differ by rounding and by the tolerance of a path, 0.3 nm;
        `Simulation.copy` and checkpoints keep them (docs/theory/motion.md#the-inner-ring).

        Parameters
        ----------
        vector : State, or array_like of shape (n_state,)
            `Simulation.state`, which knows everything else, too; or the core's state vector alone.
        time, shaft_angle, displacement, housing_load : optional
            As in `State`, whose own they replace. A vector alone is at time 0, and the shaft's angle is what it has turned by
            since then, which is wrong where the saved run itself did not start at t = 0. A ring that is held is then placed
            again, at the equilibrium at `time`; where the speed changes that is another place than that of the saved run.
        """
        given = {
            "time": time,
            "shaft_angle": shaft_angle,
            "displacement": displacement,
            "housing_load": housing_load,
        }
        fields: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
        if isinstance(vector, State):
            fields = {name: getattr(vector, name) for name in given if getattr(vector, name) is not None} | fields
            vector = vector.vector
        arrays = ("displacement", "housing_load")
        fields |= {name: _numbers(name, fields[name]) for name in arrays if name in fields}
        return cls(kind="state", state_vector=_numbers("state_vector", vector), **fields)


def _numbers(name: str, given: ArrayLike) -> tuple[float, ...]:
    try:
        return tuple(np.asarray(given, dtype=np.float64).ravel().tolist())
    except (TypeError, ValueError, OverflowError):
        raise InputError.of(("start", name), given, "must be a vector of numbers") from None
