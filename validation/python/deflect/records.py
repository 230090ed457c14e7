"""The JSON of results as dataclasses: each says its members by their names there, with types. One schema, in schema.py
(parts) and results.py (results); tests hold what the program writes against it, member by member.

    str, float, int, bool, list[…], dict[str, …]   as in the JSON
    Array                a list of numbers, or of such lists, as a NumPy array; null is NaN
    Optional[…]          null is None
    Maybe[…]             a member that may be missing: None then
    Others[…]            a dict of all members that no other field names: one for each theory
"""

from __future__ import annotations

import dataclasses
import typing
from typing import Annotated, Any, Dict, Iterator, List, Optional, TypeVar

import numpy as np

T = TypeVar("T")
Array = np.ndarray
Maybe = Annotated[Optional[T], "maybe"]
Others = Annotated[Dict[str, T], "others"]


class Record:
    """A part of a result. Its members are attributes, and by name as in the JSON: ``p.value``, ``p["value"]``. Equal
    where all members are."""

    def __getitem__(self, name: str) -> Any:
        """The member of this name; KeyError with those that there are."""
        for field in fields_of(type(self)):
            value = getattr(self, field.name)
            if field.others and name in value:
                return value[name]
            if field.name == name and not (field.maybe and value is None):
                return value
        raise KeyError(f"{type(self).__name__} has no '{name}'; it has {', '.join(self.keys())}")

    def keys(self) -> list[str]:
        """Names of the members that are there, as in the JSON."""
        return list(self.to_dict())

    def get(self, name: str, default: Any = None) -> Any:
        """The member of this name, or the default."""
        try:
            return self[name]
        except KeyError:
            return default

    def __contains__(self, name: str) -> bool:
        return name in self.keys()

    def to_dict(self) -> dict[str, Any]:
        """The JSON as dicts, lists and plain values, made of the members."""
        return dict(_written(self))

    def __eq__(self, other: Any) -> bool:
        return type(self) is type(other) and self.to_dict() == other.to_dict()


@dataclasses.dataclass(frozen=True)
class Field:
    """A field of a record: its type without what ``maybe`` and ``others`` say."""

    name: str
    type: Any
    maybe: bool
    others: bool


_FIELDS: dict[type, tuple[Field, ...]] = {}


def fields_of(kind: type) -> tuple[Field, ...]:
    """The fields of a record's class, in the order in which they are written."""
    if kind not in _FIELDS:
        _FIELDS[kind] = _fields(kind)
    return _FIELDS[kind]


def _fields(kind: Any) -> tuple[Field, ...]:
    hints = typing.get_type_hints(kind, include_extras=True)
    out = []
    for each in dataclasses.fields(kind):
        hint, marks = hints[each.name], []
        if typing.get_origin(hint) is Annotated:
            hint, *marks = typing.get_args(hint)
        out.append(Field(each.name, hint, "maybe" in marks, "others" in marks))
    return tuple(out)


def values_of(kind: type, content: dict[str, Any]) -> dict[str, Any]:
    """The fields of a record from its JSON; None for what is missing."""
    named = {f.name for f in fields_of(kind)}
    out = {}
    for f in fields_of(kind):
        if f.others:
            inner = typing.get_args(f.type)[1]
            out[f.name] = {name: _read(inner, value) for name, value in content.items() if name not in named}
        else:
            out[f.name] = _read(f.type, content.get(f.name))
    return out


def record(kind: type, content: dict[str, Any]) -> Any:
    """The record of a JSON object."""
    return kind(**values_of(kind, content))


def _inner(hint: Any) -> tuple[Any, tuple[Any, ...]]:
    return typing.get_origin(hint), typing.get_args(hint)


def _read(hint: Any, value: Any) -> Any:
    if value is None:
        return None
    origin, arguments = _inner(hint)
    if origin is typing.Union:  # Optional
        return _read(arguments[0], value)
    if origin is list and arguments[0] not in (str, float, int, bool):
        return [_read(arguments[0], each) for each in value]
    if origin is dict and arguments[1] not in (str, float, int, bool, Any):
        return {name: _read(arguments[1], each) for name, each in value.items()}
    if hint is Array:
        return np.array(value, dtype=float)
    if isinstance(hint, type) and issubclass(hint, Record):
        return record(hint, value)
    return value


def _plain(value: Any) -> Any:
    if isinstance(value, Record):
        return dict(_written(value))
    if isinstance(value, np.ndarray):
        return _without_nan(value.tolist())
    if isinstance(value, list):
        return [_plain(each) for each in value]
    if isinstance(value, dict):
        return {name: _plain(each) for name, each in value.items()}
    return value


def _without_nan(value: Any) -> Any:
    if isinstance(value, list):
        return [_without_nan(each) for each in value]
    return None if value != value else value


def _written(one: Record) -> Iterator[tuple[str, Any]]:
    for f in fields_of(type(one)):
        value = getattr(one, f.name)
        if f.others:
            yield from _plain(value).items()
        elif not (f.maybe and value is None):
            yield f.name, _plain(value)


def differences(hint: Any, value: Any, at: str = "") -> List[str]:
    """Where a JSON value is not what the schema says, "candidates[2].site: missing"; empty where all fits."""
    origin, arguments = _inner(hint)
    if origin is typing.Union:
        return [] if value is None else differences(arguments[0], value, at)
    if isinstance(hint, type) and issubclass(hint, Record):
        return _differences_of_record(hint, value, at)
    if hint is Any:
        return []
    if origin is list and isinstance(value, list):
        return [d for i, each in enumerate(value) for d in differences(arguments[0], each, f"{at}[{i}]")]
    if origin is dict and isinstance(value, dict):
        return [d for name, each in value.items() for d in differences(arguments[1], each, f"{at}.{name}")]
    if hint is Array:
        return _differences_of_array(value, at)
    wanted: dict[Any, tuple[type, ...]] = {float: (int, float), int: (int,), str: (str,), bool: (bool,)}
    fits = isinstance(value, wanted.get(hint, ())) and (hint is bool or not isinstance(value, bool))
    return [] if fits else [f"{at}: {value!r:.60} is no {getattr(hint, '__name__', hint)}"]


def _differences_of_array(value: Any, at: str) -> List[str]:
    if value is None or (isinstance(value, (int, float)) and not isinstance(value, bool)):
        return []
    if isinstance(value, list):
        return [d for i, each in enumerate(value) for d in _differences_of_array(each, f"{at}[{i}]")]
    return [f"{at}: {value!r:.60} is no number"]


def _differences_of_record(kind: type, value: Any, at: str) -> List[str]:
    if not isinstance(value, dict):
        return [f"{at}: {value!r:.60} is no object"]
    out, others = [], None
    for f in fields_of(kind):
        if f.others:
            others = typing.get_args(f.type)[1]
        elif f.name in value:
            out += differences(f.type, value[f.name], f"{at}.{f.name}")
        elif not f.maybe:
            out.append(f"{at}.{f.name}: missing")
    named = {f.name for f in fields_of(kind)}
    for name in value:
        if name not in named:
            out += [f"{at}.{name}: unknown"] if others is None else differences(others, value[name], f"{at}.{name}")
    return out
