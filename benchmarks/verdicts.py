"""Verdicts on slip, temperature and preload of catalogue bearings, beside long runs and fixed points that are found another way.

    python benchmarks/verdicts.py [--quick] [--smoke] [--bearings NAME ...] [--only slip|thermal|preload] [--json FILE]

Slip: `trb.least_load` at a light and a medium load, beside runs of `LONG` turns from rolling and, where the verdict is for both
starts, from standing rollers; the verdict is wrong where the slip of their last eighth is on the other side of the limit.
Temperature: `trb.thermal` at a medium load, beside the films that the power of one run of `STEADY` turns makes at the temperature
that was found, by equations of the heat paths that are written down here.
Preload: `trb.preload_over`, for tapered bearings of a preloaded pair, in both arrangements, beside temperatures that are iterated
from cold parts with a small share of each step; no losses or slopes are kept from one temperature outside to the next.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import common
import numpy as np

import trbdyn as trb
from trbdyn.extras.heat.heat_network import heat_of

BEARINGS: Final = {
    "30205": 6000.0,
    "32004X": 4500.0,
    "LM67048/LM67010": 2000.0,
    "30206": 3000.0,
    "32208": 2000.0,
    "30310": 1500.0,
    "31312": 1500.0,
    "33217": 1000.0,
    "NU210": 6000.0,
    "NJ210": 6000.0,
    "NU2210": 3000.0,
    "NU320": 1500.0,
}
"""Designations, and speeds (rpm)."""
LIGHT: Final = 0.0015
MEDIUM: Final = 0.06
"""Loads over the dynamic rating."""
LONG: Final = 40.0
"""Turns of the shaft of a long run from which slip is taken."""
STEADY: Final = 32.0
"""Turns of the shaft of a long run from which power is taken."""
OUTSIDE: Final = (20.0, 60.0)
"""Temperatures outside of a preloaded pair (C)."""
LIMIT: Final = 0.1
"""Slip up to which rollers are taken to roll (1), as `trb.least_load` takes it."""
KELVIN: Final = 2.0
"""Difference of a temperature, beside a twentieth of the rise, from which on it counts as wrong (K)."""
SHARE: Final = 0.3
"""Share of a step of the iteration of a preloaded pair."""
HOTTEST: Final = 180.0
"""Parts hotter than this have no balance (C)."""
COLUMNS: Final = {
    "question": "text: slip, thermal or preload",
    "bearing": "text: designation",
    "case": "text: load, or arrangement and temperature outside",
    "answer": "text: the verdict",
    "value": "slip (1), or temperature of the films (C)",
    "beside": "the same of the long run, or of the own fixed point",
    "other": "slip of the long run from standing rollers (1)",
    "agrees": "1: whether the verdict is right",
    "seconds": "s: processor time of the answer",
    "verdicts": "1: number of verdicts",
    "wrong": "1: number of wrong ones",
    "not_known": "1: number of cases that were not decided",
    "largest_kelvin": "K: largest difference of a temperature",
}


@dataclass(frozen=True)
class Subject:
    """A bearing of the list."""

    name: str
    speed_rpm: float

    @property
    def row(self) -> trb.Designation:
        """Its row of the table."""
        return trb.designation(self.name)

    @property
    def is_cylindrical(self) -> bool:
        """Whether its rollers are cylinders."""
        return self.row.flanges is not None

    def loads(self, share: float) -> tuple[float, float]:
        """Axial and radial load for a share of the dynamic rating (N)."""
        load = share * self.row.C
        if self.is_cylindrical:
            return 0.0 if self.row.flanges in ("NU", "N") else 0.05 * load, load
        return load, 0.5 * load

    def scene(self, share: float, **changes: Any) -> trb.Scene:
        """At a load, with some oil between the rollers."""
        axial, radial = self.loads(share)
        return trb.Scene(
            trb.Bearing.named(self.name),
            speed_rpm=self.speed_rpm,
            **{"axial_load": axial} if axial else {},
            radial_load=radial,
            lubricant=trb.lubricants.vg68(60.0),
            effects=trb.Effects.standard().replace(oil_fill=0.1),
            **changes,
        )

    @property
    def paths(self) -> trb.HeatPaths:
        """Both seats by the reference conditions of ISO 15312, and some oil."""
        row = self.row
        return trb.HeatPaths.reference(
            bore=row.bore, outside=row.outside, width=row.width, oil_flow=5.0, oil_inlet_c=40.0
        )


# slip


def slip(report: common.Report, subject: Subject, share: float, turns: float) -> None:
    """Whether rollers roll at a load."""
    scene, loads = subject.scene(share), subject.loads(share)
    began = time.process_time()
    data = trb.least_load(scene, [subject.speed_rpm], [loads]).data.isel(temperature_c=0, speed_rpm=0, load=0)
    seconds, verdict = time.process_time() - began, str(data["verdict"].values)
    rolling = slip_after(scene, turns)
    expected = {"rolls": (False, False), "slips": (True, True), "rolls or slips, as it starts": (False, True)}
    more: dict[str, Any] = {}
    found = [rolling > LIMIT]
    if verdict in ("rolls", "rolls or slips, as it starts"):
        more["other"] = slip_after(scene, turns, standing=True)
        found.append(more["other"] > LIMIT)
    if verdict in expected:
        more["agrees"] = tuple(found) == expected[verdict][: len(found)]
    report.add(
        question="slip",
        bearing=subject.name,
        case=f"{share:g} C",
        answer=verdict,
        value=float(data["cage_slip"]),
        beside=rolling,
        seconds=seconds,
        **more,
    )


def slip_after(scene: trb.Scene, turns: float, *, standing: bool = False) -> float:
    """Mean slip of the last eighth of a run."""
    start = {"start": trb.Start.equal().replace(slip=0.9)} if standing else {}
    groups: Any = ["cage", "rollers"]
    run = trb.Simulation(scene.replace(**start), accuracy="fast").run(
        revolutions=turns, save_every=turns * 60.0 / scene.speed_rpm / 160.0, save_groups=groups
    )
    return float(run.cage_slip[-len(run) // 8 :].mean())


# temperature


def films_of(paths: trb.HeatPaths, losses: Mapping[str, float], ribs: Any) -> tuple[dict[str, float], float]:
    """Temperatures of the parts and of the films (C) with these losses (W), by the balance of each part."""
    p, heat = paths, heat_of(losses, paths.oil_share, ribs)
    outer = (p.outer_ring_to_surroundings, p.outer_ring_to_rollers, p.outer_ring_to_oil)
    inner = (p.inner_ring_to_surroundings, p.inner_ring_to_rollers, p.inner_ring_to_oil)
    matrix = np.array(
        [
            [sum(outer), 0.0, -outer[1], -outer[2]],
            [0.0, sum(inner), -inner[1], -inner[2]],
            [-outer[1], -inner[1], outer[1] + inner[1] + p.rollers_to_oil, -p.rollers_to_oil],
            [-outer[2], -inner[2], -p.rollers_to_oil, outer[2] + inner[2] + p.rollers_to_oil + p.oil_flow],
        ]
    )
    right = [
        heat["outer_ring"] + outer[0] * p.housing_air_c,
        heat["inner_ring"] + inner[0] * p.shaft_end_c,
        heat["rollers"],
        heat["oil"] + p.oil_flow * p.oil_inlet_c,
    ]
    outer_ring, inner_ring, rollers, oil = np.linalg.solve(matrix, right).tolist()
    nodes = {"outer_ring": outer_ring, "inner_ring": inner_ring, "rollers": rollers, "oil": oil}
    return nodes, 0.25 * (outer_ring + inner_ring) + 0.5 * rollers


def thermal(report: common.Report, subject: Subject, turns: float) -> None:
    """The temperature of its films."""
    scene, paths = subject.scene(MEDIUM), subject.paths
    began = time.process_time()
    found = trb.thermal(scene, paths)
    seconds, film = time.process_time() - began, found.temperatures["film"]
    groups: Any = ["torque", "power", "energy", "contacts"]
    run = trb.Simulation(found.scene, accuracy="fast").run(revolutions=turns, save_groups=groups)
    _, beside = films_of(paths, {key: float(value) for key, value in run.power_split.items()}, scene.bearing.ribs)
    report.add(
        question="thermal",
        bearing=subject.name,
        case=f"{MEDIUM:g} C",
        answer="found",
        value=film,
        beside=beside,
        agrees=abs(film - beside) < KELVIN + 0.05 * (film - paths.oil_inlet_c),
        seconds=seconds,
    )


# preload


def pair(subject: Subject, arrangement: str) -> tuple[trb.Assembly, trb.Mounting]:
    """A preloaded pair on a shaft, with its seats."""
    row = subject.row
    shaft = trb.Shaft.hollow_cylinder(mass=3.0 * (row.bore / 0.03) ** 3, outer_diameter=row.bore, length=6.0 * row.bore)
    load = trb.ShaftLoad(position=0.0, force=(0.0, -0.5 * MEDIUM * row.C, 0.02 * row.C))
    one = trb.Assembly.pair(
        trb.Bearing.named(subject.name),
        arrangement,
        spread=4.0 * row.bore,
        end_play=-10e-6,
        shaft=shaft,
        speed_rpm=subject.speed_rpm,
        loads=[load],
        lubricant="vg32",
    )
    seat = trb.Mounting(bore=row.bore, outside=row.outside, width=row.width, shaft="k5", housing="JS6")
    return one, seat


def preload(report: common.Report, subject: Subject, arrangement: str, outside: Sequence[float], steps: int) -> None:
    """Temperatures of a preloaded pair, at each temperature outside."""
    one, seat = pair(subject, arrangement)
    paths = subject.paths
    began = time.process_time()
    rows: dict[float, Any] = {}
    try:
        found = trb.preload_over(one, seat, list(outside), paths=paths)
        rows = {row.temperature_c: row for row in found.rows} | {miss.temperature_c: miss for miss in found.without}
    except trb.TrbError as error:
        rows = dict.fromkeys(outside, str(error))
    seconds = time.process_time() - began
    for at in outside:
        film, ended = own_balance(one, seat, paths, at, steps)
        more: dict[str, Any] = {"answer": "balance"}
        row = rows[at]
        if isinstance(row, str):
            more["answer"], balanced = row, False
        elif balanced := hasattr(row, "temperatures"):
            nodes = [0.25 * (t.outer_ring_c + t.inner_ring_c) + 0.5 * t.rollers_c for t in row.temperatures.values()]
            more["value"] = max(nodes)
        else:
            more["answer"] = row.why
        if balanced and film is not None:
            more["agrees"] = abs(more["value"] - film) < KELVIN + 0.05 * (film - at)
        else:
            more["agrees"] = ended in more["answer"] if film is None and not balanced else False
        if film is not None:
            more["beside"] = film
        report.add(
            question="preload",
            bearing=subject.name,
            case=f"{arrangement}, {at:g} C",
            seconds=seconds / len(outside),
            **more,
        )


def own_balance(
    one: trb.Assembly, seat: trb.Mounting, paths: trb.HeatPaths, outside: float, steps: int
) -> tuple[float | None, str]:
    """Films of the hotter bearing (C) where a small share of each step, from cold parts on, comes to rest; else None and how it
    ends.
    """
    own = paths.replace(housing_air_c=outside, shaft_end_c=outside, oil_inlet_c=outside)
    names = [bearing.name for bearing in one.bearings]
    nodes = [dict.fromkeys(("outer_ring", "inner_ring", "rollers", "oil"), outside) for _ in names]
    for _ in range(steps):
        if max(max(part.values()) for part in nodes) > HOTTEST:
            return None, "too hot"
        warm = {name: trb.Temperatures.of_nodes(part) for name, part in zip(names, nodes, strict=True)}
        try:
            at = trb.fit(one, seat, temperatures=warm).subject
            oils = {
                f"bearings[{k}].lubricant": trb.lubricants.vg32(
                    0.25 * (part["outer_ring"] + part["inner_ring"]) + 0.5 * part["rollers"]
                )
                for k, part in enumerate(nodes)
            }
            record = trb.Simulation(at.replace(oils)).record()
        except trb.InputError as error:
            return None, "play" if "end_play" in str(error) else str(error).splitlines()[0]
        except trb.LoadError:
            return None, "nothing holds the shaft"
        further = []
        for name in names:
            losses = {
                key[6:]: float(power)
                for key, power in record[name].items()
                if key.startswith("power_") and key != "power_loss"
            }
            further.append(films_of(own, losses, one.bearings[names.index(name)].bearing.ribs)[0])
        change = max(abs(new[key] - part[key]) for new, part in zip(further, nodes, strict=True) for key in part)
        nodes = [
            {key: part[key] + SHARE * (new[key] - part[key]) for key in part}
            for new, part in zip(further, nodes, strict=True)
        ]
        if change < 0.05:
            return max(0.25 * (n["outer_ring"] + n["inner_ring"]) + 0.5 * n["rollers"] for n in nodes), "balance"
    return None, "not found"


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    parser = common.parser(__doc__)
    parser.add_argument("--bearings", nargs="+", metavar="NAME", help="which bearings, by their designations")
    parser.add_argument("--speed", type=float, help="their speed, where it is not that of the list (rpm)")
    parser.add_argument("--only", choices=("slip", "thermal", "preload"), help="one of the questions")
    options = parser.parse_args(arguments)
    report = common.Report("verdicts", options, COLUMNS)
    names = options.bearings or (["30205", "NU210"] if options.quick else list(BEARINGS))
    subjects = [Subject(name, options.speed or BEARINGS.get(name, 1500.0)) for name in names]
    asked = [options.only] if options.only else ["preload", "slip", "thermal"]
    if options.smoke:
        subjects, asked = subjects[:1], [options.only] if options.only else ["preload", "slip"]
    long, steady = (8.0, 4.0) if options.smoke else (LONG, STEADY)
    for question in asked:
        for subject in subjects:
            before = len(report.results)
            if question == "preload" and not subject.is_cylindrical:
                arrangements = ("face to face",) if options.quick else ("face to face", "back to back")
                for arrangement in arrangements:
                    preload(report, subject, arrangement, OUTSIDE[:1] if options.smoke else OUTSIDE, 80)
            if question == "slip":
                for share in (MEDIUM,) if options.smoke else (LIGHT, MEDIUM):
                    slip(report, subject, share, long)
            if question == "thermal":
                thermal(report, subject, steady)
            print(*report.results[before:], f"{time.process_time():.0f} s", sep="\n", flush=True)
    report.summary = _summary(report.results)
    print(common.table(report.results, ("question", "bearing", "case", "answer", "value", "beside", "other", "agrees")))
    print(report.summary)
    report.finish()
    return report


def _summary(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    told = [row for row in rows if "agrees" in row]
    apart = [
        abs(row["value"] - row["beside"]) for row in told if row["question"] != "slip" and {"value", "beside"} <= {*row}
    ]
    return {
        "verdicts": len(told),
        "wrong": sum(not row["agrees"] for row in told),
        "not_known": len(rows) - len(told),
        "largest_kelvin": max(apart, default=None),
    }


if __name__ == "__main__":
    main()
