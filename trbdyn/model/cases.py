"""Bearings and scenes that ship with the package."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

from trbdyn.model.bearing import Bearing, Cage, CageBody, Profile, Ribs, Roller
from trbdyn.model.effects import Effects
from trbdyn.model.lubricants import vg100
from trbdyn.model.scene import Scene

__all__ = [
    "BEARINGS",
    "MEASURED_TORQUE_32216",
    "MEASURED_TORQUE_32216_COMBINED",
    "OPERATING_POINTS",
    "OperatingPoint",
    "bearing_32216",
    "bearing_nj210",
    "cage_body_30310",
    "paper_30310",
    "rig_30310",
    "scene_30310",
    "scene_32216",
    "scene_nj210",
]


def __dir__() -> list[str]:
    return sorted(__all__)


@dataclass(frozen=True)
class OperatingPoint:
    """Speed and loads of a measurement.

    Attributes
    ----------
    speed_rpm : float
        Speed of the inner ring (rpm).
    axial_load : float
        Axial load (N).
    radial_load : float
        Radial load (N).
    """

    speed_rpm: float
    axial_load: float
    radial_load: float = 0.0

    @property
    def name(self) -> str:
        """For instance ``3000rpm_4930N`` or ``2000rpm_4930N_5530N``."""
        loads = f"{self.axial_load:g}N" + (f"_{self.radial_load:g}N" if self.radial_load else "")
        return f"{self.speed_rpm:g}rpm_{loads}"


_SPEEDS = (1000.0, 2000.0, 3000.0)

OPERATING_POINTS: Final = {
    point.name: point
    for point in (
        *(OperatingPoint(speed, axial) for axial in (1230.0, 3080.0, 4930.0) for speed in _SPEEDS),
        *(OperatingPoint(speed, 4930.0, radial) for radial in (2780.0, 5530.0, 8380.0) for speed in _SPEEDS),
    )
}
"""The paper's speeds and loads (Sakaguchi and Harada 2006) for the 30310 rig, by name."""

MEASURED_TORQUE_32216: Final = {500.0: 1.30, 2000.0: 2.95, 4000.0: 3.75}
"""Measured torque (N m) of the 32216 at an axial load of 6 kN, FVA3 at 50 C, by speed (rpm); Wingertszahn et al. 2023.

Read from a figure. 1.20, 2.75 and 3.80 N m, which are quoted as well, are results of that paper's own simulation.
"""

MEASURED_TORQUE_32216_COMBINED: Final = {500.0: 1.50, 1000.0: 1.95, 2000.0: 2.50, 4000.0: 3.25}
"""The same at an axial load of 6 kN with a radial load of 6.5 kN."""


def rig_30310() -> Bearing:
    """The test bearing of Sakaguchi and Harada 2006: equivalent of 30310 (50 x 110 x 29.25 mm), 12 rollers.

    The design load of the rollers' profile is the outer load of a roller at an axial load of 4930 N (assumed).
    """
    return Bearing(
        name="30310",
        n_rollers=12,
        cup_half_angle_deg=12.0 + 57.0 / 60.0 + 10.0 / 3600.0,
        pitch_diameter=82.389e-3,
        roller=Roller(
            diameter=14.0e-3, effective_length=19.8e-3, total_length=20.8e-3, profile=Profile.logarithmic(1833.0)
        ),
        ribs=Ribs(contact_height=1.667e-3),
        cage=Cage(
            mass=0.20,  # inertias: 3.9e-4 and 2.1e-4 kg m2, the defaults
            play_radial=0.25e-3,
            play_circumferential=0.12e-3,
        ),
    )


def cage_body_30310() -> CageBody:
    """Rims and bars for the cage of `rig_30310`. No source gives them: thickness and width of the rims (equal ones) are
    chosen so that a cage of steel has the mass of the rig's, 0.200 kg; axial and transverse moments of inertia then are 1 %
    and 4 % above the rig's, to which nothing was fitted. Windows, height and length of the bars follow from the rig's pockets.
    """
    return CageBody(thickness=5e-3, small_rim_width=4.8e-3, large_rim_width=4.8e-3)


def bearing_32216() -> Bearing:
    """A 32216 (80 x 140 x 35.25 mm) from catalogue numbers; 16 rollers.

    Known are the pitch diameter, diameter, length and number of the rollers (Wingertszahn et al. 2023, Lubricants
    11:369). That source gives no cup angle: it is that of ISO 355 for the series 3EC, 15 deg 38' 32", which agrees
    with the catalogues' e = 0.42 to 0.43 = 1.5 tan(alpha). All other numbers are assumed: those of the 30310 rig,
    lengths of rib and pocket scaled with the roller's diameter (17/14), bars with its length, the cage's mass with
    pitch diameter squared times length, its inertias with pitch diameter squared in addition. The rollers' profile is that of
    table 4 of the source: a_p = 0.0005, c_p = 20.7 mm (the length less the edge radii of 1.0 mm), d_p = 0, k_p = 2 of the general
    form of ISO/TS 16281. That a_p multiplies the roller's diameter is inferred: the table gives it no unit, 0.0005 and 0.00035
    are the standard's constants, and only so the source's own simulation comes within reach.
    """
    rig = rig_30310()
    scale = 17.0 / 14.0
    length, pitch_diameter = 22.7e-3, 108.5e-3
    mass = (pitch_diameter / rig.pitch_diameter) ** 2 * length / rig.roller.effective_length
    return Bearing(
        name="32216",
        bore=80e-3,
        outside=140e-3,
        width=35.25e-3,
        n_rollers=16,
        cup_half_angle_deg=15.0 + 38.0 / 60.0 + 32.0 / 3600.0,
        pitch_diameter=pitch_diameter,
        roller=Roller(
            diameter=17.0e-3,
            effective_length=length,
            total_length=length + 1.0e-3,
            profile=Profile.iso(a_p=0.0005, c_p=20.7e-3, d_p=0.0, k_p=2.0),
            end_stiffness=rig.roller.end_stiffness,
        ),
        ribs=Ribs(
            contact_height=scale * rig.ribs.contact_height,
            edge_low=scale * rig.ribs.edge_low,
            edge_high=scale * rig.ribs.edge_high,
            front_clearance=rig.ribs.front_clearance,
            front_low=scale * rig.ribs.front_low,
            front_high=scale * rig.ribs.front_high,
        ),
        cage=Cage(
            mass=mass * rig.cage.mass,
            play_radial=scale * rig.cage.play_radial,
            play_circumferential=scale * rig.cage.play_circumferential,
            play_axial=scale * rig.cage.play_axial,
            rail_offset=rig.cage.rail_offset * length / rig.roller.effective_length,
            bar_width=scale * rig.cage.bar_width,
            wall_inner=scale * rig.cage.wall_inner,
            wall_outer=scale * rig.cage.wall_outer,
            wall_half_width=scale * rig.cage.wall_half_width,
        ),
    )


def scene_30310(
    speed_rpm: float = 3000.0, axial_load: float = 4930.0, radial_load: float = 0.0, **changes: Any
) -> Scene:
    """The 30310 rig: VG100 at 60 C, effects as by default (`Effects.standard`).

    Parameters
    ----------
    speed_rpm : float
        Speed of the inner ring (rpm).
    axial_load, radial_load : float
        Loads (N); the radial load acts on the inner ring along +y (loaded zone on top).
    **changes
        Other fields of `Scene`.

    See Also
    --------
    paper_30310 : The same with the effects of the paper.
    """
    return _scene(rig_30310, 60.0, speed_rpm, axial_load, radial_load, changes)


def paper_30310(
    speed_rpm: float = 3000.0, axial_load: float = 4930.0, radial_load: float = 0.0, **changes: Any
) -> Scene:
    """The 30310 rig as Sakaguchi and Harada 2006 simulated it: VG100 at 60 C, `Effects.paper`.

    It is there to repeat the paper. The torques of its two rings differ, as the paper leaves out the force of the rolling film's
    pressure on the rollers; `scene_30310` is the scene for a design.

    Parameters
    ----------
    speed_rpm, axial_load, radial_load, **changes
        As in `scene_30310`.
    """
    return scene_30310(speed_rpm, axial_load, radial_load, **{"effects": Effects.paper(), **changes})


def scene_32216(
    speed_rpm: float = 2000.0, axial_load: float = 6000.0, radial_load: float = 0.0, **changes: Any
) -> Scene:
    """The 32216: FVA3 at 50 C, effects as by default (`Effects.standard`).

    Parameters
    ----------
    speed_rpm, axial_load, radial_load, **changes
        As in `scene_30310`; the torque is known at the speeds of `MEASURED_TORQUE_32216`.
    """
    return _scene(bearing_32216, 50.0, speed_rpm, axial_load, radial_load, changes)


def bearing_nj210() -> Bearing:
    """A cylindrical NJ 210 (50 x 90 x 20 mm, ISO 15) with its ribs: two of the outer ring, one of the inner ring.

    Raceways of 59.5 and 81.5 mm, as catalogues have them (F and E), give rollers of 11 mm; 16 of them with an effective length of
    10.6 mm have the static rating of 69.5 kN (ISO 76). Number and length, ends, ribs and cage are estimates.
    """
    return Bearing(
        name="NJ 210",
        bore=50e-3,
        outside=90e-3,
        width=20e-3,
        n_rollers=16,
        cup_half_angle_deg=0.0,
        pitch_diameter=70.5e-3,
        radial_clearance=20e-6,
        roller=Roller(diameter=11e-3, effective_length=10.6e-3, total_length=11e-3),
        ribs=Ribs(flanges="NJ"),
    )


def scene_nj210(
    speed_rpm: float = 3000.0, axial_load: float = 500.0, radial_load: float = 5000.0, **changes: Any
) -> Scene:
    """The NJ 210: VG100 at 60 C, effects as by default (`Effects.standard`).

    Parameters
    ----------
    speed_rpm, axial_load, radial_load, **changes
        As in `scene_30310`; the axial load is carried by a rib of each ring.
    """
    return _scene(bearing_nj210, 60.0, speed_rpm, axial_load, radial_load, changes)


def _scene(
    make: Callable[[], Bearing],
    temperature_c: float,
    speed_rpm: float,
    axial_load: float,
    radial_load: float,
    changes: dict[str, Any],
) -> Scene:
    """A scene of a shipped bearing in VG100 (FVA3); `changes` may hold another bearing and any other field."""
    fields = {"lubricant": vg100(temperature_c=temperature_c), **changes}
    bearing = fields.pop("bearing", None) or make()
    return Scene(bearing, speed_rpm=speed_rpm, axial_load=axial_load, radial_load=radial_load, **fields)


BEARINGS: Final[dict[str, Callable[[], Bearing]]] = {
    "30310": rig_30310,
    "32216": bearing_32216,
    "nj210": bearing_nj210,
}
"""Shipped bearings by name, as TOML cases call for them."""
