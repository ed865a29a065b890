"""Laws of rolling resistance beside a numerical solution of the lubricated line contact, over the groups W, U and G.

    .venv/bin/python benchmarks/rolling_laws.py [--quick] [--json FILE] [--no-picture]

The solution (`rolling/solution.py`) has no number that was fitted: Reynolds' equation and the elastic half space, without heat.
Every law stands beside it as the law's force over the solution's.
"""

from __future__ import annotations

from typing import Any

import common
import numpy as np
from rolling.solution import NoSolution, solve

from trbdyn import laws

LAWS = {
    "zhou_hoeprich": laws.rolling_line,
    "goksem_hargreaves": laws.rolling_goksem_hargreaves,
    "aihara": laws.rolling_aihara,
    "matsuyama": laws.rolling_matsuyama,
    "biboulet_houpert": laws.rolling_biboulet_houpert,
}
COLUMNS = {
    "W": "1: load group w/(E' Re)",
    "U": "1: speed group eta0 u/(E' Re)",
    "G": "1: material group alpha0 E'",
    "force": "1: F/(E' Re l) of the solution",
    "moment": "1: force from the moment of the pressure, over force: 1 where nothing is wrong",
    "film": "1: central film of the solution over that of Pan and Hamrock, eq. 4",
    **dict.fromkeys(LAWS, "1: force of this law over that of the solution"),
    "lowest": "1: smallest ratio of each law, all points and those of bearings",
    "highest": "1: largest ratio of each law, all points and those of bearings",
}
LOADS = (2e-7, 2e-6, 1e-5, 2.8e-5, 5e-5, 1e-4, 2e-4, 3.5e-4)
SPEEDS = (1e-11, 3e-11, 1e-10, 3e-10)
MATERIALS = (1000.0, 2500.0, 3745.0, 4460.0, 6000.0)
BEARINGS = (2e-5, 1.5e-4, 3000.0)
"""Smallest and largest W, and smallest G, of points that are called those of bearings: the 30310 and the 32216 run at W of
2.8e-5 to 1e-4, and G of a mineral oil is 3700 to 5200 from 100 to 40 C."""
NODES = (120, 150, 100, 134, 170)
"""Numbers of nodes that are tried until Newton's method finds a solution."""


def point(w: float, u: float, g: float) -> dict[str, Any] | None:
    """The solution and the laws at a point."""
    for nodes in NODES:
        try:
            found = solve(w, u, g, nodes)
        except NoSolution:
            continue
        ratios = {name: law(w, u, g) / g / found.force for name, law in LAWS.items()}
        film = found.central / laws.film_line_elastic(w, u, g)
        return {
            "W": w,
            "U": u,
            "G": g,
            "force": found.force,
            "moment": found.moment / found.force,
            "film": film,
            **ratios,
        }
    return None


def main() -> dict[str, Any]:
    """Solve all points; print the table."""
    options = common.parser(__doc__).parse_args()
    report = common.Report("rolling_laws", options, COLUMNS)
    loads, speeds, materials = ((2.8e-5, 1e-4), (1e-10,), (4460.0,)) if options.quick else (LOADS, SPEEDS, MATERIALS)
    missing = 0
    for g in materials:
        for u in speeds:
            for w in loads:
                row = point(w, u, g)
                if row is None:
                    missing += 1
                else:
                    report.add(**row)
    report.notes.append(f"{missing} of {len(loads) * len(speeds) * len(materials)} points without a solution")
    bearings = [row for row in report.results if BEARINGS[0] < row["W"] < BEARINGS[1] and row["G"] > BEARINGS[2]]
    for name, chosen in (("all", report.results), ("bearings", bearings)):
        for word, pick in (("lowest", min), ("highest", max)):
            report.summary.setdefault(word, {})[name] = {law: pick(row[law] for row in chosen) for law in LAWS}
    rows = [
        {
            "law": law,
            "bearings": "{:.2f} to {:.2f}".format(
                *(report.summary[word]["bearings"][law] for word in ("lowest", "highest"))
            ),
            "all": "{:.2f} to {:.2f}".format(*(report.summary[word]["all"][law] for word in ("lowest", "highest"))),
        }
        for law in LAWS
    ]
    report.readme = common.table(rows, list(rows[0]))
    print(report.readme)
    print(report.notes[0], f"; moment over force {min(r['moment'] for r in report.results):.4f} or more")
    if not options.no_picture and not options.quick:
        draw(report.results)
    return report.finish()


def draw(rows: list[dict[str, Any]]) -> None:
    """Every law over W beside the solution, at the speed and oil of the 30310 rig."""
    plt = common.pyplot()
    figure, axes = plt.subplots(figsize=(7.0, 4.4), layout="constrained")
    u, g = 1e-10, 4460.0
    w = np.geomspace(2e-7, 4e-4, 200)
    axes.axvspan(2.8e-5, 1e-4, color="0.9", label="30310 and 32216")
    for name, law in LAWS.items():
        axes.loglog(w, law(w, u, g) / g, label=name.replace("_", "-").title())
    at = [row for row in rows if row["U"] == u and row["G"] == g]
    axes.loglog([row["W"] for row in at], [row["force"] for row in at], "ko", label="numerical solution")
    axes.set(
        xlabel="load W = w/(E' Re)", ylabel="rolling resistance F/(E' Re l)", title="U = 1e-10, G = 4460, without heat"
    )
    axes.grid(True, which="major", color="0.85")
    axes.legend(fontsize=8)
    common.save_picture(figure, "rolling_laws")


if __name__ == "__main__":
    main()
