"""What the program's commands do, as functions: the same library functions, the same numbers."""

from __future__ import annotations

import json
import os
from typing import Any, Iterable, Mapping

import numpy as np

from . import _core, _sources
from ._checks import (MOST, MOST_SEED, listed, maybe_largest, maybe_number, maybe_vector, number, numbers, shown, six,
                      text, theory_names, threads_of, truth, vector, whole)
from .errors import InputError
from .measurements import Measurements, diagnosed_sessions, maybe_text_of, result_text, sessions_of, text_of
from .models import Subject, subject_of
from .results import (Comparison, Diagnosis, Fit, Foresight, History, Plan, Prediction, Result, Validation, Validity,
                      progress_of)
from .results_of_shapes import Check, Drawing, FrameSolution, StiffnessMap
from .solution import Solution
from .units import loads_in_mm, poses_in_mm, require_units


def _noise(sigma: Any, sigma_rotation: Any, as_recorded: Any = False) -> _core.Noise:
    return _core.Noise(maybe_number("sigma", sigma), maybe_number("sigma_rotation", sigma_rotation),
                       truth("as_recorded", as_recorded))


def compare(model: Any, data: Any, *, sigma: float | None = None, sigma_rotation: float | None = None,
            validation: bool = False, calibration: Any = None, use: Any = None, fit: Any = None,
            free: Iterable[str] = (), threads: int = 0, progress: Any = None) -> Comparison | Validity:
    """Where the model fails, nothing fitted: Comparison. With ``validation`` in the words of the validation standards:
    Validity.

    ``model``  a Model, a Frame, or what load() takes
    ``data``   Measurements, a path, the text of a file or a DataFrame
    ``sigma``, ``sigma_rotation``  standard deviations in mm and rad where the data have none
    ``calibration``, ``use``, ``fit``, ``free``  as the options of `deflect compare --validation`
    ``threads``   0: all cores; they change no bit
    ``progress``  True, or a function of the share that is done

    Raises InputError with file, line and column, NumericalError where the model cannot be predicted.
    """
    s, noise = subject_of(model), _noise(sigma, sigma_rotation)
    threads, told = threads_of(threads), progress_of(progress, "compare")
    free = [text("free", each) for each in listed("free", free)]
    if not truth("validation", validation):
        if calibration is not None or use is not None or fit is not None or free:
            raise InputError("calibration, use, fit and free go with validation=True")
        found, report, readings = _core.compare(s._core, text_of(data), noise, threads, told)
        return Comparison(found, report, readings_csv=readings)
    return Validity(*_core.validity(s._core, text_of(data), noise, maybe_text_of(calibration), maybe_text_of(use),
                                    None if fit is None else result_text(fit), free, s.source, threads, told))


def diagnose(model: Any, data: Any, *, effects: Any = (), sigma: float | None = None,
             sigma_rotation: float | None = None, as_recorded: bool = False, bootstrap: int = 1999, threads: int = 0,
             progress: Any = None) -> Diagnosis:
    """Which physical effect is missing: its probability, values with 95 % intervals, and what is tied.

    ``data``         as for compare(), or a list: sessions of one campaign, each once
    ``effects``      own effect files, texts or dicts, also with edits by a Python function (the slow way)
    ``as_recorded``  without the search for mistakes of recording
    ``bootstrap``    sets drawn with nothing missing, at least 99
    ``sigma``, ``sigma_rotation``, ``threads``, ``progress``  as for compare()

    Raises InputError, NumericalError.
    """
    return Diagnosis(*_core.diagnose(subject_of(model)._core, sessions_of(data), _sources.effect_sources(effects),
                                     _noise(sigma, sigma_rotation, as_recorded),
                                     whole("bootstrap", bootstrap, 99, 10**9), threads_of(threads),
                                     progress_of(progress, "diagnose")))


def _freed(free: Any, effects: Any) -> tuple[list[str], list[_core.AskedEffect], list[Any]]:
    """What is free: paths and names of effects; the effects asked for; all own effects."""
    own = _sources.own_effects(effects)
    names, asked = [], []
    one = isinstance(free, (str, dict)) or (isinstance(free, tuple) and len(free) == 2 and isinstance(free[1], Mapping))
    for each in [free] if one else listed("free", free):
        if isinstance(each, dict):
            own.append(each)
            each = each["name"]
        if isinstance(each, str) and "." in each and "@" not in each:
            names.append(each)
            continue
        name, leg, values = _sources.name_leg_values(each)
        asked.append(_core.AskedEffect(name, leg, values))
        names.append(name if leg is None else f"{name}[{leg}]")
    return names, asked, own


def fit(model: Any, data: Any, free: Any, *, prior: Mapping[str, str] | Iterable[str] = (), effects: Any = (),
        sigma: float | None = None, sigma_rotation: float | None = None, as_recorded: bool = False, threads: int = 0,
        progress: Any = None) -> Fit:
    """Fits numbers of the description, by their paths, and parameters of effects, with all tolerances free under their
    priors.

    ``free``     one or a list of: a path, "materials.aluminium.E", "leg.joint_2.rz.stiffness" …; the name of an effect of
                 the catalogue, of a place or of ``effects``, all of whose parameters are then free; (name, {parameter:
                 where the search begins, "leg": 4}); the dict of an own effect
    ``prior``    {path: "70 GPa ± 2 %"}, or one or a list of "path=70 GPa ± 2 %"; of an effect's parameter
                 {"rubber_pad.depth_mm": "0.1 ± 10 %"}
    ``effects``  own effects: files, texts or dicts, also with edits by a Python function (the slow way)
    ``data``, ``sigma``, ``sigma_rotation``  as for compare()

    The result's ``model`` is the description with the fitted values, ``given`` that without. Raises InputError for what
    leads to no number or effect, NumericalError where nothing can be predicted.
    """
    s = subject_of(model)
    names, asked, own = _freed(free, effects)
    priors = ([f"{path}={value}" for path, value in prior.items()] if isinstance(prior, Mapping)
              else [text("prior", each) for each in listed("prior", prior)])
    wanted = _core.FreeAsked(names, priors, s.source, _sources.effect_sources(own), asked)
    found, report, fitted = _core.fit(s._core, text_of(data), wanted, _noise(sigma, sigma_rotation, as_recorded),
                                      threads_of(threads), progress_of(progress, "fit"))
    return Fit(found, report, model=type(s)(fitted), given=s)


def predict(model: Any, plan: Any = None, *, at: Any = None, joints: Any = None, load: Any = None, fit: Any = None,
            effects: Any = (), theories: Iterable[str] | None = None, sigma: float | None = None,
            sigma_rotation: float | None = None, threads: int = 0, units: str = "mm",
            progress: Any = None) -> Prediction:
    """Readings with 95 % intervals: of a ``plan`` (as data), or of one reading: ``at`` a pose under a ``load``, or of a
    frame factors on its load cases, {"snow": 1}.

    ``fit``      a Fit or its file, of this model, with its values or without. Where parameters of effects were fitted,
                 the model is that which lacks them (with a Fit, ``fit.model`` will do)
    ``effects``  own effects that were fitted, as for fit()
    ``at``, ``joints``, ``load``  mm, deg; mm or rad; N, Nmm; with ``units`` "SI" m, rad, N, Nm. Results are in their units
    ``sigma``, ``sigma_rotation``  of a reading, mm and rad, where neither sensor nor fit tell it

    Raises InputError, MechanismError, NumericalError.
    """
    s = subject_of(model)
    if (plan is None) == (at is None and joints is None):
        raise InputError("give either a plan or at (or joints)")
    if isinstance(fit, Fit) and s == fit.__dict__.get("model"):
        s = fit.given
    factors = []
    if isinstance(at, Mapping):
        factors, at = [(text("load case", k), number(f"at: {k}", v)) for k, v in at.items()], None
    si = require_units(units)
    if si:
        at = None if at is None else poses_in_mm(six(at, "at"))
        load = None if load is None else loads_in_mm(six(load, "load"))
    stand = _core.Asked(maybe_vector("at", at), maybe_vector("joints", joints), si)
    asked = _core.PredictAsked(maybe_text_of(plan), stand, maybe_vector("load", load) or [0.0] * 6, factors)
    sources = _sources.effect_sources(effects) if fit is not None else None
    return Prediction(*_core.predict(s._core, asked, None if fit is None else result_text(fit), sources,
                                     _noise(sigma, sigma_rotation), theory_names(theories), threads_of(threads),
                                     progress_of(progress, "predict")))


def simulate(model: Any, effect: Any = (), *, campaign: Any = "rich", force: float = 50, noise: float = 0.002,
             noise_rotation: float | None = None, tolerances: float = 1, outliers: float = 0,
             temperature: float | tuple[float, float] = 20, geometry: str = "finite", elements: int = 4, seed: int = 1,
             machine: int | None = None, effects: Any = (), threads: int = 0, progress: Any = None) -> Measurements:
    """Measurements as a laboratory would deliver them, of a machine with hidden effects. The same seed gives the same
    file.

    ``effect``    a name, or (name, {parameter: value, "leg": 4}), or a list of these
    ``campaign``  "paper", "cycle", "rich" or "random"; or a plan, as data
    ``force``     N; ``noise`` and ``noise_rotation``: standard deviations in mm and rad; ``temperature``: °C, or (mean,
                  swing)
    ``effects``   own effects, as for diagnose()
    Other arguments as the options of `deflect simulate`. Raises InputError, MechanismError, NumericalError.
    """
    s = subject_of(model)
    named = isinstance(campaign, str) and _core.is_campaign(campaign)
    plan = None if named or (isinstance(campaign, str) and campaign.isidentifier()) else text_of(campaign)
    seed = whole("seed", seed, 0, MOST_SEED)
    pair = isinstance(temperature, (tuple, list)) and len(temperature) == 2
    options = {"force": number("force", force), "elements": whole("elements", elements, 1, 1000),
               "seed": seed, "machine": None if machine is None else whole("machine", machine, 0, MOST_SEED),
               "noise": number("noise", noise), "noise_rotation": maybe_number("noise_rotation", noise_rotation),
               "tolerances": number("tolerances", tolerances), "outliers": number("outliers", outliers),
               "temperature": tuple(number("temperature", t) for t in (temperature if pair else (temperature, 0))),
               "geometry": text("geometry", geometry)}
    hidden = effect if isinstance(effect, list) else [] if effect == () else [effect]
    asked = _core.SimulateAsked([_sources.asked_effect(each) for each in hidden], campaign if plan is None else "",
                                plan, options)
    file, told = _core.simulate(s._core, asked, _sources.effect_sources(effects), threads_of(threads),
                                progress_of(progress, "simulate"))
    return Measurements(file, f"{s.name}, simulated, seed {seed}", json.loads(told)["hidden"])


def plan(model: Any, diagnosis: Any = None, data: Any = None, *, before: Any = None, use: Any = None,
         aim: str = "effects", group: int = 1, readings: int = 30, probability: float = 0.95,
         max_force: float | None = None, max_moment: float | None = None, forces_only: bool = False,
         max_cases: int = 0, nodes: Iterable[str] = (), poses: Any = "workspace", max_poses: int = 0,
         sigma: float | None = None, sigma_rotation: float | None = None, effects: Any = (), seed: int = 1,
         threads: int = 0, progress: Any = None) -> Plan | Foresight:
    """What to measure. ``before``: what a campaign ("paper", … or a plan) will tell, and a better one: Foresight. Else the
    readings that tell the tied effects of a ``diagnosis`` apart: Plan; ``data`` are the measurements (or a list: sessions)
    that were diagnosed, without it the files that the diagnosis names, there or beside its own file. The result's
    ``measurements`` are to be filled in. Arguments as the options of `deflect plan`; forces in N, moments in Nmm,
    ``sigma`` in mm and ``sigma_rotation`` in rad, ``nodes`` of a frame their names, or "all". Raises InputError,
    MechanismError, NumericalError."""
    s, noise, told = subject_of(model), _noise(sigma, sigma_rotation), progress_of(progress, "plan")
    group, readings = whole("group", group, 1, MOST), whole("readings", readings, 1, MOST)
    probability, threads = number("probability", probability), threads_of(threads)
    as_text = isinstance(poses, str) and poses in ("workspace", "measured")
    asked = _core.PlanAsked(maybe_largest("max_force", max_force, "N"), maybe_largest("max_moment", max_moment, "Nmm"),
                            truth("forces_only", forces_only), whole("max_cases", max_cases, 0, MOST),
                            [text("nodes", each) for each in listed("nodes", nodes)],
                            as_text and poses == "measured", None if as_text else text_of(poses),
                            whole("max_poses", max_poses, 0, MOST), whole("seed", seed, 0, MOST_SEED))
    sources = _sources.effect_sources(effects)
    if before is not None:
        if diagnosis is not None or data is not None:
            raise InputError("before plans a campaign before it is measured: leave out the diagnosis and its data, or "
                             "before")
        for name, changed in (("group", group != 1), ("readings", readings != 30), ("probability", probability != 0.95)):
            if changed:
                raise InputError(f"{name} is of a plan after a diagnosis; the campaign of before keeps its length: leave "
                                 f"out {name}, or before")
        named = isinstance(before, str) and _core.is_campaign(before)
        found = _core.foresight(s._core, before if named else "", None if named else text_of(before),
                                maybe_text_of(use), text("aim", aim), noise, asked, sources, threads, told)
    else:
        if diagnosis is None:
            raise InputError("give a diagnosis, or before=CAMPAIGN to plan before measuring")
        if use is not None:
            raise InputError("use: wants before=CAMPAIGN, which it is for")
        sessions = diagnosed_sessions(diagnosis) if data is None else sessions_of(data)
        found = _core.next_readings(s._core, result_text(diagnosis), sessions, group, readings, probability, noise, asked,
                                    sources, threads, told)
    chosen = Measurements(found[2], "plan") if found[2] else None
    return Plan(*found[:2], measurements=chosen) if before is None else Foresight(*found[:2], measurements=chosen)


def history(data: Any, models: Any, *, sigma: float | None = None, sigma_rotation: float | None = None,
            threads: int = 0, progress: Any = None) -> History:
    """How the error falls from version to version of a model (``models``: one or a list), on one set of measurements.
    Arguments and errors as for compare()."""
    one = (str, dict, os.PathLike, Subject)
    versions = [subject_of(m)._core for m in listed("models", models, one, "version")]
    return History(*_core.history(versions, text_of(data), _noise(sigma, sigma_rotation), threads_of(threads),
                                  progress_of(progress, "history")))


def validate(model: Any, points: Any = None, *, force: float = 50, theories: Iterable[str] | None = None,
             as_printed: str = "", errata: bool = False, mesh_study: bool = False,
             progress: Any = None) -> Validation:
    """The theories against each other under a force (N) along x, y, z at points of the workspace, or at ``points``:
    (n, 6) or (n, 3), mm and deg. ``as_printed``, ``errata``, ``mesh_study``: as the options of `deflect validate`.
    Raises InputError, MechanismError (out of reach), NumericalError (a failed check, theories that disagree)."""
    rows = [] if points is None else np.atleast_2d(six(points, "points")).tolist()
    if points is not None and not rows:
        raise InputError("points: give at least one, or leave it out for those of the workspace")
    return Validation(*_core.validate(subject_of(model)._core, [(str(i), row) for i, row in enumerate(rows)],
                                     number("force", force), theory_names(theories), text("as_printed", as_printed),
                                     truth("errata", errata), truth("mesh_study", mesh_study),
                                     progress_of(progress, "validate")))


def _range(name: str, values: Any) -> list[float]:
    """None, one or several numbers."""
    row = np.atleast_1d(numbers(name, values))
    return row.tolist() if row.size == 0 else vector(name, row)


def map(model: Any, n: int | tuple[int, int, int] = 11, *, x: Any = (), y: Any = (), z: Any = (), tilt: Any = (),  # noqa: A001
        force: float = 50, load: Any = None, theories: Iterable[str] | None = None, length: float = 0, threads: int = 0,
        progress: Any = None) -> StiffnessMap:
    """The stiffness over the workspace, on a grid of n or (nx, ny, nz) poses. ``x``, ``y``, ``z``: (from, to) or one
    value, in mm; ``tilt``: roll pitch yaw in deg; ``force`` along x, y, z in turn, in N, or one ``load`` (6,);
    ``length``: the characteristic length of the isotropy, mm (0: the platform's radius or the machine's extent). Raises
    InputError, MechanismError (all out of reach), NumericalError."""
    counts = list(n) if isinstance(n, (tuple, list, np.ndarray)) else [n] * 3
    if len(counts) != 3:
        raise InputError(f"n: {shown(n)}: give a whole number, or three: along x, y and z")
    return StiffnessMap(*_core.map(subject_of(model)._core, [whole("n", each, 1, 10**6) for each in counts],
                                  [_range(name, r) for name, r in (("x", x), ("y", y), ("z", z))], _range("tilt", tilt),
                                  maybe_vector("load", load), number("force", force), number("length", length),
                                  theory_names(theories), threads_of(threads), progress_of(progress, "map")))


def built_in() -> dict[str, list[str]]:
    """Names of the built-in machines and frames."""
    return {kind: list(_sources.built_in(kind)) for kind in _sources.KINDS}


def effects(model: Any = None, own: Any = ()) -> list[dict[str, Any]]:
    """The effects that a model can lack, as `deflect effects --json`; with a model also the laws at its places, and for
    each whether it ``applies``. ``own``: effects of one's own. Raises InputError."""
    core = None if model is None else subject_of(model)._core
    content = json.loads(_core.effects_json(_sources.effect_sources(own), core))
    return content["effects"] if isinstance(content, dict) else content


def check(K: Any, *, unit: str = "mm", passive: Any = None, reference: Any = None, tolerance: float | None = None,
          size: float | None = None, key: str = "analytic.stiffness") -> Check:
    """Whether a 6×6 stiffness from elsewhere can be right, and the usual mistake that explains it where not, as `deflect
    check`.

    ``K``          (6, 6), translation first, rad, or the path of a file: N/mm, N, Nmm, or with ``unit`` "m" N/m, N, Nm
    ``passive``    (6, m) twists of passive joints as columns, m from 1 to 5: K J = 0 is wanted
    ``reference``  (6, 6) or a path: what K should equal
    ``tolerance``  relative difference to ignore, instead of the digits given
    ``size``       of the device, mm: K's characteristic length must be a tenth to ten times this
    ``key``        of a JSON file, the member that holds the matrix

    Raises InputError for what is no such matrix. A matrix that fails is an answer: ``passes`` is False.
    """
    if unit not in ("mm", "m"):
        raise InputError(f"unit '{unit}': write 'mm' or 'm'")

    def given(name: str, matrix: Any) -> Any:
        return os.fspath(matrix) if isinstance(matrix, (str, os.PathLike)) else numbers(name, matrix)

    names = [os.fspath(x) if isinstance(x, (str, os.PathLike)) else word if x is not None else ""
             for x, word in ((K, "K"), (reference, "reference"))]
    asked = _core.CheckAsked(1e-3 if unit == "mm" else 1.0, maybe_number("tolerance", tolerance),
                             maybe_number("size", size), text("key", key), *names)
    return Check(*_core.check(given("K", K), None if passive is None else numbers("passive", passive),
                              None if reference is None else given("reference", reference), asked))


def report(results: Any, path: str | os.PathLike[str]) -> None:
    """Writes one page (HTML) of ``results``, one or a list of them or of their files, which needs no network, as `deflect
    report`. Raises InputError for no result, and where this package was built without pages."""
    all_of = listed("results", results, (Result, str, os.PathLike), "result")
    _core.write_page(os.fspath(path), [result_text(each) for each in all_of])


#: By the member "kind" of the JSON.
RESULTS: dict[str, type[Result]] = {
    "check": Check, "comparison": Comparison, "diagnosis": Diagnosis, "drawing": Drawing, "fit": Fit,
    "foresight": Foresight, "frame": FrameSolution, "history": History, "map": StiffnessMap, "plan": Plan,
    "prediction": Prediction, "solve": Solution, "validation": Validation, "validity": Validity}


def read(path: str | os.PathLike[str]) -> Result:
    """A result from a file that --json of the program or ``save`` wrote, as an object of its kind. Raises InputError."""
    content = _sources.read_text(path)
    try:
        kind = json.loads(content)["kind"]
        return RESULTS[kind](content)
    except RecursionError:
        raise InputError(f"{os.fspath(path)}: this is no result: lists stand within lists too deeply") from None
    except (ValueError, KeyError, TypeError):
        raise InputError(f"{os.fspath(path)}: this is no result: give a file of --json, of one of these kinds: "
                         f"{', '.join(RESULTS)}") from None


__all__ = ["built_in", "check", "compare", "diagnose", "effects", "fit", "history", "map", "plan", "predict", "read",
           "report", "simulate", "validate", "Subject"]
