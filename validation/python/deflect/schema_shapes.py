"""Parts of results of frames, drawings and checks of matrices, as schema.py."""

from __future__ import annotations

import dataclasses
from typing import List

from .records import Array, Maybe, Record
from .schema import Share

# Of drawings

@dataclasses.dataclass(frozen=True, eq=False)
class Driven(Record):
    """An actuator with its coordinate."""

    name: str
    value: float
    unit: str


@dataclasses.dataclass(frozen=True, eq=False)
class DrawnMember(Record):
    """A straight member; ``axes`` (3, 3): its x, y, z as columns; ``size_mm`` of its section along y and z."""

    leg: str
    part: str
    section: str
    material: str
    start_mm: Array
    end_mm: Array
    length_mm: float
    axes: Array
    size_mm: Array
    round: bool


@dataclasses.dataclass(frozen=True, eq=False)
class DrawnJoint(Record):
    """A joint; ``freedoms``: a letter for each of x y z rx ry rz."""

    leg: str
    part: str
    at_mm: Array
    axes: Array
    freedoms: str
    elastic: List[str]
    words: str
    driven: bool


@dataclasses.dataclass(frozen=True, eq=False)
class DrawnFrame(Record):
    """Base or tool, or a node with what holds it."""

    name: str
    at_mm: Array
    axes: Array
    held: str


@dataclasses.dataclass(frozen=True, eq=False)
class DrawnInstrument(Record):
    """A sensor or a point of load."""

    name: str
    words: str
    at_mm: Array
    axis: Maybe[Array]


@dataclasses.dataclass(frozen=True, eq=False)
class DrawnEntry(Record):
    """A spring, a place with laws, a load case or a sensor of a frame."""

    name: str
    words: str


@dataclasses.dataclass(frozen=True, eq=False)
class DrawnMotion(Record):
    """A motion that nothing resists: displacements (n, 3) of the points."""

    words: str
    displacement_mm: Array


# Of check

@dataclasses.dataclass(frozen=True, eq=False)
class MatrixCheck(Record):
    """One check of a matrix with its bounds; ``measured`` is missing where it could not be judged."""

    check: str
    quantity: str
    measured: Maybe[float]
    at_least: Maybe[float]
    at_most: Maybe[float]
    passes: bool


@dataclasses.dataclass(frozen=True, eq=False)
class MatrixDiagnosis(Record):
    """A mistake that explains a matrix, and what to do."""

    id: str
    sentence: str
    remedy: str
    certain: bool


# Of frames

@dataclasses.dataclass(frozen=True, eq=False)
class NodeDisplacement(Record):
    """Of a node, base axes."""

    node: str
    ux_mm: float
    uy_mm: float
    uz_mm: float
    rx_rad: float
    ry_rad: float
    rz_rad: float


@dataclasses.dataclass(frozen=True, eq=False)
class Reaction(Record):
    """On a node, of the freedoms that its support holds."""

    node: str
    fx_N: Maybe[float]
    fy_N: Maybe[float]
    fz_N: Maybe[float]
    mx_Nmm: Maybe[float]
    my_Nmm: Maybe[float]
    mz_Nmm: Maybe[float]


@dataclasses.dataclass(frozen=True, eq=False)
class SpringForce(Record):
    """Of a spring, of the freedoms in which it acts."""

    spring: str
    fx_N: Maybe[float]
    fy_N: Maybe[float]
    fz_N: Maybe[float]
    mx_Nmm: Maybe[float]
    my_Nmm: Maybe[float]
    mz_Nmm: Maybe[float]


@dataclasses.dataclass(frozen=True, eq=False)
class ConstraintForce(Record):
    """What holds a constraint: a force or a moment."""

    constraint: str
    force_N: Maybe[float]
    moment_Nmm: Maybe[float]


@dataclasses.dataclass(frozen=True, eq=False)
class SectionForces(Record):
    """At an end of a member, in its axes."""

    N_N: float
    Vy_N: float
    Vz_N: float
    T_Nmm: float
    My_Nmm: float
    Mz_Nmm: float


@dataclasses.dataclass(frozen=True, eq=False)
class Member(Record):
    """Forces in a member, its largest bending moments with where they are, and its strain energy."""

    member: str
    start: SectionForces
    end: SectionForces
    largest_My_Nmm: float
    largest_My_at_mm: float
    largest_Mz_Nmm: float
    largest_Mz_at_mm: float
    energy_Nmm: float


@dataclasses.dataclass(frozen=True, eq=False)
class LoadPath(Record):
    """How the load was followed in a deformed shape."""

    converged: bool
    stable: bool
    load_factor: float
    steps: int
    iterations: int
    message: str


@dataclasses.dataclass(frozen=True, eq=False)
class FrameChecks(Record):
    """Residual, equilibrium and (in linear geometry) energy, relative."""

    residual: float
    equilibrium: float
    energy: Maybe[float]


@dataclasses.dataclass(frozen=True, eq=False)
class Case(Record):
    """A load case of a frame."""

    path: Maybe[LoadPath]
    displacements: List[NodeDisplacement]
    reactions: List[Reaction]
    springs: List[SpringForce]
    constraints: List[ConstraintForce]
    members: List[Member]
    energy_Nmm: float
    shares: List[Share]
    checks: FrameChecks


@dataclasses.dataclass(frozen=True, eq=False)
class Solver(Record):
    """The solver of the equations, why it was taken, and of an iterative one its end."""

    name: str
    why: str
    freedoms: int
    iterations: Maybe[int]
    error_bound: Maybe[float]
