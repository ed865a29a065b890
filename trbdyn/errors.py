"""Exceptions that users of trbdyn meet.

Every exception derives from `TrbError`. Bad input is an `InputError`: it names the field, the value found and what is
allowed, one line per problem, before anything runs.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from pydantic import ValidationError
    from pydantic.fields import FieldInfo

__all__ = ["FileError", "InputError", "LoadError", "MissingExtra", "Problem", "RunWarning", "StepError", "TrbError"]


def __dir__() -> list[str]:
    return sorted(__all__)


MOST_TOLD: Final = 20
"""Most problems of one kind that are told at once."""
LONGEST_NAME: Final = 80
"""Most letters of a name in a message."""

Path = tuple[str | int, ...]


class _Missing:
    """Marks a value that was not given."""

    def __repr__(self) -> str:
        return "MISSING"

    def __reduce__(self) -> str:
        return "MISSING"


MISSING: Final = _Missing()


class TrbError(Exception):
    """Base of every exception of trbdyn."""


@dataclass(frozen=True)
class Problem:
    """One thing wrong with the input.

    Attributes
    ----------
    path : tuple of str or int
        Where the value stands: names of fields, indices in sequences.
    value : object
        The value found; `MISSING` if there is none.
    allowed : str
        What is allowed, with the unit.
    """

    path: Path
    value: object
    allowed: str

    def line(self, root: Path = ()) -> str:
        """One readable line, for instance ``bearing.roller.diameter = -3 : must be > 0 (m)``."""
        where = join_path(root + self.path) or "input"
        return (
            f"{where} : {self.allowed}" if self.value is MISSING else f"{where} = {_short(self.value)} : {self.allowed}"
        )


class InputError(TrbError, ValueError):
    """Input that cannot be used.

    Parameters
    ----------
    problems : sequence of Problem
        What is wrong, at least one.
    root : tuple of str or int, optional
        Where the paths of the problems start.

    Attributes
    ----------
    problems : tuple of Problem
        What is wrong.
    field : str
        Full name of the first field that is wrong.
    value : object
        Its value.
    allowed : str
        What is allowed there.
    """

    def __init__(self, problems: Sequence[Problem], root: Path = ()) -> None:
        self.problems = tuple(problems)
        self.root = root
        lines = [problem.line(root) for problem in self.problems[:MOST_TOLD]]
        rest = len(self.problems) - MOST_TOLD
        super().__init__("\n".join(lines + ([f"and {rest} more"] if rest > 0 else [])))

    @classmethod
    def of(cls, field: str | Path, value: object, allowed: str) -> InputError:
        """One problem: the field (a name or a path), its value, what is allowed."""
        return cls([Problem((field,) if isinstance(field, str) else field, value, allowed)])

    @property
    def field(self) -> str:
        return join_path(self.root + self.problems[0].path)

    @property
    def value(self) -> object:
        return self.problems[0].value

    @property
    def allowed(self) -> str:
        return self.problems[0].allowed

    def under(self, path: Path) -> InputError:
        """The same problems, their paths prolonged at the front by `path`."""
        return type(self)([Problem(path + problem.path, problem.value, problem.allowed) for problem in self.problems])

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.problems, self.root)


class LoadError(TrbError):
    """No static equilibrium: the bearing cannot carry this load."""


class FileError(TrbError, OSError):
    """A file that cannot be read or written as asked."""


class MissingExtra(TrbError, ImportError):
    """A part of trbdyn was called that is not installed, or whose packages are not."""


class RunWarning(UserWarning):
    """A run is doubtful: its energy does not add up, or it makes no progress. `Result.warnings` keeps what was said."""


class StepError(TrbError):
    """A time step that failed.

    Parameters
    ----------
    message : str
        What failed, in a sentence.
    time : float
        Last good time (s).
    body : str, optional
        Body whose quantity failed, for instance ``roller 3`` or ``cage``.
    quantity : str, optional
        Quantity that failed.
    result : object, optional
        Everything that was kept up to the last good time.
    """

    def __init__(
        self, message: str, *, time: float, body: str | None = None, quantity: str | None = None, result: Any = None
    ) -> None:
        super().__init__(message)
        self.time = time
        self.body = body
        self.quantity = quantity
        self.result = result

    def __reduce__(self) -> tuple[Any, ...]:
        state = {"time": self.time, "body": self.body, "quantity": self.quantity, "result": self.result}
        return _rebuild_step_error, (type(self), str(self), state)


def _rebuild_step_error(cls: type[StepError], message: str, state: Mapping[str, Any]) -> StepError:
    return cls(message, **state)


def join_path(path: Iterable[str | int]) -> str:
    """A path as users write it: ``bearing.cage.pocket.faces[2].outline``."""
    text = ""
    for part in path:
        name = f"{part[: LONGEST_NAME - 3]}..." if isinstance(part, str) and len(part) > LONGEST_NAME else part
        text += f"[{part}]" if isinstance(part, int) else f".{name}" if text else str(name)
    return text


def unknown_name(name: str, allowed: Iterable[str]) -> str:
    """What to say of a name that is not known: the nearest known one and all that are allowed."""
    names = sorted(allowed)
    near = difflib.get_close_matches(name[:LONGEST_NAME], names, n=1)
    hint = f"did you mean '{near[0]}'? " if near else ""
    return f"unknown name; {hint}allowed: {', '.join(names)}"


def from_validation_error(error: ValidationError, fields: Mapping[str, FieldInfo], root: Path = ()) -> InputError:
    """An `InputError` with one problem per line of a pydantic error.

    Parameters
    ----------
    error : pydantic.ValidationError
        The error of one model.
    fields : mapping of str to FieldInfo
        The model's fields: their units and names.
    root : tuple of str or int, optional
        Where the paths of the problems start.
    """
    problems: list[Problem] = []
    for line in error.errors(include_url=False)[:MOST_TOLD]:
        context = line.get("ctx", {})
        cause = context.get("error")
        where: Path = tuple(line["loc"])
        if isinstance(cause, InputError):
            problems.extend(Problem(where + problem.path, problem.value, problem.allowed) for problem in cause.problems)
            continue
        kind = line["type"]
        value = MISSING if kind == "missing" or (kind == "value_error" and not where) else line["input"]
        problems.append(
            Problem(where, value, _allowed(kind, context, line["msg"], where, fields) + _unit(where, fields))
        )
    return InputError(problems, root)


_COMPARISONS: Final = {
    "greater_than": ("gt", ">"),
    "greater_than_equal": ("ge", ">="),
    "less_than": ("lt", "<"),
    "less_than_equal": ("le", "<="),
}

_SENTENCES: Final = {
    "missing": "is required",
    "finite_number": "must be a finite number",
    "float_type": "must be a number",
    "int_type": "must be a whole number",
    "bool_type": "must be true or false",
    "string_type": "must be text",
    "tuple_type": "must be a sequence",
    "frozen_instance": "cannot be changed; use replace(...) to get a changed copy",
    "frozen_field": "cannot be changed; use replace(...) to get a changed copy",
    "model_type": "must be a table of named values",
}


def _allowed(kind: str, context: Mapping[str, Any], message: str, where: Path, fields: Mapping[str, FieldInfo]) -> str:
    """What is allowed, from the kind of a pydantic error."""
    if kind in _COMPARISONS:
        key, sign = _COMPARISONS[kind]
        return f"must be {sign} {context[key]:g}"
    if kind in _SENTENCES:
        return _SENTENCES[kind]
    if kind == "value_error":
        return str(context["error"])
    if kind in ("literal_error", "enum"):
        return f"must be {context['expected']}"
    if kind == "extra_forbidden" and len(where) == 1:
        return unknown_name(str(where[0]), fields)
    if kind == "too_short":
        return f"must have at least {context['min_length']} entries"
    if kind == "too_long":
        return f"must have at most {context['max_length']} entries"
    return message[:1].lower() + message[1:]


def _unit(where: Path, fields: Mapping[str, FieldInfo]) -> str:
    """The unit of the field that a path starts with, in brackets; empty if it has none."""
    info = fields.get(str(where[0])) if where else None
    extra = info.json_schema_extra if info is not None else None
    symbol = extra.get("unit", "1") if isinstance(extra, dict) else "1"
    return "" if symbol == "1" else f" ({symbol})"


def _short(value: object) -> str:
    try:
        text = repr(value)
    except (ValueError, RecursionError):
        text = "a whole number of thousands of digits" if isinstance(value, int) else f"a {type(value).__name__}"
    return text if len(text) <= 60 else text[:57] + "..."
