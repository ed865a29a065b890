"""The land of a ring that guides the cage."""

from __future__ import annotations

from typing import Annotated, ClassVar

from trbdyn.base.validation import Model, Number
from trbdyn.model.assumed import RIG
from trbdyn.model.core_table import parameter


class Land(Model):
    """The land of a ring that guides the cage, and the guiding surface of the cage on it: a ring about the cage's axis. It acts
    where `Effects.guidance` says so. What is not given is assumed in proportion to the 30310 rig; catalogues tell nothing of it,
    so show the effect of its numbers over their bands.

    Parameters
    ----------
    offset : float
        Axial position of the middle of the guiding surface from the roller-centre plane, positive towards the large ends (m);
        by default 12/19.8 of the roller's length, at the large-end rail.
    inner_radius, outer_radius : float
        Radius of the land of the inner ring, and of the outer ring (m); `Effects.guidance` chooses one. By default 39.5/82.389
        and 50.5/82.389 of the pitch diameter.
    width : float
        Width of the guiding surface (m); by default 3/19.8 of the roller's length.
    clearance : float
        Radial clearance between cage and land (m); by default 0.1/14 of the roller's diameter; usual are 0.1 to 0.4 % of the
        land's radius. The rollers guide the cage where their plays are smaller.
    contact_film : float
        Height of the film below which roughness peaks of cage and land touch (m), from 1e-4 to 0.5 of the clearance; by
        default a hundredth of the clearance, which is 1 um at the rig. The law of the film holds down to this height.
    fill : float
        Share of the guiding surface's width that is filled with oil, from 0 (no film) to 1 (1); 1 by default. It is known in no
        bearing.
    """

    _assumed: ClassVar[bool] = True

    offset: Annotated[Number, parameter("land_offset")] = RIG["rail_offset"]
    inner_radius: Annotated[Number, parameter("land_inner_radius")] = RIG["land_inner_radius"]
    outer_radius: Annotated[Number, parameter("land_outer_radius")] = RIG["land_outer_radius"]
    width: Annotated[Number, parameter("land_width")] = RIG["land_width"]
    clearance: Annotated[Number, parameter("land_clearance")] = RIG["land_clearance"]
    contact_film: Annotated[Number, parameter("land_contact_film")] = RIG["land_contact_film"]
    fill: Annotated[Number, parameter("land_fill")] = 1.0
