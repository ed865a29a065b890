"""The inner ring as a body that moves, with the shaft that turns with it."""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Self

from pydantic import model_validator

from trbdyn.base.validation import Model, Number, unit
from trbdyn.errors import InputError
from trbdyn.model.core_table import parameter


class RingBody(Model):
    """What moves with a free inner ring (``Scene(ring="free")``): the ring, and the shaft or rotor that is fixed to it.

    Parameters
    ----------
    mass : float
        Mass (kg).
    inertia_axial, inertia_transverse : float
        Moments of inertia about the axis, and about a transverse axis through the centre of mass (kg m2).
    mass_offset : float
        Axial position of the centre of mass from the roller-centre plane, positive towards the large ends (m).
    unbalance : float
        Mass times radius (kg m). Its force turns with the shaft in the plane of the centre of mass.
    unbalance_angle_deg : float
        Angle of the unbalance from +x towards +y where the shaft's angle is zero (deg).
    damping : float
        Damping between the ring and the surroundings, of translations (N s/m). It stands for whatever else takes energy from the
        shaft's vibrations; none by default.
    damping_turns : float
        The same of turns about transverse axes (N m s).
    support_radial, support_axial : float
        Stiffness across and along the axis (N/m) of a support of the shaft, such as a second bearing: `Stiffness.springs`. It
        carries nothing at the start, and then what moves the shaft from there.
    support_tilt : float
        Its stiffness against tilt (N m/rad).
    support_position : float
        Axial position of the support from the roller-centre plane, positive towards the large ends (m).

    Raises
    ------
    InputError
        If no body can have these moments of inertia: the axial one is at most twice the transverse one.

    Examples
    --------
    >>> import trbdyn as trb
    >>> body = trb.RingBody.hollow_cylinder(mass=0.7, inner_diameter=0.05, outer_diameter=0.072, length=0.027)
    >>> round(1e4 * body.inertia_axial, 2)
    6.72
    """

    _root: ClassVar[str | None] = "ring_body"

    mass: Annotated[Number, parameter("ring_mass", gt=0.0)]
    inertia_axial: Annotated[Number, parameter("ring_inertia_axial", gt=0.0)]
    inertia_transverse: Annotated[Number, parameter("ring_inertia_transverse", gt=0.0)]
    mass_offset: Annotated[Number, parameter("ring_offset")] = 0.0
    unbalance: Annotated[Number, parameter("ring_unbalance")] = 0.0
    unbalance_angle_deg: Annotated[Number, unit("deg", ge=-360.0, le=360.0)] = 0.0
    damping: Annotated[Number, parameter("ring_damping")] = 0.0
    damping_turns: Annotated[Number, parameter("ring_damping_turns")] = 0.0
    support_radial: Annotated[Number, parameter("ring_support_radial")] = 0.0
    support_axial: Annotated[Number, parameter("ring_support_axial")] = 0.0
    support_tilt: Annotated[Number, parameter("ring_support_tilt")] = 0.0
    support_position: Annotated[Number, parameter("ring_support_position")] = 0.0

    @model_validator(mode="after")
    def _check(self) -> Self:
        most = 2.0 * self.inertia_transverse
        if self.inertia_axial > most * (1.0 + 1e-9):
            limit = f"must be <= {most:.6g}: no body has more than twice its inertia_transverse (kg m2)"
            raise InputError.of("inertia_axial", self.inertia_axial, limit)
        return self

    @classmethod
    def hollow_cylinder(
        cls, *, mass: float, inner_diameter: float = 0.0, outer_diameter: float, length: float, mass_offset: float = 0.0
    ) -> Self:
        """A hollow or solid cylinder.

        Parameters
        ----------
        mass : float
            Mass (kg).
        inner_diameter, outer_diameter : float
            Its diameters (m).
        length : float
            Its length (m).
        mass_offset : float
            Axial position of its middle from the roller-centre plane (m).

        Raises
        ------
        InputError
            If a dimension is not allowed.
        """
        if not outer_diameter > 0.0:
            raise InputError.of("outer_diameter", outer_diameter, "must be > 0 (m)")
        if not 0.0 <= inner_diameter < outer_diameter:
            limit = f"must be from 0 to less than outer_diameter = {outer_diameter:g} (m)"
            raise InputError.of("inner_diameter", inner_diameter, limit)
        if not length > 0.0:
            raise InputError.of("length", length, "must be > 0 (m)")
        squares = 0.25 * (math.pow(inner_diameter, 2) + math.pow(outer_diameter, 2))
        return cls(
            mass=mass,
            inertia_axial=0.5 * mass * squares,
            inertia_transverse=mass * (0.25 * squares + length**2 / 12.0),
            mass_offset=mass_offset,
        )
