"""Everything that follows from a bearing's catalogue numbers. The core derives it; this module gives it names."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core


@dataclass(frozen=True)
class Geometry:
    """Derived geometry of a bearing whose cup, cone and rollers share one apex, or are cylinders. SI units; angles in radians.

    Cylinders have no apex: distances from it are then from the middle of the bearing.

    Attributes
    ----------
    roller_half_angle : float
        nu: half angle of the roller cone (rad).
    roller_axis_angle : float
        alpha_m: angle of the roller axis to the bearing axis (rad).
    cone_half_angle : float
        alpha_i: half angle of the cone (inner) raceway (rad).
    apex_to_mid : float
        Rc: apex to roller mid length along its axis; 0 for cylindrical rollers (m).
    apex_to_large_end : float
        Apex to the large end of the effective length (m).
    outer_race_radius : float
        Radius of the outer raceway at mid roller (m).
    inner_race_radius : float
        Radius of the inner raceway at mid roller (m).
    outer_equivalent_radius : float
        Re at the outer raceway, mid roller (m).
    inner_equivalent_radius : float
        Re at the inner raceway, mid roller (m).
    large_end_diameter : float
        Roller diameter at the large end of the effective length (m).
    small_end_diameter : float
        Roller diameter at the small end of the effective length (m).
    roller_mass : float
        Mass of a roller (kg).
    roller_inertia_axial : float
        Moment of inertia about the roller's axis (kg m2).
    roller_inertia_transverse : float
        Moment of inertia about a transverse axis through the centre of mass (kg m2).
    roller_mass_offset : float
        Centre of mass from mid length, towards the large end (m).
    roller_centre_radius : float
        Radius of the roller's centre of mass from the bearing axis (m).
    roller_centre_height : float
        Axial position of the roller's centre of mass from the apex (m).
    centre_plane : float
        Axial position of the roller-centre plane (mid length) from the apex (m).
    effective_modulus : float
        E' of roller and ring: 2/[(1-v1^2)/E1 + (1-v2^2)/E2] (Pa).
    pocket_modulus : float
        E' of roller and cage (Pa).
    sphere_radius : float
        Rs: radius of the roller's large end (m).
    sphere_centre : float
        Distance from the apex to the large-end sphere's centre, along the roller axis (m).
    rib_normal_angle : float
        Angle of the rib face's normal to the bearing axis (rad).
    rib_contact_radius : float
        Radius of the nominal rib contact from the bearing axis (m).
    rib_contact_z : float
        Axial position of the nominal rib contact from the apex (m).
    rib_curvature_radius : float
        Circumferential radius of curvature of the rib face (concave) (m).
    rib_rx : float
        Rx: equivalent radius at the rib, along rolling (m).
    rib_ry : float
        Ry: equivalent radius at the rib, across rolling (m).
    rib_ellipticity : float
        Ratio of the contact ellipse's semi-axes, >= 1 (1).
    rib_stiffness : float
        K of the Hertz law Q = K d^1.5 at the rib (N/m^1.5).
    rib_semi_axis_rolling : float
        Semi-axis of the rib's ellipse along rolling, per cube root of load (m/N^(1/3)).
    rib_semi_axis_across : float
        Semi-axis of the rib's ellipse across rolling, per cube root of load (m/N^(1/3)).
    cage_speed_ratio : float
        Kinematic cage speed over shaft speed (1).
    roller_spin_ratio : float
        Roller spin in the cage's frame over shaft speed (1).
    small_end_station : float
        Mid length to the small end, along the axis (negative) (m).
    large_end_station : float
        Mid length to the large end, along the axis (m).
    small_end_radius : float
        Roller radius at its small end (m).
    """

    roller_half_angle: float
    roller_axis_angle: float
    cone_half_angle: float
    apex_to_mid: float
    apex_to_large_end: float
    outer_race_radius: float
    inner_race_radius: float
    outer_equivalent_radius: float
    inner_equivalent_radius: float
    large_end_diameter: float
    small_end_diameter: float
    roller_mass: float
    roller_inertia_axial: float
    roller_inertia_transverse: float
    roller_mass_offset: float
    roller_centre_radius: float
    roller_centre_height: float
    centre_plane: float
    effective_modulus: float
    pocket_modulus: float
    sphere_radius: float
    sphere_centre: float
    rib_normal_angle: float
    rib_contact_radius: float
    rib_contact_z: float
    rib_curvature_radius: float
    rib_rx: float
    rib_ry: float
    rib_ellipticity: float
    rib_stiffness: float
    rib_semi_axis_rolling: float
    rib_semi_axis_across: float
    cage_speed_ratio: float
    roller_spin_ratio: float
    small_end_station: float
    large_end_station: float
    small_end_radius: float

    @classmethod
    def from_parameters(cls, block: NDArray[np.float64]) -> Geometry:
        """Geometry of a parameter block.

        Parameters
        ----------
        block : ndarray, shape (P,)
            A value for each row of the core's table of parameters; those that are not a bearing's own may be NaN.

        Raises
        ------
        ValueError
            If the core refuses the numbers (its `CoreInputError`).
        """
        names = [name for name, _, _ in _core.geometry_table()]
        known = {field.name for field in fields(cls)}
        if set(names) != known:
            raise RuntimeError(f"the core's table of geometry and Geometry differ in {sorted(set(names) ^ known)}")
        return cls(**dict(zip(names, _core.geometry(block).tolist(), strict=True)))
