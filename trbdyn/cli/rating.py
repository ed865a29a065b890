"""The command ``rating``: equivalent load, lives, static safety and viscosity ratio of a case or of a result."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

from trbdyn.cli.case import subject_with_changes
from trbdyn.cli.declared import SET, Options, argument, subcommand
from trbdyn.cli.outcome import DONE
from trbdyn.errors import InputError

RESULTS = (".h5", ".hdf5")


@subcommand(
    "rating",
    "rating lives, static safety and viscosity ratio of a case or a result",
    argument("subject", "a TOML file, the name of a shipped case, or a result file", "CASE"),
    argument("--cleanliness", "particles in the oil (ISO 4406), for instance 17/14", "CODE"),
    argument("--filtered", "circulating oil with an in-line filter", default=None),
    argument("--reliability", "from 90 to 99.95", "PERCENT", type=float, default=90.0),
    argument("--json", "print the numbers as JSON, in SI units and hours"),
    SET,
)
def rating(options: Options) -> int:
    """Equivalent load, lives (ISO 281, ISO 16281), static safety (ISO 76) and viscosity ratio of a case, by its
    equilibrium, or of a result, by its records. Of bearings on a shaft: each bearing, and the lives of all together.
    """
    from trbdyn.results.assembly import load
    from trbdyn.results.summary import clean
    from trbdyn.run.rating import rating

    how = {name: getattr(options, name) for name in ("cleanliness", "filtered", "reliability")}
    if Path(options.subject).suffix in RESULTS:
        if options.changes:
            raise InputError.of("--set", options.changes[0], "must not be given with a result: its case has been run")
        found: Any = rating(load(options.subject), **how)
    else:
        found = rating(subject_with_changes(options.subject, options.changes)[0], **how)
    print(json.dumps(clean(asdict(found)), indent=2, allow_nan=False) if options.json else found)
    return DONE
