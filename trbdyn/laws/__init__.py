"""The laws of the C core as functions over NumPy arrays: the same code that the simulation runs.

Every law takes its arguments by position or name, broadcasts them, and gives a float64 array (a scalar for scalars).
``trbdyn.laws.names()`` lists them; each docstring names equation and source.

    >>> import trbdyn as trb
    >>> trb.laws.traction_muraki_kimura(sigma=10.0, d=1.0)
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trbdyn import _core
from trbdyn.errors import InputError
from trbdyn.laws.texts import docstring

Law = Callable[..., Any]


def _make(name: str, arguments: str, text: str) -> Law:
    parameters = [inspect.Parameter(part, inspect.Parameter.POSITIONAL_OR_KEYWORD) for part in arguments.split()]
    signature = inspect.Signature(parameters)

    def law(*args: ArrayLike, **keywords: ArrayLike) -> Any:
        try:
            given = signature.bind(*args, **keywords).arguments
        except TypeError as error:
            raise TypeError(f"{name}: {error}; takes ({', '.join(signature.parameters)})") from None
        missing = [part for part, value in given.items() if value is None]
        if missing:
            raise InputError.of(("laws", name, missing[0]), None, "must be numbers, one or an array")
        try:
            arrays = np.broadcast_arrays(*(np.asarray(given[part], dtype=np.float64) for part in signature.parameters))
        except (TypeError, ValueError) as error:
            raise InputError.of(("laws", name), "arguments", f"must be numbers that broadcast: {error}") from None
        shape = arrays[0].shape
        rows: NDArray[np.float64] = np.ascontiguousarray([array.ravel() for array in arrays], dtype=np.float64)
        out = _core.law(name, rows)
        out[np.isnan(rows).any(axis=0)] = np.nan
        out = out.reshape(shape)
        return out if shape else float(out)

    law.__name__ = law.__qualname__ = name
    law.__signature__ = signature  # type: ignore[attr-defined]
    law.__doc__ = docstring(name, list(signature.parameters), text)
    return law


_TABLE = {name: _make(name, arguments, text) for name, arguments, text in _core.law_table()}
globals().update(_TABLE)
__all__ = ["names", *_TABLE]


def __dir__() -> list[str]:
    return sorted(__all__)


def names() -> tuple[str, ...]:
    """Names of the laws."""
    return tuple(_TABLE)


def __getattr__(name: str) -> Law:
    raise AttributeError(f"no law {name!r}; there are {', '.join(_TABLE)}")
