"""Parts of results, as dataclasses whose members are those of the JSON: see records.py for what types mean. Numbers are
in the unit that the name ends with, mm (or what ``unit`` says of names in _mm), N, Nmm, rad where it has none."""

from __future__ import annotations

import dataclasses
from typing import Any, Dict, List

from .records import Array, Maybe, Others, Record

# Of every result

@dataclasses.dataclass(frozen=True, eq=False)
class Theory(Record):
    """A theory: ``name`` of its members, ``title``, and how it is spoken of."""

    name: str
    title: str
    spoken: str


@dataclasses.dataclass(frozen=True, eq=False)
class HashedFile(Record):
    """A file with the SHA-256 of its bytes."""

    name: str
    sha256: str


@dataclasses.dataclass(frozen=True, eq=False)
class Machine(Record):
    """The computer that a result was made on."""

    system: str
    processor: str
    compiler: str


@dataclasses.dataclass(frozen=True, eq=False)
class Provenance(Record):
    """What the program made a result from; functions of this package leave it out."""

    program: str
    command: List[str]
    inputs: List[HashedFile]
    outputs: Maybe[List[HashedFile]]
    seed: Maybe[int]
    machine: Machine


@dataclasses.dataclass(frozen=True, eq=False)
class Share(Record):
    """The share of a part in the strain energy."""

    part: str
    share: float


@dataclasses.dataclass(frozen=True, eq=False)
class Strained(Record):
    """A tolerance that would have to be so many standard deviations off."""

    name: str
    sigmas: float


@dataclasses.dataclass(frozen=True, eq=False)
class Mistake(Record):
    """A mistake of recording that the data look like."""

    ids: List[str]
    sentence: str
    certain: bool


@dataclasses.dataclass(frozen=True, eq=False)
class LeftOut(Record):
    """An effect that was not looked at, and why."""

    effect: str
    why: str


@dataclasses.dataclass(frozen=True, eq=False)
class PlaceOf(Record):
    """The place of a law; ``also``: paths of the other parts of a group."""

    kind: str
    part: str
    path: str
    motion: Maybe[str]
    leg: Maybe[int]
    also: Maybe[List[str]]


# Of solve

@dataclasses.dataclass(frozen=True, eq=False)
class TheoryAnswer(Record):
    """``displacement`` (6,): ux uy uz, thx thy thz of the tool point; ``stiffness`` (6, 6): tangent under the load, base
    axes. ``from_linear``: in a deformed shape, by how much the displacement differs from the linear one."""

    displacement: Array
    stiffness: Array
    from_linear: Maybe[float] = None


@dataclasses.dataclass(frozen=True, eq=False)
class SolveChecks(Record):
    """Whether the stiffness is symmetric and positive and no passive joint is resisted (in linear geometry)."""

    symmetric: bool
    positive: bool
    passive_joints_free: Maybe[bool]


@dataclasses.dataclass(frozen=True, eq=False)
class Joint(Record):
    """A commanded joint coordinate: a slide in mm or a turn in rad."""

    name: str
    value_rad: Maybe[float]
    value_mm: Maybe[float]


@dataclasses.dataclass(frozen=True, eq=False)
class Assembly(Record):
    """The mechanism assembled with its misfits, without load: wrenches on legs, and offsets of T by theory under
    "analytic_offset" …"""

    offsets: Others[Array]
    leg_wrenches_N_Nmm: Maybe[Dict[str, Array]]


@dataclasses.dataclass(frozen=True, eq=False)
class Floating(Record):
    """Play that nothing loads: T may move from the least to the most (mm, rad; NaN without end)."""

    parts: List[str]
    least: Array
    most: Array


# Of validate and map

@dataclasses.dataclass(frozen=True, eq=False)
class Point(Record):
    """A point and a load: ``pose`` (6,), and (6,) displacements by theory (mm, rad)."""

    point: Any
    pose: Array
    load_axis: str
    load_N: float
    as_printed: Maybe[Array]
    by_theory: Others[Array]


@dataclasses.dataclass(frozen=True, eq=False)
class Erratum(Record):
    """The price of an erratum: ratios printed / corrected for loads along x, y, z, or why it is refused."""

    erratum: str
    equations: str
    smallest: Maybe[Array]
    largest: Maybe[Array]
    refused: Maybe[str]
    failed_check: str


@dataclasses.dataclass(frozen=True, eq=False)
class MeshRow(Record):
    """What the theories differ by with elements of this size."""

    element_mm: float
    elements_per_leg: int
    max_relative_difference: float


@dataclasses.dataclass(frozen=True, eq=False)
class Grid(Record):
    """Coordinates of the poses of a map, x fastest."""

    x_mm: Array
    y_mm: Array
    z_mm: Array
    roll_pitch_yaw_deg: Array
    order: str


@dataclasses.dataclass(frozen=True, eq=False)
class OutOfReach(Record):
    """How many poses are out of reach for a reason, with an example in words."""

    reason: str
    poses: int
    example: str


@dataclasses.dataclass(frozen=True, eq=False)
class Range(Record):
    """Smallest and largest over a map, and the poses (6,) where they are."""

    smallest: float
    smallest_at: Array
    largest: float
    largest_at: Array


@dataclasses.dataclass(frozen=True, eq=False)
class Correlation(Record):
    """By ranks and linear."""

    spearman: float
    pearson: float
