"""The command ``torque``: friction torque of a case over speed, load and temperature."""

from __future__ import annotations

import sys
from pathlib import Path

from trbdyn.cli.case import subject_with_changes
from trbdyn.cli.declared import CASE, SET, WORKERS, Options, argument, subcommand
from trbdyn.cli.outcome import DONE, FAILED, say
from trbdyn.errors import MISSING, InputError


@subcommand(
    "torque",
    "friction torque over speed, load and temperature",
    CASE,
    argument("--speeds", "speeds of the shaft", "RPM", type=float, nargs="+", required=True),
    argument(
        "--loads",
        "axial loads (N), with a radial one behind a colon (default: those of the case of one bearing)",
        "FA[:FR]",
        nargs="+",
    ),
    argument("--temperatures", "temperatures of the oil (default: that of the case)", "C", type=float, nargs="+"),
    argument("--tolerance", "change of a settled torque (default: 0.01)", "SHARE", type=float, default=0.01),
    argument("--bands", "draw inputs that nobody knows exactly, and give the band of each torque"),
    argument("--samples", "draws of each point (default: 16)", "N", type=int, default=16),
    WORKERS,
    argument("-o --output", "writes NAME.nc and NAME.png (default: CASE_torque)", "NAME"),
    argument("--overwrite", "replace these files"),
    argument("--quiet", "no progress bar, no table"),
    SET,
)
def torque(options: Options) -> int:
    """Friction torque of a case over speed, load and temperature of the oil, split by what loses it. Writes the numbers as
    NAME.nc and a picture NAME.png.
    """
    from trbdyn import study, torque_map
    from trbdyn.base.own_files import output_path
    from trbdyn.model.motion import value_at
    from trbdyn.model.scene import Scene

    scene, run = subject_with_changes(options.case, options.changes)
    loads: list[float | tuple[float, float]] = [_load(text) for text in options.loads or ()]
    if not loads:
        if not isinstance(scene, Scene):
            limit = "must be given for bearings on a shaft: forces on the centre of mass (N)"
            raise InputError.of("--loads", MISSING, limit)
        loads = [(value_at(scene.axial_load, 0.0), value_at(scene.radial_load, 0.0))]
    name = options.output or f"{Path(options.case).stem}_torque"
    again = {"overwrite": options.overwrite}
    numbers, picture = (output_path(f"{name}{ending}", **again) for ending in (".nc", ".png"))
    found = torque_map(
        scene,
        options.speeds,
        loads,
        temperatures=options.temperatures,
        tolerance=options.tolerance,
        bands=options.bands,
        samples=options.samples,
        options=run,
        workers=options.workers,
        progress=not options.quiet,
    )
    study.save(found.data, numbers, **again)
    found.picture(picture, **again)
    if not options.quiet:
        say(found)
        say(f"\n{numbers}\n{picture}")
    if not found.settled:
        say("trbdyn: not every torque has settled; the table says which, and why", file=sys.stderr)
    return DONE if found.settled else FAILED


def _load(text: str) -> tuple[float, float]:
    try:
        axial, _, radial = text.partition(":")
        return float(axial), float(radial or 0.0)
    except ValueError:
        raise InputError.of("--loads", text, "must be FA or FA:FR, for instance 4930:2780 (N)") from None
