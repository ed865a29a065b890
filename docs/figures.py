"""Pictures of README and site, made again: ``make figures``, or ``python docs/figures.py report.png`` for one of them.

Beside the pictures lies `shown.json`: numbers that belong to what each picture shows, as they were when it was made. A test
computes these numbers again, so that a picture which is older than what it shows is named. Pictures of pages need Chromium.
Pictures of benchmarks take up to hours and a quiet machine: they are made only where they are named.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from typing import Final

import trbdyn as trb

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "benchmarks"))
SHOWN = ROOT / "docs" / "pictures" / "shown.json"
MOTION: Final = ("cage_speed_ratio", "outer_load_mean", "inner_load_mean", "rib_load_mean")
FRICTION: Final = (*MOTION, "torque", "power_loss")
COST: Final = (*MOTION, "steps")
TURNS: Final = 50.0
TOP: Final = ("cage_locus", "load_zone")
"""Pictures of the report: its top alone is photographed."""


def scene() -> trb.Scene:
    return trb.cases.scene_30310(3000.0, 4930.0, start=trb.Start.whirl(0.9))


def design() -> trb.Scene:
    """What the page shows when it is opened for the first time."""
    return trb.cases.scene_30310(3000.0, 4930.0)


def slow() -> trb.Scene:
    """A point of the Stribeck curve."""
    return trb.cases.scene_30310(100.0, 4930.0)


def paper() -> trb.Scene:
    """A point of the paper's figure 12a."""
    from paper.points import FIGURES, Point

    return Point(FIGURES["12a"][-1], "whirl").scene()


def campaign() -> dict[str, float]:
    """What the picture of the paper's statements is drawn from."""
    from paper.overview import kept

    points = kept()["points"]
    reach = sum(point["whirl_radius_over_cpr"]["p95"] for point in points.values())
    return {"points": float(len(points)), "reach of all": reach}


@cache
def summary(of: Callable[[], trb.Scene], integrator: str = "auto") -> dict[str, float]:
    """What a scene gives, from a short run."""
    return trb.Simulation(of(), accuracy="fast", integrator=integrator).run(revolutions=1.0).summary()


def numbers(of: Callable[[], trb.Scene], names: tuple[str, ...] = FRICTION) -> dict[str, float]:
    """Those of a scene's numbers that a picture shows."""
    made_with = "bdf" if names is COST else "auto"  # the picture of cost was measured with CVODE
    return {name: summary(of, made_with)[name] for name in names}


@cache
def long_run() -> trb.Result:
    return trb.Simulation(scene()).run(revolutions=TURNS)


def locus(path: Path) -> None:
    trb.plot.save(trb.plot.cage_locus(long_run()), path, overwrite=True)


def report(path: Path) -> None:
    with tempfile.TemporaryDirectory() as folder:
        page = trb.report(long_run(), Path(folder) / "report.html", pictures=TOP)
        photograph(page, path, (1100, 1400), "document.readyState == 'complete'")


def viewer(path: Path) -> None:
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "view.html"
        trb.view(long_run(), page, max_frames=200)
        photograph(page, path, (1200, 760), "window.trbView && document.getElementById('message').textContent == ''")


def photograph(page: Path, path: Path, size: tuple[int, int], ready: str) -> None:
    sys.path.insert(0, str(ROOT / "tests" / "view"))
    from browser import Browser

    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:  # Chromium still writes while it ends
        browser = Browser(Path(folder), size)
        try:
            browser.open(page, ready)
            browser.frame()
            browser.picture(path)
        finally:
            browser.close()


def app(path: Path) -> None:
    """The page of `trbdyn app` after a run."""
    sys.path.insert(0, str(ROOT / "tests" / "app"))
    from conftest import Server, User, browser_module

    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        server, browser = Server(Path(folder) / "app"), browser_module().Browser(Path(folder), (1400, 900))
        try:
            browser.go(server.address_for(browser), "window.trbReady && document.querySelector('[data-path=source]')")
            user = User(browser)
            user.choose("source", "30310 (ships")
            user.type("scene.speed_rpm", "3000")
            user.type("scene.axial_load", "4930")
            user.says("inputs complete")
            user.click("tab.run")
            user.type("run.revolutions", "20")
            user.click("run")
            browser.wait("document.querySelector('[data-path=said]').textContent.includes('done: ')", 240.0)
            user.click("tab.results")
            time.sleep(8.0)  # the 3-D view draws itself in a frame of its own
            browser.picture(path)
        finally:
            browser.close()
            server.end()


def stribeck(path: Path) -> None:
    found = trb.torque_map(
        trb.cases.rig_30310(),
        speeds=[10.0, 20.0, 40.0, 70.0, 100.0, 200.0, 500.0, 1000.0, 3000.0],
        loads=[4930.0],
        temperatures=[40.0, 60.0, 90.0],
    )
    found.picture(path, overwrite=True)


def benchmark(*words: str) -> Callable[[Path], None]:
    """A picture that a script of the benchmarks makes."""

    def make(_: Path) -> None:
        subprocess.run([sys.executable, *words], cwd=ROOT / "benchmarks", check=True)

    return make


def statements(path: Path) -> None:
    """The paper's statements beside what the campaign found."""
    from paper.overview import draw

    draw(path)


CURVES: Final = {"paper_16a": "fig_11a_16a"} | {
    f"paper_{name}": f"fig_{name}" for name in ("09", "10", "13", "14", "15", "17", "18")
}
"""Pictures of the paper's figures with the named set of inputs."""
CAMPAIGN: Final = ROOT / "build" / "paper"
"""Their points, which are kept for the next picture."""


def curves(name: str, path: Path) -> None:
    """One of them; points that were not run yet take minutes."""
    from paper.curves import draw

    draw(CURVES[name], path, CAMPAIGN)


def of_curves(name: str) -> trb.Scene:
    """The last scene of such a picture."""
    from paper.curves import points_of

    return points_of(CURVES[name])[-1].scene()


PICTURES: Final[dict[str, tuple[Callable[[Path], None], Callable[[], dict[str, float]]]]] = {
    "benchmarks/pictures/demo_cage_locus.png": (locus, partial(numbers, scene)),
    "docs/pictures/report.png": (report, partial(numbers, scene)),
    "docs/pictures/viewer.png": (viewer, partial(numbers, scene)),
    "docs/pictures/stribeck.png": (stribeck, partial(numbers, slow)),
    "docs/pictures/app.png": (app, partial(numbers, design)),
    "benchmarks/pictures/work_precision.png": (benchmark("work_precision.py"), partial(numbers, scene, COST)),
    "docs/pictures/paper_statements.png": (statements, campaign),
    **{
        f"docs/pictures/{name}.png": (partial(curves, name), partial(numbers, partial(of_curves, name), MOTION))
        for name in CURVES
    },
    "benchmarks/paper/figures/fig_08a_12a.png": (benchmark("-m", "paper"), partial(numbers, paper, MOTION)),
}
"""Pictures, who makes them, and the numbers that say whether they are old."""
OWN: Final = (locus, report, viewer, stribeck, app, statements)
"""Makers of minutes, that need no name."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", help="files, without their folders; by default all but those of benchmarks")
    wanted = parser.parse_args().names
    shown = json.loads(SHOWN.read_text()) if SHOWN.exists() else {}
    for name, (make, of) in PICTURES.items():
        if Path(name).name in wanted or (not wanted and make in OWN):
            make(ROOT / name)
            shown[name] = of()
            SHOWN.write_text(json.dumps(shown, indent=2) + "\n")
            print(name)


if __name__ == "__main__":
    main()
