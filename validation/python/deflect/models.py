"""Machines and frames as values."""

from __future__ import annotations

import dataclasses
import json
import os
import re
import warnings
from typing import Any, Iterable, TypeVar

import numpy as np

from . import _core, _sources
from ._checks import (MOST, listed, maybe_number, maybe_vector, number, six, text, theory_names, threads_of, whole)
from .errors import InputError
from .results import progress_of
from .results_of_shapes import Drawing, FrameSolution
from .solution import Solution
from .units import Numbers, displacement_from_mm, loads_in_mm, poses_in_mm, require_units, stiffness_from_mm


@dataclasses.dataclass(frozen=True)
class Place:
    """Where an effect can act: see `deflect effects --device`. `also`: paths of the other parts of a group."""

    id: str
    name: str
    kind: str
    part: str
    path: str
    hold: str
    freedoms: tuple[str, ...] = ()
    motion: str = ""
    leg: int | None = None
    also: tuple[str, ...] = ()


@dataclasses.dataclass(frozen=True)
class Sensor:
    """A named sensor: the unit of its column, and the standard deviation of a reading, in that unit, where known."""

    name: str
    unit: str
    sigma: float | None = None


class Remark(UserWarning):
    """Something in a description that a person should look at again."""


S = TypeVar("S", bound="Subject")


class Subject:
    """A machine (Model) or a frame (Frame): immutable; changes give another one. Can be pickled, copied and shared by
    threads."""

    def __init__(self, core: _core.Subject, text: str = "") -> None:
        self._core, self._text = core, text

    @property
    def name(self) -> str:
        """What the file calls it."""
        return self._core.name

    @property
    def about(self) -> str:
        """What the file says of it in a line."""
        return self._core.about

    @property
    def yaml(self) -> str:
        """A file of it: load(m.yaml) is the same to the last bit of every number."""
        return self._core.yaml(self.name, self.about)

    @property
    def source(self) -> str:
        """The text that it was read from, with its comments and units; of a changed one ``yaml``."""
        return self._text or self.yaml

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes ``source`` to a file, which load() and the program read."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.source)

    def show(self, pose: Numbers | None = None, *, joints: Numbers | None = None) -> Drawing:
        """As drawn, before any solution, as `deflect show`: members, joints, and motions that nothing resists.

        ``pose``, ``joints``  of a machine, as for solve(); home without

        Raises InputError, MechanismError (out of reach).
        """
        at = _core.Asked(maybe_vector("pose", pose), maybe_vector("joints", joints), False)
        return Drawing(*_core.drawing(self._core, at))

    def places(self) -> list[Place]:
        """The places where effects can act, from what the parts are."""
        found: list[dict[str, Any]] = json.loads(self._core.places_json())
        for p in found:
            p.update(freedoms=tuple(p["freedoms"]), also=tuple(p.get("also", ())))
        return [Place(**p) for p in found]

    def sensors(self) -> list[Sensor]:
        """Its named sensors; a machine without any is read at its tool point."""
        return [Sensor(*each) for each in self._core.sensors()]

    def effects(self, effects: Any = ()) -> list[dict[str, Any]]:
        """What it can lack: the catalogue, own ``effects`` and the laws at its places, as `deflect effects --json`.
        Raises InputError for an effect that cannot be read."""
        content = json.loads(_core.effects_json(_sources.effect_sources(effects), self._core))
        return content["effects"] if isinstance(content, dict) else content

    def named(self: S, name: str) -> S:
        """The same under another name; ``source`` keeps its comments."""
        core = self._core.named(text("name", name))
        written = name if re.fullmatch(r"[A-Za-z][\w .-]*\w", name) else json.dumps(name, ensure_ascii=False)
        source, times = re.subn(r"^name: .*$", lambda _: f"name: {written}", self._text, flags=re.MULTILINE)
        if times != 1:
            source = ""  # not written in a line of its own
        return type(self)(core, source)

    def edited(self: S, path: str | dict[str, Any], value: Any = None, action: str = "set") -> S:
        """With a field of the description changed; checked like a file. Several by a dict of path -> value.

        ``path``    "materials.steel.E", "leg.ball_joint.tz", "leg[4].guideway.bending_factor", "materials.*.E"
        ``value``   as in a file: "200 GPa", or a number, list or dict: {"law": "linear", "stiffness": "500 N/mm"}
        ``action``  "set", "append" (laws in series), "multiply" or "add"

        Raises InputError with path, value and the nearest valid name.
        """
        pairs = path.items() if isinstance(path, dict) else [(path, value)]
        return type(self)(self._core.edited([(text("path", p), _sources.as_yaml(v), text("action", action))
                                             for p, v in pairs]))

    def with_effect(self: S, effect: Any, /, *, leg: int | None = None, effects: Any = (), **parameters: float) -> S:
        """With an effect of the catalogue, of its places ("clearance@elbow.rz") or of ``effects`` (files, texts or
        dicts of effect files, see deflect.law); or one such dict itself. Parameters in the units that their names end
        with:

        >>> m.with_effect("guide_root_compliance", stiffness_Nmm_per_rad=5e6)

        Raises InputError for an effect, parameter or leg that it does not have.
        """
        if isinstance(effect, dict):
            effects, effect = [effect], effect["name"]
        asked = _sources.asked_effect((effect, {**parameters, "leg": leg}))
        return type(self)(self._core.with_effect(_sources.effect_sources(effects), asked))

    def __eq__(self, other: Any) -> bool:
        return isinstance(other, Subject) and self.yaml == other.yaml

    def __hash__(self) -> int:
        return hash(self.yaml)

    def __reduce__(self):
        return _restored, (type(self), self.yaml, self._text)

    def __copy__(self):
        return self

    def __deepcopy__(self, memo):
        return self

    def __str__(self) -> str:
        return f"{self.name}: {self.about}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name}>"


class Model(Subject):
    """A machine, measured at its tool point T. Poses are x y z roll pitch yaw of T in the base frame; loads fx fy fz mx
    my mz act on T about T, displacements ux uy uz thx thy thz are those of T, both in base axes. Units mm, deg, N, Nmm
    and rad for displacements; with units="SI" m, rad, N, Nm."""

    @property
    def home(self) -> np.ndarray:
        """(6,) mm, deg: the pose from which the kinematics start."""
        return self._core.home()

    @property
    def legs(self) -> int:
        """How many."""
        return self._core.legs

    def solve(self, pose: Numbers | None = None, load: Numbers | None = None, *,
              joints: Numbers | None = None, geometry: str = "linear", theories: Iterable[str] | None = None,
              elements: int = 0, units: str = "mm") -> Solution:
        """One pose under one load by every theory, with the checks of `deflect solve`.

        ``pose``      (6,) or (3,); home without it
        ``load``      (6,) or (3,); zero without it
        ``joints``    (n,) coordinates instead of the pose: slides in mm (SI: m), turns in rad
        ``geometry``  shape in which forces balance: "linear", "second-order" or "finite"
        ``theories``  names; all without it
        ``elements``  of the MSA for each member; 0: one, or in a deformed shape eight

        Raises InputError, MechanismError (out of reach, cannot stand), NumericalError (a failed check).
        """
        si = require_units(units)
        if si:
            load = None if load is None else loads_in_mm(six(load, "load"))
            pose = None if pose is None else poses_in_mm(six(pose, "pose"))
        at = _core.Asked(maybe_vector("pose", pose), maybe_vector("joints", joints), si)
        forces = maybe_vector("load", load) or [0.0] * 6
        return Solution(_core.solve(self._core, at, forces, text("geometry", geometry), theory_names(theories),
                                    whole("elements", elements, 0, MOST)), units)

    def stiffness(self, poses: Any, loads: Any = None, *, theory: str | Iterable[str] | None = None,
                  out_of_reach: str = "raise", threads: int = 0, units: str = "mm", progress: Any = None) -> Any:
        """The 6×6 at many poses, tangent under the loads; in linear geometry.

        ``poses``   (n, 6) or (n, 3); or one, (6,) or (3,). C-contiguous float64 of (n, 6) is not copied
        ``loads``   (6,) or (3,) for all poses, or (n, 6); zero without it. Without load contacts have no stiffness
        ``theory``  a name; or None: all theories solve and must agree, and the one that `solve` shows is returned; or
                    names or "all": a dict of name -> array
        ``out_of_reach``  "raise" (MechanismError), or "nan"
        ``threads``       0: all cores. The result has the same bits for any number of them
        ``units``         "mm": mm, deg, N, Nmm in, N/mm, N, Nmm out; "SI": m, rad, N, Nm, N/m
        ``progress``      True, or a function of the share that is done

        Returns (n, 6, 6), or (6, 6) for one pose. Raises InputError, MechanismError "pose i: …", NumericalError (a
        failed check, theories that disagree).
        """
        return self._many(poses, loads, theory, (False, True), out_of_reach, threads, units, progress)

    def displacement(self, poses: Any, loads: Any = None, *, theory: str | Iterable[str] | None = None,
                     out_of_reach: str = "raise", threads: int = 0, units: str = "mm", progress: Any = None) -> Any:
        """The displacement of T at many poses under their loads: (n, 6), or (6,) for one pose; mm and rad, SI: m and rad.
        Arguments and errors as for stiffness()."""
        return self._many(poses, loads, theory, (True, False), out_of_reach, threads, units, progress)

    def solve_many(self, poses: Any, loads: Any = None, *, theory: str | Iterable[str] | None = None,
                   out_of_reach: str = "raise", threads: int = 0, units: str = "mm", progress: Any = None) -> Any:
        """(displacement (n, 6), stiffness (n, 6, 6)) at many poses; a dict of such pairs where a dict is asked for.
        Arguments, units and errors as for stiffness()."""
        return self._many(poses, loads, theory, (True, True), out_of_reach, threads, units, progress)

    def _many(self, poses, loads, theory, wanted, out_of_reach, threads, units, progress):
        si = require_units(units)
        if out_of_reach not in ("raise", "nan"):
            raise InputError(f"out_of_reach '{out_of_reach}': write 'raise' or 'nan'")
        rows = six(poses, "poses")
        single = rows.ndim == 1
        forces = np.zeros(6) if loads is None else six(loads, "loads")
        if si:
            rows, forces = poses_in_mm(rows), loads_in_mm(forces)
        if single:
            rows = rows[np.newaxis, :]
        one = theory if isinstance(theory, str) and theory != "all" else None
        names = [one] if one else theory_names(None if theory in (None, "all") else theory)
        found = _core.solve_many(self._core, rows, forces, names, wanted, out_of_reach == "nan",
                                 threads_of(threads), progress_of(progress, self.name))
        by_theory = {}
        for name, (d, K) in zip(_in_order(names), found):
            if si:
                d = None if d is None else displacement_from_mm(d)
                K = None if K is None else stiffness_from_mm(K)
            parts = [x[0] if single else x for x in (d, K) if x is not None]
            by_theory[name] = parts[0] if len(parts) == 1 else tuple(parts)
        if one:
            return by_theory[one]
        return by_theory[_core.reference_theory] if theory is None else by_theory

    def export(self, path: str | os.PathLike[str], *, pose: Numbers | None = None,
               joints: Numbers | None = None, load: Numbers | None = None, to: str | None = None,
               element_size: float = 5, scale: float | None = None) -> tuple[str, str]:
        """Writes the loaded mechanism for other programs, as `deflect export`; returns the paths of two files: the shape
        unloaded, with displacements and forces as fields, and the deflected shape.

        ``path``   ends in .vtu (ParaView) or .msh (Gmsh); ``to`` "vtk" or "msh" without such an end
        ``pose``, ``joints``, ``load``  as for solve()
        ``element_size``  of the MSA, mm
        ``scale``  factor on displacements in the deflected shape; what makes them visible without

        Raises InputError, MechanismError, NumericalError as solve().
        """
        file = os.fspath(path)
        kinds = {".vtu": "vtk", ".msh": "msh"}
        kind = text("to", to or "") or kinds.get(os.path.splitext(file)[1], "")
        if not kind:
            raise InputError(f"{file}: a path that ends in .vtu or .msh is wanted, or to='vtk' or 'msh'")
        at = _core.Asked(maybe_vector("pose", pose), maybe_vector("joints", joints), False)
        second, _, _ = _core.export_structure(self._core, file, kind, at, maybe_vector("load", load) or [0.0] * 6,
                                              number("element_size", element_size), maybe_number("scale", scale))
        return file, second

    def derivatives(self, paths: str | Iterable[str], poses: Any, loads: Any = None, *, theory: str | None = None,
                    step: float = 1e-4, threads: int = 0, units: str = "mm") -> np.ndarray:
        """∂d/∂ln p: what the displacement of T changes by where a number p of the description grows, per relative
        change of it: 0.01 of it is the change for 1 %.

        ``paths``   numbers of the description by their paths, as for edited(); "materials.*.E" grows all moduli alike
        ``poses``, ``loads``, ``theory``, ``threads``, ``units``  as for displacement()
        ``step``    relative, of the central difference

        Returns (n, 6, number of paths), or (6, number of paths) for one pose, mm and rad, SI: m and rad. A number that is
        0 has the derivative 0. Raises InputError for a path that leads to no number, and as displacement().
        """
        if not 0 < number("step", step) < 0.5:
            raise InputError(f"step = {step}: give a relative step above 0 and below 0.5")
        columns = []
        for path in listed("paths", paths, str, "number of the description"):
            more, less = (self.edited(path, 1 + s, "multiply").displacement(
                poses, loads, theory=theory, threads=threads, units=units) for s in (step, -step))
            columns.append((more - less) / (2 * step))
        return np.stack(columns, axis=-1)


class Frame(Subject):
    """A frame of nodes and members under load cases, read by its sensors."""

    def nodes(self) -> dict[str, Any]:
        """``{"node": names, "x_mm": (n,), "y_mm": (n,), "z_mm": (n,), "held": words}``, what a support holds."""
        rows = self.show().frames
        at = np.array([row.at_mm for row in rows]).reshape(-1, 3)
        return {"node": [row.name for row in rows], **{f"{axis}_mm": at[:, i] for i, axis in enumerate("xyz")},
                "held": [row.held for row in rows]}

    def members(self) -> dict[str, Any]:
        """``{"member": names, "section": names, "material": names, "start_mm": (n, 3), "end_mm": (n, 3), "length_mm":
        (n,)}``."""
        rows = self.show().members
        ends = {name: np.array([row[name] for row in rows]).reshape(-1, 3) for name in ("start_mm", "end_mm")}
        return {"member": [row.part for row in rows], "section": [row.section for row in rows],
                "material": [row.material for row in rows], **ends,
                "length_mm": np.array([row.length_mm for row in rows], dtype=float)}

    @property
    def load_cases(self) -> list[str]:
        """Their names."""
        return self._core.load_cases

    def solve(self, *, solver: str = "auto", progress: Any = None) -> FrameSolution:
        """Every load case: displacements, reactions, member forces, shares, checks, as `deflect frame`.

        ``solver``  "auto", "direct" or "iterative"

        Raises InputError, MechanismError with ``motions`` where it cannot stand, NumericalError.
        """
        return FrameSolution(*_core.solve_frame(self._core, text("solver", solver), progress_of(progress, self.name)))


def _in_order(names: list[str]) -> list[str]:
    """In the order of the table, as results are."""
    return [name for name in _core.theories if name in names]


def _restored(kind: type, yaml: str, text: str) -> Subject:
    return kind(_core.parse(yaml, "pickle", kind is Frame), text)


def _subject(text: str, origin: str, want_frame: bool) -> Any:
    core = _core.parse(text, origin, want_frame)
    for question in core.questions():
        warnings.warn(f"{origin}: {question}", Remark, stacklevel=3)
    return (Frame if core.is_frame else Model)(core, text)


def load(source: Any) -> Any:
    """A machine (Model) or a frame (Frame): by a built-in name, a path, the text of a file, or a dict of its fields.

    >>> deflect.load("haptic-6psu").solve([25, 25, 198.9], [50, 0, 0]).displacement

    Raises InputError with file, line, what is wrong and the nearest valid name.
    """
    return _subject(*_sources.description(source, ("machine", "frame")), False)


def frame(source: Any) -> Frame:
    """A frame likewise; InputError for a machine."""
    return _subject(*_sources.description(source, ("frame",)), True)


def subject_of(source: Any) -> Any:
    """A Model or a Frame, or what load() takes."""
    return source if isinstance(source, Subject) else load(source)
