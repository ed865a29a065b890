"""Units, ranges and texts of inputs from the core's tables, where they are said once: parameters of a model
(``csrc/bearing/params.h``) and settings of an integration (``csrc/stepping/integrator.h``).

Models add what the core cannot know: defaults, angles in degrees, and bounds that are stricter than the table's.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from pydantic import Field

from trbdyn import _core


@dataclass(frozen=True)
class Parameter:
    """A row of the core's table."""

    name: str
    unit: str  # SI; "count" and "choice" stand for whole numbers
    lower: float
    upper: float
    text: str
    part: str  # whose it is: of the bearing, a roller, a rib, the cage and so on


PARAMETERS: Final = {row[0]: Parameter(*row) for row in _core.parameter_table()}
"""Rows of the core's table, by name."""


def parameter(name: str, **bounds: float) -> Any:
    """Metadata of a field that is a parameter of the core: its unit, range and text. Bounds (``gt``, ``ge``, ``lt``, ``le``) are
    those that are stricter than the table's.
    """
    row = PARAMETERS[name]
    whole = row.unit in ("count", "choice")
    if "gt" not in bounds:
        bounds.setdefault("ge", int(row.lower) if whole else row.lower)
    if "lt" not in bounds:
        bounds.setdefault("le", int(row.upper) if whole else row.upper)
    extra: dict[str, Any] = {"unit": "1" if whole else row.unit, "parameter": name}
    options: dict[str, Any] = dict(bounds)
    return Field(description=row.text, json_schema_extra=extra, **options)


@dataclass(frozen=True)
class Setting:
    """A row of the core's table of settings."""

    name: str
    default: float  # what it is unless something else is asked for
    lower: float
    upper: float
    text: str  # what it is, with its unit


SETTINGS: Final = {row[0]: Setting(*row) for row in _core.setting_table()}
"""Settings of an integration, by name."""


def setting(name: str, unit: str, **bounds: float) -> Any:
    """Metadata of a field that is a setting of the core's integration: its range and text. Bounds (``ge``, ``le``) are those with
    which the field allows more than the core, as 0 for a choice of the integrator.
    """
    row = SETTINGS[name]
    options: dict[str, Any] = {"ge": row.lower, "le": row.upper} | bounds
    return Field(description=row.text, json_schema_extra={"unit": unit, "setting": name}, **options)
