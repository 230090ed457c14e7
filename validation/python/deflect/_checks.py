"""Arguments as users give them: numbers, whole numbers, rows of numbers, texts and lists. What is something else is an
InputError that names the argument, what was given and what is wanted; whether a value makes sense others judge."""

from __future__ import annotations

import operator
import os
from typing import Any

import numpy as np

from . import _core
from .errors import InputError

MOST_THREADS = 1024
MOST_SEED = 2**64 - 1
#: readings, poses, load cases, elements of a member
MOST = 100_000


def shown(value: Any) -> str:
    """The value in a message: on one line and short."""
    words = " ".join(repr(value).split())
    return words if len(words) <= 60 else words[:59] + "…"


def is_missing(value: Any) -> bool:
    """None, and what pandas writes into an empty cell."""
    return value is None or type(value).__name__ == "NAType"


def number(name: str, value: Any) -> float:
    """Also NaN and infinity."""
    kind = getattr(getattr(value, "dtype", None), "kind", "f")
    if kind in "fiuO" and not isinstance(value, (str, bytes, bool, complex)):
        try:
            return float(value)
        except (TypeError, ValueError, OverflowError):
            pass
    raise InputError(f"{name}: {shown(value)} is no number")


def maybe_number(name: str, value: Any) -> float | None:
    return None if value is None else number(name, value)


def maybe_largest(name: str, value: Any, unit: str) -> float | None:
    """A limit, of zero or more."""
    if value is not None and not 0 <= number(name, value) < 1e12:
        raise InputError(f"{name} = {shown(value)}: give {unit} of zero or more")
    return maybe_number(name, value)


def whole(name: str, value: Any, low: int, high: int) -> int:
    """A whole number within limits; 4.0 is one."""
    found = None
    if isinstance(value, (float, np.floating)) and float(value).is_integer():
        found = int(value)
    elif not isinstance(value, (bool, np.bool_)) and hasattr(value, "__index__"):
        try:
            found = operator.index(value)
        except TypeError:  # an array
            pass
    if found is None or not low <= found <= high:
        most = "2^64 - 1" if high == MOST_SEED else high
        raise InputError(f"{name} = {shown(value)}: give a whole number from {low} to {most}")
    return found


def threads_of(value: Any) -> int:
    return whole("threads", value, 0, MOST_THREADS)


def truth(name: str, value: Any) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise InputError(f"{name}: {shown(value)} is neither True nor False")
    return bool(value)


def text(name: str, value: Any) -> str:
    if not isinstance(value, str):
        raise InputError(f"{name}: {shown(value)} is no text")
    return value


def listed(name: str, values: Any, one: Any = (str, os.PathLike), least: str = "") -> list[Any]:
    """As a list; what is ``one`` stands for a list of it. ``least``: what there must be at least one of."""
    if isinstance(values, one):
        return [values]
    if not hasattr(values, "__iter__") or isinstance(values, bytes):
        raise InputError(f"{name}: {shown(values)} is no list")
    out = list(values)
    if least and not out:
        raise InputError(f"{name}: give at least one {least}")
    return out


def numbers(name: str, values: Any) -> np.ndarray:
    """float64 of any shape; what is missing is NaN. Numbers of 64 bits are not copied."""
    if isinstance(values, np.ndarray) and values.dtype == np.float64:
        return values
    try:
        given = np.asarray(values)
    except ValueError:
        raise InputError(f"{name}: rows of different length") from None
    kind = given.dtype.kind
    if kind == "O":
        flat = [np.nan if is_missing(x) else number(name, x) for x in given.ravel()]
        return np.array(flat, dtype=np.float64).reshape(given.shape)
    if kind not in "fiub":
        what = {"c": "complex numbers", "M": "dates", "m": "durations"}.get(kind, "text")
        raise InputError(f"{name}: {what}, {shown(given.ravel().tolist())}: real numbers are wanted")
    return given.astype(np.float64)


def vector(name: str, values: Any) -> list[float]:
    """Numbers in a row, at least one."""
    row = numbers(name, values)
    if row.ndim != 1:
        raise InputError(f"{name}: {shown(values)}: a list of numbers is wanted")
    if not row.size:
        raise InputError(f"{name}: there are no numbers: leave {name} out, or give them")
    return row.tolist()


def maybe_vector(name: str, values: Any) -> list[float]:
    """Likewise; empty where there is none."""
    return [] if values is None else vector(name, values)


def six(values: Any, what: str) -> np.ndarray:
    """(…, 6) of float64, the last three zero where three are given."""
    rows = numbers(what, values)
    if rows.ndim in (1, 2) and rows.shape[-1] == 3:
        rows = np.concatenate([rows, np.zeros_like(rows)], axis=-1)
    if rows.ndim not in (1, 2) or rows.shape[-1] != 6:
        raise InputError(f"{what}: shape {rows.shape}; (n, 6), (n, 3), (6,) or (3,) is wanted")
    return rows


def theory_names(theories: Any) -> list[str]:
    """All of them for None."""
    if theories is None:
        return list(_core.theories)
    names = [text("theories", each) for each in listed("theories", theories, str)]
    if not names:
        raise InputError(f"theories: name at least one of {', '.join(_core.theories)}")
    return names
