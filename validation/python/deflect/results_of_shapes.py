"""Results of maps, frames, drawings and checks of matrices."""

from __future__ import annotations

import dataclasses
import functools
from typing import Any, Dict, List

import numpy as np

from . import schema, schema_shapes
from .records import Array, Maybe, Others
from .results import Result, _flat


@dataclasses.dataclass(frozen=True, init=False, repr=False, eq=False)
class StiffnessMap(Result):
    """Of map(): ``arrays`` in the order of ``grid``: (n,) lists by name, and by theory and name; ``ranges`` of these;
    ``correlations`` by axis, of the stiffness with the mean length of slides, under their names in the JSON."""

    kind: str
    device: str
    theories: List[schema.Theory]
    load: Maybe[Array]
    force_N: Maybe[float]
    compliance_kind: str
    length_mm: float
    grid: schema.Grid
    poses: int
    reached: int
    out_of_reach: List[schema.OutOfReach]
    ranges: Maybe[Dict[str, Dict[str, schema.Range]]]
    correlations: Others[Dict[str, schema.Correlation]]
    max_relative_difference: Maybe[float]
    arrays: Dict[str, Any]
    provenance: Maybe[schema.Provenance]

    _drawn_by = "figures.stiffness_map"

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
        """A row for each pose."""
        names, values = list(self.columns), list(self.columns.values())
        return [dict(zip(names, row)) for row in zip(*values)]


@dataclasses.dataclass(frozen=True, init=False, repr=False, eq=False)
class FrameSolution(Result):
    """Of Frame.solve(): ``cases`` by name. Tables as arrays: displacements(), reactions(), members()."""

    kind: str
    frame: str
    geometry: str
    cases: Dict[str, schema_shapes.Case]
    reciprocity: Maybe[float]
    solver: Maybe[schema_shapes.Solver]
    notes: List[str]
    provenance: Maybe[schema.Provenance]

    _drawn_by = "figures_more.frame"

    def _table_of(self, case: str | None, what: str, name: str) -> dict[str, Any]:
        cases = self.content["cases"]
        if case is None:
            if len(cases) != 1:
                raise KeyError(f"name one of the load cases: {', '.join(cases)}")
            case = next(iter(cases))
        rows = [dict(_flat(row)) for row in cases[case][what]]
        names = list(dict.fromkeys(key for row in rows for key in row if key != name))
        out: dict[str, Any] = {name: [row[name] for row in rows]}
        for key in names:
            out[key] = np.array([row.get(key, np.nan) for row in rows], dtype=float)
        return out

    def displacements(self, case: str | None = None) -> dict[str, Any]:
        """``{"node": names, "ux_mm": (n,), … "rz_rad": (n,)}`` of a load case (of the only one)."""
        return self._table_of(case, "displacements", "node")

    def reactions(self, case: str | None = None) -> dict[str, Any]:
        """``{"node": names, "fx_N": (n,), … "mz_Nmm": (n,)}``; NaN where a support does not hold."""
        return self._table_of(case, "reactions", "node")

    def members(self, case: str | None = None) -> dict[str, Any]:
        """``{"member": names, "start.N_N": (n,), … "energy_Nmm": (n,)}``."""
        return self._table_of(case, "members", "member")

    def rows(self) -> list[dict[str, Any]]:
        """A row for each load case and node."""
        return [{"case": case, **dict(_flat(row))}
                for case, of_case in self.content["cases"].items() for row in of_case["displacements"]]

    @property
    def load_cases(self) -> list[str]:
        """Their names."""
        return list(self.content["cases"])


@dataclasses.dataclass(frozen=True, init=False, repr=False, eq=False)
class Drawing(Result):
    """Of show(): the machine or frame as its file draws it, base axes, mm: ``members``, ``joints``, ``frames``,
    ``instruments``, ``lines`` between ``points_mm`` (n, 3), ``motions`` that nothing resists, ``trouble``; of a frame also
    ``springs``, ``laws``, ``loads`` and ``sensors``; rows: the members."""

    kind: str
    drawing: str
    name: str
    about: str
    pose_mm_deg: Maybe[Array]
    driven: List[schema_shapes.Driven]
    members: List[schema_shapes.DrawnMember]
    joints: List[schema_shapes.DrawnJoint]
    frames: List[schema_shapes.DrawnFrame]
    instruments: List[schema_shapes.DrawnInstrument]
    springs: Maybe[List[schema_shapes.DrawnEntry]]
    laws: Maybe[List[schema_shapes.DrawnEntry]]
    loads: Maybe[List[schema_shapes.DrawnEntry]]
    sensors: Maybe[List[schema_shapes.DrawnEntry]]
    points_mm: Array
    lines: List[List[int]]
    motions: List[schema_shapes.DrawnMotion]
    trouble: str
    provenance: Maybe[schema.Provenance]

    _table = "members"
    _drawn_by = "figures_shapes.drawing"


@dataclasses.dataclass(frozen=True, init=False, repr=False, eq=False)
class Check(Result):
    """Of check(): ``passes``, ``verdict`` in a sentence, the ``checks``, which are the rows, and ``diagnosis``: mistakes
    that explain the matrix."""

    kind: str
    file: str
    reference: Maybe[str]
    verdict: str
    passes: bool
    matrix: Array
    checks: List[schema_shapes.MatrixCheck]
    diagnosis: List[schema_shapes.MatrixDiagnosis]
    max_asymmetry: float
    weighing_length_mm: float
    eigenvalues_N_per_mm: Array
    centre_of_stiffness_mm: Maybe[Array]
    centre_of_compliance_mm: Maybe[Array]
    characteristic_length_mm: Maybe[float]
    principal_translation_N_per_mm: Maybe[Array]
    principal_axes: Maybe[Array]
    principal_rotation_Nmm_per_rad: Maybe[Array]
    ratio_to_reference: Maybe[Array]
    provenance: Maybe[schema.Provenance]

    _table = "checks"
    _drawn_by = "figures_shapes.check"
