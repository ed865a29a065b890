"""What the descriptions of all pictures have in common, and the check of what they are given."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any, Final

from trbdyn.base.expected import expect

SECTION: Final = re.compile(r"\n*^(Parameters|Returns|Raises|Examples)\n-+\n", re.MULTILINE)


def describe(draw: Callable[..., Any], groups: Sequence[str]) -> None:
    """Complete the description of a picture: the result with the groups that it needs, the axes, and what is returned.

    Parameters
    ----------
    draw : callable
        The function that draws; what its description has already is left as it is.
    groups : sequence of str
        Groups that the result must have beside the group time.
    """
    signature = inspect.signature(draw)
    words, *parts = SECTION.split(inspect.cleandoc(draw.__doc__ or ""))
    sections = dict(zip(parts[::2], parts[1::2], strict=True))
    known = {"ax": "ax : Axes, optional\n    Axes to draw into."}
    if groups:
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
