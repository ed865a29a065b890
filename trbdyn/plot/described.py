"""What the descriptions of all pictures have in common, and the check of what they are given."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any, Final

from trbdyn.base.expected import expect

SHARED: Final = {
    entry.partition(" : ")[0]: entry
    for entry in (
        "along : {'x', 'y', 'z'}\n    Direction.",
        "ax : Axes, optional\n    Axes to draw into.",
        "bearing : Bearing\n    The bearing.",
        "bins : int\n    Number of places around the bearing.",
        "last : float or None\n    Number of last shaft revolutions to show; None shows all.",
        "on : {'cage', 'outer_ring'}\n    The body.",
        "once_per : {'cage', 'shaft', 'roller'}\n    A turn of the cage, of the shaft, or a pitch of the cage (the next roller).",
        "pocket : int\n    Number of the pocket, 0 to Z - 1.",
        "records : int\n    Number of records to use, spread over the run.",
        "ring : {'inner', 'outer'}\n    Which ring: the outer one where it moves with a housing.",
        "segments : int\n    Number of segments to average.",
        "threshold : float\n    Force above which a face counts as touched (N).",
    )
}
"""Arguments that several pictures have: each is described once."""
NEEDED: Final = {
    "on": "Needs the group cage; rollers and peaks for the outer ring.",
    "ring": "Needs the groups time and ring, or housing for the outer ring.",
}
"""What the result must have for a picture with one of these arguments."""
SECTION: Final = re.compile(r"\n*^(Parameters|Returns|Raises|Examples)\n-+\n", re.MULTILINE)


def describe(draw: Callable[..., Any], groups: Sequence[str]) -> None:
    """Complete the description of a picture: the result with the groups that it needs beside the group time, arguments that
    several pictures have, and what is returned. What its description has already is left as it is.
    """
    signature = inspect.signature(draw)
    words, *parts = SECTION.split(inspect.cleandoc(draw.__doc__ or ""))
    sections = dict(zip(parts[::2], parts[1::2], strict=True))
    known = dict(SHARED)
    for name in NEEDED.keys() & signature.parameters.keys():
        known["result"] = f"result : Result\n    {NEEDED[name]}"
    if groups and "ring" not in signature.parameters:
        known["result"] = (
            f"result : Result\n    Needs the groups {' and '.join([', '.join(['time', *groups[:-1]]), groups[-1]])}."
        )
    entries = re.split(r"\n(?=\w)", sections.pop("Parameters", "").strip())
    known |= {re.split(r",| : ", entry, maxsplit=1)[0]: entry for entry in entries if entry}
    given = [known[name] for name in signature.parameters if name in known]
    sections = {"Parameters": "\n".join(given), "Returns": str(signature.return_annotation)} | sections
    draw.__doc__ = "\n\n".join(
        [words, *(f"{name}\n{'-' * len(name)}\n{text}" for name, text in sections.items() if text)]
    )


def of_its_kind(draw: Callable[..., Any], kind: type) -> Callable[..., Any]:
    """A picture that refuses anything but the kind of result that it shows."""

    @wraps(draw)
    def checked(result: Any, *given: Any, **named: Any) -> Any:
        expect("result", result, kind)
        return draw(result, *given, **named)

    return checked
