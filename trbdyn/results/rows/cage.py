"""Numbers of the motion of the cage and the rollers, and of the forces in the pockets."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.extras import of_extras
from trbdyn.results import notes, observables
from trbdyn.results.confidence import percentile_as_mean
from trbdyn.results.number import Number, Seen
from trbdyn.results.rows.contacts import extreme

if TYPE_CHECKING:
    from trbdyn.results.records import Records

Array = NDArray[np.float64]

RECORDS_AT_ONCE: Final = 4096
"""Records whose deformed cages are in memory together."""


def has_pockets(seen: Seen) -> bool:
    return seen.run.scene.effects.has_pockets


def has_cage(seen: Seen) -> bool:
    return seen.run.has_cage


def has_growth(seen: Seen) -> bool:
    return seen.run.scene.growth is not None and seen.run.has_cage


def has_land(seen: Seen) -> bool:
    return seen.run.scene.effects.guidance != "rollers"


def is_elastic(seen: Seen) -> bool:
    return seen.run.scene.elastic_cage is not None


def rolls(seen: Seen) -> bool:
    return "cage_speed_ratio" in seen.run.geometry


def drops(seen: Seen) -> bool:
    return has_pockets(seen) and len(seen.run) > 1 and notes.load_drops(seen.run)


def _percentile(of: Callable[[Seen], Array], share: float) -> Callable[[Seen], float]:
    return lambda seen: np.percentile(of(seen), share)


def _orbit(seen: Seen) -> Array:
    return seen.orbit


def _distance(seen: Seen) -> Array:
    return seen.distance


def orbit_as_mean(window: Records) -> Array:
    """A series whose mean changes as the root mean square of the orbit, to first order."""
    orbit = window.orbit_radius_over_cpr
    size = math.sqrt(float(np.mean(orbit**2)))
    return 0.5 * (orbit**2 / size + size) if size > 0.0 else orbit


def orbit_percentile(share: float, window: Records) -> Array:
    """The same for a percentile of the orbit."""
    place = window["cage_position"][:, :2] / window.clearances.radial
    return percentile_as_mean(window.orbit_radius_over_cpr, share, place - place.mean(axis=0))


def distance_percentile(share: float, window: Records) -> Array:
    """The same for a percentile of the distance from the bearing axis."""
    return percentile_as_mean(window.axis_distance_over_cpr, share, None)


def _kinematic_ratio(seen: Seen) -> float | None:
    """Speed of the cage over that of the shaft, or of the outer ring where the shaft rests, in pure rolling."""
    window = seen.window
    ratio: float | None = window.geometry.get("cage_speed_ratio")
    if ratio is None or not window.scene.outer_turns:
        return ratio
    return float(window.rolling_orbit.mean() / window.turning_speed.mean())


def _deflection(seen: Seen) -> float | None:
    """Largest displacement of the middle of a face by the modes of an elastic cage's finite-element model, at any record."""
    result, elastic = seen.run, seen.run.scene.elastic_cage
    if elastic is None or (elastic.file or result.scene.bearing.cage.drawing) is not None:
        return None  # a summary opens no file whose name stands in a result
    shape, largest = of_extras("cage_modes")(result.scene).shape[:, :, :3], 0.0
    for first in range(0, len(result), RECORDS_AT_ONCE):
        amplitude = result["cage_mode"][first : first + RECORDS_AT_ONCE]
        largest = max(largest, float(np.linalg.norm(np.tensordot(amplitude, shape, 1), axis=2).max()))
    return largest


def _usual_pocket_force(seen: Seen) -> float:
    force = seen.window["pocket_force"]
    touched = force[force > 0]
    return np.percentile(touched, 95.0) if touched.size else 0.0


def _band(end: int, seen: Seen) -> float | None:
    """Ends of the band of the largest pocket force after a load that dropped."""
    peak = seen.peaks["pocket_force_peak"]
    return None if np.isnan(peak).all() else notes.drop_band(float(np.nanmax(peak)))[end]


CAGE: Final[dict[str, Any]] = {"groups": ("cage",), "exists": has_cage, "interval": "motion"}
BELOW: Final = "Below this for {} % of the time."

MOTION: Final = (
    Number(
        "cage_speed_ratio",
        "cage speed / shaft speed",
        "",
        "Turns of the cage for each turn of the shaft.",
        lambda seen: seen.window.cage_speed_ratio,
        groups=("cage",),
        exists=has_cage,
        interval="load",
        shown=frozenset({"report"}),
    ),
    Number(
        "cage_speed_ratio_kinematic",
        "the same, pure rolling",
        "",
        "The same if all rollers rolled without slip.",
        _kinematic_ratio,
        groups=("rollers",),
    ),
    Number(
        "cage_slip",
        "slip of the roller set",
        "",
        "How much slower than pure rolling the roller set goes round.",
        lambda seen: seen.window.cage_slip.mean(),
        groups=("rollers",),
        exists=rolls,
        interval="load",
        least=1e-4,
        shown=frozenset({"page"}),
    ),
    Number(
        "cage_motion",
        "cage motion",
        "",
        "Stable: the centre stays at a place. Rocking: it hangs beside the bearing axis and moves about that place. "
        "Circling: it goes round the axis in one sense. Unstable: none of these. Unknown: the run is too short.",
        lambda seen: seen.motion.kind,
        "words",
        groups=("cage",),
        exists=has_cage,
        shown=frozenset({"result", "sweep"}),
        source="docs/theory/whirl.md",
    ),
    Number(
        "orbit_rms_over_cpr",
        "orbit radius of the cage about its mean place, rms / Cpr",
        "",
        "How far the cage's centre moves about its mean place, over the radial play: the whirl's size.",
        lambda seen: seen.motion.orbit_over_play,
        "rms",
        **CAGE,
        series=orbit_as_mean,
        least=0.01,
        grows=1.0,
        shown=frozenset({"result", "report", "shaft", "sweep", "page", "band", "ensemble"}),
        source="docs/theory/whirl.md",
    ),
    *(
        Number(
            f"orbit_radius_over_cpr_p{share:02d}",
            f"    {share} %",
            "",
            BELOW.format(share),
            _percentile(_orbit, float(share)),
            "percentile",
            **CAGE,
            series=partial(orbit_percentile, 0.01 * share),
            least=0.01,
            grows=1.0,
        )
        for share in (5, 95)
    ),
    Number(
        "axis_distance_over_cpr",
        "distance of the cage from the bearing axis, mean / Cpr",
        "",
        "Mean distance of the cage's centre from the axis over the radial play; 1: the play is used up.",
        lambda seen: seen.distance.mean(),
        **CAGE,
        least=0.01,
        grows=1.0,
        shown=frozenset({"shaft"}),
    ),
    *(
        Number(
            f"axis_distance_over_cpr_p{share:02d}",
            f"    {share} %",
            "",
            BELOW.format(share),
            _percentile(_distance, float(share)),
            "percentile",
            **CAGE,
            series=partial(distance_percentile, 0.01 * share),
            least=0.01,
            grows=1.0,
        )
        for share in (5, 95)
    ),
    Number(
        "whirl_ratio",
        "whirl frequency / cage frequency",
        "",
        "Orbits of the cage's centre for each turn of the cage; 1 is the usual whirl with the cage's rotation.",
        lambda seen: seen.window.whirl_ratio,
        **CAGE,
        least=0.05,
        shown=frozenset({"sweep"}),
    ),
    Number(
        "whirl_frequency",
        "whirl frequency",
        "Hz",
        "Orbits of the cage's centre in a second; negative: against the rotation.",
        lambda seen: seen.window.whirl_frequency,
        **CAGE,
    ),
    Number(
        "whirl_coherence",
        "share of turning in the cage centre's motion",
        "",
        "1: the centre goes round steadily in one sense; 0: it does not.",
        lambda seen: seen.motion.whirl_coherence,
        **CAGE,
        least=0.05,
    ),
    Number(
        "speed_deviation_ratio",
        "cage centre speed, deviation / mean",
        "",
        "Spread of the centre's speed over its mean: 0 for a steady circle, 0.52 for random motion.",
        lambda seen: seen.motion.speed_deviation_ratio,
        **CAGE,
        least=0.05,
    ),
    Number(
        "axial_over_clearance",
        "axial position / axial play",
        "",
        "Mean axial place of the cage in its play; 0: against the large ends.",
        lambda seen: seen.window.axial_motion.mean(),
        **CAGE,
        least=0.01,
    ),
    Number(
        "running_play_radial",
        "radial play of the warm, turning cage",
        "m",
        "Cpr with the growth of the parts by temperature and rotation; Cpr itself stays that of the drawing.",
        lambda seen: seen.run.scene.running_plays[0],
        "state",
        "run",
        exists=has_growth,
    ),
    Number(
        "running_play_circumferential",
        "circumferential play of the warm, turning cage",
        "m",
        "Cpc with the growth of the parts by temperature and rotation.",
        lambda seen: seen.run.scene.running_plays[1],
        "state",
        "run",
        exists=has_growth,
    ),
    Number(
        "cage_deflection",
        "displacement of a pocket's face by the cage's deformation, largest",
        "m",
        "How far the modes of an elastic cage move the middle of a pocket's face, at the records.",
        _deflection,
        "largest",
        "run",
        groups=("cage",),
        exists=is_elastic,
    ),
    Number(
        "tilt_rms",
        "cage tilt, rms",
        "rad",
        "How far the cage's axis leans.",
        lambda seen: np.sqrt(np.mean(np.sum(seen.window["cage_tilt"] ** 2, axis=1))),
        "rms",
        **CAGE,
        least=1e-5,
    ),
    Number(
        "lean_mean",
        "tilt to the side of the cage's displacement, mean",
        "rad",
        "Positive: the axis leans to the side to which the centre is displaced.",
        lambda seen: observables.lean(seen.window["cage_position"], seen.window["cage_tilt"]).mean(),
        **CAGE,
        least=1e-5,
    ),
    Number(
        "spacing_std_deg",
        "roller spacing, deviation",
        "deg",
        "Spread of the angles between neighbouring rollers.",
        lambda seen: seen.window.spacing_std.mean(),
        groups=("rollers",),
        interval="motion",
        least=1e-3,
    ),
)
"""Rows of the motion of cage and rollers."""

POCKETS: Final = (
    Number(
        "pocket_force_p95",
        "pocket force, 95 % in contact",
        "N",
        "While a roller touches the cage, 95 % of the forces stay below this.",
        _usual_pocket_force,
        "percentile",
        groups=("pocket",),
        exists=has_pockets,
        interval="motion",
        least=0.1,
        shown=frozenset({"sweep", "page"}),
        checked=True,
    ),
    *extreme(
        "pocket_force_peak",
        "pocket force, largest in the run",
        "N",
        "The hardest hit on a pocket in the whole run.",
        exists=has_pockets,
        least=0.1,
        shown=frozenset({"result", "report", "shaft"}),
        pictures=("pocket_statistics",),
        checked=True,
    ),
    Number(
        "pocket_force_peak_low",
        "the same with other starts or accuracies, at least",
        "N",
        "Where the load drops and comes back, other starts and accuracies give a hardest hit above this in 97 of 100 "
        "cases, as measured on a 30310.",
        partial(_band, 0),
        "largest",
        "run",
        groups=("peaks",),
        exists=drops,
    ),
    Number(
        "pocket_force_peak_high",
        "the same with other starts or accuracies, at most",
        "N",
        "And one below this in 97 of 100 cases.",
        partial(_band, 1),
        "largest",
        "run",
        groups=("peaks",),
        exists=drops,
    ),
    Number(
        "pocket_impacts",
        "impacts in the pockets, in the run",
        "",
        "How often a roller began to touch its pocket.",
        lambda seen: int(seen.peaks["pocket_impacts"].sum()),
        "count",
        "run",
        groups=("peaks",),
        exists=has_pockets,
    ),
    Number(
        "pocket_impulse_peak",
        "largest impulse of one impact, in the run",
        "N s",
        "Momentum that the hardest impact passed on.",
        lambda seen: seen.peaks["pocket_impulse_peak"].max(),
        "largest",
        "run",
        groups=("peaks",),
        exists=has_pockets,
    ),
    *extreme(
        "land_force_peak",
        "force of the land on the cage, largest in the run",
        "N",
        "The hardest push of the land that guides the cage.",
        exists=has_land,
        checked=True,
    ),
    *extreme(
        "land_gap_min",
        "gap between cage and land, smallest in the run",
        "m",
        "How near the cage came to the land; below bearing.land.contact_film they touch.",
        smallest=True,
        exists=has_land,
    ),
    Number(
        "pocket_duty",
        "share of time that a pocket is touched",
        "",
        "Share of the time for which a pocket is touched.",
        lambda seen: (seen.window["pocket_force"] > 0).any(axis=2).mean(),
        groups=("pocket",),
        exists=has_pockets,
        interval="motion",
        least=1e-3,
        checked=True,
    ),
)
"""Rows of the forces between rollers and cage."""

SKEW: Final = (
    Number(
        "skew_rms",
        "roller skew, rms",
        "rad",
        "How far the rollers turn out of their rolling direction.",
        lambda seen: np.sqrt(np.mean(seen.window["roller_skew"] ** 2)),
        "rms",
        groups=("rollers",),
        interval="motion",
        least=1e-5,
        checked=True,
    ),
)
