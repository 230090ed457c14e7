"""Measurements: the text of a file, which functions read with the instruments of the machine or frame."""

from __future__ import annotations

import csv
import io
import os
from typing import Any, Mapping

import numpy as np

from . import _core, _sheet, _sources, notebook
from ._checks import is_missing, number, numbers, shown
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
        return cls(_sources.read_text(path), os.fspath(path))

    @classmethod
    def from_arrays(cls, poses: Any = None, loads: Any = None, displacements: Any = None, *,
                    columns: Mapping[str, Any] | None = None, origin: str = "arrays",
                    units: str = "mm") -> "Measurements":
        """Of n readings:

        ``poses``          (n, 6) or (n, 3), mm and deg; rows that are equal are readings at one approach, unless
                           ``columns`` has "pose", the labels
        ``loads``          (n, 6) or (n, 3), N and Nmm
        ``displacements``  (n, 6) or (n, 3), mm and rad; NaN, None and pandas.NA were not measured
        ``columns``        name -> n values: any other columns, sensors too, in the units of their names
        ``units``          "SI": poses, loads and displacements in m, rad, N, Nm

        Raises InputError for other shapes, for columns of different length or given twice, and for what is no real number.
        """
        si = require_units(units)
        table: dict[str, Any] = dict(columns or {})
        for what, names, in_mm, given in (("poses", POSE, poses_in_mm, poses), ("loads", LOAD, loads_in_mm, loads),
                                          ("displacements", DISPLACEMENT, displacement_in_mm, displacements)):
            if given is None:
                continue
            rows = numbers(what, given)
            if rows.ndim != 2 or rows.shape[1] not in (3, 6):
                raise InputError(f"{names[0]} …: shape {rows.shape}; (n, 6) or (n, 3) is wanted")
            if what == "poses":
                rows = np.hstack([rows, np.zeros((len(rows), 6 - rows.shape[1]))])
            rows = in_mm(rows) if si else rows
            for name, column in zip(names, rows.T.tolist()):
                if name in table:
                    raise InputError(f"column {name} is given twice: in {what} and in columns")
                table[name] = column
        if poses is not None and "pose" not in table:
            seen: dict[tuple, int] = {}
            table["pose"] = [str(seen.setdefault(tuple(row), len(seen))) for row in numbers("poses", poses).tolist()]
        return cls(_file_of(table), origin)

    @classmethod
    def from_dataframe(cls, frame: Any, origin: str = "dataframe") -> "Measurements":
        """Of a pandas.DataFrame whose columns are those of a file. Raises InputError."""
        table: dict[str, Any] = {}
        for name in frame.columns:
            if str(name) in table:
                raise InputError(f"column {name} is given twice")
            table[str(name)] = frame[name]
        return cls(_file_of(table), origin)

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


def _file_of(table: dict[str, Any]) -> str:
    """The text of a file with these columns."""
    if not table:
        raise InputError("no columns: measurements have loads and displacements at least")
    cells = {name: _cells(str(name), values) for name, values in table.items()}
    lengths = {name: len(column) for name, column in cells.items()}
    if len(set(lengths.values())) != 1:
        raise InputError(f"columns of different length: {lengths}")
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(cells)
    writer.writerows(zip(*cells.values()))
    return out.getvalue()


def _cells(name: str, values: Any) -> list[str]:
    one = isinstance(values, (str, bytes)) or getattr(values, "ndim", 1) == 0
    if one or not hasattr(values, "__len__") or not hasattr(values, "__iter__"):
        raise InputError(f"column {name}: {shown(values)} is no list: give a value for each reading")
    return [_cell(name, x) for x in values]


def _cell(name: str, x: Any) -> str:
    """Of a number, a truth as 1 or 0, or a text; empty where nothing was measured."""
    if type(x) is float:
        return "" if x != x else repr(x)
    if isinstance(x, str):
        return x
    if is_missing(x):
        return ""
    value = number(f"column {name}", int(x) if isinstance(x, (bool, np.bool_)) else x)
    return "" if value != value else repr(value)


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
    if isinstance(data, (str, os.PathLike)):
        data = Measurements.from_csv(data)
    if not isinstance(data, Measurements):
        raise InputError(f"{shown(data)}: these are no measurements: give Measurements, a path, the text of a file or a "
                         "DataFrame")
    return data.text, data.origin


def maybe_text_of(data: Any) -> tuple[str, str] | None:
    return None if data is None else text_of(data)


def sessions_of(data: Any) -> list[tuple[str, str]]:
    """(text, origin) of each session of one campaign: of a list of them, or of one."""
    return [text_of(each) for each in (data if isinstance(data, (list, tuple)) else [data])]


def diagnosed_sessions(diagnosis: Any) -> list[tuple[str, str]]:
    """What a diagnosis was made of: the files that it names, there or beside its own, as `deflect plan` finds them."""
    content, origin = result_text(diagnosis)
    named = _core.data_of_diagnosis(content, origin)
    if not named:
        raise InputError(f"{origin}: names no measurements: give data too")
    files = [named] if os.path.exists(named) else named.split(" + ")
    of_file = isinstance(diagnosis, (str, os.PathLike))
    for i, file in enumerate(files):
        beside = os.path.join(os.path.dirname(origin), os.path.basename(file))
        if not os.path.exists(file) and of_file and os.path.exists(beside):
            files[i] = beside
        elif not os.path.exists(file):
            raise InputError(f"{origin}: the measurements it names, '{file}', are not there: give data too")
    return sessions_of(files)


def result_text(result: Any) -> tuple[str, str]:
    """(JSON, origin) of a result, or of the file of one."""
    if hasattr(result, "json"):
        return result.json, type(result).__name__.lower()
    if not isinstance(result, (str, os.PathLike)):
        raise InputError(f"{shown(result)}: this is no result: give one, or the file of one")
    return _sources.read_text(result), os.fspath(result)
