"""Where descriptions, effects and texts come from: built-in names, files, texts, dicts."""

from __future__ import annotations

import functools
import json
import os
import pathlib
from typing import Any, Mapping

from . import _core
from ._checks import listed, number, shown, text, whole
from .errors import InputError

KINDS = {"machine": ("devices",), "frame": ("cases", "frames")}


@functools.cache
def data_folder() -> pathlib.Path:
    """share/deflect of the nearest folder above this package: of the prefix it is installed below, or of the build tree."""
    for parent in pathlib.Path(__file__).absolute().parents:
        if (parent / "share/deflect/devices").is_dir():
            return parent / "share/deflect"
    raise InputError(f"no folder above {__file__} has share/deflect, the devices and effects: install deflect again")


def built_in(kind: str) -> dict[str, pathlib.Path]:
    """Name -> file of the built-in machines or frames, sorted."""
    files = [f for folder in KINDS[kind] for f in (data_folder() / folder).glob("*.yaml")]
    return {f.stem: f for f in sorted(files, key=lambda f: f.stem)}


def named_file(name: str, kinds: tuple[str, ...]) -> str:
    """The file of a built-in name, or the path itself."""
    known = {k: f for kind in kinds for k, f in built_in(kind).items()}
    if name in known:
        return str(known[name])
    if "/" in name or name.endswith((".yaml", ".yml", ".json")) or os.path.exists(name):
        return name
    what = "machine or frame" if len(kinds) == 2 else kinds[0]
    raise InputError(f"there is no {what} '{name}'{_core.suggestion(name, list(known))}: "
                     f"name a built-in one ({', '.join(known)}) or a file, or give its text")


def read_text(path: str | os.PathLike[str]) -> str:
    """Of a file. InputError where it cannot be read or is not UTF-8, with the line."""
    try:
        return _core.read_text(os.fspath(path))
    except UnicodeDecodeError as wrong:
        read, at = wrong.object, wrong.start
        line, why = read.count(b"\n", 0, at) + 1, f"byte 0x{read[at]:02X} is not UTF-8: save the file as UTF-8"
        if read.startswith((b"\xff\xfe", b"\xfe\xff")):
            line, why = 1, "the file is UTF-16: save it as UTF-8"
        elif b"\0" in read[:at]:
            line = read.count(b"\n", 0, read.index(b"\0")) + 1
            why = "there is a NUL byte: the file is binary or damaged, save it as UTF-8 text"
    raise InputError(f"{os.fspath(path)}:{line}: {why}")


def as_yaml(value: Any) -> str:
    """YAML as it would stand in a file: text as it is, numbers with all their digits, dicts and lists in flow style."""
    if isinstance(value, str):
        return value
    return json.dumps(value, default=_plain, ensure_ascii=False)


def _plain(value: Any) -> Any:
    """What json does not know: numbers and arrays of NumPy."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} is no value of a description")


def description(source: Any, kinds: tuple[str, ...]) -> tuple[str, str]:
    """(text, what messages call it) of a built-in name, a path, a text or a dict."""
    if isinstance(source, dict):
        return as_yaml(source), "dict"
    if isinstance(source, str) and "\n" in source:
        return source, "text"
    if not isinstance(source, (str, os.PathLike)):
        raise TypeError(f"a built-in name, a path, a text or a dict is wanted, not {type(source).__name__}")
    path = named_file(source, kinds) if isinstance(source, str) else os.fspath(source)
    return read_text(path), path


def effect_sources(own: Any = ()) -> _core.EffectSources:
    """The catalogue and own effects: files, texts or dicts; dicts whose "edits" is a function are computed ones."""
    texts, computed = [], []
    for each in own_effects(own):
        if isinstance(each, dict) and callable(each.get("edits")):
            computed.append(_computed(each))
        elif isinstance(each, dict):
            texts.append((as_yaml(with_pages(each)), f"effect {each.get('name', '')}".strip()))
        elif isinstance(each, str) and "\n" in each:
            texts.append((each, "text"))
        elif isinstance(each, (str, os.PathLike)):
            texts.append((read_text(each), os.fspath(each)))
        else:
            raise InputError(f"effects: {shown(each)}: an effect file, its text or a dict is wanted")
    return _core.EffectSources(str(data_folder() / "effects" / "catalogue"), texts, computed)


def own_effects(own: Any) -> list[Any]:
    return listed("effects", own, (str, dict, os.PathLike))


def asked_effect(each: Any) -> _core.AskedEffect:
    """"clearance", or ("clearance", {"gap_mm": 0.1}) or ("leg_defect", {"leg": 4, …})."""
    name, leg, values = name_leg_values(each)
    return _core.AskedEffect(name, leg, values)


def name_leg_values(each: Any) -> tuple[str, int | None, list[tuple[str, float]]]:
    pair = (each, {}) if isinstance(each, str) else each
    if not (isinstance(pair, (tuple, list)) and len(pair) == 2 and isinstance(pair[1], Mapping)):
        raise InputError(f"effect {shown(each)}: write a name, or (name, {{parameter: value}})")
    values = dict(pair[1])
    leg = values.pop("leg", None)
    return (text("effect", pair[0]), None if leg is None else whole("leg", leg, 1, 1000),
            [(text("parameter", name), number(name, value)) for name, value in values.items()])


def with_pages(effect: dict[str, Any]) -> dict[str, Any]:
    """A trial needs no explanation: pages that are not there are empty, and the title is the name."""
    pages = {page: "not described" for page in ("machine", "data", "bench", "cure")}
    return {"title": effect.get("name", ""), "scope": "machine", **effect, "pages": {**pages, **effect.get("pages", {})}}


def _computed(effect: dict[str, Any]) -> _core.ComputedEffect:
    full, function = with_pages(effect), effect["edits"]
    parameters = full.get("parameters", {})
    names = list(parameters)
    about = {"about": "of an effect written in Python"}
    head = {**full, "parameters": {n: {**about, **p} for n, p in parameters.items()},
            "edits": [{"at": "leg.x", "set": "$" + n} for n in names] or [{"at": "leg.x", "set": 0}]}
    bare = {name: value for name, value in full.items() if name != "parameters"}

    def edits(values: list[float]) -> tuple[bool, str]:
        try:
            made = list(function(dict(zip(names, values))))
        except InputError as impossible:
            return False, str(impossible)
        return True, as_yaml({**bare, "edits": made}) if made else ""

    return _core.ComputedEffect((as_yaml(head), f"effect {full.get('name', '')}"), edits)
