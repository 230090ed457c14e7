"""One pose under one load, by every theory."""

from __future__ import annotations

import dataclasses
import functools
from typing import Any, List

import numpy as np

from . import _core, records, schema
from .records import Array, Maybe, Others
from .results import Result
from .schema import TheoryAnswer
from .units import displacement_from_mm, stiffness_from_mm


@dataclasses.dataclass(frozen=True, init=False, repr=False, eq=False)
class Solution(Result):
    """Of Model.solve(): a dataclass equal to the JSON. Units mm, rad, N/mm, N, Nmm. With units="SI" ``displacement``,
    ``stiffness`` and ``by_theory`` are in m, rad, N/m, N, Nm; all else is as in the JSON. Base axes; translation first.

    ``displacement`` (6,), ``stiffness`` (6, 6)  by the theory that is shown where one must do
    ``by_theory``   name -> TheoryAnswer
    ``parts``       part -> share of the strain energy
    """

    kind: str
    pose: Array
    load: Array
    theories: List[schema.Theory]
    reference: str
    by_theory: Others[TheoryAnswer]
    relative_difference: Maybe[float]
    checks: schema.SolveChecks
    geometry: Maybe[str]
    shares: List[schema.Share]
    joints: List[schema.Joint]
    redundant_constraints: int
    assembly: Maybe[schema.Assembly]
    rigid: Maybe[List[str]]
    floating: Maybe[schema.Floating]
    notes: Maybe[List[str]]
    provenance: Maybe[schema.Provenance]

    _drawn_by = "figures.solution"
    _beside = ("_units",)

    def __init__(self, native: Any, units: str = "mm", report: str = ""):
        """``native``: of the compiled module, or the text of a JSON, which is written when it is first asked for."""
        self.__dict__.update(_units=units)
        if isinstance(native, str):
            self.__dict__.update(_native=None, json=native, report=report)
        else:
            self.__dict__.update(_native=native)

    @functools.cached_property
    def json(self) -> str:
        """The text of the JSON."""
        return self.__dict__["_json"] if self._native is None else self._native.json()

    @functools.cached_property
    def report(self) -> str:
        """What the program prints for a person."""
        return self.__dict__["_report"] if self._native is None else self._native.report()

    @functools.cached_property
    def _native(self) -> Any:
        return None  # of one that was pickled

    def __getattr__(self, name: str) -> Any:
        value = super().__getattr__(name)
        if self._units == "SI":
            for each in self.__dict__["by_theory"].values():
                displacement_from_mm(each.displacement), stiffness_from_mm(each.stiffness)
        return value

    def answer(self, theory: str = "") -> TheoryAnswer:
        """By the theory of this name ("analytic", "msa"); without one by that which is shown."""
        if self._native is None:
            return self.by_theory[theory or self.reference]
        d, K = self._native.displacement(theory), self._native.stiffness(theory)
        if self._units == "SI":
            displacement_from_mm(d), stiffness_from_mm(K)
        return TheoryAnswer(d, K)

    @functools.cached_property
    def _shown(self) -> TheoryAnswer:
        return self.answer()

    @property
    def displacement(self) -> np.ndarray:
        """(6,) of T: ux uy uz, thx thy thz."""
        return self._shown.displacement

    @property
    def stiffness(self) -> np.ndarray:
        """(6, 6): tangent under the load, translation first."""
        return self._shown.stiffness

    @property
    def parts(self) -> dict[str, float]:
        """Part -> its share of the strain energy."""
        return {each["part"]: each["share"] for each in self.content["shares"]}

    def to_dict(self) -> dict[str, Any]:
        """The JSON of the members, in mm, rad, N, Nmm in any units."""
        if self._units == "mm":
            return super().to_dict()
        return Solution(self.json, "mm", self.report).to_dict()

    def rows(self) -> list[dict[str, Any]]:
        """A row for each component of the displacement, a column for each theory."""
        names = ("ux_mm", "uy_mm", "uz_mm", "thx_rad", "thy_rad", "thz_rad")
        theories = [t["name"] for t in self.content["theories"]]
        return [{"component": name, **{t: self.content[t]["displacement"][i] for t in theories}}
                for i, name in enumerate(names)]

    def __repr__(self) -> str:
        return f"<Solution: displacement {np.array2string(self.displacement, precision=6)}>"
