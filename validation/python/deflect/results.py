"""Results: the JSON that the program writes with --json (without its provenance), as an object."""

from __future__ import annotations

import dataclasses
import csv
import functools
import io
import json as _json
from typing import Any, Iterator

import numpy as np

from . import _sheet, notebook


@dataclasses.dataclass(frozen=True, repr=False)
class Result:
    """What a function of deflect found.

    ``json``     text of the JSON, as the program writes it
    ``report``   text for a person, as the program prints it
    ``content``  the JSON as dicts and lists; its members are attributes too: ``result.verdict``

    Two results are equal where their JSON is. Results can be pickled and copied.
    """

    json: str
    report: str = dataclasses.field(default="", compare=False)

    #: the member of the JSON that is a table, for rows() and to_dataframe(); and who draws it
    table = ""
    drawing = ""

    @functools.cached_property
    def content(self) -> dict[str, Any]:
        return _json.loads(self.json)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name in ("json", "report", "content"):
            raise AttributeError(name)
        try:
            return self.content[name]
        except KeyError:
            raise AttributeError(f"{type(self).__name__} has no '{name}'; it has {', '.join(self.content)}") from None

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.content})

    def rows(self) -> list[dict[str, Any]]:
        """The table of this result as flat dicts, one for each row; names of nested members are joined by dots."""
        return [dict(_flat(row)) for row in self.content.get(self.table, [])]

    def to_dataframe(self):
        """rows() as a pandas.DataFrame. Needs pandas."""
        return _sheet.pandas().DataFrame(self.rows())

    def plot(self, figure: Any = None):
        """Its picture, a matplotlib Figure in the style of the program's figures: ``r.plot().savefig("r.pdf")``. With
        ``figure`` it is drawn there: ``r.plot(pyplot.figure())``, for a window. ImportError without matplotlib."""
        return notebook.drawn(self, figure)

    def save(self, path) -> None:
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


@dataclasses.dataclass(frozen=True, repr=False)
class Comparison(Result):
    """Of compare(): ``findings``, ``tests``, ``patterns``, ``errors``, ``baseline`` …; rows: the tests.

    ``readings_csv``  the table of residuals, as `deflect compare --out` writes it
    """

    readings_csv: str = dataclasses.field(default="", compare=False)
    table = "tests"
    drawing = "figures.comparison"

    @functools.cached_property
    def residuals(self) -> dict[str, Any]:
        """Every measured number: "line" (of the file), "pose" and "component" and "unit" (str), "measured", "predicted",
        "residual" and its "sigma" of noise and tolerances, (n,) each, in that unit."""
        rows = list(csv.DictReader(io.StringIO(self.readings_csv)))
        words = ("pose", "component", "unit")
        return {name: [r[name] for r in rows] if name in words else np.array([float(r[name]) for r in rows])
                for name in (rows[0] if rows else ())}


class Validity(Result):
    """Of compare(validation=True): ``sentence``, ``agreement``, ``channels``, ``domain`` …; rows: the channels."""

    table = "channels"
    drawing = "figures_more.validity"


class Diagnosis(Result):
    """Of diagnose(): ``verdict``, ``missing``, ``candidates`` …; rows: the candidates."""

    table = "candidates"
    drawing = "figures.diagnosis"


class Fit(Result):
    """Of fit(): ``parameters``, ``correlation``, ``before``, ``after`` …; rows: the parameters."""

    table = "parameters"
    drawing = "figures_more.fit"


class Prediction(Result):
    """Of predict(): ``numbers`` with their intervals; rows: these."""

    table = "numbers"
    drawing = "figures_more.prediction"


class Plan(Result):
    """Of plan(): the chosen readings, which are the rows; with ``before`` what the ``given`` campaign and a ``better`` one
    tell, and rows: the effects by how large they must be to show in the given one."""

    drawing = "figures_more.plan"

    def rows(self) -> list[dict[str, Any]]:
        table = self.content["given"]["detectable"] if "given" in self.content else self.content["readings"]
        return [dict(_flat(row)) for row in table]


class History(Result):
    """Of history(): one row for each version."""

    table = "versions"
    drawing = "figures.history"


class Validation(Result):
    """Of validate(): rows: a point and a load each."""

    table = "points"
    drawing = "figures.validation"


class StiffnessMap(Result):
    """Of map(): ``arrays`` in the order of ``grid``."""

    drawing = "figures.stiffness_map"

    @functools.cached_property
    def columns(self) -> dict[str, np.ndarray]:
        """x_mm, y_mm, z_mm and the arrays of the JSON, (n,) each, x fastest: "guide_mean_mm",
        "msa.stiffness_x_N_per_mm" …; NaN where a pose is out of reach."""
        grid = [np.array(self.content["grid"][axis]) for axis in ("x_mm", "y_mm", "z_mm")]
        z, y, x = np.meshgrid(*reversed(grid), indexing="ij")
        out = {"x_mm": x.ravel(), "y_mm": y.ravel(), "z_mm": z.ravel()}
        for name, values in _flat(self.content["arrays"]):
            out[name] = np.array([np.nan if value is None else value for value in values], dtype=float)
        return out

    def rows(self) -> list[dict[str, Any]]:
        names, values = list(self.columns), list(self.columns.values())
        return [dict(zip(names, row)) for row in zip(*values)]


class FrameSolution(Result):
    """Of Frame.solve(): ``cases`` by name. Tables as arrays: displacements(), reactions(), members()."""

    drawing = "figures_more.frame"

    def _table(self, case: str | None, what: str, name: str) -> dict[str, Any]:
        cases = self.content["cases"]
        if case is None:
            if len(cases) != 1:
                raise KeyError(f"name one of the load cases: {', '.join(cases)}")
            case = next(iter(cases))
        rows = [dict(_flat(row)) for row in cases[case][what]]
        names = list(dict.fromkeys(key for row in rows for key in row if key != name))
        out = {name: [row[name] for row in rows]}
        for key in names:
            out[key] = np.array([row.get(key, np.nan) for row in rows], dtype=float)
        return out

    def displacements(self, case: str | None = None) -> dict[str, Any]:
        """``{"node": names, "ux_mm": (n,), … "rz_rad": (n,)}`` of a load case (of the only one)."""
        return self._table(case, "displacements", "node")

    def reactions(self, case: str | None = None) -> dict[str, Any]:
        """``{"node": names, "fx_N": (n,), … "mz_Nmm": (n,)}``; NaN where a support does not hold."""
        return self._table(case, "reactions", "node")

    def members(self, case: str | None = None) -> dict[str, Any]:
        """``{"member": names, "start.N_N": (n,), … "energy_Nmm": (n,)}``."""
        return self._table(case, "members", "member")

    def rows(self) -> list[dict[str, Any]]:
        """A row for each load case and node."""
        return [{"case": case, **dict(_flat(row))}
                for case, of_case in self.content["cases"].items() for row in of_case["displacements"]]

    @property
    def load_cases(self) -> list[str]:
        return list(self.content["cases"])


def progress_of(progress: Any, what: str) -> Any:
    """None, a function of the share that is done, or for True one that writes it into a line of standard error."""
    if progress is None or progress is False:
        return None
    if callable(progress):
        return progress
    import sys

    def tell(share: float) -> None:
        print(f"\r{what} {100 * share:3.0f} %", end="\n" if share >= 1 else "", file=sys.stderr, flush=True)

    return tell
