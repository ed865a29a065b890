"""What a run has given: recorded fields, observables, summary, and the files that hold them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from trbdyn.results.result import Result, load

__all__ = ["Result", "load"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module 'trbdyn.results' has no attribute {name!r}")
    from trbdyn.results import result  # loaded when it is needed

    globals().update({known: getattr(result, known) for known in __all__})
    return globals()[name]
