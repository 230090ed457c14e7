"""Parts of results of fit, predict, compare with validation, and plan, as schema.py."""

from __future__ import annotations

import dataclasses
from typing import List, Optional

from .records import Array, Maybe, Others, Record
from .schema import LeftOut
from .schema_measured import Quality

# Of fit, predict and compare with validation

@dataclasses.dataclass(frozen=True, eq=False)
class FittedQuality(Quality):
    """With χ² itself."""

    chi2: float


@dataclasses.dataclass(frozen=True, eq=False)
class Prior(Record):
    """A mean with its standard deviation, in the unit of the parameter."""

    mean: float
    deviation: float


@dataclasses.dataclass(frozen=True, eq=False)
class OfEffect(Record):
    """The effect whose parameter was fitted."""

    effect: str
    leg: Maybe[int]


@dataclasses.dataclass(frozen=True, eq=False)
class FittedParameter(Record):
    """A fitted number in ``unit`` with its 95 % interval (None: open); ``deviation`` is of its logarithm where ``scale``
    is "log". ``before``: in the description, or of an effect where the search began."""

    path: str
    unit: str
    value: float
    low95: Optional[float]
    high95: Optional[float]
    before: float
    scale: str
    deviation: float
    common_factor: Maybe[bool]
    of: Maybe[OfEffect]
    first_number_SI: float
    prior: Maybe[Prior]
    prior_deviations: Maybe[float]
    tolerance_deviations: Maybe[float]


@dataclasses.dataclass(frozen=True, eq=False)
class Undetermined(Record):
    """A direction (n,) of the parameters that the data do not determine, in a sentence; None: nothing resists."""

    sentence: str
    direction: Array
    deviation: Optional[float]


@dataclasses.dataclass(frozen=True, eq=False)
class Discrepancy(Record):
    """What is left at held-out poses beyond noise, as a share of a reading."""

    quantity: str
    share: float


@dataclasses.dataclass(frozen=True, eq=False)
class NoiseOf(Record):
    """Noise of a reading of a quantity, m or rad …"""

    quantity: str
    sigma_SI: float


@dataclasses.dataclass(frozen=True, eq=False)
class Posterior(Record):
    """What the fit leaves of parameters and tolerances: ``mean`` (n,) and ``covariance`` (n, n)."""

    names: List[str]
    mean: Array
    covariance: Array


@dataclasses.dataclass(frozen=True, eq=False)
class Deviations(Record):
    """Shares of the standard deviation of a predicted reading."""

    parameters: float
    tolerances: float
    load: float
    discrepancy: float
    noise: float
    prediction: float
    reading: float


@dataclasses.dataclass(frozen=True, eq=False)
class PredictedNumber(Record):
    """A predicted reading with its 95 % interval, and by theory."""

    line: int
    pose: str
    channel: str
    unit: str
    value: float
    low95: float
    high95: float
    deviation: Deviations
    by_theory: Others[float]


@dataclasses.dataclass(frozen=True, eq=False)
class Agreement(Record):
    """χ² of all errors together."""

    chi2: float
    numbers: int
    p_value: float


@dataclasses.dataclass(frozen=True, eq=False)
class ModelBias(Record):
    """Of ln S/D: the factor of the model and its scatter, the uncertainty of the measurements taken off."""

    factor: float
    scatter: float
    experiment: float
    scatter_from_experiment: bool
    pairs: int


@dataclasses.dataclass(frozen=True, eq=False)
class Channel(Record):
    """Errors E = S − D of a channel and their uncertainty u_val, in its unit."""

    name: str
    unit: str
    numbers: int
    mean_E: float
    rms_E: float
    rms_D: float
    u_num: float
    u_input: float
    u_noise: float
    u_load: float
    u_val: float
    area_in_unit: float
    u_D: float
    within_2_u_val: float
    agreement: Agreement
    area: float
    bias: Maybe[ModelBias]


@dataclasses.dataclass(frozen=True, eq=False)
class OfCurve(Record):
    """A point of the distribution function of all errors."""

    u: float
    F: float


@dataclasses.dataclass(frozen=True, eq=False)
class DomainRange(Record):
    """A range of validation, and of use where that was given."""

    name: str
    unit: str
    low: float
    high: float
    use_low: Maybe[float]
    use_high: Maybe[float]
    outside: Maybe[bool]


@dataclasses.dataclass(frozen=True, eq=False)
class WithoutGroup(Record):
    """The agreement without a group of readings."""

    kind: str
    name: str
    readings: int
    p_value: float
    changes: bool


@dataclasses.dataclass(frozen=True, eq=False)
class Sameness(Record):
    """Whether a parameter is the same in all groups."""

    parameter: str
    kind: str
    groups: int
    p_value: float


@dataclasses.dataclass(frozen=True, eq=False)
class Calibration(Record):
    """The data of the calibration beside those of the validation."""

    data: str
    readings: int
    poses_shared: int
    rms_E: float
    validation_rms_E: float
    unit: str


@dataclasses.dataclass(frozen=True, eq=False)
class UsePoint(Record):
    """A point of use, and how far it is from where the model was validated."""

    line: int
    inside: bool
    pose_distance_mm: Maybe[float]
    pose_distance_share: Maybe[float]
    load_distance_share: float
    words: str


@dataclasses.dataclass(frozen=True, eq=False)
class UseNumber(Record):
    """A prediction at a point of use."""

    line: int
    channel: str
    unit: str
    value: float
    low95: float
    high95: float
    where: str


@dataclasses.dataclass(frozen=True, eq=False)
class Use(Record):
    """The intended use."""

    plan: str
    points: List[UsePoint]
    numbers: List[UseNumber]


@dataclasses.dataclass(frozen=True, eq=False)
class Maturity(Record):
    """What is known of an element of a scheme of maturity."""

    scheme: str
    element: str
    known: str


# Of plan

@dataclasses.dataclass(frozen=True, eq=False)
class PlanValue(Record):
    """A parameter of a rival."""

    name: str
    value: float


@dataclasses.dataclass(frozen=True, eq=False)
class PlanRival(Record):
    """A rival of the tie that a plan tells apart."""

    effect: str
    probability: float
    parameters: List[PlanValue]


@dataclasses.dataclass(frozen=True, eq=False)
class PlannedReading(Record):
    """A reading in words: pose, where that is, load, and how to come there."""

    pose: str
    at: str
    load: str
    how: str


@dataclasses.dataclass(frozen=True, eq=False)
class Separation(Record):
    """How far readings tell two effects apart."""

    between: List[str]
    lambda_squared: float
    least_lambda_squared: float
    log_bayes_factor: float


@dataclasses.dataclass(frozen=True, eq=False)
class PlanStep(Record):
    """After so many readings: the expected probability of the right effect."""

    readings: int
    probability: float
    separations: List[Separation]


@dataclasses.dataclass(frozen=True, eq=False)
class Inseparable(Record):
    """Two effects that no static reading tells apart, and what does instead."""

    between: List[str]
    lambda_squared: float
    instead: List[str]


@dataclasses.dataclass(frozen=True, eq=False)
class NewSensor(Record):
    """An instrument that would help: its ``entry`` in the description, the numbers (from 1) of the planned readings that are
    then ``enough``, none where not even all are, and what all of them give."""

    name: str
    entry: str
    enough: List[int]
    probability: float
    lambda_squared: float


@dataclasses.dataclass(frozen=True, eq=False)
class Foreseen(Record):
    """How large an effect must be to show in a campaign (NaN: never)."""

    effect: str
    parameters: List[str]
    smallest: Array
    lambda_at_start: float
    mistaken_for: str
    cosine: float


@dataclasses.dataclass(frozen=True, eq=False)
class Gain(Record):
    """What the first so many readings bring: error in use (µm), or a bound on the chance of taking the wrong effect."""

    readings: int
    value: float


@dataclasses.dataclass(frozen=True, eq=False)
class PlannedStand(Record):
    """A pose of a campaign and the number of its readings."""

    pose: str
    pose_mm_deg: List[float]
    readings: int


@dataclasses.dataclass(frozen=True, eq=False)
class Insight(Record):
    """What a campaign can tell: pairs of effects, errors before and after (µm), indices O1 … O5 of observability,
    ``cosines`` (n, n) of the signatures, ``chances`` (n, n) of taking the effect of the column for that of the row,
    ``gain`` by number of readings, and the poses."""

    readings: int
    poses: int
    parameters: int
    numbers: int
    effects_that_show: int
    pairs_alike: int
    pairs: int
    pairs_told_apart: int
    chance_of_confusion: float
    error_before_um: float
    error_after_um: float
    O1: float
    O2: float
    O3: float
    O4: float
    O5: float
    D_gain: float
    detectable: List[Foreseen]
    cosines: Array
    chances: Array
    gain: List[Gain]
    stands: List[PlannedStand]
    left_out: List[LeftOut]
