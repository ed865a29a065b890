"""Base of every input model, and the kinds of number that it accepts."""

from __future__ import annotations

import hashlib
import inspect
import json
import math
import numbers
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Self

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, StrictBool, ValidationError, model_validator

from trbdyn.base.shown import Displayed, Shown, field_rows
from trbdyn.errors import InputError, Path, from_validation_error, join_path, unknown_name

_PART = re.compile(r"\[(\d+)\]|([^.\[\]]+)")


def split_paths(changes: Mapping[str, Any]) -> dict[Path, Any]:
    """Paths such as ``cage.other_pockets[0].index`` in parts."""
    if not isinstance(changes, Mapping):
        raise InputError.of("replace", changes, "must be a mapping of paths to values, or name=value")
    found: dict[Path, Any] = {}
    for path, value in changes.items():
        parts = [int(index) if index else name for index, name in _PART.findall(path)] if isinstance(path, str) else []
        if not parts or join_path(parts) != path:
            raise InputError.of("replace", path, "must be a path such as 'bearing.cage.mass' or 'gravity[1]'")
        found[tuple(parts)] = value
    return found


def _changed_value(before: Any, changes: Mapping[Path, Any]) -> Any:
    """A value with what lies below it changed."""
    if () in changes:
        return changes[()]
    if isinstance(before, Model):
        return before.replace(**before._changed(changes))
    where, value = next(iter(changes.items()))
    if isinstance(before, tuple):
        entries = list(before)
        for path, new in changes.items():
            place = path[0]
            if not isinstance(place, int) or place >= len(entries):
                raise InputError.of(
                    path, new, f"must name one of the {len(entries)} entries, [0] to [{len(entries) - 1}]"
                )
            entries[place] = _changed_value(entries[place], {path[1:]: new})
        return tuple(entries)
    limit = "has nothing below it: it is not given" if before is None else f"has nothing below it: it is {before!r}"
    raise InputError.of(where, value, f"{limit}; give the whole")


def unit(symbol: str, **bounds: float) -> Any:
    """Metadata of a number: its unit and bounds (``gt``, ``ge``, ``lt``, ``le``)."""
    options: dict[str, Any] = dict(bounds)
    return Field(json_schema_extra={"unit": symbol}, **options)


def as_number(value: object) -> float:
    """A real number as float; a ValueError for anything else, True and False among them."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise ValueError("must be a number")
    try:
        return float(value)
    except OverflowError:
        raise ValueError("must be a number below 1.8e308") from None


def as_whole_number(value: object) -> int:
    """A whole number as int; a ValueError for anything else, True, False and floats among them."""
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise ValueError("must be a whole number")
    whole = int(value)
    if abs(whole) >= 2**63:
        raise ValueError("must be a whole number of less than 64 bits")
    return whole


def number_of(name: str, value: object, symbol: str = "1", **bounds: float) -> float:
    """An argument that must be a real number, as float, within bounds in its unit (``gt``, ``ge``, or ``ge`` and ``le``); without
    them it may be infinite or not a number.
    """
    suffix = "" if symbol == "1" else f" ({symbol})"
    try:
        number = as_number(value)
    except ValueError as error:
        raise InputError.of(name, value, f"{error}{suffix}") from None
    low, high = bounds.get("gt", bounds.get("ge", -math.inf)), bounds.get("le", math.inf)
    if bounds and not (low < number if "gt" in bounds else low <= number <= high):
        limit = f"from {low:g} to {high:g}" if "le" in bounds else f"{'>' if 'gt' in bounds else '>='} {low:g}"
        raise InputError.of(name, value, f"must be {limit}{suffix}")
    return number


def whole_number_of(name: str, value: object, least: int, most: float = math.inf) -> int:
    """An argument that must be a whole number within limits, as int; True and False are none."""
    if isinstance(value, bool) or not isinstance(value, numbers.Integral) or not least <= int(value) <= most:
        limit = f"at least {least}" if most == math.inf else f"from {least} to {most}"
        raise InputError.of(name, value, f"must be a whole number, {limit}")
    return int(value)


Number = Annotated[float, BeforeValidator(as_number)]
Whole = Annotated[int, BeforeValidator(as_whole_number)]
Flag = StrictBool

Length = Annotated[Number, unit("m", gt=0)]
Gap = Annotated[Number, unit("m", ge=0)]
Ratio = Annotated[Number, unit("1", ge=0)]
Vector3 = tuple[Number, Number, Number]


if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)


class _Listed(ModelMetaclass):
    """Lists a model's own names: what pydantic adds to every model is not for users, and would fill ``help`` with
    pages.
    """

    def __dir__(cls) -> list[str]:
        own = (base for base in cls.__mro__ if issubclass(base, Model))
        names = {name for base in own for name in vars(base) if not name.startswith("_") and name not in _INTERNAL}
        return sorted(names | set(getattr(cls, "model_fields", ())))


_INTERNAL: Final = (
    "model_config",
    "model_copy",
    "model_fields",
    "model_computed_fields",
    "model_post_init",
    "model_rebuild",
    "model_validate",
)


class _Brief:
    """Stands in a signature for a model as default."""

    def __init__(self, model: object) -> None:
        self._name = type(model).__name__

    def __repr__(self) -> str:
        return f"{self._name}(...)"


def _brief(default: Any) -> Any:
    return _Brief(default) if isinstance(default, BaseModel) else default


class Model(Displayed, BaseModel, metaclass=_Listed):
    """A frozen, validated set of named values.

    Every number must be finite, every name known; anything else raises `InputError`.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, validate_default=True, defer_build=True)

    _root: ClassVar[str | None] = None
    _assumed: ClassVar[bool] = False
    """Whether fields that were not given are assumed by the model that this one belongs to, and again after each change."""

    @classmethod
    def __pydantic_init_subclass__(cls, **options: Any) -> None:
        super().__pydantic_init_subclass__(**options)
        cls._shorten_signature()

    @classmethod
    def model_rebuild(cls, **options: Any) -> bool | None:
        """Build the model when it is first used; see pydantic."""
        options["_parent_namespace_depth"] = options.get("_parent_namespace_depth", 2) + 1
        done = super().model_rebuild(**options)
        cls._shorten_signature()
        return done

    @classmethod
    def _shorten_signature(cls) -> None:
        """What ``help`` shows: no types, which the docstring tells, and inner models by their names."""
        variable = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
        own = list(inspect.signature(cls.__init__).parameters.values())[1:]
        given = {
            entry.name: entry.replace(annotation=inspect.Parameter.empty, default=_brief(entry.default))
            for entry in own
            if entry.kind not in variable
        }
        fields = {
            name: inspect.Parameter(
                name,
                inspect.Parameter.KEYWORD_ONLY,
                default=inspect.Parameter.empty
                if field.is_required()
                else _brief(field.get_default(call_default_factory=False)),
            )
            for name, field in cls.model_fields.items()
            if name not in given
        }
        cls.__signature__ = inspect.Signature([*given.values(), *fields.values()])

    def __dir__(self) -> list[str]:
        """What `dir` of the class lists, so that completion shows fields and methods of the model, none of pydantic's."""
        return dir(type(self))

    def __init__(self, /, *unnamed: Any, **fields: Any) -> None:
        if unnamed:
            name, names = type(self).__name__, list(type(self).model_fields)
            limit = f"must be given by name, as {name}({names[0]}=...); names: {', '.join(names)}"
            raise InputError.of(name, unnamed[0], limit)
        try:
            super().__init__(**fields)
        except ValidationError as error:
            raise from_validation_error(error, type(self).model_fields, self._path_root()) from None

    @model_validator(mode="after")
    def _check_whole(self) -> Self:
        self._check()
        return self

    def _check(self) -> None:
        """Refuse what does not fit together, by an `InputError`; every field is right by itself."""

    @classmethod
    def _path_root(cls) -> tuple[str, ...]:
        """What the names of fields start with in messages: the class's name in small letters, unless it sets
        `_root`.
        """
        root = cls.__name__.lower() if cls._root is None else cls._root
        return (root,) if root else ()

    @classmethod
    def model_validate(cls, obj: Any, **options: Any) -> Self:
        """A model from an instance or a mapping of its fields, or an `InputError` that says what is wrong with the values."""
        try:
            return super().model_validate(obj, **options)
        except ValidationError as error:
            raise from_validation_error(error, cls.model_fields, cls._path_root()) from None

    def replace(self, changes: Mapping[str, Any] | None = None, /, **fields: Any) -> Self:
        """A copy with some fields changed, validated again.

        Parameters
        ----------
        changes : mapping of str to object, optional
            Values by path, for what lies deeper: ``scene.replace({"bearing.cage.mass": 0.1, "gravity[1]": 0.0})``.
        **fields
            Values by name.

        Raises
        ------
        InputError
            If a name is unknown or a value not allowed.
        """
        if changes is not None:
            fields = {**self._changed(split_paths(changes)), **fields}
        kept = self.model_fields_set if self._assumed else type(self).model_fields
        return type(self)(**{**{name: getattr(self, name) for name in kept}, **fields})

    def _changed(self, changes: Mapping[Path, Any]) -> dict[str, Any]:
        """New values of the fields that changes by path lead to."""
        groups: dict[str | int, dict[Path, Any]] = {}
        for path, value in changes.items():
            groups.setdefault(path[0], {})[path[1:]] = value
        found: dict[str, Any] = {}
        for name, group in groups.items():
            if name not in type(self).model_fields:
                value = next(iter(group.values()))
                raise InputError.of(str(name), value, unknown_name(str(name), type(self).model_fields))
            try:
                found[str(name)] = _changed_value(getattr(self, str(name)), group)
            except InputError as error:
                raise error.under((name,)) from None
        return found

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """A copy; changed fields are validated."""
        return self.replace(**update) if update else super().model_copy(deep=deep)

    def _shown(self) -> Shown:
        return Shown(type(self).__name__, tuple(field_rows(self)))

    def __setattr__(self, name: str, value: Any) -> None:
        if name in type(self).model_fields:
            raise InputError.of(name, value, "cannot be changed; use replace(...) to get a changed copy")
        super().__setattr__(name, value)

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return all(getattr(self, name) == getattr(other, name) for name in type(self).model_fields)

    def __hash__(self) -> int:
        return hash((type(self), *(getattr(self, name) for name in type(self).model_fields)))

    def to_dict(self) -> dict[str, Any]:
        """Plain dictionaries, lists, numbers and text, as `from_dict` and JSON take them."""
        return self.model_dump(mode="json")

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Self:
        """The model that `to_dict` described, or an `InputError` that says what is wrong with the values."""
        return cls.model_validate(values)

    def to_json(self) -> str:
        """JSON text; numbers are written so that `from_json` gets back exactly the same ones."""
        return json.dumps(self.to_dict(), allow_nan=False)

    @classmethod
    def from_json(cls, text: str | bytes) -> Self:
        """The model that `to_json` wrote, or an `InputError` that says what is wrong with the text or the values."""
        try:
            values = json.loads(text)
        except RecursionError:
            raise InputError.of("json", text[:40], "must be JSON text that is not nested so deeply") from None
        except (ValueError, TypeError) as error:
            found = text[:40] if isinstance(text, str | bytes) else text
            raise InputError.of("json", found, f"must be JSON text: {error}") from None
        return cls.from_dict(values)

    @property
    def fingerprint(self) -> str:
        """SHA-256 of the model's values, as 64 hexadecimal digits: the same in every process and on every machine."""
        text = json.dumps(self.to_dict(), sort_keys=True, separators=(",", ":"), allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()
