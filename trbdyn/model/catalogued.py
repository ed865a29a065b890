"""Bearings from a catalogue page, or by their designation: class methods of `Bearing`."""

from __future__ import annotations

import pathlib
from typing import Any, Self

from trbdyn.base.validation import Model
from trbdyn.errors import MISSING
from trbdyn.model.catalogue import fields_from_catalogue
from trbdyn.model.designations import designation as row_of


class Catalogued(Model):
    """What can be made from a catalogue page, or by its designation."""

    @classmethod
    def from_catalogue(
        cls,
        *,
        bore: Any = MISSING,
        outside: Any = MISSING,
        width: Any = MISSING,
        C: Any = MISSING,
        e: float | None = None,
        Y: float | None = None,
        C0: float | None = None,
        Y0: float | None = None,
        Cu: float | None = None,
        cup_width: float | None = None,
        n_rollers: int | None = None,
        roller_diameter: float | None = None,
        roller_length: float | None = None,
        pitch_diameter: float | None = None,
        contact_angle_deg: float | None = None,
        cage_mass: float | None = None,
        maker_factor: float | None = None,
        reference_speed_rpm: float | None = None,
        limiting_speed_rpm: float | None = None,
        flanges: str | None = None,
        F: float | None = None,
        E: float | None = None,
        a: float | None = None,
        radial_clearance: float | None = None,
        name: str = "",
        **others: Any,
    ) -> Self:
        """A bearing from the numbers of a catalogue page; what is inside is estimated.

        The angle of the cup follows from e = 1.5 tan(alpha) or Y = 0.4 cot(alpha) (ISO 281). Diameter, length and number of the
        rollers and the maker's factor on C are the least unusual ones with this C; the rest is scaled from the 30310 rig.
        See `estimated`. What is given here derives the others; a later ``replace(n_rollers=17)`` changes that number alone.

        Parameters
        ----------
        bore, outside, width : float
            Boundary dimensions d, D and T, of a cylindrical bearing B (m).
        C, C0, Cu : float
            Ratings and fatigue load limit, also called Pu (N); C alone is needed, the others are for `trbdyn.rating`.
        e, Y, Y0 : float, optional
            Calculation factors; e or Y, or the contact angle, must be given, and they must agree (1). Of a cylindrical bearing
            NJ or NUP e and Y are the maker's for the axial load on its ribs, and need not be given.
        n_rollers : int, optional
            Z.
        roller_diameter, roller_length, pitch_diameter, cup_width : float, optional
            Dwe, Lwe, Dpw, and the width of the cup, often called C beside T and B (m).
        contact_angle_deg, cage_mass : float, optional
            Half angle of the cup (deg); mass of the cage (kg).
        maker_factor : float, optional
            C over the rating of ISO 281 with b_m = 1.1, where it is known; 0.8 to 1.5 (1).
        reference_speed_rpm, limiting_speed_rpm : float, optional
            Speeds that the catalogue permits (rpm): kept for `trbdyn.rating`.
        flanges : {'NU', 'NJ', 'NUP', 'N'}, optional
            Type of a cylindrical bearing; without it the bearing is tapered. With it C0 tells the rollers' number times length.
        F, E : float, optional
            Diameters of the raceways of the inner and the outer ring of a cylindrical bearing (m).
        a : float, optional
            Distance of the load centre of a tapered bearing from the face of its outer ring at the small ends (m): tables of an
            `Assembly` then say where that face is.
        radial_clearance : float, optional
            Clearance of a cylindrical bearing in operation (m), negative: preload; by default half of group N of ISO 5753-1.
        name : str
            Name; by default the boundary dimensions.

        Raises
        ------
        InputError
            If a number is not allowed or contradicts another one, or no rollers of that size come near this C.

        Examples
        --------
        >>> import trbdyn as trb
        >>> bearing = trb.Bearing.from_catalogue(bore=0.080, outside=0.140, width=0.03525, C=187e3, e=0.43)
        >>> print(bearing.estimated[0])
        cup_half_angle_deg = 16 deg (15.82 to 16.17): tan(alpha) = e/1.5 (ISO 281), e as rounded in the catalogue
        """
        given = {
            name: value for name, value in locals().items() if name not in ("cls", "others") and value is not MISSING
        }
        return cls(**fields_from_catalogue(given | others))

    @classmethod
    def named(cls, designation: str, *, table: str | pathlib.Path | None = None, **known: Any) -> Self:
        """A bearing by its designation: boundary dimensions and ratings of a table, the rest estimated as `from_catalogue` does.
        `trbdyn.designation` shows which number is a fact and of which source, and which one is an estimate.

        Parameters
        ----------
        designation : str
            Such as ``"32208"`` or ``"LM67048/LM67010"``, see `trbdyn.designation`.
        table : path-like, optional
            A table of your own, see `trbdyn.designations`.
        **known
            What you know better, by the names of `from_catalogue`: ``C=95e3, n_rollers=17``.

        Raises
        ------
        InputError
            If there is no such row, or it cannot be right.

        Examples
        --------
        >>> import trbdyn as trb
        >>> bearing = trb.Bearing.named("32208")
        >>> bearing.ratings.dynamic, bearing.estimated[0].path
        (77700.0, 'cup_half_angle_deg')
        """
        return cls(**row_of(designation, table=table).fields(**known))
