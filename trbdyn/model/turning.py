"""Which rings turn, of one bearing or of all bearings of a shaft."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Literal

from trbdyn.model.motion import History, check_size, value_at, values_of

MAX_SPEED_RPM: Final = 1e6


class TurningRings:
    """What has the fields `speed_rpm` and `outer_speed_rpm`."""

    if TYPE_CHECKING:
        speed_rpm: float | History
        outer_speed_rpm: float | History

    @property
    def outer_turns(self) -> bool:
        """Whether the outer ring turns at any time."""
        return any(values_of(self.outer_speed_rpm))

    @property
    def turning_ring(self) -> Literal["shaft", "outer ring"]:
        """What turns are counted of: the shaft, or the outer ring where the shaft rests."""
        return "outer ring" if self.outer_turns and not any(values_of(self.speed_rpm)) else "shaft"

    @property
    def turning_rpm(self) -> float | History:
        """The speed by which turns are counted (rpm): that of the shaft, or of the outer ring where the shaft rests."""
        return self.speed_rpm if self.turning_ring == "shaft" else self.outer_speed_rpm

    def rolling_rpm(self, time: float) -> float:
        """Speed of the inner ring relative to the outer ring (rpm)."""
        return value_at(self.speed_rpm, time) - value_at(self.outer_speed_rpm, time)

    def check_speeds(self) -> None:
        """Refuse a speed beyond `MAX_SPEED_RPM`."""
        check_size("speed_rpm", self.speed_rpm, MAX_SPEED_RPM, "rpm")
        check_size("outer_speed_rpm", self.outer_speed_rpm, MAX_SPEED_RPM, "rpm")
