"""``python benchmarks/validation``: every measurement beside its prediction with a band, every law, and published formulas.

    .venv/bin/python benchmarks/validation [--quick] [--json FILE] [--write-readme]

Assumptions are those of `validation.assumptions`, measurements those of
`validation.measured`. ``--write-readme`` puts the tables into docs/validation.md, the numbers into
benchmarks/validation/validation.json, and their summary into the package, whose torques name it.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import common
import numpy as np

import trbdyn as trb
from trbdyn.model.lubricants import REPLENISHMENT
from validation import makers, skf
from validation.assumptions import (
    CATALOGUE,
    DEFAULT,
    OPTIONS,
    SAMPLES,
    SEED,
    SLOWEST,
    TURNS,
    bands_of,
    oil_of,
    scene_of,
)
from validation.measured import MEASUREMENTS, NOT_ENOUGH, Measurement

HERE = Path(__file__).resolve().parent
PAGE = HERE.parents[1] / "docs" / "validation.md"
RECORD = HERE.parents[1] / "trbdyn" / "data" / "torque_record.json"
TORQUES = ("torque", "rolling_torque")
DRAGS = ("no_drag", "drag_of_the_state")
"""Effects for which the package quotes an error: the default, whose oil does not drag, and with `oil_fill` of the state."""
SUPPLIES = (0.7, 1.0)
"""Supplies between which a torque is taken as a straight line, to fit the supply without a bearing."""
CLOSE = 30.0
"""Error below which a prediction counts as close (%)."""
COLUMNS = {
    "source": "1: where it is published",
    "bearing": "1: bearing",
    "quantity": "1: what was measured",
    "speed_rpm": "rpm: speed of the shaft",
    "axial_load": "N: axial load",
    "radial_load": "N: radial load, down",
    "measured": "unit of the quantity",
    "reading_error": "unit of the quantity: how far the reading may be off",
    "predicted": "unit of the quantity: by the default, with every open input at its value",
    "low": "unit of the quantity: lowest of the defended laws' bands",
    "high": "unit of the quantity: highest of the same",
    "is_inside": "1: whether the measured value lies within the band, or its reading may",
    "error": "%: predicted over measured, less 100 %",
    "skf": "unit of the quantity: SKF's model",
    "palmgren": "unit of the quantity: Palmgren's formula",
    "shares": "1: inputs that make most of the variance of the default's band",
    "options": "unit of the quantity: by laws and supply of oil",
    "default": "1: the option that Effects.standard() has",
    "by_option": "%: mean over bearings of the mean error from 1000 rpm on, the same below, share within 30 %, and the mean "
    "at points that were held back, by option",
    "is_held_back": "1: whether no choice of the package was made with it",
    "held_back": "%: mean size of the default's error at points that were held back, by bearing",
    "held_back_torques": "1: number of these points",
    "temperature_c": "C: that the source gives",
    "by_bearing": "%: mean size of the default's error from 1000 rpm on, by bearing",
    "left_out": "%: the same with the supply of a bath fitted without this bearing",
    "supply_without": "1: this supply",
    "left_out_error": "%: mean of these over bearings",
    "formulas": "1: the default over formulas of makers, over twelve catalogue bearings; what was measured over the same",
    "parts": "1: what a change makes of the torques of these bearings, median",
    "starts": "1: the default over a maker's starting torque, over these bearings",
    "exponents": "1: of the torque of the 32216 with viscosity, speed and load",
    "record": "what the package quotes, without and with drag of the oil",
    "inside": "1: share of measured points within their band",
    "mean_error": "%: mean over bearings of the mean size of the default's error, torques from 1000 rpm on",
    "mean_error_slow": "%: the same, torques below 1000 rpm",
    "no_drag": "N m: by the default whose oil does not drag",
    "by_supply": "N m: with a supply of 0.7 and 1",
    "supply": "1: state of lubrication",
    "max_error": "%: largest size of the error, torques from 1000 rpm on",
    "median_band": "%: median of half the band's width over the prediction, torques",
    "skf_mean_error": "%: mean size of SKF's error, torques from 1000 rpm on",
    "palmgren_mean_error": "%: mean size of Palmgren's error, torques from 1000 rpm on",
    "bearings": "1: number of bearings with a torque from 1000 rpm on",
    "torques": "1: number of torques from 1000 rpm on",
}


def main() -> int:
    """Run all measurements; print the tables."""
    options = common.parser(__doc__).parse_args()
    report = common.Report("validation", options, COLUMNS)
    points = [MEASUREMENTS[1], MEASUREMENTS[12], MEASUREMENTS[-1]] if options.quick else MEASUREMENTS
    samples = 8 if options.quick else SAMPLES
    own = DEFAULT
    chosen = [own, next(name for name in OPTIONS if name != own)] if options.quick else list(OPTIONS)
    report.inputs = {"samples": samples, "seed": SEED, "turns": TURNS}
    for point in points:
        report.add(**row(point, chosen, own, samples))
    report.summary = summary(report.results, chosen, own)
    report.summary |= beside_makers(report.results, options.quick)
    report.notes = [f"not used, {name}: {why}" for name, why in NOT_ENOUGH.items()]
    shown_rows = [shown(one) for one in report.results]
    first = common.table(shown_rows, list(shown_rows[0]))
    ranked = ranking(report.summary)
    second = common.table(ranked, list(ranked[0]))
    third = made_by_formulas(report.summary)
    words = ", ".join(
        f"`{name}` {value:.3g}" for name, value in report.summary.items() if isinstance(value, float | int)
    )
    print(f"{first}\n\n{second}\n\n{third}\n\n{words}")
    if options.write_readme:
        options.json = options.json or HERE / "validation.json"
        common.write_readme("validation", f"{first}\n\n{second}\n\n{third}\n\n{words} (errors and bands in %).", PAGE)
        kept = {drag: report.summary["record"][drag] for drag in DRAGS}
        RECORD.write_text(json.dumps({**kept, "from_rpm": SLOWEST}, indent=1) + "\n", encoding="utf-8")
    report.finish()
    return 0


def beside_makers(rows: list[dict[str, Any]], quick: bool) -> dict[str, Any]:
    """The default beside formulas that no torque of the table was used for."""
    if quick:
        return {}
    starts, found = makers.starts(), makers.rows()
    fast = [one for one in rows if one["quantity"] in TORQUES and one["speed_rpm"] >= SLOWEST]
    scenes = {point.speed_rpm: scene_of(point, OPTIONS[DEFAULT]) for point in MEASUREMENTS[:3]}
    return {
        "formulas": makers.ratios(found, fast),
        "parts": makers.parts(found),
        "starts": {
            "median": float(np.median(list(starts.values()))),
            "low": min(starts.values()),
            "high": max(starts.values()),
        },
        "exponents": {f"32216, {rpm:g} rpm": makers.exponents(scene) for rpm, scene in scenes.items()},
        "measured_exponents": measured_exponents(),
    }


def measured_exponents() -> dict[str, str]:
    """Of the torques of the 32216: with viscosity from 42 and 50 C, with speed at 50 C under axial load; of load that of
    Aihara (1987).
    """
    found = {
        (one.temperature_c, one.radial_load, one.speed_rpm): one
        for one in MEASUREMENTS
        if (one.bearing, one.quantity) == ("32216", "torque")
    }
    viscosity = []
    for (t, radial, speed), one in found.items():
        if t < 50.0:
            warm = found[50.0, radial, speed]
            thinner = oil_of(one).viscosity / oil_of(warm).viscosity
            viscosity.append(math.log(one.value / warm.value) / math.log(thinner))
    speeds = [(500.0, 2000.0), (2000.0, 4000.0)]
    by_speed = [
        f"{math.log(found[50.0, 0.0, b].value / found[50.0, 0.0, a].value) / math.log(b / a):.2f} ({a:g} to {b:g} rpm)"
        for a, b in speeds
    ]
    return {
        "viscosity": f"{min(viscosity):.2f} to {max(viscosity):.2f}",
        "speed": ", ".join(by_speed),
        "load": "0.3",
    }


def made_by_formulas(found: dict[str, Any]) -> str:
    """The two tables of `beside_makers`."""
    if "formulas" not in found:
        return ""
    names = {
        "aihara": "Aihara 1987, running torque",
        "skf": "SKF's model, running torque",
        "palmgren": "f0 and f1 (Palmgren), running torque",
        "starts": "NSK's starting torque, mu 0.2",
    }
    ratios = found["formulas"] | {"starts": found["starts"]}
    first = [
        {
            "twelve catalogue bearings, default over": names[key],
            "median": f"{one['median']:.2f}",
            "range": f"{one['low']:.2f} to {one['high']:.2f}",
            "full supply on either side": f"{one['full']:.2f}" if "full" in one else "-",
            "what was measured over it": f"{one['measured']:.2f}" if "full" in one else "-",
            "default there": f"{one['there']:.2f}" if "full" in one else "-",
        }
        for key, one in ratios.items()
    ]
    changed = [
        {
            "twelve catalogue bearings": f"default, {key}" if n == 0 else f"full supply, {key}",
            "torque": f"{100 * one - 100:+.0f} %",
        }
        for n, (key, one) in enumerate(found["parts"].items())
    ]
    second = [
        {"exponents of the torque": name, **{key: f"{value:.2f}" for key, value in one.items()}}
        for name, one in found["exponents"].items()
    ]
    second.append({"exponents of the torque": "measured", **found["measured_exponents"]})
    return "\n\n".join(common.table(one, list(one[0])) for one in (first, changed, second))


def row(point: Measurement, chosen: list[str], own: str, samples: int) -> dict[str, Any]:
    """A measurement with what is predicted for it."""
    predict = {**dict.fromkeys(TORQUES, torque), "loaded_rollers": loaded_rollers, "torque_change": torque_change}
    found = predict[point.quantity](point, chosen, own, samples)
    inside = found["low"] - point.reading_error <= point.value <= found["high"] + point.reading_error
    return {
        "source": point.source,
        "bearing": point.bearing,
        "quantity": point.quantity,
        "speed_rpm": point.speed_rpm,
        "axial_load": point.axial_load,
        "radial_load": point.radial_load,
        "temperature_c": point.temperature_c if math.isfinite(point.temperature_c) else None,
        "supply": point.supply,
        "is_held_back": point.held_back,
        "measured": point.value,
        "reading_error": point.reading_error,
        "is_inside": bool(inside),
        "error": 100.0 * (found["predicted"] / point.value - 1.0),
        **found,
    }


def torque_of(scene: trb.Scene, quantity: str) -> float:
    """Mean torque of a short run (N m), of the rolling torque without the ribs' share."""
    found = trb.Simulation(scene, accuracy="fast").run(revolutions=TURNS).summary()
    split = found["torque_by_loss"]
    ribs = split.get("rib", 0.0) + split.get("front_rib", 0.0)
    return float(found["torque"] - (ribs if quantity == "rolling_torque" else 0.0))


def at_start(scene: trb.Scene, quantity: str) -> float:
    """The same of the contacts at the equilibrium (N m)."""
    found = trb.Simulation(scene).contacts()
    lost = float(np.sum(found["power"])) - (ribs_at_start(found) if quantity == "rolling_torque" else 0.0)
    return lost / (float(scene.speed_rpm) * math.pi / 30.0)  # type: ignore[arg-type]


def ribs_at_start(found: dict[str, Any]) -> float:
    """Power that the back-face rib loses (W)."""
    return float(np.sum(found["rib_friction"] * found["rib_sliding_speed"]))


def torque(point: Measurement, chosen: list[str], own: str, samples: int) -> dict[str, Any]:
    """Predictions and band of a torque (N m)."""
    scene = scene_of(point, OPTIONS[own])
    value, still = (torque_of(one, point.quantity) for one in (scene, scene.replace({"effects.oil_fill": 0.0})))
    # other laws, by what the contacts of the start lose
    began = at_start(scene, point.quantity)
    values = {name: value + at_start(scene_of(point, OPTIONS[name]), point.quantity) - began for name in chosen}
    ends = [at_start(scene.replace({"effects.supply": end}), point.quantity) - began for end in SUPPLIES]
    run = trb.RunOptions(revolutions=TURNS, accuracy="fast")
    found = trb.uncertainty(scene, bands_of(point, scene), samples=samples, seed=SEED, options=run)
    spread = found["torque"]
    low, high = found.laws.band(spread.low, spread.high) if found.laws is not None else (spread.low, spread.high)
    # ribs are a small part of a rolling torque: its band is in proportion
    scale = values[own] / spread.value
    shares = dict(sorted(spread.shares.items(), key=lambda entry: -entry[1])[:2])
    oil, page = scene.lubricant, CATALOGUE[point.bearing]
    common_inputs = {
        "bore": page["bore"],
        "outside": page["outside"],
        "Y": page["Y"],
        "speed_rpm": point.speed_rpm,
        "axial_load": point.axial_load,
        "radial_load": point.radial_load,
        "viscosity": 1e6 * oil.viscosity / oil.density,
    }
    return {
        "predicted": values[own],
        "no_drag": still,
        "by_supply": [value + end for end in ends],
        "low": scale * low,
        "high": scale * high,
        "shares": shares,
        "options": values,
        "skf": skf.torque(
            series=page["series"],
            replenishment=REPLENISHMENT[point.supply].value,
            rolling_alone=point.quantity == "rolling_torque",
            **common_inputs,
        ),
        "palmgren": skf.palmgren(**common_inputs),
    }


def loaded_rollers(point: Measurement, chosen: list[str], own: str, samples: int) -> dict[str, Any]:
    """Number of rollers that carry, at the equilibrium; its band is that of the cup's angle."""
    scene = scene_of(point, OPTIONS[own])
    counts = [count(scene)]
    band = next(band for band in bands_of(point, scene) if band.path == "bearing.cup_half_angle_deg")
    for angle in np.linspace(band.low, band.high, 9):
        counts.append(count(scene.replace({"bearing.cup_half_angle_deg": float(angle)})))
    return {
        "predicted": counts[0],
        "low": min(counts),
        "high": max(counts),
        "shares": {"bearing.cup_half_angle_deg": 1.0},
    }


def count(scene: trb.Scene) -> float:
    """Rollers that the inner raceway loads."""
    return float(np.count_nonzero(trb.Simulation(scene).equilibrium.inner_load > 1.0))


def torque_change(point: Measurement, chosen: list[str], own: str, samples: int) -> dict[str, Any]:
    """Change of the torque with the radius of the end sphere (%); its band is that of the oil's temperature and the ribs."""

    def change(scene: trb.Scene) -> float:
        ends = [torque_of(scene.replace({"bearing.roller.sphere_ratio": ratio}), "torque") for ratio in (0.85, 0.95)]
        return 100.0 * (ends[0] / ends[1] - 1.0)

    scene = scene_of(point, OPTIONS[own])
    bands = {band.path: band for band in bands_of(point, scene)}
    predicted = change(scene)
    tried = [predicted]
    for path in ("lubricant.temperature_c", "bearing.roughness.rib", "effects.friction.rib_boundary_limit"):
        tried += [change(scene.replace({path: end})) for end in (bands[path].low, bands[path].high)]
    return {"predicted": predicted, "low": min(tried), "high": max(tried), "shares": {}}


def summary(rows: list[dict[str, Any]], chosen: list[str], own: str) -> dict[str, Any]:
    """What the tables come to."""
    all_torques = [one for one in rows if one["quantity"] in TORQUES]
    torques = [one for one in all_torques if not one["is_held_back"]]
    held = [one for one in all_torques if one["is_held_back"]]
    fast = [one for one in torques if one["speed_rpm"] >= SLOWEST]

    def sizes(some: list[dict[str, Any]], pick: Any) -> list[float]:
        return [100.0 * abs(pick(one) / one["measured"] - 1.0) for one in some]

    def weighted(some: list[dict[str, Any]], pick: Any) -> float:
        """Mean over bearings of the mean size of the error of each."""
        names = sorted({one["bearing"] for one in some})
        return float(np.mean([np.mean(sizes([one for one in some if one["bearing"] == name], pick)) for name in names]))

    def by_name(some: list[dict[str, Any]], key: str) -> dict[str, float]:
        """Mean size of the error of each bearing."""
        return {
            name: float(np.mean(sizes([one for one in some if one["bearing"] == name], lambda one: one[key])))
            for name in dict.fromkeys(one["bearing"] for one in some)
        }

    slow = [one for one in torques if one["speed_rpm"] < SLOWEST]
    by_option = {}
    for name in chosen:

        def pick(one: dict[str, Any], name: str = name) -> float:
            return float(one["options"][name])

        by_option[name] = {
            "mean_error": weighted(fast, pick),
            "mean_error_slow": weighted(slow, pick) if slow else math.nan,
            "within_30": float(np.mean(np.array(sizes(fast, pick)) < CLOSE)),
            "held_back": weighted(held, pick) if held else math.nan,
        }
    names = sorted({one["bearing"] for one in fast})
    supplies = {name: fitted_supply([one for one in fast if one["bearing"] != name]) for name in names}
    record = {}
    for drag, key in zip(DRAGS, ("no_drag", "predicted"), strict=True):

        def left_out(one: dict[str, Any], key: str = key) -> float:
            return with_supply(one, supplies[one["bearing"]]) + float(one[key] - one["predicted"])

        record[drag] = {
            "bearings": len(names),
            "torques": len(fast),
            "mean_error": weighted(fast, lambda one, key=key: one[key]),
            "max_error": max(sizes(fast, lambda one, key=key: one[key])),
            "left_out_error": weighted(fast, left_out),
            "held_back": by_name(held, key),
            "held_back_torques": len(held),
        }
    return {
        "inside": float(np.mean([one["is_inside"] for one in rows])),
        "mean_error": record[DRAGS[1]]["mean_error"],
        "mean_error_slow": weighted(slow, lambda one: one["predicted"]) if slow else math.nan,
        "max_error": record[DRAGS[1]]["max_error"],
        "left_out_error": record[DRAGS[1]]["left_out_error"],
        "median_band": float(np.median([50.0 * (one["high"] - one["low"]) / one["predicted"] for one in all_torques])),
        "skf_mean_error": weighted(fast, lambda one: one["skf"]),
        "palmgren_mean_error": weighted(fast, lambda one: one["palmgren"]),
        "bearings": len(names),
        "torques": len(fast),
        "default": own,
        "by_option": by_option,
        "left_out": {
            name: float(
                np.mean(
                    sizes(
                        [one for one in fast if one["bearing"] == name],
                        lambda one: with_supply(one, supplies[one["bearing"]]),
                    )
                )
            )
            for name in names
        },
        "supply_without": supplies,
        "record": record,
        "by_bearing": by_name(fast, "predicted"),
        "held_back": by_name(held, "predicted"),
        "held_back_torques": len(held),
    }


def with_supply(one: dict[str, Any], supply: float | None) -> float:
    """Torque of a row with another supply (N m); of a flooded bearing, or without one, as it is."""
    if supply is None or one["supply"] != "bath":
        return float(one["predicted"])
    low, high = one["by_supply"]
    return float(low + (high - low) * (supply - SUPPLIES[0]) / (SUPPLIES[1] - SUPPLIES[0]))


def fitted_supply(rows: list[dict[str, Any]]) -> float | None:
    """The supply of a bath with the smallest mean error, weighted by bearing; None without such a bearing."""
    found = [one for one in rows if one["supply"] == "bath"]
    if not found:
        return None
    bearings = sorted({one["bearing"] for one in found})

    def error(supply: float) -> float:
        return float(
            np.mean(
                [
                    np.mean(
                        [
                            abs(with_supply(one, supply) / one["measured"] - 1.0)
                            for one in found
                            if one["bearing"] == name
                        ]
                    )
                    for name in bearings
                ]
            )
        )

    return float(min(np.linspace(0.5, 1.2, 141), key=error))


def ranking(found: dict[str, Any]) -> list[dict[str, str]]:
    """The options as they are printed, the one with the smallest error first."""
    ranked = sorted(found["by_option"].items(), key=lambda entry: entry[1]["mean_error"])
    return [
        {
            "law, supply, ribs": name + (" (default)" if name == found["default"] else ""),
            "mean over bearings from 1000 rpm on": f"{errors['mean_error']:.0f} %",
            "below": f"{errors['mean_error_slow']:.0f} %",
            "within 30 % from 1000 rpm on": f"{100.0 * errors['within_30']:.0f} %",
            "held back": f"{errors['held_back']:.0f} %",
        }
        for name, errors in ranked
    ]


def shown(one: dict[str, Any]) -> dict[str, str]:
    """A row as it is printed."""
    digits = {"torque": 3 if abs(one["measured"]) < 1.0 else 2, "rolling_torque": 2, "torque_change": 1}.get(
        one["quantity"], 0
    )
    load = f"{one['axial_load'] / 1e3:g}" + (f", Fr {one['radial_load'] / 1e3:g}" if one["radial_load"] else "")
    error = one["error"]
    return {
        "bearing": one["bearing"],
        "quantity": one["quantity"].replace("_", " "),
        "rpm": f"{one['speed_rpm']:g}",
        "C": "-" if one["temperature_c"] is None else f"{one['temperature_c']:g}",
        "Fa (kN)": load,
        "measured": f"{one['measured']:.{digits}f}",
        "predicted": f"{one['predicted']:.{digits}f}",
        "band": f"{one['low']:.{digits}f} to {one['high']:.{digits}f}",
        "inside": "yes" if one["is_inside"] else "no",
        "held back": "yes" if one["is_held_back"] else "",
        "error": f"{error:+.0f} %" if math.isfinite(error) and one["quantity"] != "torque_change" else "-",
        "SKF": f"{one['skf']:.{digits}f}" if "skf" in one else "-",
        "Palmgren": f"{one['palmgren']:.{digits}f}" if "palmgren" in one else "-",
    }
