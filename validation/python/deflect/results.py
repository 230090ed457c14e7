"""Results: the JSON that the program writes with --json (without its provenance), as dataclasses."""

from __future__ import annotations

import csv
import dataclasses
import functools
import io
import json as _json
from typing import Any, Iterator, List

import numpy as np

from . import _sheet, notebook, records, schema, schema_fitted, schema_measured
from ._checks import shown
from .errors import InputError
from .records import Array, Maybe

class Result(records.Record):
    """What a function of deflect found: a dataclass whose fields are the members of the JSON, equal to it:
    ``r.to_dict() == r.content``.

    ``json``     text of the JSON, as the program writes it
    ``report``   text for a person, as the program prints it
    ``content``  the JSON as dicts and lists

    Two results are equal where their JSON is. Results can be pickled and copied.
    """

    #: the member of the JSON that is a table, for rows() and to_dataframe(); who draws it; what goes with it in a pickle
    _table = ""
    _drawn_by = ""
    _beside: tuple[str, ...] = ()

    def __init__(self, json: str, report: str = "", **beside: Any):
        """``json``: text of a result of this kind; ``report``: for a person."""
        self.__dict__.update(_json=json, _report=report, **beside)

    @property
    def json(self) -> str:
        """The text of the JSON."""
        return self._json

    @property
    def report(self) -> str:
        """What the program prints for a person."""
        return self._report

    @functools.cached_property
    def content(self) -> dict[str, Any]:
        """The JSON as dicts, lists and plain values."""
        return _json.loads(self.json)

    def __getattr__(self, name: str) -> Any:
        if name in self._beside:
            raise AttributeError(f"the file of a {type(self).__name__} has no '{name}': call the function again that "
                                 "made it")
        if name.startswith("_") or not any(f.name == name for f in records.fields_of(type(self))):
            words = "" if name.startswith("_") else f"; it has {', '.join(f.name for f in records.fields_of(type(self)))}"
            raise AttributeError(f"{type(self).__name__} has no '{name}'{words}")
        self.__dict__.update(records.values_of(type(self), self.content))  # parsed when first asked for
        return self.__dict__[name]

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *(f.name for f in records.fields_of(type(self)))})

    def __getstate__(self) -> dict[str, Any]:
        return {"_json": self.json, "_report": self.report,
                **{name: self.__dict__[name] for name in self._beside if name in self.__dict__}}

    def __eq__(self, other: Any) -> bool:
        return type(self) is type(other) and self.json == other.json

    def __hash__(self) -> int:
        return hash(self.json)

    def rows(self) -> list[dict[str, Any]]:
        """The table of this result as flat dicts, one for each row; names of nested members are joined by dots."""
        return [dict(_flat(row)) for row in self.content.get(self._table, [])]

    def to_dataframe(self) -> Any:
        """rows() as a pandas.DataFrame. ImportError without pandas."""
        return _sheet.pandas().DataFrame(self.rows())

    def plot(self, figure: Any = None) -> Any:
        """Its picture, a matplotlib Figure in the style of the program's figures: ``r.plot().savefig("r.pdf")``. With
        ``figure`` it is drawn there: ``r.plot(pyplot.figure())``, for a window. ImportError without matplotlib."""
        return notebook.drawn(self, figure)

    def save(self, path: Any) -> None:
        """Writes the JSON, which `deflect report` and functions that take results read."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.json)

    def __str__(self) -> str:
        return self.report or self.json

    def __repr__(self) -> str:
        first = next((line for line in self.report.splitlines() if line.strip()), "")
        return f"<{type(self).__name__}: {first}>"

    def _repr_html_(self) -> str:
        return notebook.html_of(self)


def _flat(row: Any, before: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in row.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{before}{name}.")
        else:
            yield before + name, value


@dataclasses.dataclass(frozen=True, init=False, repr=False, eq=False)
class Comparison(Result):
    """Of compare(): ``findings``, ``tests``, ``patterns``, ``errors``, ``baseline`` …; rows: the tests. Names in _mm are in
    ``unit``.

    ``readings_csv``  the table of residuals, as `deflect compare --out` writes it
    """

    kind: str
    device: str
    data: str
    readings: int
    poses: int
    unit: str
    baseline: schema_measured.Baseline
    noise_floor_mm: float
    sigma_u_mm: float
    sigma_from_residuals: bool
    noise_estimated: Maybe[List[schema_measured.EstimatedNoise]]
    pure_error: Maybe[schema_measured.PureError]
    verdict: str
    notes: List[str]
    findings: List[schema_measured.Finding]
    unexplained_chi2_per_dof: float
    deformed_shape: Maybe[schema_measured.DeformedShape]
    tests: List[schema_measured.ContrastTest]
    patterns: List[schema_measured.PatternTest]
    errors: schema_measured.ErrorGroups
    tolerances: List[schema_measured.ToleranceSize]
    strained_tolerances: List[schema.Strained]
    looks_like: List[str]
    mistakes: List[schema.Mistake]
    inside: Maybe[schema_measured.Inside]
    set_aside_lines: List[int]
    in_play: Maybe[int]
    provenance: Maybe[schema.Provenance]

    _table = "tests"
    _drawn_by = "figures.comparison"
    _beside = ("readings_csv",)

    @functools.cached_property
    def residuals(self) -> dict[str, Any]:
        """Every measured number: "line" (of the file), "pose" and "component" and "unit" (str), "measured", "predicted",
        "residual" and its "sigma" of noise and tolerances, (n,) each, in that unit. InputError where the comparison was
        read from a file, which does not hold them."""
        if "readings_csv" not in self.__dict__:
            raise InputError("the file of a comparison does not hold the residuals, which its picture shows: compare again "
                             "(deflect.compare), or read the table that deflect compare --out writes")
        rows = list(csv.DictReader(io.StringIO(self.readings_csv)))
        words = ("pose", "component", "unit")
        return {name: [r[name] for r in rows] if name in words else np.array([float(r[name]) for r in rows])
                for name in (rows[0] if rows else ())}


@dataclasses.dataclass(frozen=True, init=False, repr=False, eq=False)
class Validity(Result):
    """Of compare(validation=True): ``sentence``, ``agreement``, ``channels``, ``domain`` …; rows: the channels."""

    kind: str
    device: str
    data: str
    sentence: str
    readings: int
    poses: int
    set_aside_lines: List[int]
    agrees: bool
    agreement: schema_fitted.Agreement
    coverage_factor: float
    channels: List[schema_fitted.Channel]
    area: float
    expected_area: float
    u: List[schema_fitted.OfCurve]
    discrepancy: List[schema_fitted.Discrepancy]
    domain: List[schema_fitted.DomainRange]
    without: List[schema_fitted.WithoutGroup]
    same: List[schema_fitted.Sameness]
    calibration: Maybe[schema_fitted.Calibration]
    use: Maybe[schema_fitted.Use]
    maturity: List[schema_fitted.Maturity]
    formulas: List[str]
    provenance: Maybe[schema.Provenance]

    _table = "channels"
    _drawn_by = "figures_more.validity"


@dataclasses.dataclass(frozen=True, init=False, repr=False, eq=False)
class Diagnosis(Result):
    """Of diagnose(): ``verdict``, ``missing``, ``candidates``, ``found`` …; rows: the candidates. Names in _mm are in
    ``unit``."""

    kind: str
    verdict: str
    device: str
    data: str
    notes: List[str]
    sentence: str
    headline: str
    mistakes: List[schema.Mistake]
    missing: List[str]
    candidates: List[schema_measured.Candidate]
    indistinguishable: List[List[str]]
    ties: List[schema_measured.Tie]
    splitting: List[schema_measured.Splitting]
    baseline: schema_measured.Quality
    final: schema_measured.Quality
    unit: str
    noise_floor_mm: float
    unexplained: schema_measured.Unexplained
    found: List[schema_measured.FoundEffect]
    probability_nothing: float
    probability_larger_tolerances: float
    larger_tolerances: float
    probability_unknown: float
    chance_of_any: float
    bootstrap_sets: int
    tolerance_scale: float
    readings: int
    set_aside: int
    in_play: Maybe[int]
    strained_tolerances: List[schema.Strained]
    detectable: List[schema_measured.Detectable]
    left_out: List[schema.LeftOut]
    provenance: Maybe[schema.Provenance]

    _table = "candidates"
    _drawn_by = "figures.diagnosis"


@dataclasses.dataclass(frozen=True, init=False, repr=False, eq=False)
class Fit(Result):
    """Of fit(): ``parameters``, ``correlation`` (k, k), ``before``, ``after``, ``posterior`` …; rows: the parameters. Names
    in _mm are in ``unit``.

    ``model``  the description with the fitted values, and with effects that were fitted
    ``given``  the description that was fitted
    """

    kind: str
    device: str
    data: str
    readings: int
    poses: int
    numbers: int
    set_aside: int
    unit: str
    parameters: List[schema_fitted.FittedParameter]
    correlation: Array
    undetermined: List[schema_fitted.Undetermined]
    before: schema_fitted.FittedQuality
    after: schema_fitted.FittedQuality
    noise_floor_mm: float
    p_value: float
    converged: bool
    warnings: List[str]
    findings: List[str]
    strained_tolerances: List[schema.Strained]
    tolerance_scale: float
    discrepancy: List[schema_fitted.Discrepancy]
    noise: List[schema_fitted.NoiseOf]
    posterior: schema_fitted.Posterior
    provenance: Maybe[schema.Provenance]

    _table = "parameters"
    _drawn_by = "figures_more.fit"
    _beside = ("model", "given")


@dataclasses.dataclass(frozen=True, init=False, repr=False, eq=False)
class Prediction(Result):
    """Of predict(): ``numbers`` with their intervals; rows: these."""

    kind: str
    device: str
    plan: str
    theories: List[schema.Theory]
    fitted: bool
    noise_known: bool
    numbers: List[schema_fitted.PredictedNumber]
    provenance: Maybe[schema.Provenance]

    _table = "numbers"
    _drawn_by = "figures_more.prediction"


@dataclasses.dataclass(frozen=True, init=False, repr=False, eq=False)
class Plan(Result):
    """Of plan() after a diagnosis: the chosen ``readings``, which are the rows, and what they tell apart.

    ``measurements``  the readings as a file to be filled in; None where no reading tells the effects apart
    """

    kind: str
    subject: str
    data: str
    taken: int
    possible: int
    rivals: List[schema_fitted.PlanRival]
    readings: List[schema_fitted.PlannedReading]
    probability: float
    separations: List[schema_fitted.Separation]
    at_random: int
    at_random_is_more: bool
    steps: List[schema_fitted.PlanStep]
    inseparable: List[schema_fitted.Inseparable]
    new_sensors: List[schema_fitted.NewSensor]
    provenance: Maybe[schema.Provenance]

    _table = "readings"
    _drawn_by = "figures_more.plan"
    _beside = ("measurements",)


@dataclasses.dataclass(frozen=True, init=False, repr=False, eq=False)
class Foresight(Result):
    """Of plan(before=…): what the ``given`` campaign and a ``better`` one tell; rows: the effects by how large they must be
    to show in the given one.

    ``better_found``  whether ``better`` is another one than the given
    ``given_within_limits``  whether the given one keeps to the limits; else ``better`` does, whatever it tells
    ``measurements``  the better campaign as a file to be filled in
    """

    kind: str
    subject: str
    campaign: str
    toward: str
    better_found: bool
    given_within_limits: bool
    gain_in: str
    given: schema_fitted.Insight
    better: schema_fitted.Insight
    readings: List[schema_fitted.PlannedReading]
    provenance: Maybe[schema.Provenance]

    _drawn_by = "figures_more.plan"
    _beside = ("measurements",)

    def rows(self) -> list[dict[str, Any]]:
        """The effects by how large they must be to show in the given campaign."""
        return [dict(_flat(row)) for row in self.content["given"]["detectable"]]


@dataclasses.dataclass(frozen=True, init=False, repr=False, eq=False)
class History(Result):
    """Of history(): one row for each version. Names in _mm are in ``unit``."""

    kind: str
    data: str
    unit: str
    versions: List[schema_measured.Version]
    provenance: Maybe[schema.Provenance]

    _table = "versions"
    _drawn_by = "figures.history"


@dataclasses.dataclass(frozen=True, init=False, repr=False, eq=False)
class Validation(Result):
    """Of validate(): rows: a point and a load each."""

    kind: str
    device: str
    theories: List[schema.Theory]
    points: List[schema.Point]
    max_relative_difference: Maybe[float]
    rms_relative_difference: Maybe[float]
    errata: Maybe[List[schema.Erratum]]
    mesh_study: Maybe[List[schema.MeshRow]]
    provenance: Maybe[schema.Provenance]

    _table = "points"
    _drawn_by = "figures.validation"


def progress_of(progress: Any, what: str) -> Any:
    """None, a function of the share that is done, or for True one that shows it: a bar in a notebook, else a line of
    standard error."""
    if progress is None or progress is False:
        return None
    if progress is True:
        return notebook.progress(what)
    if not callable(progress):
        raise InputError(f"progress: {shown(progress)} is neither True nor False nor a function")
    return progress
