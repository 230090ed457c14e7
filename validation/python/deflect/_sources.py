"""Where descriptions, effects and texts come from: built-in names, files, texts, dicts."""

from __future__ import annotations

import functools
import json
import os
import pathlib
from typing import Any

from . import _core
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
    return _core.read_text(path), path


def effect_sources(own: Any = ()) -> _core.EffectSources:
    """The catalogue and own effects: files, texts or dicts; dicts whose "edits" is a function are computed ones."""
    if isinstance(own, (str, dict, os.PathLike)):
        own = [own]
    texts, computed = [], []
    for each in own:
        if isinstance(each, dict) and callable(each.get("edits")):
            computed.append(_computed(each))
        elif isinstance(each, dict):
            texts.append((as_yaml(with_pages(each)), f"effect {each.get('name', '')}".strip()))
        elif isinstance(each, str) and "\n" in each:
            texts.append((each, "text"))
        else:
            texts.append((_core.read_text(os.fspath(each)), os.fspath(each)))
    return _core.EffectSources(str(data_folder() / "effects" / "catalogue"), texts, computed)


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
