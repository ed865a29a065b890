"""`trbdyn.rating`: the engineer's sheet of a scene or a result."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, TypedDict, Unpack, overload

from trbdyn.base.expected import expect
from trbdyn.errors import InputError
from trbdyn.model.assembly import Assembly
from trbdyn.model.bearing import Bearing
from trbdyn.model.scene import Scene
from trbdyn.model.spectrum import Spectrum
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.result import Result
from trbdyn.run.run_loads import of_run
from trbdyn.standards.loading import Loading, at_equilibrium
from trbdyn.standards.sheet import Rating, sheet
from trbdyn.standards.spectrum import SpectrumRating, over_cases, over_run
from trbdyn.standards.system import SystemRating, loadings_of, system_of, system_sheet
from trbdyn.statics.assembly import ShaftEquilibrium, equilibrium
from trbdyn.statics.fit import Fit


class Options(TypedDict, total=False):
    """What `rating` takes beside its subject."""

    cleanliness: str | None
    filtered: bool | None
    contamination: float | None
    reliability: float


@overload
def rating(subject: Scene | Result, **options: Unpack[Options]) -> Rating: ...


@overload
def rating(subject: Assembly | AssemblyResult | ShaftEquilibrium, **options: Unpack[Options]) -> SystemRating: ...


@overload
def rating(subject: Fit, **options: Unpack[Options]) -> Rating | SystemRating: ...


@overload
def rating(subject: Spectrum, **options: Unpack[Options]) -> SpectrumRating | SystemRating: ...


def rating(
    subject: Scene | Result | Assembly | AssemblyResult | ShaftEquilibrium | Fit | Spectrum,
    *,
    cleanliness: str | None = None,
    filtered: bool | None = None,
    contamination: float | None = None,
    reliability: float = 90.0,
) -> Rating | SpectrumRating | SystemRating:
    """What every catalogue program answers first: equivalent load, rating lives, static safety, kappa, limits of speed.

    C, C0 and the factors are those of ``bearing.ratings`` (`Bearing.from_catalogue` keeps them there); what is not known is
    computed by ISO 281 and ISO 76 from the rollers, and the note says so. Reference lives (ISO 16281) stand on the loads of
    the laminas: of a scene, those of the equilibrium at its start; of a result, those of its records. Where speed or loads of a
    run change, lives, damage and static safety are of the whole run, or of all of a window (`Result.window`); where they are
    constant, of the records after the transient. The sheet says which.

    Parameters
    ----------
    subject : Scene, Result, Assembly, AssemblyResult, ShaftEquilibrium, Fit or Spectrum
        A result needs the groups cage and rollers. Of an assembly each bearing has a sheet, under the loads of the equilibrium or
        of its run, and the whole has lives. Of what `trbdyn.fit` gives: the scene or assembly with its play of operation in the
        mean, and the sheet shows the fits. Of a spectrum the damages of its load cases add up.
    cleanliness : {'13/10', '15/12', '17/14', '19/16', '21/18'}, optional
        Particles in the oil, the last two numbers of ISO 4406; that of the scene's lubricant by default, and 17/14 where that
        has none, which is said with what a neighbouring class gives.
    filtered : bool, optional
        Circulating oil with an in-line filter; that of the scene's lubricant by default.
    contamination : float, optional
        e_C, in place of the cleanliness: from 0 (very dirty) to 1 (laboratory) (1).
    reliability : float
        From 90 to 99.95 (%).

    Returns
    -------
    Rating, SystemRating or SpectrumRating
        Prints as a table; `Rating.rows` has every number with its symbol, unit and source. Of an assembly a `SystemRating`, of a
        spectrum of one bearing a `SpectrumRating`, of a spectrum of an assembly a `SystemRating` of these.

    Raises
    ------
    InputError
        If a number is not allowed, or a result lacks what is needed.
    LoadError
        If the bearing cannot carry the scene's load.

    Notes
    -----
    Sources: ISO 281:2007, ISO 16281:2025 as far as it could be read, else ISO/TS 16281:2008, ISO 76:2006; docs/theory/ratings.md.

    Examples
    --------
    >>> import trbdyn as trb
    >>> bearing = trb.Bearing.from_catalogue(bore=0.040, outside=0.080, width=0.02475, C=74.8e3, C0=86.5e3, e=0.37, Y=1.6)
    >>> scene = trb.Scene(bearing, speed_rpm=2000, axial_load=2500.0, lubricant="vg68")
    >>> found = trb.rating(scene, cleanliness="15/12", filtered=True)
    >>> round(found.equivalent_load), round(found.life_hours, -3)
    (4000, 145000.0)
    """
    options: dict[str, Any] = {
        "cleanliness": cleanliness,
        "filtered": filtered,
        "contamination": contamination,
        "reliability": reliability,
    }
    expect("subject", subject, Scene, Result, Assembly, AssemblyResult, ShaftEquilibrium, Fit, Spectrum)
    if isinstance(subject, Fit):
        return _of_fit(subject, options)
    if isinstance(subject, Spectrum):
        return _of_spectrum(subject, options)
    if isinstance(subject, Scene):
        return sheet(subject, at_equilibrium(subject), **options)
    if isinstance(subject, Result):
        return _of_result(subject, options)
    if isinstance(subject, Mapping):
        parts: Mapping[str, Any] = subject
        return system_of({name: _of_result(one, options) for name, one in parts.items()})
    if isinstance(subject, ShaftEquilibrium):
        return system_sheet(subject, **options)
    return system_sheet(equilibrium(subject), **options)


def _of_result(result: Result, options: dict[str, Any]) -> Rating:
    loads = of_run(result)
    return over_run(result.scene, loads.shares, loads.loadings, loads.whole, **options)


def _of_fit(fits: Fit, options: dict[str, Any]) -> Rating | SystemRating:
    if isinstance(fits.subject, Bearing):
        limit = "must be those of a Scene or an Assembly: a rating needs speed and loads"
        raise InputError.of("subject", "fits of a bearing alone", limit)
    found: Rating | SystemRating = rating(fits.subject, **options)
    return replace(found, fits=fits)


def _of_spectrum(spectrum: Spectrum, options: dict[str, Any]) -> SpectrumRating | SystemRating:
    names = [one.name for one in spectrum.cases]
    loadings = [_loadings(one.subject) for one in spectrum.cases]
    each = {
        bearing: over_cases(names, spectrum.shares, [one[bearing] for one in loadings], **options)
        for bearing in loadings[0]
    }
    return each[""] if "" in each else system_of(each)


def _loadings(subject: Scene | Assembly) -> dict[str, tuple[Scene, Loading]]:
    """What each bearing carries in its equilibrium, by its name; that of one bearing alone is empty."""
    if isinstance(subject, Scene):
        return {"": (subject, at_equilibrium(subject))}
    return loadings_of(equilibrium(subject))
