"""Rings as bodies that move: the inner one with the shaft that turns with it, the outer one with its housing."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Self

from trbdyn.base.validation import Model, Number, number_of, unit
from trbdyn.errors import MISSING, InputError
from trbdyn.model.core_table import parameter
from trbdyn.model.motion import is_constant, values_of

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene


class Revolved(Model):
    """A rigid body of revolution: what everything that moves with a shaft or a housing has in common.

    Raises
    ------
    InputError
        If no body can have these moments of inertia: the axial one is at most twice the transverse one.
    """

    mass: Annotated[Number, parameter("ring_mass", gt=0.0)]
    inertia_axial: Annotated[Number, parameter("ring_inertia_axial", gt=0.0)]
    inertia_transverse: Annotated[Number, parameter("ring_inertia_transverse", gt=0.0)]

    def _check(self) -> None:
        most = 2.0 * self.inertia_transverse
        if self.inertia_axial > most * (1.0 + 1e-9):
            limit = f"must be <= {most:.6g}: no body has more than twice its inertia_transverse (kg m2)"
            raise InputError.of("inertia_axial", self.inertia_axial, limit)

    @classmethod
    def hollow_cylinder(
        cls, *, mass: float, inner_diameter: float = 0.0, outer_diameter: float, length: float, **fields: Any
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
        **fields
            Other fields: `mass_position` or `mass_offset`, where its middle is.

        Raises
        ------
        InputError
            If a dimension is not allowed.
        """
        number_of("outer_diameter", outer_diameter, "m", gt=0.0)
        number_of("length", length, "m", gt=0.0)
        if not 0.0 <= number_of("inner_diameter", inner_diameter, "m") < outer_diameter:
            limit = f"must be from 0 to less than outer_diameter = {outer_diameter:g} (m)"
            raise InputError.of("inner_diameter", inner_diameter, limit)
        squares = 0.25 * (math.pow(inner_diameter, 2) + math.pow(outer_diameter, 2))
        across = mass * (0.25 * squares + length**2 / 12.0)
        return cls(mass=mass, inertia_axial=0.5 * mass * squares, inertia_transverse=across, **fields)


class MovingBody(Revolved):
    """A body on springs and dampers to the surroundings: what `RingBody` and `Housing` have in common."""

    mass_offset: Annotated[Number, parameter("ring_offset")] = 0.0
    damping: Annotated[Number, parameter("ring_damping")] = 0.0
    damping_turns: Annotated[Number, parameter("ring_damping_turns")] = 0.0
    support_radial: Annotated[Number, parameter("ring_support_radial")] = 0.0
    support_axial: Annotated[Number, parameter("ring_support_axial")] = 0.0
    support_tilt: Annotated[Number, parameter("ring_support_tilt")] = 0.0
    support_position: Annotated[Number, parameter("ring_support_position")] = 0.0

    @property
    def is_supported(self) -> bool:
        """Whether a spring holds it."""
        return self.support_radial > 0.0 or self.support_axial > 0.0 or self.support_tilt > 0.0


class RingBody(MovingBody):
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
        Mass times radius (kg m). Its force turns with the shaft in the plane of the centre of mass; the drive keeps the speed
        against it, so it is refused together with a torque.
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

    Examples
    --------
    >>> import trbdyn as trb
    >>> body = trb.RingBody.hollow_cylinder(mass=0.7, inner_diameter=0.05, outer_diameter=0.072, length=0.027)
    >>> round(1e4 * body.inertia_axial, 2)
    6.72
    """

    _root: ClassVar[str | None] = "ring_body"

    unbalance: Annotated[Number, parameter("ring_unbalance")] = 0.0
    unbalance_angle_deg: Annotated[Number, unit("deg", ge=-360.0, le=360.0)] = 0.0


class Housing(MovingBody):
    """What moves with an outer ring that is not held in space (``Scene(housing=...)``): the ring, and the housing around it.

    At the start the outer ring stands at its nominal place, and its support carries the load of the bearing and the weight of the
    housing. From there on the springs act on what moves the ring, and the dampers on its velocity.

    Parameters
    ----------
    mass : float
        Mass (kg).
    inertia_axial, inertia_transverse : float
        Moments of inertia about the axis, and about a transverse axis through the centre of mass (kg m2).
    mass_offset : float
        Axial position of the centre of mass from the roller-centre plane, positive towards the rollers' large ends (m).
    damping : float
        Damping between the housing and the surroundings, of translations (N s/m).
    damping_turns : float
        The same of turns about transverse axes (N m s).
    support_radial, support_axial : float
        Stiffness of the support across and along the axis (N/m). Without stiffness the support keeps the force that it has at the
        start, as a long spring does.
    support_tilt : float
        Its stiffness against tilt (N m/rad).
    support_position : float
        Axial position of the support from the roller-centre plane, positive towards the large ends (m).

    Examples
    --------
    >>> import trbdyn as trb
    >>> housing = trb.Housing.hollow_cylinder(mass=4.0, inner_diameter=0.11, outer_diameter=0.16, length=0.05)
    >>> housing = housing.replace(support_radial=2e8, support_axial=1e8, support_tilt=2e5)
    >>> round(1e3 * housing.inertia_axial, 2)
    18.85
    """

    _root: ClassVar[str | None] = "housing"


def check_free_ring(scene: Scene) -> None:
    """Refuse what goes together with a free ring alone, or not with it."""
    if scene.ring != "free":
        for name in ("ring_body", "torque"):
            if (given := getattr(scene, name)) is not None:
                raise InputError.of(name, given, "must not be given unless ring = 'free'")
        return
    if scene.ring_body is None:
        raise InputError.of("ring_body", MISSING, "must be given where ring = 'free': its mass and moments of inertia")
    if scene.ring_body.is_supported and scene.start.kind == "state" and scene.start.displacement is None:
        limit = (
            "must be given with a support of ring_body, which is without force there: Start.state(simulation.state) (m)"
        )
        raise InputError.of(("start", "displacement"), None, limit)
    if scene.displacement is not None:
        limit = "must not be given where ring = 'free': it begins in the equilibrium of its loads (m)"
        raise InputError.of("displacement", scene.displacement, limit)
    if scene.unloaded != "refused":
        raise InputError.of("unloaded", scene.unloaded, "must be 'refused' where ring = 'free'")
    for name in ("misalignment_x", "misalignment_y"):
        if any(values_of(getattr(scene, name))):
            limit = f"must be 0 where ring = 'free': the ring turns under moment_{name[-1]} (rad)"
            raise InputError.of(name, getattr(scene, name), limit)
    if not is_constant(scene.radial_direction_deg):
        limit = "must be constant where ring = 'free'; use rotating_load for a load that turns (deg)"
        raise InputError.of("radial_direction_deg", scene.radial_direction_deg, limit)
    if scene.torque is not None and scene.ring_body.unbalance > 0.0:
        limit = "must be 0 with torque: what an unbalance takes from the speed of a shaft is not simulated (kg m)"
        raise InputError.of(("ring_body", "unbalance"), scene.ring_body.unbalance, limit)
    if scene.torque is not None and not is_constant(scene.speed_rpm):
        limit = "must be a number with torque: the speed at the start (rpm)"
        raise InputError.of("speed_rpm", scene.speed_rpm, limit)
    if scene.rotating_load is not None and any(values_of(scene.rotating_load.load)):
        by_shaft = scene.rotating_load.frequency_hz is None
        for path, quantity in (
            (("rotating_load", "load"), scene.rotating_load.load),
            (("radial_load",), scene.radial_load),
        ):
            if not is_constant(quantity):
                raise InputError.of(path, quantity, "must be constant with a rotating_load where ring = 'free' (N)")
        if by_shaft and (scene.torque is not None or not is_constant(scene.speed_rpm)):
            limit = "must be 0 where the speed changes; use frequency_hz, or ring_body.unbalance without torque (N)"
            raise InputError.of(("rotating_load", "load"), scene.rotating_load.load, limit)


def counts_from_the_start(scene: Scene) -> bool:
    """Whether forces count from where the inner ring stood at the start: of a supported shaft, or of a housing's support."""
    return scene.housing is not None or (scene.ring_body is not None and scene.ring_body.is_supported)


def check_housing(scene: Scene) -> None:
    """Refuse what does not go together with an outer ring that moves with its housing."""
    if scene.housing is None:
        return
    if scene.ring == "follows":
        limit = "must be 'held' or 'free' with a housing: under a load that changes both rings move, so the ring must be 'free'"
        raise InputError.of("ring", scene.ring, limit)
    if scene.start.kind == "state" and scene.start.displacement is None:
        limit = "must be given with a housing, whose support carries the load of the bearing there: Start.state(sim.state) (m)"
        raise InputError.of(("start", "displacement"), None, limit)
    if scene.start.kind == "state" and scene.start.housing_load is None:
        _check_hold(scene)
    if scene.ring_body is None:
        return
    for name in ("support_radial", "support_axial"):
        stiffness = getattr(scene.housing, name)
        if not stiffness > 0.0 and not getattr(scene.ring_body, name) > 0.0:
            limit = f"must be > 0 where ring = 'free', or ring_body.{name}: nothing else holds both rings in their place (N/m)"
            raise InputError.of(("housing", name), stiffness, limit)


def _check_hold(scene: Scene) -> None:
    """Refuse changes in time of what the support's force follows from: that of the first start, which is not given."""
    limit = "must be constant in a run from a state with a housing, or start.housing_load given: Start.state(sim.state)"
    for path, quantity in (
        (("speed_rpm",), scene.speed_rpm),
        (("outer_speed_rpm",), scene.outer_speed_rpm),
        *((("gravity", place), part) for place, part in enumerate(scene.gravity)),
    ):
        if not is_constant(quantity):
            raise InputError.of(path, quantity, limit)
