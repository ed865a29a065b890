"""A load that rotates, and what every load has in common."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from trbdyn.base.validation import Model, Number, unit
from trbdyn.errors import MISSING, InputError
from trbdyn.model.motion import History, Quantity, values_of


class RotatingLoad(Model):
    """A radial load on the inner ring that rotates, for instance of an unbalance; it adds to the load that does not.

    Parameters
    ----------
    load : float or History
        Magnitude (N).
    turns : float
        Turns of the load for a turn of the shaft (1); 1: an unbalance of the shaft. Not together with `frequency_hz`.
    frequency_hz : float, optional
        Turns of the load in a second (Hz), whatever the shaft does; negative: against positive speed.
    direction_deg : float
        Direction of the load where the shaft's angle is zero, with `frequency_hz` at t = 0; from +x towards +y (deg). The shaft's
        angle is zero at the start, and goes on in a run from a state.

    Examples
    --------
    >>> import trbdyn as trb
    >>> scene = trb.Scene(
    ...     trb.cases.rig_30310(), speed_rpm=3000, axial_load=4930.0, rotating_load=trb.RotatingLoad(500.0),
    ...     ring="follows",
    ... )
    >>> float(scene.period)
    0.02
    """

    _root: ClassVar[str | None] = "rotating_load"

    load: Annotated[Quantity, unit("N")]
    turns: Annotated[Number, unit("1", ge=-1000, le=1000)] = 1.0
    frequency_hz: Annotated[Number, unit("Hz", ge=-1e6, le=1e6)] | None = None
    direction_deg: Annotated[Number, unit("deg")] = 0.0

    def __init__(self, load: Any = MISSING, **fields: Any) -> None:
        super().__init__(**fields if load is MISSING else {"load": load, **fields})

    def _check(self) -> None:
        check_sign("load", self.load)
        if self.frequency_hz is not None and self.turns != 1.0:
            raise InputError.of("turns", self.turns, "must not be given together with frequency_hz")


def check_sign(name: str, load: float | History) -> None:
    """Refuse a load (N) that is negative at some time."""
    for place, value in enumerate(values_of(load)):
        if value < 0.0:
            raise InputError.of(
                (name, "values", place) if isinstance(load, History) else name, value, "must be >= 0 (N)"
            )
