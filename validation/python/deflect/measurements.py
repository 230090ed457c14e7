"""Measurements: the text of a file, which functions read with the instruments of the machine or frame."""

from __future__ import annotations

import csv
import io
import os
from typing import Any, Mapping

import numpy as np

from . import _core, _sheet, _sources, notebook
from .errors import InputError
from .units import displacement_in_mm, loads_in_mm, poses_in_mm, require_units

POSE = ("x_mm", "y_mm", "z_mm", "roll_deg", "pitch_deg", "yaw_deg")
LOAD = ("fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm")
DISPLACEMENT = ("ux_mm", "uy_mm", "uz_mm", "thx_rad", "thy_rad", "thz_rad")


class Measurements:
    """Static readings under known loads, or a plan of them: one row for each reading. Columns as in a measurement file:
    pose, x_mm … yaw_deg, fx_N … mz_Nmm, ux_mm … thz_rad, sigma_u_mm, sequence, temperature_C, names of sensors …

    ``text``    the file
    ``origin``  what messages and results call it
    ``hidden``  of simulated ones: the effects in them
    """

    def __init__(self, text: str, origin: str = "measurements", hidden: list[dict] | None = None) -> None:
        self.text, self.origin, self.hidden = text, origin, hidden

    @classmethod
    def from_csv(cls, path: Any) -> "Measurements":
        """Of a file. InputError where it cannot be read; what it says is read by the function that uses it."""
        return cls(_core.read_text(os.fspath(path)), os.fspath(path))

    @classmethod
    def from_arrays(cls, poses: Any = None, loads: Any = None, displacements: Any = None, *,
                    columns: Mapping[str, Any] | None = None, origin: str = "arrays",
                    units: str = "mm") -> "Measurements":
        """Of n readings:

        ``poses``          (n, 6) or (n, 3), mm and deg; rows that are equal are readings at one approach, unless
                           ``columns`` has "pose", the labels
        ``loads``          (n, 6) or (n, 3), N and Nmm
        ``displacements``  (n, 6) or (n, 3), mm and rad; NaN was not measured
        ``columns``        name -> n values: any other columns, sensors too, in the units of their names
        ``units``          "SI": poses, loads and displacements in m, rad, N, Nm

        Raises InputError for other shapes and for columns of different length.
        """
        si = require_units(units)
        table: dict[str, Any] = dict(columns or {})
        for names, rows in ((POSE, poses), (LOAD, loads), (DISPLACEMENT, displacements)):
            if rows is None:
                continue
            rows = np.array(rows, dtype=float)
            if rows.ndim != 2 or rows.shape[1] not in (3, 6):
                raise InputError(f"{names[0]} …: shape {rows.shape}; (n, 6) or (n, 3) is wanted")
            if si:
                rows = {POSE: poses_in_mm, LOAD: loads_in_mm, DISPLACEMENT: displacement_in_mm}[names](rows)
            padded = np.zeros((len(rows), 6)) if names is POSE else rows
            padded[:, : rows.shape[1]] = rows
            table.update({name: padded[:, i] for i, name in enumerate(names[: padded.shape[1]])})
        if poses is not None and "pose" not in table:
            seen: dict[tuple, int] = {}
            table["pose"] = [str(seen.setdefault(tuple(row), len(seen))) for row in np.asarray(poses, dtype=float)]
        lengths = {name: len(values) for name, values in table.items()}
        if len(set(lengths.values())) != 1:
            raise InputError(f"columns of different length: {lengths}")
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(table)
        writer.writerows(zip(*([_cell(x) for x in values] for values in table.values())))
        return cls(out.getvalue(), origin)

    @classmethod
    def from_dataframe(cls, frame: Any, origin: str = "dataframe") -> "Measurements":
        """Of a pandas.DataFrame whose columns are those of a file. Raises InputError."""
        return cls.from_arrays(columns={str(name): frame[name] for name in frame.columns}, origin=origin)

    def to_csv(self, path: Any) -> None:
        """Writes the file."""
        with open(path, "w", encoding="utf-8", newline="") as file:
            file.write(self.text)

    @property
    def columns(self) -> dict[str, np.ndarray]:
        """Name -> (n,) of float64 with NaN for empty cells; labels and notes of str."""
        lines = [line for line in csv.reader(io.StringIO(self.text)) if line and not line[0].startswith("#")]
        names, rows = lines[0], lines[1:]
        return {name.strip(): _array(name.strip(), [row[i] if i < len(row) else "" for row in rows])
                for i, name in enumerate(names)}

    def to_dataframe(self) -> Any:
        """``columns`` as a pandas.DataFrame. ImportError without pandas."""
        return _sheet.pandas().DataFrame(self.columns)

    def _repr_html_(self) -> str:
        columns = self.columns
        rows = [dict(zip(columns, row)) for row in zip(*columns.values())]
        return notebook.heading(repr(self)) + notebook.table_of(rows, 8)

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def __eq__(self, other: Any) -> bool:
        return isinstance(other, Measurements) and self.text == other.text

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<Measurements {self.origin}: {len(self)} readings>"


def _cell(x: Any) -> str:
    if isinstance(x, str):
        return x
    if x is None:
        return ""
    number = float(x)
    return "" if number != number else repr(number)


def _array(name: str, cells: list[str]) -> np.ndarray:
    if name == "pose" or name.startswith("note"):
        return np.array(cells, dtype=str)
    try:
        return np.array([float(c) if c.strip() else np.nan for c in cells])
    except ValueError:
        return np.array(cells, dtype=str)


def text_of(data: Any) -> tuple[str, str]:
    """(text, origin) of Measurements, a path, the text of a file or a DataFrame."""
    if hasattr(data, "columns") and hasattr(data, "iloc"):
        data = Measurements.from_dataframe(data)
    if isinstance(data, str) and "\n" in data:
        data = Measurements(data, "text")
    if not isinstance(data, Measurements):
        data = Measurements.from_csv(data)
    return data.text, data.origin


def maybe_text_of(data: Any) -> tuple[str, str] | None:
    return None if data is None else text_of(data)


def result_text(result: Any) -> tuple[str, str]:
    """(JSON, origin) of a result, or of the file of one."""
    if hasattr(result, "json"):
        return result.json, type(result).__name__.lower()
    return _core.read_text(os.fspath(result)), os.fspath(result)
