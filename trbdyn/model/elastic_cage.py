"""A cage that deforms by its natural modes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, ClassVar, Final

from pydantic import Field

from trbdyn.base.own_files import digest_of
from trbdyn.base.validation import Model, Number, Whole, unit
from trbdyn.errors import FileError, InputError
from trbdyn.model.core_table import parameter

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene


LEAST_WHOLE_BARS: Final = 3
"""Bars that hold both rims of a cracked cage together."""


class ElasticCage(Model):
    """How the cage of a scene deforms: by the lowest natural modes of its finite elements, or of a file
    (docs/theory/cage.md#an-elastic-cage).

    Parameters
    ----------
    n_modes : int
        Number of modes, from the lowest on.
    damping_ratio : float, optional
        Damping of every mode over the critical one (1); by default that of the cage's material, or of the file.
    fineness : int
        Into how many parts each edge of the coarsest finite-element mesh is divided. It has no meaning for modes of a file.
    cracked_bars : tuple of int
        Bars of the finite-element model that are cracked through at their root at the small end; bar k lies behind pocket k in
        the direction of rotation. The surfaces of a crack pass through each other.
    file : str, optional
        File of modes that `trbdyn.extras.elastic.modes.CageModes.save`, or a finite-element program's script, has written.
        Without it the modes are those of a finite-element model, made from ``bearing.cage.body``, or meshed from
        ``bearing.cage.drawing``, and the cage's material.
    file_sha256 : str, optional
        SHA-256 of that file, by which another file of the same name is found out; by default it is taken from the file.

    Raises
    ------
    InputError
        If a number is not allowed, or the file cannot be read.

    Examples
    --------
    >>> import trbdyn as trb
    >>> bearing = trb.cases.rig_30310().replace({"cage.body": trb.cases.cage_body_30310()})
    >>> scene = trb.Scene(bearing, speed_rpm=3000, axial_load=4930.0, elastic_cage=trb.ElasticCage(n_modes=6))
    >>> trb.Simulation(scene).record()["cage_mode"].shape
    (6,)
    """

    _root: ClassVar[str | None] = "elastic_cage"

    n_modes: Annotated[Whole, parameter("cage_modes", ge=1)] = 20
    damping_ratio: Annotated[Number | None, unit("1", ge=0.0, lt=1.0)] = None
    fineness: Annotated[Whole, unit("1", ge=1, le=3)] = 1
    cracked_bars: tuple[Annotated[Whole, unit("1", ge=0)], ...] = ()
    file: Annotated[str | None, Field(min_length=1)] = None
    file_sha256: Annotated[str | None, Field(min_length=64, max_length=64)] = None

    def _check(self) -> None:
        if self.file is not None and self.cracked_bars:
            raise InputError.of(
                "cracked_bars", self.cracked_bars, "must not be given with a file, whose modes know its cracks"
            )
        if self.file is None and self.file_sha256 is not None:
            raise InputError.of("file_sha256", self.file_sha256, "must not be given without a file")
        if self.file is not None and self.file_sha256 is None:
            try:
                object.__setattr__(self, "file_sha256", digest_of(self.file))
            except FileError as error:
                raise InputError.of("file", self.file, f"must be a file of modes: {error}") from None


def check_elastic_cage(scene: Scene) -> None:
    """Refuse what does not go together with an elastic cage."""
    elastic, cage = scene.elastic_cage, scene.bearing.cage
    if elastic is None:
        return
    for name, allowed in (("bodies", "rollers_and_cage"), ("planar", False), ("guidance", "rollers")):
        if (given := getattr(scene.effects, name)) != allowed:
            raise InputError.of(("effects", name), given, f"must be {allowed!r} with an elastic_cage")
    if elastic.file is not None:
        return
    if cage.drawing is not None and elastic.cracked_bars:
        limit = "must not be given with a cage from a drawing: draw the crack"
        raise InputError.of(("elastic_cage", "cracked_bars"), elastic.cracked_bars, limit)
    if cage.body is None and cage.drawing is None:
        limit = "must be given where elastic_cage has no file: elements need rims and bars (trb.CageBody), or a drawing"
        raise InputError.of(("bearing", "cage", "body"), None, limit)
    whole = scene.bearing.n_rollers - len(set(elastic.cracked_bars))
    if any(bar >= scene.bearing.n_rollers for bar in elastic.cracked_bars) or whole < LEAST_WHOLE_BARS:
        limit = f"must be numbers from 0 to {scene.bearing.n_rollers - 1}, and leave {LEAST_WHOLE_BARS} whole bars"
        raise InputError.of(("elastic_cage", "cracked_bars"), elastic.cracked_bars, limit)
    for name, needed in (("density", True), ("damping_ratio", elastic.damping_ratio is None)):
        if needed and getattr(scene.bearing.cage_material, name) is None:
            limit = "must be given: natural modes of the cage need it"
            raise InputError.of(("bearing", "cage", "material", name), None, limit)
