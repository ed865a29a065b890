"""Effects: the switches and choices of a scene. What is off is not evaluated."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Final, Literal, Self

from pydantic import model_validator

from trbdyn.base.validation import Flag, Model, Number, Whole, split_paths, unit
from trbdyn.errors import InputError, unknown_name
from trbdyn.model.core_table import parameter
from trbdyn.model.lubricants.supply import OIL_SUPPLIES, REPLENISHMENT, ROLLING_SUPPLY, rolling_supply_of

FILMED: Final = ("mixed", "full_film")
"""Kinds of lubrication with films."""


class Friction(Model):
    """Constants of friction and the small speeds that keep its laws smooth.

    Parameters
    ----------
    lambda_boundary, lambda_full : float
        Film parameters below which friction is boundary, and above which the film carries all (1).
    asperity_factor, asperity_exponent : float
        B and C of the share exp(-B Lambda^C) of the load that asperities carry on raceways, with ``mixed_law = 'exponential'``
        (1). They belong to the surfaces: measured were 2.32 and 0.97 for a 32216, 2.1 and 0.85 for a 32208.
    rib_asperity_factor, rib_asperity_exponent : float
        The same at the back-face rib (1).
    boundary_limit, boundary_slope, boundary_decay : float
        mu_bd = (-limit + slope s) exp(-decay s) + limit of the slide-roll ratio s (1).
    rib_boundary_limit : float
        The limit at ribs (1): 0.2 by Aihara 1987, Zhou and Hoeprich 1991 and the starting torques of a maker; the paper has 0.1.
    dry_friction : float
        Coulomb coefficient of dry contacts and of traction 'coulomb' (1); assumed.
    coulomb_speed : float
        Sliding speed over which Coulomb friction turns smoothly through zero (m/s); assumed.
    cage_entrainment_speed : float
        ue, guards the slide-roll ratio where surfaces do not roll (m/s); assumed.
    speed_floor : float
        Smallest mean speed in films and slide-roll ratios, smooth (m/s); assumed.
    thermal_floor : float
        Smallest thermal film reduction factor, smooth (1).
    rolling_blend : float
        Half width in h_PE/h_IR over which rolling resistance sets in, with the laws that are powers (1); assumed.

    Notes
    -----
    Sources: Sakaguchi and Harada 2006, eqs. 2, 6 and 10; Wingertszahn et al. 2023, table 4 (asperities, with 0.2 for
    `boundary_limit`); docs/theory/lubrication.md#mixed-friction.
    """

    lambda_boundary: Annotated[Number, parameter("lambda_boundary")] = 0.01
    lambda_full: Annotated[Number, parameter("lambda_full")] = 1.5
    asperity_factor: Annotated[Number, parameter("asperity_factor")] = 2.32
    asperity_exponent: Annotated[Number, parameter("asperity_exponent")] = 0.97
    rib_asperity_factor: Annotated[Number, parameter("rib_asperity_factor")] = 1.90
    rib_asperity_exponent: Annotated[Number, parameter("rib_asperity_exponent")] = 0.99
    boundary_limit: Annotated[Number, parameter("boundary_limit")] = 0.1
    rib_boundary_limit: Annotated[Number, parameter("rib_boundary_limit")] = 0.2
    boundary_slope: Annotated[Number, parameter("boundary_slope")] = 22.28
    boundary_decay: Annotated[Number, parameter("boundary_decay")] = 181.46
    dry_friction: Annotated[Number, parameter("dry_friction")] = 0.1
    coulomb_speed: Annotated[Number, parameter("coulomb_speed")] = 0.01
    cage_entrainment_speed: Annotated[Number, parameter("cage_entrainment_speed")] = 0.05
    speed_floor: Annotated[Number, parameter("speed_floor")] = 1e-3
    thermal_floor: Annotated[Number, parameter("thermal_floor")] = 0.05
    rolling_blend: Annotated[Number, parameter("rolling_blend")] = 0.1

    def _check(self) -> None:
        if self.lambda_full <= self.lambda_boundary:
            raise InputError.of(
                "lambda_full", self.lambda_full, f"must be > lambda_boundary, {self.lambda_boundary:g} (1)"
            )


def refuse_idle(damping: str, lubrication: str, given: Mapping[str, Any]) -> None:
    """Coefficients that somebody gives, and that the law of damping does not use."""
    if "damping_race" in given and damping == "film" and lubrication in FILMED:
        raise InputError.of(
            "damping_race", given["damping_race"], "acts with damping = 'hunt_crossley' only; damping is 'film' here"
        )
    for name in ("film_damping", "film_damping_depth"):
        if name in given and damping != "film":
            raise InputError.of(name, given[name], f"acts with damping = 'film' only; damping is {damping!r} here")


class Effects(Model):
    """Every switch and choice of a scene; the defaults are those of `standard`.

    They are chosen by physics. The pressure of a rolling contact's film is not symmetric:
    that makes rolling resistance, and it pushes the roller, too. With this force (`rolling_pressure_force`) the moments on a
    roller balance, and both rings carry the same friction torque, as they must in steady rotation; without it they differ by
    about 40 %. The film at the rib is that of a contact
    that is long along rolling, as this one is (`rib_film` 'needle'): the paper's formula for the isoviscous-rigid regime gives
    tens of micrometres there, so that no rib would ever run in mixed friction. Rolling resistance follows numerical solutions of
    the contact, heat of the inlet Aihara's law, which such solutions confirm; the supply of oil is assumed
    (docs/validation.md#friction-torque-beside-measured-values). Contacts damp a little (assumed). `paper` has none of these: it
    repeats the paper.

    Parameters
    ----------
    gravity : bool
        Gravity acts.
    bodies : {'rollers_and_cage', 'rollers_and_spacer', 'rollers'}
        Rollers with their cage, or without one; rollers without a cage must not touch each other. With a spacer in its place they
        orbit at even spacing, at the speed that their tangential forces together give: an ideal cage without play and friction,
        centred in the bearing, with the moment of inertia and the drag of the real one. It costs a small part of the time, for
        torque, loads, films and life; what concerns the cage itself is not known (docs/theory/motion.md#cage-as-a-spacer).
    planar : bool
        Axial positions and tilts of rollers and cage are frozen.
    lubrication : {'mixed', 'full_film', 'boundary', 'dry'}
        How friction arises. Dry: Coulomb friction everywhere. Boundary: the law of eq. 6 alone. Full film: no boundary
        share.
    traction : {'muraki_kimura', 'coulomb', 'none'}
        Friction of films; acts where lubrication is mixed or full film.
    thermal : bool
        Thermal reduction of films; acts where there are films.
    thermal_law : {'gupta', 'aihara'}
        Its law: with pressure and slip, or by the speed alone.
    mixed_law : {'power', 'exponential'}
        Share of boundary friction in mixed lubrication: the sixth power of the paper (eq. 2), which ends at a film parameter of
        1.5, or the share exp(-B Lambda^C) of the load that asperities carry, with the constants of `friction`.
    supply : float or {'bath', 'flooded'}, optional
        Share of the rolling resistance of full contacts that the supply of oil leaves on raceways, or a state of lubrication by
        its name in `trbdyn.lubricants.ROLLING_SUPPLY`. Where it is not stated it is that of a bath, 0.83, or with `oil_fill` 1
        that of a flooded bearing, 1. It is assumed: `trbdyn.uncertainty` has it between 0.7 and 1. Films keep their thickness.
    replenishment : float or {'flooded', 'bath', 'jet', 'oil_air', 'grease'}
        SKF's constant K_rs (for mm2/s, rpm and mm; 0: none), or a state of lubrication by its name in
        `trbdyn.lubricants.REPLENISHMENT`: rolling resistance on raceways falls by exp[-K_rs nu n (d + D) sqrt(6/(2 (D - d)))], as
        fast rollers do not leave enough oil to those that follow. d + D is twice the pitch diameter here, and D - d four roller
        diameters. Films keep their thickness.
    oil_height : float
        Height of the oil before each contact on a raceway (m), 0: as much as it takes. Rolling resistance is that of a contact
        whose meniscus lies where the gap is as high; films keep their thickness.
    flooded_gaps : bool
        Gaps beside the loaded part of a contact, of a crowned or a misaligned roller, are full of oil and resist rolling, too
        (Biboulet and Houpert 2010); acts with `rolling_resistance`.
    hysteresis : float
        Share of a contact's elastic energy that the steel loses as rollers pass (1), 0: none. Johnson has about 0.01; it acts
        with `rolling_resistance`.
    rolling_resistance : bool
        EHL rolling resistance; acts where there are films.
    rolling_law : {'line_solution', 'biboulet_houpert', 'zhou_hoeprich', 'goksem_hargreaves', 'aihara', 'matsuyama'}
        Law of the rolling resistance. The default follows numerical solutions of a contact that is full of oil; the paper's is
        'zhou_hoeprich' (docs/theory/lubrication.md#which-law-of-rolling-resistance).
    rolling_load : {'contact', 'slices'}
        Load in the laws 'zhou_hoeprich' and 'aihara': that of the whole contact over the roller's length, as in the papers of
        these names, or of each slice, as in the paper. With slices a crowned roller counts its load twice: in the pressure of
        the slices and in their number.
    rolling_pressure_force : bool
        Pressure force of the rolling film on the roller; needs `rolling_resistance`, and is off by default without it.
    starvation_factor : float
        Factor of every film thickness, and of rolling resistance (1).
    back_rib, front_rib : bool
        Large and small ends of the rollers against the ribs of the inner ring; of a cylindrical bearing against those of both
        rings, towards +z and towards -z.
    rib_film : {'max', 'pe', 'needle'}
        Film at the back-face rib: the thicker of piezoviscous-elastic and isoviscous-rigid, or the former, or that of a contact
        that is long along rolling (Aihara).
    rib_turning : bool
        Sliding at the back-face rib turns within the contact: friction has a moment about the normal.
    pocket_bars, pocket_ends : bool
        Flank, and ends, of the rollers against the faces of their pockets.
    pocket_edges : bool
        Faces end at their outlines; without it they are unbounded planes.
    pocket_film : float
        Gap between roller and bar in which the oil makes a film (m), where there are films at all: it carries by the wedge that
        the turning roller draws it into, and by its resistance to being pressed out or drawn in. 0: none, as in the paper. How
        much oil a bar has is known in no bearing: compare with 0 and with a few times as much.
    guidance : {'rollers', 'inner_land', 'outer_land'}
        What guides the cage: its rollers alone, or also a land of the inner or outer ring, whose numbers are `Bearing.land`.
        The land has an oil film where lubrication is mixed or full film; below a stated height of the film the cage touches
        it, with the friction of pockets.
    oil_fill : float or {'minimum', 'oil_air', 'bath', 'flooded'}
        Share of oil in the mixture of oil and air round the rollers, from 0 (no drag) to 1 (a flooded bearing), or the name of
        a state of lubrication with its assumed share, `trbdyn.lubricants.OIL_SUPPLIES`: 0.01, 0.03, 0.1 and 1. It is known in no
        bearing: show its effect over a band, which `trbdyn.uncertainty` has for each state. The mixture rests.
    drag_coefficient : float
        Cd of a roller that moves across its axis, on its diameter times its length (assumed; a cylinder alone has 1.0 to
        1.2). Acts where `oil_fill` is not 0.
    damping : {'off', 'hunt_crossley', 'film'}
        Normal damping of contacts, F = q (1 + c d_dot), which never pulls. 'film': raceways and ribs are damped by their oil
        films, c = t/(d + d0), as rolling bearings are by measurement; in scenes without films, which have nothing that damps so,
        and in pockets c is constant, as with 'hunt_crossley'.
    film_damping : float
        t (s): the damping of a contact over its stiffness, about; Kramer (1993) gives 0.25e-5 to 2.5e-5 s for rolling bearings.
    film_damping_depth : float
        d0 (m; assumed): t/d0 is c of rollers that hardly any load presses on a raceway, which float on oil.
    damping_race : float
        c of raceways and ribs (s/m; assumed) where it is constant.
    damping_cage : float
        c of pockets and of the cage on its land (s/m; assumed).
    quadrature : {'uniform', 'gauss'}
        Nodes along a contact line: uniform slices or Gauss-Legendre nodes.
    n_slices : int
        Number of slices or nodes along a contact line; 0: 16, or 24 where a profile drops from the middle of the line on.
    friction : Friction
        Constants of friction.
    """

    gravity: Flag = True
    bodies: Literal["rollers_and_cage", "rollers_and_spacer", "rollers"] = "rollers_and_cage"
    planar: Flag = False
    lubrication: Literal["mixed", "full_film", "boundary", "dry"] = "mixed"
    traction: Literal["muraki_kimura", "coulomb", "none"] = "muraki_kimura"
    thermal: Flag = True
    thermal_law: Literal["gupta", "aihara"] = "aihara"
    mixed_law: Literal["power", "exponential"] = "power"
    supply: Annotated[Number | None, parameter("supply")] = None
    replenishment: Annotated[Number, unit("1", ge=0, le=1e-6)] = 0.0
    oil_height: Annotated[Number, parameter("oil_height")] = 0.0
    flooded_gaps: Flag = False
    hysteresis: Annotated[Number, parameter("hysteresis")] = 0.0
    rolling_resistance: Flag = True
    rolling_law: Literal[
        "line_solution", "biboulet_houpert", "zhou_hoeprich", "goksem_hargreaves", "aihara", "matsuyama"
    ] = "line_solution"
    rolling_load: Literal["contact", "slices"] = "contact"
    rolling_pressure_force: Flag = True
    starvation_factor: Annotated[Number, parameter("starvation_factor")] = 1.0
    back_rib: Flag = True
    front_rib: Flag = True
    rib_film: Literal["max", "pe", "needle"] = "needle"
    rib_turning: Flag = False
    pocket_bars: Flag = True
    pocket_ends: Flag = True
    pocket_edges: Flag = True
    pocket_film: Annotated[Number, parameter("pocket_film")] = 0.0
    guidance: Literal["rollers", "inner_land", "outer_land"] = "rollers"
    oil_fill: Annotated[Number, parameter("oil_fill")] = 0.0
    drag_coefficient: Annotated[Number, parameter("drag_coefficient")] = 1.0
    damping: Literal["off", "hunt_crossley", "film"] = "film"
    film_damping: Annotated[Number, parameter("film_damping")] = 1e-5
    film_damping_depth: Annotated[Number, parameter("film_damping_depth")] = 3e-7
    damping_race: Annotated[Number, parameter("damping_race")] = 0.1
    damping_cage: Annotated[Number, parameter("damping_cage")] = 0.5
    quadrature: Literal["uniform", "gauss"] = "gauss"
    n_slices: Annotated[Whole, parameter("n_slices", ge=0)] = 0
    friction: Friction = Friction()

    @model_validator(mode="before")
    @classmethod
    def _follow(cls, values: Any) -> Any:
        """Without rolling resistance its pressure force is off, unless it is asked for; the name of a supply is its share."""
        if not isinstance(values, dict):
            return values
        if values.get("rolling_resistance") is False and "rolling_pressure_force" not in values:
            values = {**values, "rolling_pressure_force": False}
        # a table out of a file has the coefficients of every law; one of an earlier version lacks the newest fields
        if len(values) < 0.5 * len(cls.model_fields):
            refuse_idle(values.get("damping", "film"), values.get("lubrication", "mixed"), values)
        elif "rolling_load" not in values:
            values = {"rolling_load": "slices", "supply": 1.0, **values}
        states_of: dict[str, tuple[Mapping[str, Any], str]] = {
            "oil_fill": (OIL_SUPPLIES, "1"),
            "replenishment": (REPLENISHMENT, "1e-6"),
            "supply": (ROLLING_SUPPLY, "1"),
        }
        for name, (states, most) in states_of.items():
            if isinstance(state := values.get(name), str):
                if state not in states:
                    limit = f"must be from 0 to {most}, or a name: {unknown_name(state, states)}"
                    raise InputError.of(name, state, limit)
                values = {**values, name: states[state][0]}
        return values

    def _check(self) -> None:
        if self.rolling_pressure_force and not self.rolling_resistance:
            raise InputError.of("rolling_pressure_force", True, "needs rolling_resistance = True")
        if self.guidance != "rollers" and not self.has_cage:
            raise InputError.of("guidance", self.guidance, "needs a cage: bodies = 'rollers_and_cage'")
        if self.n_slices == 1 and not self.back_rib:
            raise InputError.of("n_slices", 1, "must be >= 2 without back_rib: one slice lets rollers tilt freely")

    def replace(self, changes: Mapping[str, Any] | None = None, /, **fields: Any) -> Self:
        """As of every input; a coefficient of damping that would act nowhere is refused."""
        fields = {**(self._changed(split_paths(changes)) if changes is not None else {}), **fields}
        refuse_idle(fields.get("damping", self.damping), fields.get("lubrication", self.lubrication), fields)
        return super().replace(**fields)

    @property
    def has_cage(self) -> bool:
        """Whether there is a cage with pockets: not where rollers are alone, or a spacer holds them."""
        return self.bodies == "rollers_and_cage"

    @property
    def has_pockets(self) -> bool:
        """Whether rollers can touch the faces of pockets."""
        return self.has_cage and (self.pocket_bars or self.pocket_ends)

    @property
    def rolling_supply(self) -> float:
        """Share of rolling resistance that the supply of oil leaves (1): `supply`, or that of the state by `oil_fill`."""
        return rolling_supply_of(self.oil_fill).value if self.supply is None else self.supply

    @property
    def films(self) -> bool:
        """Whether contacts have lubricant films."""
        return self.lubrication in FILMED

    @classmethod
    def standard(cls) -> Self:
        """What we recommend, and the default: the paper's effects, and the rolling film's pressure force (torques on both rings
        agree), rolling resistance by numerical solutions of the contact with Aihara's heat of the inlet and the supply of a bath,
        normal damping, the film of a needle contact and twice the paper's boundary friction at ribs, Gauss nodes.
        """
        return cls()

    @classmethod
    def paper(cls) -> Self:
        """The assumptions of Sakaguchi and Harada 2006, errata corrected: no damping, no pressure force of the rolling film,
        the law of rolling resistance of Zhou and Hoeprich in every slice, full supply, uniform slices.
        """
        return cls(
            thermal_law="gupta",
            rolling_law="zhou_hoeprich",
            rolling_load="slices",
            supply=1.0,
            rolling_pressure_force=False,
            rib_film="max",
            damping="off",
            quadrature="uniform",
            n_slices=24,
            friction=Friction(rib_boundary_limit=0.1),
        )

    @classmethod
    def frictionless(cls) -> Self:
        """Normal contact alone: no friction, no rolling resistance, no damping. Energy is conserved."""
        return cls.paper().replace(lubrication="full_film", traction="none", thermal=False, rolling_resistance=False)

    @classmethod
    def minimal(cls) -> Self:
        """The least that turns a bearing: planar motion, dry Coulomb friction, no front rib, no pocket ends."""
        return cls.paper().replace(
            planar=True,
            lubrication="dry",
            traction="coulomb",
            thermal=False,
            rolling_resistance=False,
            front_rib=False,
            pocket_ends=False,
            quadrature="gauss",
            n_slices=8,
        )


PRESETS = {
    "standard": Effects.standard,
    "paper": Effects.paper,
    "frictionless": Effects.frictionless,
    "minimal": Effects.minimal,
}
