"""The command ``demo``: a bearing, its pictures, report and 3-D view, in one go."""

from __future__ import annotations

import sys
from typing import Final

from trbdyn.base.own_files import output_path
from trbdyn.cli.case import simulate
from trbdyn.cli.declared import LENGTH, Options, argument, subcommand
from trbdyn.cli.outcome import DONE, FAILED, say

DEMO_PICTURES: Final = ("cage_locus", "spacing_angles", "tilt", "pocket_forces")
DEMO_REPORT: Final = (
    "cage_locus",
    "orbit_radius",
    "load_zone",
    "pressure_map",
    "film_map",
    "pocket_polar",
    "torque_split",
    "energy_audit",
)
DEMO_WORDS: Final = (
    "A tapered roller bearing 30310 turns at 3000 rpm under 4930 N axial load, for {turns:g} turns of the shaft.\n"
    "Its cage starts off centre. Will it whirl, how hard do the rollers strike it, and what does the bearing cost in torque?\n"
    "Everything is written to {folder}."
)


TURNS: Final = 1300.0
"""Turns of the shaft after which the motion is known to have settled."""


@subcommand(
    "demo",
    "the 30310 at 3000 rpm and 4930 N, from a whirling start",
    *LENGTH,
    argument("-o --output", "folder (default: demo)", "FOLDER", default="demo"),
    argument("--overwrite", "replace the files of a demo that are in the folder"),
)
def demo(options: Options) -> int:
    from trbdyn import plot
    from trbdyn.model.cases import scene_30310
    from trbdyn.model.scene import Start
    from trbdyn.reporting import report
    from trbdyn.reporting.verdict import what_matters
    from trbdyn.results import summary
    from trbdyn.run.options import RunOptions
    from trbdyn.viewer import view

    revolutions = TURNS if options.revolutions is None else options.revolutions
    run = RunOptions(revolutions=revolutions, accuracy=options.accuracy or "standard")
    scene = scene_30310(3000.0, 4930.0, start=Start.whirl(0.9))
    run.end_time(scene)
    folder = plot.make_folder(options.output)
    again = {"overwrite": options.overwrite}
    pictures = [f"{name}.png" for name in DEMO_PICTURES]
    for name in ("run.h5", "summary.json", "report.html", "view.html", *pictures):
        output_path(folder / name, **again)
    if not options.quiet:
        say(DEMO_WORDS.format(turns=revolutions, folder=folder))
    result = simulate(scene, run, folder / "run.h5", quiet=options.quiet, **again)
    plot.all(result, folder, DEMO_PICTURES, **again)
    numbers = result.summary()
    summary.write_json(numbers, folder / "summary.json", **again)
    page = report(result, folder / "report.html", pictures=DEMO_REPORT, **again)
    moving = folder / "view.html"
    view(result, moving, **again)
    if not options.quiet:
        say("\n" + "\n".join(f"{number}. {text}" for number, text in enumerate(what_matters(result, numbers), 1)))
        say(f"\nreport: {page}\n3-D view: {moving}")
    if not result.success:
        say(f"trbdyn: {result.message}", file=sys.stderr)
    return DONE if result.success else FAILED
