"""Inputs that were not given but estimated: value, band and source of each."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from trbdyn.base.validation import Model, Number


class Estimated(Model):
    """An input of a bearing that was estimated.

    Parameters
    ----------
    path : str
        Which input, for instance ``roller.diameter``.
    value : float
        The estimate, in the unit of the input.
    low, high : float
        Band in which the true value is expected, same unit.
    unit : str
        Unit.
    source : str
        Where the estimate comes from.
    """

    path: Annotated[str, Field(min_length=1)]
    value: Number
    low: Number
    high: Number
    unit: str
    source: Annotated[str, Field(min_length=1)]

    @classmethod
    def of(cls, path: str, value: float, low: float, high: float, unit: str, source: str) -> Estimated:
        """An estimate whose band holds its value."""
        return cls(path=path, value=value, low=min(low, value), high=max(high, value), unit=unit, source=source)

    def __str__(self) -> str:
        unit = "" if self.unit == "1" else f" {self.unit}"
        return f"{self.path} = {self.value:.4g}{unit} ({self.low:.4g} to {self.high:.4g}): {self.source}"
