"""Commands that answer a question without a run: ``fit``, ``spectrum``, ``stiffness``; and ``export`` of a result."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

from trbdyn.cli.case import subject_with_changes
from trbdyn.cli.declared import CASE, FILE, SET, Options, argument, subcommand
from trbdyn.cli.outcome import DONE, say

CLEAN = argument("--cleanliness", "particles in the oil (ISO 4406), for instance 17/14", "CODE")
RELIABLE = argument("--reliability", "90, 95, 96, 97, 98 or 99", "PERCENT", type=float, default=90.0)


@subcommand(
    "fit",
    "fits of a case: interference of its seats, the play that is left, and its band",
    CASE,
    argument("--shaft", "tolerance of the shaft by ISO 286, for instance m6", "CODE", required=True),
    argument("--housing", "tolerance of the housing, for instance N7", "CODE", required=True),
    argument("--bore", "bore of the bearing in m (default: by its designation)", "M", type=float),
    argument("--outside", "outside diameter in m (default: by its designation)", "M", type=float),
    argument("--width", "width in m (default: by its designation)", "M", type=float),
    argument("--before-mounting", "the end play was set before mounting (default: of mounted bearings)"),
    argument("--inner", "temperature of shaft and inner rings (default: 20)", "C", type=float, default=20.0),
    argument("--outer", "temperature of outer rings and housing (default: 20)", "C", type=float, default=20.0),
    SET,
)
def fit(options: Options) -> int:
    """Interference of the seats of a case, what it and temperatures make of the rings, and the end play or clearance that is
    left, with its band over the tolerances. Bore, outside diameter and width are those of the table of designations where the
    bearing's name is one.
    """
    from trbdyn.errors import InputError
    from trbdyn.model.designations import designation
    from trbdyn.model.mounting import Mounting, Temperatures
    from trbdyn.statics.fit import fit

    subject = subject_with_changes(options.case, options.changes)[0]
    listed: dict[str, Any] = {
        name: cast(Any, part).bearing for name, part in zip(subject.names, subject.parts.values(), strict=True)
    }
    seats = {}
    for name, bearing in listed.items():
        sizes: dict[str, Any] = {}
        for size in ("bore", "outside", "width"):
            value = getattr(options, size)
            if value is None:
                try:
                    value = getattr(designation(bearing.name), size)
                except InputError:
                    limit = f"must be given: {bearing.name!r} is not in the table of designations (m)"
                    raise InputError.of(f"--{size}", None, limit) from None
            sizes[size] = value
        how = "before mounting" if options.before_mounting else "mounted"
        seats[name] = Mounting(**sizes, shaft=options.shaft, housing=options.housing, set=how)
    warm = Temperatures(
        shaft_c=options.inner,
        inner_ring_c=options.inner,
        rollers_c=0.5 * (options.inner + options.outer),
        outer_ring_c=options.outer,
        housing_c=options.outer,
    )
    say(fit(subject, seats.get("", seats), temperatures=warm))
    return DONE


@subcommand(
    "spectrum",
    "lives under a spectrum of load cases",
    CASE,
    argument("table", "CSV file: a row for each load case", "TABLE"),
    CLEAN,
    RELIABLE,
)
def spectrum(options: Options) -> int:
    """Lives of a case under a spectrum. The table has a column share, the time of each load case, and columns of what changes:
    speed_rpm, axial_load, loads[0].force[1] and so on. Commas, semicolons or tabs lie between cells; with semicolons or tabs,
    numbers may have decimal commas.
    """
    from trbdyn import spectrum
    from trbdyn.run.rating import rating

    say(rating(spectrum(options.case, options.table), cleanliness=options.cleanliness, reliability=options.reliability))
    return DONE


@subcommand("stiffness", "stiffness of a bearing, or of a shaft on its bearings", CASE, SET)
def stiffness(options: Options) -> int:
    """Stiffness about the equilibrium at the start of a case: forces and moments per displacement and tilt."""
    from trbdyn.statics.assembly import stiffness

    say(stiffness(subject_with_changes(options.case, options.changes)[0]))
    return DONE


@subcommand(
    "export",
    "write the records of a result for another program",
    FILE,
    argument("output", "file to write: NAME.csv, NAME.mat (MATLAB) or NAME.vtkhdf (ParaView)", "OUTPUT"),
    argument("--overwrite", "replace the file if it is there"),
)
def export(options: Options) -> int:
    """Write the records of a result for another program; the ending of the file's name says for which."""
    from trbdyn.results.assembly import load

    say(load(options.file).export(Path(options.output), overwrite=options.overwrite))
    return DONE
