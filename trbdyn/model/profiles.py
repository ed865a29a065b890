"""Drops of the profiles of rollers and raceways along the contact line (docs/theory/geometry.md#roller-profile)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from trbdyn import laws
from trbdyn.model.contact_line import stations

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing
    from trbdyn.model.roller import Profile
    from trbdyn.model.scene import Scene

Array = NDArray[np.float64]


def drop_of(bearing: Bearing, profile: Profile, places: ArrayLike) -> Array:
    """Drop of a profile of a bearing below the straight cone (m), shape (n,), at places from mid length along the axis (m); those
    beyond the effective length have the drop of its ends.
    """
    roller = bearing.roller
    half = 0.5 * roller.effective_length
    place = np.clip(np.asarray(places, dtype=float), -half, half)
    match profile.kind:
        case "crowned":
            drop = laws.profile_crowned(station=place, radius=profile.crown_radius)
        case "logarithmic":
            drop = laws.profile_logarithmic(
                station=place,
                length=roller.effective_length,
                k1=profile.k1,
                k2=profile.k2,
                zm=profile.zm,
                load=profile.load,
                effective_modulus=bearing.geometry.effective_modulus,
            )
        case "iso":
            scale = profile.a_p * roller.diameter
            drop = laws.profile_iso(
                station=place, scale=scale, length=profile.c_p, straight=profile.d_p, exponent=profile.k_p
            )
        case "table":
            drop = scipy.interpolate.PchipInterpolator(profile.stations, profile.drops)(place)
        case _:
            drop = np.zeros_like(place)
    return np.asarray(drop)


def profile_drop(bearing: Bearing, places: ArrayLike) -> Array:
    """Drop of the rollers' profile (m), as `drop_of`."""
    return drop_of(bearing, bearing.roller.profile, places)


def raceway_drops(bearing: Bearing, places: ArrayLike) -> Array:
    """Drops of the raceways' profiles (m), shape (2, n): cup, cone."""
    none = np.zeros_like(np.asarray(places, dtype=float))
    given = (bearing.cup_profile, bearing.cone_profile)
    return np.array([none if profile is None else drop_of(bearing, profile, places) for profile in given])


def drop_rows(scene: Scene) -> Array:
    """Rows for the core, where rollers have a table or a raceway a profile: what its parameters do not give; else none."""
    bearing, places = scene.bearing, stations(scene)
    raceways = raceway_drops(bearing, places)
    table = bearing.roller.profile.kind == "table"
    if not table and not raceways.any():
        return np.zeros((0, places.size))
    return np.vstack([profile_drop(bearing, places) if table else np.zeros_like(places), raceways])
