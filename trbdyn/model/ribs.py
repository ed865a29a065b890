"""The ribs of a bearing's rings."""

from __future__ import annotations

from typing import Annotated, ClassVar, Final, Literal

from trbdyn.base.validation import Model, Number
from trbdyn.errors import InputError
from trbdyn.model.assumed import RIG
from trbdyn.model.core_table import parameter

_TAPERED_RIBS: Final = frozenset({("inner", "large"), ("inner", "small")})
_OUTER_RIBS: Final = frozenset({("outer", "large"), ("outer", "small")})
_RIBS: Final[dict[str | None, frozenset[tuple[str, str]]]] = {
    None: _TAPERED_RIBS,
    "NU": _OUTER_RIBS,
    "NJ": _OUTER_RIBS | {("inner", "large")},
    "NUP": _OUTER_RIBS | _TAPERED_RIBS,
    "N": _TAPERED_RIBS,
}
"""Ribs by the type of a bearing; None: tapered."""


class Ribs(Model):
    """Back-face rib (against the large ends) and front-face rib of the inner ring. Heights are above the raceway,
    perpendicular to it. What is not given is assumed in proportion to the 30310 rig.

    Parameters
    ----------
    contact_height : float
        Height of the nominal contact of the large end (m); by default 1.667/14 of the roller's diameter.
    edge_low, edge_high : float
        Heights of the back-face rib's edges (m); by default 0.3/1.667 and 3.5/1.667 of the contact height.
    front_clearance : float
        Nominal gap between small end and front rib (m); by default 0.2/14 of the roller's diameter. The front rib's
        face is perpendicular to the roller's axis.
    front_low, front_high : float
        Heights of the front rib's edges (m); by default 0.3/14 and 2/14 of the roller's diameter.
    flanges : {'NU', 'NJ', 'NUP', 'N'}, optional
        Which ribs a cylindrical bearing has, by its type in ISO 15; it must be given there, and nowhere else. NU: two of the
        outer ring. NJ: these, and one of the inner ring, against the ends towards +z. NUP: two of each ring. N: two of the inner
        ring. All have the contact height and the edges above; `front_clearance`, `front_low` and `front_high` are for cones.
    clearance : float
        Gap between a cylindrical roller in the middle and each rib (m); by default 1.5e-3 of the roller's diameter.
    """

    _assumed: ClassVar[bool] = True

    contact_height: Annotated[Number, parameter("rib_contact_height", gt=0)] = RIG["contact_height"]
    edge_low: Annotated[Number, parameter("rib_edge_low")] = RIG["edge_low"]
    edge_high: Annotated[Number, parameter("rib_edge_high", gt=0)] = RIG["edge_high"]
    front_clearance: Annotated[Number, parameter("front_rib_clearance")] = RIG["front_clearance"]
    front_low: Annotated[Number, parameter("front_rib_low")] = RIG["front_low"]
    front_high: Annotated[Number, parameter("front_rib_high", gt=0)] = RIG["front_high"]
    flanges: Literal["NU", "NJ", "NUP", "N"] | None = None
    clearance: Annotated[Number, parameter("rib_clearance")] = 0.0

    @property
    def places(self) -> frozenset[tuple[str, str]]:
        """Of which ring, and against which end of the rollers they are; the large end of a cylinder is the one towards +z."""
        return _RIBS[self.flanges]

    def carry(self, force: float) -> bool:
        """Whether ribs of a cylindrical bearing carry an axial force on the inner ring (N): NJ one towards -z, NUP either."""
        return force < 0.0 if self.flanges == "NJ" else self.flanges == "NUP" and force != 0.0

    def _check(self) -> None:
        given = self.model_fields_set
        if {"contact_height", "edge_low"} <= given and self.edge_low >= self.contact_height:
            limit = f"must be > edge_low, {self.edge_low:g}: between the rib's edges (m)"
            raise InputError.of("contact_height", self.contact_height, limit)
        if {"contact_height", "edge_high"} <= given and self.edge_high <= self.contact_height:
            limit = f"must be < edge_high, {self.edge_high:g}: between the rib's edges (m)"
            raise InputError.of("contact_height", self.contact_height, limit)
        if {"front_high", "front_low"} <= given and self.front_high <= self.front_low:
            raise InputError.of("front_high", self.front_high, f"must be > front_low, {self.front_low:g} (m)")
