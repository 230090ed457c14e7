"""Between the units of results (mm, deg, N, Nmm) and SI (m, rad, N, Nm), for units="SI"."""

from __future__ import annotations

import math
from typing import Sequence, Union

import numpy as np

from .errors import InputError

#: a list of numbers
Numbers = Union[Sequence[float], np.ndarray]


def require_units(units: str) -> bool:
    """Whether SI."""
    if units not in ("mm", "SI"):
        raise InputError(f"units '{units}': write 'mm' (mm, deg, N, Nmm) or 'SI' (m, rad, N, Nm)")
    return units == "SI"


def poses_in_mm(poses: np.ndarray) -> np.ndarray:
    out = np.array(poses, dtype=float)
    out[..., :3] *= 1e3
    out[..., 3:] *= 180 / math.pi
    return out


def loads_in_mm(loads: np.ndarray) -> np.ndarray:
    out = np.array(loads, dtype=float)
    out[..., 3:] *= 1e3
    return out


def displacement_in_mm(d: np.ndarray) -> np.ndarray:
    """A copy: (…, 3) or (…, 6)."""
    out = np.array(d, dtype=float)
    out[..., :3] *= 1e3
    return out


def displacement_from_mm(d: np.ndarray) -> np.ndarray:
    """In place: (…, 6)."""
    d[..., :3] /= 1e3
    return d


def stiffness_from_mm(K: np.ndarray) -> np.ndarray:
    """In place: (…, 6, 6). N/mm and N and Nmm to N/m, N and Nm."""
    K[..., :3, :3] *= 1e3
    K[..., 3:, 3:] /= 1e3
    return K
