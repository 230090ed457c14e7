"""One pose under one load, by every theory."""

from __future__ import annotations

import dataclasses
import functools
import json as _json
from typing import Any

import numpy as np

from . import _core, _sheet, notebook
from .units import displacement_from_mm, stiffness_from_mm


@dataclasses.dataclass(frozen=True, eq=False)
class TheoryAnswer:
    """``displacement`` (6,): ux uy uz, thx thy thz of the tool point; ``stiffness`` (6, 6): tangent under the load."""

    displacement: np.ndarray
    stiffness: np.ndarray


class Solution:
    """Of Model.solve(). Units mm, rad, N/mm, N, Nmm, or with units="SI" m, rad, N/m, N, Nm; ``content`` is always that
    of the JSON. Base axes; translation first.

    ``displacement`` (6,), ``stiffness`` (6, 6)  by the theory that is shown where one must do
    ``by_theory``   name -> TheoryAnswer
    ``parts``       part -> share of the strain energy
    ``content``, ``json``, ``report``  as the program's result
    """

    def __init__(self, native: Any, units: str = "mm", saved: tuple[str, str] | None = None):
        self._native, self._units, self._saved = native, units, saved

    def _matrices(self, theory: str) -> tuple[np.ndarray, np.ndarray]:
        if self._native is not None:
            return self._native.displacement(theory), self._native.stiffness(theory)
        one = self.content[theory or self._reference()]
        return np.array(one["displacement"]), np.array(one["stiffness"])

    def _reference(self) -> str:
        names = [t["name"] for t in self.content["theories"]]
        return _core.reference_theory if _core.reference_theory in names else names[-1]

    def answer(self, theory: str = "") -> TheoryAnswer:
        """By the theory of this name ("analytic", "msa")."""
        d, K = self._matrices(theory)
        if self._units == "SI":
            displacement_from_mm(d), stiffness_from_mm(K)
        return TheoryAnswer(d, K)

    @functools.cached_property
    def by_theory(self) -> dict[str, TheoryAnswer]:
        return {t["name"]: self.answer(t["name"]) for t in self.content["theories"]}

    @functools.cached_property
    def _shown(self) -> TheoryAnswer:
        return self.answer()

    @property
    def displacement(self) -> np.ndarray:
        return self._shown.displacement

    @property
    def stiffness(self) -> np.ndarray:
        return self._shown.stiffness

    @functools.cached_property
    def json(self) -> str:
        return self._saved[0] if self._saved else self._native.json()

    @functools.cached_property
    def report(self) -> str:
        return self._saved[1] if self._saved else self._native.report()

    @functools.cached_property
    def content(self) -> dict[str, Any]:
        return _json.loads(self.json)

    @property
    def parts(self) -> dict[str, float]:
        return {each["part"]: each["share"] for each in self.content["shares"]}

    def rows(self) -> list[dict[str, Any]]:
        """A row for each component of the displacement, a column for each theory."""
        names = ("ux_mm", "uy_mm", "uz_mm", "thx_rad", "thy_rad", "thz_rad")
        theories = [t["name"] for t in self.content["theories"]]
        return [{"component": name, **{t: self.content[t]["displacement"][i] for t in theories}}
                for i, name in enumerate(names)]

    def to_dataframe(self):
        """rows() as a pandas.DataFrame. Needs pandas."""
        return _sheet.pandas().DataFrame(self.rows())

    drawing = "figures.solution"

    def plot(self, figure: Any = None):
        """Displacement by every theory, what they differ by, and the shares of the parts: a matplotlib Figure, as
        Result.plot()."""
        return notebook.drawn(self, figure)

    def __eq__(self, other: Any) -> bool:
        return isinstance(other, Solution) and self.json == other.json

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self):
        return Solution, (None, self._units, (self.json, self.report))

    def __str__(self) -> str:
        return self.report

    def __repr__(self) -> str:
        return f"<Solution: displacement {np.array2string(self.displacement, precision=6)}>"

    def _repr_html_(self) -> str:
        return notebook.html_of(self)
