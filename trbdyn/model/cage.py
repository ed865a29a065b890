"""The cage of a bearing."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Annotated, ClassVar

from trbdyn.base.extras import of_extras
from trbdyn.base.validation import Gap, Length, Model, Number, unit
from trbdyn.errors import InputError
from trbdyn.model.assumed import RIG
from trbdyn.model.cage_body import CageBody
from trbdyn.model.cage_drawing import CageDrawing
from trbdyn.model.core_table import parameter
from trbdyn.model.material import Material
from trbdyn.model.pocket import OtherPocket, Pocket

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing


class Cage(Model):
    """The cage and its pockets. What is not given is assumed in proportion to the 30310 rig: lengths with the roller's
    diameter unless it is said otherwise.

    Parameters
    ----------
    mass : float
        Mass (kg); by default it follows from `body`, or else it is 0.2 kg times pitch diameter, roller diameter, roller
        length and density of the material over those of the rig, a cage of steel.
    inertia_axial, inertia_transverse : float
        Moments of inertia about its axis, and about a transverse axis through its centre of mass (kg m2); by default
        with mass and radius squared (what lies along the axis: with length squared), so that they follow a mass
        that is changed; with a `body` they are its own, in proportion to the mass. Given ones must belong to the mass: no
        cage has its mass outside of the bearing.
    play_radial, play_circumferential : float
        Cpr and Cpc: plays in the x-y plane, radial and circumferential, one-sided, measured to one roller with the cage
        centred and the roller's large end touching its pocket (m); by default 0.25/14 and 0.12/14 of the diameter.
    play_axial : float
        Play along the roller's axis from large-end to small-end contact (m); by default 0.4/14 of the diameter.
    offset : float
        Axial position of the centre of mass from the roller-centre plane (m); that of the `body`, or 0 (assumed).
    unbalance : float
        Unbalance: mass times distance of the centre of mass from the axis of the pockets (kg m; 1 g mm is 1e-6 kg m).
    unbalance_direction_deg : float
        Direction of the centre of mass, from the middle of pocket 0 in the direction of positive rotation (deg).
    rail_offset : float
        Axial position of the large-end rail, where sensors look, from the roller-centre plane (m); by default 12/19.8
        of the roller's length.
    bar_width : float
        Width of the bars' faces across the contact line (m); by default 3/14 of the diameter.
    wall_inner, wall_outer : float
        Inner and outer edge of the end walls' bands, outward of the roller's axis (m); by default 1.5/14 and 4.5/14 of
        the diameter, at most 0.3 and 0.9 of the small end's radius.
    wall_half_width : float
        Half width of the end walls' bands (m); by default 6/14 of the diameter.
    pocket : Pocket, optional
        Faces of every pocket; without it the default pocket of `trbdyn.pocket_shapes` is built from the plays.
    other_pockets : sequence of OtherPocket
        Pockets that differ from the others.
    material : Material, optional
        What it is made of; that of the bearing by default.
    body : CageBody, optional
        Its rims and bars, from which mass, centre and moments of inertia follow.
    drawing : CageDrawing, optional
        The drawing it was read from (`from_step`); not together with a `body`.
    """

    _assumed: ClassVar[bool] = True

    mass: Annotated[Number, parameter("cage_mass")] = RIG["mass"]
    inertia_axial: Annotated[Number, parameter("cage_inertia_axial")] = RIG["inertia_axial"]
    inertia_transverse: Annotated[Number, parameter("cage_inertia_transverse")] = RIG["inertia_transverse"]
    play_radial: Length = RIG["play_radial"]
    play_circumferential: Length = RIG["play_circumferential"]
    play_axial: Gap = RIG["play_axial"]
    offset: Annotated[Number, parameter("cage_offset")] = 0.0
    unbalance: Annotated[Number, unit("kg m", ge=0)] = 0.0
    unbalance_direction_deg: Annotated[Number, unit("deg")] = 0.0
    rail_offset: Annotated[Number, parameter("cage_rail_offset")] = RIG["rail_offset"]
    bar_width: Length = RIG["bar_width"]
    wall_inner: Gap = RIG["wall_inner"]
    wall_outer: Length = RIG["wall_outer"]
    wall_half_width: Length = RIG["wall_half_width"]
    pocket: Pocket | None = None
    other_pockets: tuple[OtherPocket, ...] = ()
    material: Material | None = None
    body: CageBody | None = None
    drawing: CageDrawing | None = None

    @classmethod
    def from_step(
        cls,
        path: str | os.PathLike[str],
        bearing: Bearing,
        *,
        material: Material | None = None,
        tolerance: float = 1e-6,
        unit: str = "mm",
        roller_plane: float | None = None,
        chamfer: float | None = None,
    ) -> Cage:
        """A cage as drawn: its pockets with all faces that a roller can touch, plays, mass, centre and moments of inertia.

        The cage is placed so that bars of both sides have the same gap and the large ends of the rollers just touch their walls.
        Plane faces are exact, curved faces are facets. It needs the extra ``trbdyn[cad]``
        (docs/theory/geometry.md#pockets-from-a-drawing).

        Parameters
        ----------
        path : path-like
            STEP file (``.step``, ``.stp``), which tells its unit, or STL file, of one solid.
        bearing : Bearing
            The bearing whose cage it is.
        material : Material, optional
            What it is made of; that of the bearing by default. Its density gives the mass.
        tolerance : float
            Largest distance between a curved face and its facets (m).
        unit : {'mm', 'm', 'inch'}
            Unit of an STL file; a STEP file tells its own.
        roller_plane : float, optional
            Height of the roller-centre plane above the cage's centre of volume, positive towards the large ends (m); needed where
            no wall faces the large ends.
        chamfer : float, optional
            Radius by which the edges of the roller's ends are rounded (m); half of total less effective length by default.
            Corners of a window up to this radius are free of the roller.

        Raises
        ------
        InputError
            If an argument is not allowed, or the cage does not belong to the bearing.
        FileError
            If the file cannot be read, is drawn in another unit than it says, or what is in it is not understood, as a corner of
            a window that the end of a roller would meet; the message names the face.
        ImportError
            If the extra is not installed.
        """
        how = {"tolerance": tolerance, "unit": unit, "roller_plane": roller_plane, "chamfer": chamfer}
        drawn = of_extras("read_cage")(path, bearing, **how)
        density = (material or bearing.material).density
        if density is None:
            raise InputError.of(("material", "density"), None, "must be given: the cage's mass follows from it (kg/m3)")
        return cls(**drawn.fields(density), material=material)

    def _check(self) -> None:
        given = self.model_fields_set
        if {"inertia_axial", "inertia_transverse"} <= given and self.inertia_axial > 2.0 * self.inertia_transverse:
            limit = f"must be <= 2 inertia_transverse, {2 * self.inertia_transverse:g} (kg m2): no body has more"
            raise InputError.of("inertia_axial", self.inertia_axial, limit)
        if self.body is not None and self.drawing is not None:
            raise InputError.of(
                "body", "given", "must not be given together with a drawing, which has rims and bars of its own"
            )
        if {"wall_inner", "wall_outer"} <= given and self.wall_outer <= self.wall_inner:
            raise InputError.of("wall_outer", self.wall_outer, f"must be > wall_inner, {self.wall_inner:g} (m)")
        indices = [other.index for other in self.other_pockets]
        for place, index in enumerate(indices):
            if index in indices[:place]:
                raise InputError.of(("other_pockets", place, "index"), index, "must differ from the other indices")
