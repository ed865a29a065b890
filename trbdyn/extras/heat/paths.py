"""Where a bearing's heat goes: conductances between its parts, to its surroundings and into the oil that flows through."""

from __future__ import annotations

from typing import Annotated, Final, Self

from trbdyn.base.validation import Model, Number, number_of, unit
from trbdyn.errors import InputError

Conductance = Annotated[Number, unit("W/K", ge=0, le=1e6)]
Celsius = Annotated[Number, unit("C", ge=-80, le=200)]

PARTS: Final = ("outer_ring", "inner_ring", "rollers", "oil")
"""Nodes of the network: outer ring with its housing, inner ring with its shaft, rollers with their cage, oil in the bearing."""
REFERENCE_FLOW: Final = 0.016e6 / 50.0
"""Heat flow per area and kelvin by which ISO 15312 rates thermal reference speeds: 0.016 W/mm2 at 50 K (W/m2K)."""
FACTOR: Final = 3.0
"""Conductances that are assumed may be so many times as large, or as small."""


class HeatPaths(Model):
    """Conductances of the four nodes, and temperatures outside.

    Nothing of this is known from a bearing's drawing: what is not given is assumed, with a band of a third to three times.
    At least one path must lead out.

    Parameters
    ----------
    outer_ring_to_surroundings : float
        Outer ring through its housing to the air (W/K).
    inner_ring_to_surroundings : float
        Inner ring along its shaft to the surroundings (W/K).
    outer_ring_to_rollers, inner_ring_to_rollers : float
        Through the contacts: films, and the rings and rollers that take heat while they pass (W/K); assumed.
    outer_ring_to_oil, inner_ring_to_oil, rollers_to_oil : float
        Convection (W/K); assumed.
    oil_flow : float
        Oil that flows through: volume flow times density times specific heat, 30 W/K for 1 litre a minute of mineral oil (W/K).
    housing_air_c, shaft_end_c, oil_inlet_c : float
        Temperatures of the air round the housing, of the shaft far away, and of the oil that flows in (C).
    oil_share : float
        Share of the heat of films that the oil takes along at once; both surfaces take half of the rest each (1); assumed.
    """

    outer_ring_to_surroundings: Conductance = 0.0
    inner_ring_to_surroundings: Conductance = 0.0
    outer_ring_to_rollers: Conductance = 10.0
    inner_ring_to_rollers: Conductance = 10.0
    outer_ring_to_oil: Conductance = 5.0
    inner_ring_to_oil: Conductance = 5.0
    rollers_to_oil: Conductance = 5.0
    oil_flow: Conductance = 0.0
    housing_air_c: Celsius = 20.0
    shaft_end_c: Celsius = 20.0
    oil_inlet_c: Celsius = 20.0
    oil_share: Annotated[Number, unit("1", ge=0, le=1)] = 0.5

    def _check(self) -> None:
        if not self.outer_ring_to_surroundings + self.inner_ring_to_surroundings + self.oil_flow > 0.0:
            raise InputError.of(
                "outer_ring_to_surroundings", 0.0, "or inner_ring_to_surroundings, or oil_flow, must be above 0 (W/K)"
            )

    @classmethod
    def reference(cls, *, bore: float, outside: float, width: float, **others: float) -> Self:
        """Paths out by the reference conditions of ISO 15312: 320 W/m2K on the seats of both rings.

        Parameters
        ----------
        bore, outside, width : float
            Bore d, outside diameter D and width T of the bearing (m).
        **others
            Other fields.

        Examples
        --------
        >>> import trbdyn as trb
        >>> paths = trb.HeatPaths.reference(bore=0.050, outside=0.110, width=0.02925)
        >>> round(paths.outer_ring_to_surroundings, 2), round(paths.inner_ring_to_surroundings, 2)
        (3.23, 1.47)
        """
        for name, value in (("bore", bore), ("outside", outside), ("width", width)):
            if not 0.0 < number_of(name, value) < 10.0:
                raise InputError.of(name, value, "must be above 0 and below 10 (m)")
        seat = 3.141592653589793 * width * REFERENCE_FLOW
        return cls(
            **{"outer_ring_to_surroundings": seat * outside, "inner_ring_to_surroundings": seat * bore, **others}
        )

    @property
    def inner_links(self) -> dict[tuple[str, str], float]:
        """Conductance between each two nodes (W/K)."""
        return {
            ("outer_ring", "rollers"): self.outer_ring_to_rollers,
            ("inner_ring", "rollers"): self.inner_ring_to_rollers,
            ("outer_ring", "oil"): self.outer_ring_to_oil,
            ("inner_ring", "oil"): self.inner_ring_to_oil,
            ("rollers", "oil"): self.rollers_to_oil,
        }

    @property
    def outer_links(self) -> dict[str, tuple[float, float]]:
        """Conductance from a node to the outside (W/K), and the temperature there (C)."""
        return {
            "outer_ring": (self.outer_ring_to_surroundings, self.housing_air_c),
            "inner_ring": (self.inner_ring_to_surroundings, self.shaft_end_c),
            "oil": (self.oil_flow, self.oil_inlet_c),
        }


CONDUCTANCES: Final = tuple(name for name in HeatPaths.model_fields if not name.endswith(("_c", "_share")))
"""Fields of `HeatPaths` that are conductances."""
