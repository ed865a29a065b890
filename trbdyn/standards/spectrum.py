"""Lives of a bearing over a spectrum of load cases: damages add up (Palmgren and Miner).

L = 1 / sum(share_i / L_i) with the share of time and the life (h) of each case: ISO 281 by cases. The reference lives of ISO
16281 add up at each lamina and place: at a place of a ring that stands, and at all places of one that turns, the load that
counts is

    q = [sum over cases w_i q_i^4]^(1/4)

with the shares w_i of revolutions; the mean over places and the sum over laminas are those of one case (`lamina.LaminaLoads`).
With a life factor of its own for each lamina and case q_i is divided by a_ISO^(1/4), as life goes with the fourth power of load.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.shown import Shown, Tabled
from trbdyn.errors import InputError
from trbdyn.model.scene import Scene
from trbdyn.standards import iso281, lamina
from trbdyn.standards.loading import Loading, turning_against_load
from trbdyn.standards.sheet import LIVES, METHOD, WHICH_LIFE, Rating, contact_ratings, life_text, rated

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SpectrumRating(Tabled):
    """Lives of a bearing over a spectrum.

    Attributes
    ----------
    cases : dict of str to Rating
        Sheet of each load case by its name.
    shares : dict of str to float
        Shares of the time (1).
    damage : dict of str to float
        Share of each case in the damage, by the basic life (1); 0 for a case without load or speed.
    worst : str
        The case with the largest one.
    speed_rpm : float
        Mean speed (rpm).
    axial_load, radial_load : float
        Of the worst case (N).
    equivalent_load : float
        Steady P at the mean speed that has the same basic life (N).
    life_hours, modified_life_hours, reference_life_hours, modified_reference_life_hours : float or None
        Lives of the spectrum (h); None where it is infinite or a loaded case has none.
    warnings : tuple of str
        What an engineer must know of the cases.
    """

    cases: dict[str, Rating]
    shares: dict[str, float]
    damage: dict[str, float]
    worst: str
    speed_rpm: float
    axial_load: float
    radial_load: float
    equivalent_load: float
    life_hours: float | None
    modified_life_hours: float | None
    reference_life_hours: float | None
    modified_reference_life_hours: float | None
    warnings: tuple[str, ...]

    def _shown(self) -> Shown:
        head = ("case", "time %", "n rpm", "Fa N", "Fr N", "P N", "damage %", "L10h h", "Lnmh h", "L10rh h", "Lnmrh h")

        def row(name: str, one: Rating | SpectrumRating, *parts: str) -> tuple[str, ...]:
            return (name, *parts, *(life_text(getattr(one, life)) for life in LIVES))

        rows = [
            row(
                name,
                one,
                f"{100.0 * self.shares[name]:.4g}",
                f"{one.speed_rpm:.4g}",
                f"{one.axial_load:.5g}",
                f"{one.radial_load:.5g}",
                f"{one.equivalent_load:.5g}",
                f"{100.0 * self.damage[name]:.3g}",
            )
            for name, one in self.cases.items()
        ]
        whole = row("all", self, "100", f"{self.speed_rpm:.4g}", "", "", f"{self.equivalent_load:.5g}", "100")
        worst = f"{self.worst} makes {100.0 * self.damage[self.worst]:.3g} % of the damage (by L10h)."
        return Shown(
            "lives over a spectrum", (head, *rows, whole), head=head, notes=(worst, *self.warnings, WHICH_LIFE)
        )


def over_cases(
    names: Sequence[str], shares: Sequence[float], loadings: Sequence[tuple[Scene, Loading]], **options: Any
) -> SpectrumRating:
    """Lives of one bearing over cases with shares of the time, whose sum is 1, from its scene and loading in each; options of
    `trbdyn.rating`.

    It must be the same bearing in all cases, and its rings must turn against the load in the same way.
    """
    bearing = loadings[0][0].bearing
    for name, (scene, _) in zip(names, loadings, strict=True):
        if scene.bearing != bearing:
            raise InputError.of("spectrum", name, "must have the bearing of the other cases")
    each = [rated(scene, loading, **options) for scene, loading in loadings]
    sheets = {name: sheet for name, (sheet, _) in zip(names, each, strict=True)}
    by_name = dict(zip(names, shares, strict=True))
    speed = sum(by_name[name] * one.speed_rpm for name, one in sheets.items())
    parts = {name: by_name[name] / one.life_hours if one.life_hours else 0.0 for name, one in sheets.items()}
    total = sum(parts.values())
    damage = {name: part / total if total > 0.0 else 0.0 for name, part in parts.items()}
    worst = max(damage, key=lambda name: damage[name])
    life = 1.0 / total if total > 0.0 else None
    turning = [
        (share, *one) for share, one in zip(shares, zip(loadings, each, strict=True), strict=True) if _turns(one)
    ]
    reference = modified = None
    if life is not None and all(loading.lamina_loads is not None for _, (_, loading), _ in turning):
        a1 = next(iter(sheets.values())).reliability_factor
        even = [(share, scene, loading, None) for share, (scene, loading), _ in turning]
        reference = _reference_life(even, speed)
        factors = [(share, scene, loading, factor) for share, (scene, loading), (_, factor) in turning]
        if all(factor is not None for *_, factor in factors):
            modified = a1 * _reference_life(factors, speed)
    C = sheets[worst].dynamic_rating
    turns = None if life is None else 60e-6 * life * speed
    return SpectrumRating(
        cases=sheets,
        shares=by_name,
        damage=damage,
        worst=worst,
        speed_rpm=speed,
        axial_load=sheets[worst].axial_load,
        radial_load=sheets[worst].radial_load,
        equivalent_load=0.0 if turns is None else C / turns ** (1.0 / iso281.LIFE_EXPONENT),
        life_hours=life,
        modified_life_hours=_sum_of_damage(by_name, sheets),
        reference_life_hours=reference,
        modified_reference_life_hours=modified,
        warnings=tuple(f"{name}: {text}" for name, one in sheets.items() for text in one.warnings),
    )


def over_run(
    scene: Scene, shares: Sequence[float], loadings: Sequence[Loading], whole: Loading, **options: Any
) -> Rating:
    """The sheet of a run from stretches with shares of the time, whose sum is 1: lives add up over them."""
    names = [str(k) for k in range(len(loadings))]
    found = over_cases(names, shares, [(scene, one) for one in loadings], **options)
    sheet, _ = rated(scene, whole, **options)
    speed = sheet.speed_rpm

    def turns(life: float | None) -> float | None:
        return None if life is None else 60e-6 * life * speed

    lives = {name: getattr(found, name) for name in LIVES}
    million = {name.removesuffix("_hours"): turns(life) for name, life in lives.items()}
    reference, modified = million["reference_life"], million["modified_life"]
    factor = None
    if modified is not None and million["life"]:
        factor = modified / (sheet.reliability_factor * million["life"])
    notes = sheet.notes | {"life": whole.source, "reference_life": f"{METHOD}, {whole.source}"}
    if whole.moments:
        notes["life_factor"] = "the mean of all stretches of the run"
    load = None if reference is None else sheet.dynamic_rating / reference ** (1.0 / iso281.LIFE_EXPONENT)
    changed: dict[str, Any] = {**lives, **million, "life_factor": factor, "reference_load": load, "notes": notes}
    return replace(sheet, **changed)


def _turns(one: tuple[tuple[Scene, Loading], tuple[Rating, Any]]) -> bool:
    """Whether a case does any damage."""
    return one[1][0].life_hours is not None


def _sum_of_damage(shares: Mapping[str, float], sheets: Mapping[str, Rating]) -> float | None:
    """The modified life of all cases (h); None where a loaded case has none."""
    loaded = {
        name: one.modified_life_hours for name, one in sheets.items() if one.life_hours is not None and shares[name]
    }
    if not loaded or None in loaded.values():
        return None
    return 1.0 / sum(shares[name] / life for name, life in loaded.items() if life is not None)


def _reference_life(cases: Sequence[tuple[float, Scene, Loading, Array | None]], speed: float) -> float:
    """Reference life (h) of loaded cases with their shares of time, and life factors of the laminas; mean speed of all (rpm)."""
    scene = cases[0][1]
    against = {turning_against_load(one) for _, one, _, _ in cases}
    if len(against) > 1:
        limit = "must have rings that turn against the load in the same way in all cases: rate them apart"
        raise InputError.of("spectrum", len(cases), limit)
    total = np.zeros((2, scene.bearing.n_rollers, lamina.LAMINAS))
    for share, _, loading, factor in cases:
        assert loading.lamina_loads is not None
        part = np.maximum(loading.lamina_loads, 0.0) ** 4 / (1.0 if factor is None else factor)
        total += share * abs(loading.speed_rpm) / speed * part
    found = lamina.LaminaLoads.of(total**0.25, contact_ratings(scene), turning=against.pop())
    return iso281.hours(found.reference_life, speed)
