"""Parts of results about measurements, as schema.py. Names in _mm are in the ``unit`` of the result, which is another one
where only rotations or strains were measured."""

from __future__ import annotations

import dataclasses
from typing import List, Optional

from .records import Array, Maybe, Record
from .schema import PlaceOf, Strained

# Of compare

@dataclasses.dataclass(frozen=True, eq=False)
class Quality(Record):
    """The error of a model: root mean square, the same at held-out poses, and χ² per degree of freedom."""

    rmse_mm: float
    held_out_rmse_mm: float
    chi2_per_dof: float


@dataclasses.dataclass(frozen=True, eq=False)
class Baseline(Quality):
    """Of a comparison: p of so large a χ² by chance, the size of the readings, and the largest residual."""

    p_value: float
    measured_rms_mm: float
    worst_mm: float


@dataclasses.dataclass(frozen=True, eq=False)
class PureError(Record):
    """Scatter of replicates."""

    sigma_mm: float
    degrees_of_freedom: int


@dataclasses.dataclass(frozen=True, eq=False)
class EstimatedNoise(Record):
    """Noise of a channel that nobody tells, by what no pattern explains."""

    channel: str
    sigma: float
    unit: str


@dataclasses.dataclass(frozen=True, eq=False)
class Finding(Record):
    """A pattern that the residuals have, in a sentence, with its amplitudes and how much of the misfit it takes."""

    pattern: str
    sentence: str
    columns: List[str]
    amplitude_SI: Array
    deviation_SI: Array
    unit_SI: str
    size_mm: float
    share_of_misfit: float
    chi2_gain: float
    p_value: float
    instead: List[str]


@dataclasses.dataclass(frozen=True, eq=False)
class DeformedShape(Record):
    """What equilibrium in the deformed shape contributes, and its amplitude in the data."""

    size_mm: float
    amplitude: float
    deviation: float


@dataclasses.dataclass(frozen=True, eq=False)
class ContrastTest(Record):
    """A question that readings answer by themselves; ``needs`` says what is missing for it."""

    test: str
    question: str
    numbers: int
    size_mm: Maybe[float]
    p_value: Maybe[float]
    needs: Maybe[str]


@dataclasses.dataclass(frozen=True, eq=False)
class PatternTest(Record):
    """A pattern tried alone."""

    pattern: str
    title: str
    size_mm: float
    chi2_gain: float
    columns: int
    p_value: float


@dataclasses.dataclass(frozen=True, eq=False)
class ErrorGroup(Record):
    """Errors of a group of readings; ``bias_mm`` (3,)."""

    group: str
    readings: int
    unit: str
    rmse_mm: float
    bias_mm: Array
    worst_mm: float
    worst_line: int


@dataclasses.dataclass(frozen=True, eq=False)
class ErrorGroups(Record):
    """Errors by what readings have in common."""

    by_axis: List[ErrorGroup]
    by_pose: List[ErrorGroup]
    by_direction: List[ErrorGroup]
    by_magnitude: List[ErrorGroup]
    by_heading: List[ErrorGroup]


@dataclasses.dataclass(frozen=True, eq=False)
class ToleranceSize(Record):
    """By how much one standard deviation of a tolerance moves the readings, root mean square."""

    name: str
    rms_mm: float


@dataclasses.dataclass(frozen=True, eq=False)
class InnerSite(Record):
    """A place inside whose yielding the sensors show."""

    name: str
    determined_by: str
    redundancy: float
    largest_force: float
    force_unit: str
    yields_per_force: float
    deviation: float
    yield_unit: str
    chi2_gain: float
    p_value: float
    share_of_misfit: float


@dataclasses.dataclass(frozen=True, eq=False)
class ResidualForce(Record):
    """The force at a place in one reading, and how much more it is than predicted."""

    name: str
    predicted: float
    more_than_predicted: float
    unit: str


@dataclasses.dataclass(frozen=True, eq=False)
class Inside(Record):
    """What sensors at several places tell of the inside."""

    sites: List[InnerSite]
    residual_forces: List[ResidualForce]
    reading_line: int


@dataclasses.dataclass(frozen=True, eq=False)
class Version(Record):
    """A version of a model against the data of a history."""

    device: str
    rmse_mm: float
    placebo_rmse_mm: Optional[float]
    held_out_rmse_mm: float
    chi2_per_dof: float
    deformed_shape_mm: Maybe[float]
    kept_rmse_mm: Maybe[float]
    chi2_beside_deformed_shape: Maybe[float]
    set_aside_lines: Maybe[List[int]]
    noise_floor_mm: float
    failing_tests: List[str]
    patterns: List[str]
    strained_tolerances: List[Strained]


# Of diagnose

@dataclasses.dataclass(frozen=True, eq=False)
class FoundValue(Record):
    """A parameter with its 95 % interval; None where that is open. ``at_least``: there is no upper limit, and ``high95``
    is the parameter's bound."""

    name: str
    value: float
    low95: Optional[float]
    high95: Optional[float]
    at_least: Maybe[bool]


@dataclasses.dataclass(frozen=True, eq=False)
class TriedValue(Record):
    """The same of a candidate; None where its value is infinite."""

    name: str
    value: Optional[float]
    low95: Optional[float]
    high95: Optional[float]
    at_least: Maybe[bool]


@dataclasses.dataclass(frozen=True, eq=False)
class FoundEffect(Record):
    """An effect at its site with its values."""

    effect: str
    title: str
    site: str
    leg: Maybe[int]
    place: Maybe[PlaceOf]
    parameters: List[FoundValue]


@dataclasses.dataclass(frozen=True, eq=False)
class Candidate(FoundEffect):
    """An effect that was tried, with its probability and the error with it."""

    parameters: List[TriedValue]  # type: ignore[assignment]
    probability: float
    rmse_mm: float
    held_out_rmse_mm: float
    chi2_per_dof: float


@dataclasses.dataclass(frozen=True, eq=False)
class Rival(Record):
    """One of a tie: effects that were fitted together."""

    probability: float
    effects: List[FoundEffect]


@dataclasses.dataclass(frozen=True, eq=False)
class Tie(Record):
    """Effects of which the data support one as much as the other."""

    rivals: List[Rival]


@dataclasses.dataclass(frozen=True, eq=False)
class Splitting(Record):
    """A reading in which two effects differ most."""

    between: List[str]
    reading: str
    difference: float
    unit: str
    standard_deviations: float
    sentence: str


@dataclasses.dataclass(frozen=True, eq=False)
class Localised(Record):
    """Where what is left unexplained acts; ``probability`` that it is there and nowhere else.

    ``effect``: of the laws at the place the one that explains most, None where none acts there.
    """

    what: str
    share: float
    probability: float
    effect: Optional[str]
    place: PlaceOf


@dataclasses.dataclass(frozen=True, eq=False)
class Unexplained(Record):
    """What no known effect explains."""

    significant: bool
    share_of_misfit: float
    pattern: str
    localised: List[Localised]
    nearest: str
    nearest_share: float


@dataclasses.dataclass(frozen=True, eq=False)
class Detectable(Record):
    """How large an effect must be to show in these data (NaN: never), and what it would be mistaken for."""

    effect: str
    title: str
    site: str
    leg: Maybe[int]
    place: Maybe[PlaceOf]
    parameters: List[str]
    smallest: Array
    mistaken_for: str
    cosine: float
