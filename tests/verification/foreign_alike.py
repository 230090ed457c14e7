#!/usr/bin/env python3
"""Sets of the built-in frames that look alike, by the solver of own_frames.py: friction, a sensor that sticks,
play, restraint of a free direction, a load at another node, friction at a node where the frame has no part.

  foreign_alike.py OUT_DIR --seeds 1 2 3      writes FRAME_EFFECT_SEED.csv and truth.json
  foreign_alike.py --judge OUT_DIR DEFLECT    diagnoses them with the program DEFLECT and counts, as a table

Places, sizes and what is off the drawing are drawn by lot from the seed. Sizes are such that the signature lambda
lies between 9 and 25 (see foreign_laboratory.py); places where no size of the effect reaches that are passed over.
All loads go up and down in steps, so that what lags and what has play can be told apart. Friction at a node ("node"
in its id) is no candidate of deflect: the right answer is that something unknown is missing.
"""
import collections
import json
import pathlib
import re
import zlib

import numpy as np

from foreign_laboratory import *  # noqa: F403

RANGES = {"friction": (1e-1, 1e6), "stiction": (1e-8, 1e-2), "clearance": (1e-8, 2e-2), "restraint": (1e2, 1e9)}
KINDS = ("stiction", "friction", "clearance", "restraint", "elsewhere", "friction at a node")


def freedoms_of(f):
    """Those in which the nodes of the frame move."""
    if f["plane"] == "none":
        return list(FREEDOMS)
    normal = ({"x", "y", "z"} - set(f["plane"])).pop()
    return [d for d in FREEDOMS if d.startswith("r") == (d[1] == normal)]


def turns(f, node):
    """Whether a member at the node resists its rotation."""
    return any(not m["truss"] and node in (m["from"], m["to"]) for m in f["members"].values())


def places(f):
    """By kind of effect the places that it can have."""
    out = collections.defaultdict(list)
    moves = freedoms_of(f)
    for node, held in f["supports"].items():
        for d in moves:
            if d in held:
                out["clearance"].append(f"support.{node}.{d}")
            elif d.startswith("u") or turns(f, node):
                for kind in ("friction", "restraint"):
                    out[kind].append(f"support.{node}.{d}")
    for name, s in f["springs"].items():
        for kind in ("friction", "clearance"):
            out[kind].append(f"spring.{name}.{s['freedom']}")
    out["friction"] += list(f["ends"])
    out["stiction"] = list(f["sensors"])
    sprung = {s["node"] for s in f["springs"].values()}
    out["friction at a node"] = [f"node.{n}.{d}" for n in f["nodes"] if n not in f["supports"] and n not in sprung
                                 for d in moves if d.startswith("u")]
    for case, loads in f["cases"].items():
        for node in sorted({n for n, _ in loads}):
            for m in f["members"].values():  # to the next node
                if node in (m["from"], m["to"]):
                    other = m["to"] if node == m["from"] else m["from"]
                    if other not in f["supports"]:
                        out["elsewhere"].append(f"{case}/{node}/{other}")
    return out


def same_by_construction(f, effect):
    """A spring stands beside all that a support does in the same freedom of its node."""
    law, _, place = effect.partition("@")
    out = []
    for name, s in f["springs"].items():
        if place == f"support.{s['node']}.{s['freedom']}":
            out.append(f"factor@spring.{name}.{s['freedom']}" if law == "restraint" else
                       f"{law}@spring.{name}.{s['freedom']}")
        if law != "restraint" and place == f"spring.{name}.{s['freedom']}" and s["node"] in f["supports"]:
            out.append(f"{law}@support.{s['node']}.{s['freedom']}")
    return out


def draw(f, kind, all_places, factors, weight, random):
    """An effect, its value and its signature; None where no place lets it show."""
    law = kind.split()[0]
    for place in random.permutation(all_places[kind]):
        effect, target = f"{law}@{place}", random.uniform(9, 25)
        value = 1
        if law in RANGES:
            value = effect_value(f, effect, searched(f, effect, RANGES[law], factors, weight, target))
        size = weight.size(readings_of(f, factors, effect, value) - weight.nominal)
        if size > 0.9 * (target if law in RANGES else 9):
            return effect, value, size
    return None


def make(folder, frames_folder, seeds, only):
    folder.mkdir(parents=True, exist_ok=True)
    truth = {}
    for frame in only or FRAMES:
        f = read_frame(frames_folder / f"{frame}.yaml")
        factors = steps(len(f["cases"]), True)
        weight, all_places = Weight(f, factors), places(f)
        for seed in seeds:
            for kind in KINDS:
                random = np.random.default_rng([SEED, seed, zlib.crc32(f"{frame} {kind}".encode())])
                drawn = draw(f, kind, all_places, factors, weight, random)
                if drawn is None:
                    continue
                effect, value, size = drawn
                name = f"{frame}_{re.sub('[^A-Za-z0-9]+', '-', effect)}_{seed}.csv"
                readings, built = laboratory(f, factors, random, effect, value)
                write_set(folder / name, f, factors, readings, True)
                truth[name] = {"frame": frame, "kind": kind, "effect": effect, "lambda": round(size, 2),
                               "value_SI": value, "acceptable": same_by_construction(f, effect),
                               "parameters": {} if kind.endswith("node") else parameters_of(f, effect, value),
                               "as_built": as_built(f, built, effect, value)}
                if kind == "elsewhere":
                    truth[name]["mistake"] = "a load at another node"
                if kind.endswith("node"):
                    truth[name]["unknown"] = True
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n", encoding="utf-8")


OTHER = [{"stiction", "friction"}, {"clearance", "restraint"}]


def verdict(truth, d):
    """'named', 'in a tie', 'told' (a mistake, with its place), 'unknown', 'wrong', 'confidently wrong'; whether what it
    is to be told from was named instead; whether a tie comes without a reading that splits it."""
    right = [truth["effect"]] + truth["acceptable"]
    named, tied = d["missing"], [n for group in d["indistinguishable"] for n in group]
    law = truth["effect"].split("@")[0]
    other = any({law, n.split("@")[0]} in OTHER for n in named + tied)
    open_tie = len(d["splitting"]) < len(d["indistinguishable"])
    mistakes = d["mistakes"][0]["sentence"] if d["mistakes"] and d["mistakes"][0]["certain"] else ""
    if "mistake" in truth and mistakes:
        parts = truth["effect"].split("@")[1].split("/")
        return ("told" if all(p in mistakes for p in parts) else "wrong"), False, False
    if truth.get("unknown") and d["verdict"] == "unknown_effect":
        return "unknown", other, open_tie
    if any(n in tied for n in right):
        return "in a tie", other, open_tie
    if any(n in named for n in right):
        extra = [n for n in named if n not in right]
        return ("named, and more" if extra else "named"), other, open_tie
    if d["verdict"] == "unknown_effect":
        return "called unknown", other, open_tie
    if d["verdict"] == "nothing_missing":
        return "nothing", other, open_tie
    sure = d["verdict"] == "effect" and d["candidates"][0]["probability"] > 0.9
    return ("confidently wrong" if sure else "wrong"), other, open_tie


def judge(folder, program):
    truth = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
    table, others, open_ties = collections.Counter(), [], []
    for name, t in truth.items():
        d = diagnosed(folder, name, t["frame"], program)
        what, other, open_tie = verdict(t, d)
        table[t["frame"], t["kind"], what] += 1
        others += [name] if other else []
        open_ties += [name] if open_tie else []
        print(f"{name}: {what}{' THE OTHER' if other else ''}{' OPEN TIE' if open_tie else ''}; lambda {t['lambda']}; "
              f"{d['verdict']}: {', '.join(d['missing'])}; ties {d['indistinguishable']}")
    print_table(table, KINDS)
    print(f"named with what it is to be told from: {others}\nties without a reading that splits them: {open_ties}")


if __name__ == "__main__":
    run(__doc__, make, judge)
