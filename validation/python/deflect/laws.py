"""Laws and effects written in Python.

A law of one's own is a curve, sampled into the law ``table`` of descriptions, which both theories solve:

>>> rubber = deflect.law(lambda f: 0.02 * f / (1 + f / 40), range(0, 101, 5))   # N -> mm, under push as under pull
>>> m.edited("tool.tz", rubber, "append").solve(load=[0, 0, 50])

An effect of one's own is the dict of an effect file whose "edits" is a function of the parameters:

>>> pad = {
...     "name": "pad", "title": "A pad between platform and tool", "scope": "machine",
...     "parameters": {"depth_mm": {"start": 0.1, "low": 1e-3, "high": 2, "scale": "log", "vanishes": 0}},
...     "edits": lambda p: [{"at": "tool.tz", "append": deflect.law(lambda f: p["depth_mm"] * f / (f + 20), range(101))}],
... }
>>> deflect.diagnose(m, data, effects=[pad])

with_effect(), simulate(), diagnose(), plan() and effects() take it like an entry of the catalogue. It is for trying an
idea, and the slow way: for every value of its parameters that a search tries, Python is called, one thread at a time,
and the edited description is read anew, where the numbers of an effect file are set in place.

The function gets {name: value}, in the units of the names, and returns edits as in an effect file, without "$name":
[{"at": path, "append": law}, {"at": path, "multiply": 1.1}]. It must give the same for the same values, and may be
called in any thread. It is not called where every parameter that can vanish does. For values that cannot be it raises
InputError. Title, scope (then: machine) and pages may be left out.
"""

from __future__ import annotations

from typing import Any, Callable, Iterable

import numpy as np

from ._checks import listed, number, numbers
from .errors import InputError


def law(curve: Callable[[float], float], loads: Iterable[float], *, rotation: bool = False,
        within: float = 0.01) -> dict[str, Any]:
    """The law ``table`` through a curve: the deflection under a load. Straight between the loads given, and on with the
    last slope. Both theories solve it, in all geometries.

    ``curve``     load in N -> deflection in mm; with ``rotation`` moment in Nm -> angle in mrad. It rises with the load
    ``loads``     where it is read: rising, from 0 (odd then: the same under push as under pull), or from below 0 to
                  above 0, with 0 among them
    ``within``    how far the straight pieces may be from the curve half way between two loads, as a share of the largest
                  deflection

    Raises InputError where the curve is not 0 at 0, does not rise, or needs more loads.
    """
    if not number("within", within) > 0:
        raise InputError(f"within = {within}: give a share of the largest deflection, above 0")
    at = numbers("loads", listed("loads", loads))
    if at.ndim != 1 or len(at) < 2 or not np.all(np.isfinite(at)) or not np.all(np.diff(at) > 0) or 0 not in at:
        raise InputError("loads: at least two rising numbers with 0 among them are wanted")
    if at[0] < 0 and at[-1] <= 0:
        raise InputError("loads: give some above 0; of a law that is the same under push as under pull these alone")
    deflection = np.array([number("the curve", curve(f)) for f in at])
    if not np.all(np.isfinite(deflection)):
        raise InputError(f"the curve is no number at {at[~np.isfinite(deflection)][0]:g}")
    if abs(deflection[list(at).index(0)]) > 1e-12 * np.abs(deflection).max():
        raise InputError(f"the curve is {deflection[list(at).index(0)]:g} at no load: it must be 0 there")
    deflection[list(at).index(0)] = 0
    fall = np.flatnonzero(~(np.diff(deflection) > 0))
    if fall.size:
        raise InputError(f"the curve does not rise from {at[fall[0]]:g} to {at[fall[0] + 1]:g}: a law gives way with the "
                         "load; a free travel is the law 'clearance'")
    between = 0.5 * (at[1:] + at[:-1])
    off = np.abs(np.array([number("the curve", curve(f)) for f in between]) - 0.5 * (deflection[1:] + deflection[:-1]))
    if off.max() > within * np.abs(deflection).max():
        worst = int(np.argmax(off))
        raise InputError(f"between {at[worst]:g} and {at[worst + 1]:g} the curve is {off[worst]:.3g} from the straight "
                         f"piece, more than {within:g} of the largest deflection: give more loads there, or a larger "
                         "'within'")
    force, motion = ("Nm", "mrad") if rotation else ("N", "mm")
    pairs = zip(at.tolist(), deflection.tolist())
    return {"law": "table", "points": [[f"{f!r} {force}", f"{d!r} {motion}"] for f, d in pairs]}
