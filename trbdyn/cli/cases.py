"""The commands ``cases`` and ``new``: the cases that ship, and a case to begin with."""

from __future__ import annotations

import inspect
import math
from typing import TYPE_CHECKING, Any, Final

from trbdyn.base.own_files import output_path, write_whole
from trbdyn.cli.called import command
from trbdyn.cli.case import subject_with_changes
from trbdyn.cli.declared import Options, argument, subcommand
from trbdyn.cli.outcome import DONE, say
from trbdyn.errors import InputError

if TYPE_CHECKING:
    from trbdyn.model.assembly import Subject
    from trbdyn.run.options import RunOptions

SHIPPED: Final = "rig_30310"
"""The case that a new one begins with."""
LOAD_OVER_RATING: Final = 0.04
"""Axial load of an example over the dynamic load rating: that of the test bearing is 0.046."""
PITCH_SPEED: Final = 9.0
"""Speed of an example on the pitch circle (m/s): that of the test bearing at 3000 rpm is 13, gearboxes have 5 to 15."""


@subcommand(
    "new",
    "write a case with every number, to change for your own bearing",
    argument("file", "a TOML file", "FILE"),
    argument("--overwrite", "replace the file if it is there"),
    argument("--case", "the case to begin with (default: rig_30310)", "NAME", group="begin"),
    argument(
        "--catalogue",
        "begin with a bearing from the numbers of a catalogue page, in m and N: "
        "bore=0.04 outside=0.08 width=0.02475 C=74800 e=0.37 name=32208; of a cylindrical bearing with flanges=NU in place of e",
        "NAME=VALUE",
        nargs="+",
        group="begin",
    ),
)
def new(options: Options) -> int:
    from trbdyn.run.case_text import case_text

    how: dict[str, Any] = {"overwrite": options.overwrite, "endings": (".toml",)}
    output_path(options.file, field="FILE", **how)
    text = case_text(*_first_case(options), title=_title(options))
    path = write_whole(options.file, text, field="FILE", **how)
    say(f"{path} written: change its numbers, then run it with: {command('run', path)}")
    return DONE


def _first_case(options: Options) -> tuple[Subject, RunOptions]:
    from trbdyn.model.bearing import Bearing
    from trbdyn.model.catalogue import NAMES_OF_CATALOGUES
    from trbdyn.model.scene import Scene
    from trbdyn.run.case_text import rounded
    from trbdyn.run.options import RunOptions

    if options.catalogue is None:
        return subject_with_changes(options.case or SHIPPED, ())
    numbers = dict(map(_number, options.catalogue))
    known = inspect.signature(Bearing.from_catalogue).parameters.values()
    allowed = [entry.name for entry in known if entry.kind is not inspect.Parameter.VAR_KEYWORD]
    for name, value in numbers.items():
        if name not in allowed:
            called = NAMES_OF_CATALOGUES.get(name)
            hint = f"is called {called} here; " if called else ""
            raise InputError.of("--catalogue", f"{name}={value}", f"{hint}must be one of {', '.join(allowed)}")
    missing = [name for name in ("bore", "outside", "width", "C") if name not in numbers]
    if missing:
        raise InputError.of("--catalogue", " ".join(options.catalogue), f"must hold {', '.join(missing)} as well")
    bearing = Bearing.from_dict(rounded(Bearing.from_catalogue(**numbers).inputs()))
    load = float(f"{LOAD_OVER_RATING * numbers['C']:.2g}")
    speed = float(f"{PITCH_SPEED / (math.pi * bearing.pitch_diameter) * 60.0:.1g}")
    loads = {"axial_load": load}
    if bearing.is_cylindrical:
        loads = {"radial_load": load, "axial_load": 0.1 * load if bearing.ribs.flanges in ("NJ", "NUP") else 0.0}
    return Scene(bearing, speed_rpm=speed, **loads), RunOptions(revolutions=10.0)


def _number(text: str) -> tuple[str, Any]:
    name, _, value = text.partition("=")
    if name in ("name", "flanges"):
        return name, value
    try:
        number = float(value)
    except ValueError:
        raise InputError.of("--catalogue", text, "must be NAME=VALUE, for instance bore=0.04") from None
    return name, int(number) if name == "n_rollers" and number.is_integer() else number


def _title(options: Options) -> str:
    if options.catalogue is None:
        return f"Begun from the case {options.case or SHIPPED}."
    return (
        f"Begun from catalogue numbers: {' '.join(options.catalogue)}. Speed and load are examples.\n"
        "# What is estimated belongs together: a number that is changed here, such as n_rollers, changes alone. To derive\n"
        "# the others again, write the case again with it: --catalogue ... n_rollers=17"
    )


@subcommand(
    "cases",
    "list the cases that ship with the package",
    argument("--print", "print this case with every number and what it means", "NAME", dest="name"),
)
def cases(options: Options) -> int:
    from trbdyn.base.shipped import ASSEMBLIES, CASES, SUBJECTS
    from trbdyn.run.case_text import case_text

    if options.name is not None and options.name.removesuffix(".toml") in ASSEMBLIES.names():
        say(ASSEMBLIES.find(options.name).read_text(encoding="utf-8"), end="")
        return DONE
    if options.name is not None:
        first = CASES.find(options.name).read_text(encoding="utf-8").partition("\n")[0].lstrip("# ")
        say(case_text(*subject_with_changes(options.name, ()), title=first), end="")
        return DONE
    for path in map(SUBJECTS.find, SUBJECTS.names()):
        first = path.read_text(encoding="utf-8").partition("\n")[0]
        say(f"{path.stem:<16} {first.lstrip('# ')}")
    return DONE
