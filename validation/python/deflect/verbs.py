"""What the program's commands do, as functions: the same library functions, the same numbers."""

from __future__ import annotations

import json
from typing import Any, Iterable, Mapping

from . import _core, _sources
from .errors import InputError
from .measurements import Measurements, maybe_text_of, result_text, text_of
from .models import Subject, _names, _six, subject_of
from .results import (Comparison, Diagnosis, Fit, History, Plan, Prediction, StiffnessMap, Validation, Validity,
                      progress_of)


def compare(model: Any, data: Any, *, sigma: float | None = None, sigma_rotation: float | None = None,
            validation: bool = False, calibration: Any = None, use: Any = None, fit: Any = None,
            free: Iterable[str] = (), threads: int = 0, progress: Any = None):
    """Where the model fails, nothing fitted: Comparison. With ``validation`` in the words of the validation standards:
    Validity.

    ``model``  a Model, a Frame, or what load() takes
    ``data``   Measurements, a path, the text of a file or a DataFrame
    ``sigma``, ``sigma_rotation``  standard deviations in mm and rad where the data have none
    ``calibration``, ``use``, ``fit``, ``free``  as the options of `deflect compare --validation`
    """
    s, noise = subject_of(model), _core.Noise(sigma, sigma_rotation, False)
    told = progress_of(progress, "compare")
    if not validation:
        if calibration is not None or use is not None or fit is not None or free:
            raise InputError("calibration, use, fit and free go with validation=True")
        return Comparison(*_core.compare(s._core, text_of(data), noise, threads, told))
    return Validity(*_core.validity(s._core, text_of(data), noise, maybe_text_of(calibration), maybe_text_of(use),
                                    None if fit is None else result_text(fit), list(free), s.source, threads, told))


def diagnose(model: Any, data: Any, *, effects: Any = (), sigma: float | None = None,
             sigma_rotation: float | None = None, as_recorded: bool = False, bootstrap: int = 1999, threads: int = 0,
             progress: Any = None) -> Diagnosis:
    """Which physical effect is missing. ``data`` may be a list: sessions of one campaign. ``effects``: own effect files,
    texts or dicts. Arguments as for compare() and of `deflect diagnose`."""
    sessions = data if isinstance(data, (list, tuple)) else [data]
    return Diagnosis(*_core.diagnose(subject_of(model)._core, [text_of(each) for each in sessions],
                                     _sources.effect_sources(effects),
                                     _core.Noise(sigma, sigma_rotation, as_recorded), bootstrap, threads,
                                     progress_of(progress, "diagnose")))


def fit(model: Any, data: Any, free: str | Iterable[str], *, prior: Mapping[str, str] | Iterable[str] = (),
        sigma: float | None = None, sigma_rotation: float | None = None, as_recorded: bool = False, threads: int = 0,
        progress: Any = None) -> Fit:
    """Fits numbers of the description, by their paths, with all tolerances free under their priors.

    ``free``   "materials.aluminium.E", "leg.joint_2.rz.stiffness" …
    ``prior``  {path: "70 GPa ± 2 %"}, or a list of "path=70 GPa ± 2 %"

    The result's ``model`` is the description with the fitted values.
    """
    s = subject_of(model)
    free = [free] if isinstance(free, str) else list(free)
    priors = [f"{path}={value}" for path, value in prior.items()] if isinstance(prior, Mapping) else list(prior)
    text, report, fitted = _core.fit(s._core, text_of(data), free, priors, s.source,
                                     _core.Noise(sigma, sigma_rotation, as_recorded), threads,
                                     progress_of(progress, "fit"))
    out = Fit(text, report)
    object.__setattr__(out, "model", type(s)(fitted))
    return out


def predict(model: Any, plan: Any = None, *, at: Any = None, joints: Any = None, load: Any = None, fit: Any = None,
            theories: Iterable[str] | None = None, sigma: float | None = None, sigma_rotation: float | None = None,
            threads: int = 0, progress: Any = None) -> Prediction:
    """Readings with 95 % intervals: of a ``plan`` (as data), or of one reading: ``at`` a pose under a ``load``, or of a
    frame factors on its load cases, {"snow": 1}. ``fit``: a Fit or its file."""
    s = subject_of(model)
    if (plan is None) == (at is None and joints is None):
        raise InputError("give either a plan or at (or joints)")
    factors = list(at.items()) if isinstance(at, Mapping) else []
    asked = _core.PredictAsked(maybe_text_of(plan), () if at is None or factors else at,
                               () if joints is None else joints, (0.0,) * 6 if load is None else load, factors)
    return Prediction(*_core.predict(s._core, asked, None if fit is None else result_text(fit),
                                     _core.Noise(sigma, sigma_rotation, False), _names(theories), threads,
                                     progress_of(progress, "predict")))


def _hidden(hidden: Any) -> list[Any]:
    """("clearance", {"gap_mm": 0.1}) or ("leg_defect", {"leg": 4, …}) or a name; or several of them."""
    if not isinstance(hidden, list):
        hidden = [hidden]
    out = []
    for each in hidden:
        name, values = (each, {}) if isinstance(each, str) else each
        values = dict(values)
        leg = values.pop("leg", None)
        out.append(_core.AskedEffect(name, leg, [(k, float(v)) for k, v in values.items()]))
    return out


def simulate(model: Any, effect: Any = (), *, campaign: Any = "rich", force: float = 50, noise: float = 0.002,
             noise_rotation: float | None = None, tolerances: float = 1, outliers: float = 0,
             temperature: float | tuple[float, float] = 20, geometry: str = "finite", elements: int = 4, seed: int = 1,
             machine: int | None = None, effects: Any = (), threads: int = 0, progress: Any = None) -> Measurements:
    """Measurements as a laboratory would deliver them, of a machine with hidden effects. The same seed gives the same
    file.

    ``effect``    a name, or (name, {parameter: value, "leg": 4}), or a list of these
    ``campaign``  "paper", "cycle", "rich" or "random"; or a plan, as data
    Other arguments as the options of `deflect simulate`.
    """
    s = subject_of(model)
    named = isinstance(campaign, str) and _core.is_campaign(campaign)
    plan = None if named or (isinstance(campaign, str) and campaign.isidentifier()) else text_of(campaign)
    mean, swing = temperature if isinstance(temperature, tuple) else (temperature, 0.0)
    options = {"force": float(force), "elements": elements, "seed": seed, "machine": machine, "noise": float(noise),
               "noise_rotation": noise_rotation, "tolerances": float(tolerances), "outliers": float(outliers),
               "temperature": (float(mean), float(swing)), "geometry": geometry}
    asked = _core.SimulateAsked(_hidden(list(effect) if effect == () else effect), campaign if plan is None else "",
                                plan, options)
    text, told = _core.simulate(s._core, asked, _sources.effect_sources(effects), threads,
                                progress_of(progress, "simulate"))
    return Measurements(text, f"{s.name}, simulated, seed {seed}", json.loads(told)["hidden"])


def plan(model: Any, diagnosis: Any = None, data: Any = None, *, before: Any = None, use: Any = None,
         aim: str = "effects", group: int = 1, readings: int = 30, probability: float = 0.95,
         max_force: float | None = None, max_moment: float | None = None, forces_only: bool = False,
         poses: Any = "workspace", max_poses: int = 0, sigma: float | None = None,
         sigma_rotation: float | None = None, effects: Any = (), seed: int = 1, threads: int = 0,
         progress: Any = None) -> Plan:
    """What to measure. ``before``: what a campaign ("paper", … or a plan) will tell, and a better one. Else the readings
    that tell the tied effects of a ``diagnosis`` (and its ``data``) apart. The result's ``measurements`` are to be
    filled in. Arguments as the options of `deflect plan`; forces in N, moments in Nmm."""
    s, noise, told = subject_of(model), _core.Noise(sigma, sigma_rotation, False), progress_of(progress, "plan")
    as_text = isinstance(poses, str) and poses in ("workspace", "measured")
    asked = _core.PlanAsked(max_force, max_moment, forces_only, as_text and poses == "measured",
                            None if as_text else text_of(poses), max_poses, seed)
    sources = _sources.effect_sources(effects)
    if before is not None:
        if diagnosis is not None:
            raise InputError("before plans a campaign before it is measured: leave out the diagnosis, or before")
        named = isinstance(before, str) and _core.is_campaign(before)
        found = _core.foresight(s._core, before if named else "", None if named else text_of(before),
                                maybe_text_of(use), aim, noise, asked, sources, threads, told)
    else:
        if diagnosis is None or data is None:
            raise InputError("give a diagnosis and its data, or before=CAMPAIGN to plan before measuring")
        found = _core.next_readings(s._core, result_text(diagnosis), text_of(data), group, readings, probability, noise,
                                    asked, sources, threads, told)
    out = Plan(found[0], found[1])
    object.__setattr__(out, "measurements", Measurements(found[2], "plan") if found[2] else None)
    return out


def history(data: Any, models: Iterable[Any], *, sigma: float | None = None, sigma_rotation: float | None = None,
            threads: int = 0, progress: Any = None) -> History:
    """How the error falls from version to version of a model, on one set of measurements."""
    versions = [subject_of(m)._core for m in models]
    if not versions:
        raise InputError("models: give at least one version")
    return History(*_core.history(versions, text_of(data), _core.Noise(sigma, sigma_rotation, False), threads,
                                  progress_of(progress, "history")))


def validate(model: Any, points: Any = None, *, force: float = 50, theories: Iterable[str] | None = None,
             as_printed: str = "", errata: bool = False, progress: Any = None) -> Validation:
    """The theories against each other under a force (N) along x, y, z at points of the workspace, or at ``points``:
    (n, 6) or (n, 3), mm and deg. ``as_printed``, ``errata``: as the options of `deflect validate`."""
    rows = [] if points is None else [(str(i), list(row)) for i, row in enumerate(_six(points, "points"))]
    return Validation(*_core.validate(subject_of(model)._core, rows, float(force), _names(theories), as_printed, errata,
                                     progress_of(progress, "validate")))


def map(model: Any, n: int | tuple[int, int, int] = 11, *, x: Any = (), y: Any = (), z: Any = (), tilt: Any = (),  # noqa: A001
        force: float = 50, load: Any = None, theories: Iterable[str] | None = None, length: float = 0, threads: int = 0,
        progress: Any = None) -> StiffnessMap:
    """The stiffness over the workspace, on a grid of n or (nx, ny, nz) poses. ``x``, ``y``, ``z``: (from, to) or one
    value, in mm; ``tilt``: roll pitch yaw in deg; ``force`` along x, y, z in turn, in N, or one ``load`` (6,);
    ``length``: the characteristic length of the isotropy, mm (0: the platform's radius or the machine's extent)."""
    counts = (n, n, n) if isinstance(n, int) else tuple(n)
    ranges = [[float(r)] if isinstance(r, (int, float)) else [float(v) for v in r] for r in (x, y, z)]
    return StiffnessMap(*_core.map(subject_of(model)._core, counts, ranges, list(tilt), [] if load is None else load,
                                  float(force), float(length), _names(theories), threads,
                                  progress_of(progress, "map")))


def built_in() -> dict[str, list[str]]:
    """Names of the built-in machines and frames."""
    return {kind: list(_sources.built_in(kind)) for kind in _sources.KINDS}


def effects(model: Any = None, own: Any = ()) -> list[dict[str, Any]]:
    """The effects that a model can lack, as `deflect effects --json`; with a model also the laws at its places."""
    core = None if model is None else subject_of(model)._core
    content = json.loads(_core.effects_json(_sources.effect_sources(own), core))
    return content["effects"] if isinstance(content, dict) else content


__all__ = ["built_in", "compare", "diagnose", "effects", "fit", "history", "map", "plan", "predict", "simulate",
           "validate", "Subject"]
