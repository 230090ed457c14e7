#!/usr/bin/env python3
"""Sets of the built-in frames that hide two effects, by the solver of own_frames.py: a load cell or a modulus that is
off, and beside it a member, an end, a sensor or a support.

  foreign_pairs.py OUT_DIR --seeds 1 2 3      writes FRAME_FIRST_SECOND_SEED.csv and truth.json
  foreign_pairs.py --judge OUT_DIR DEFLECT    diagnoses them with the program DEFLECT and counts, as a table

Places and what is off the drawing are drawn by lot from the seed. Each effect alone has a signature lambda between 8
and 16 (see foreign_laboratory.py). Together they strain many tolerances, as a frame does that is built worse than
declared.
"""
import collections
import copy
import json
import math
import pathlib
import re
import zlib

import numpy as np

from foreign_laboratory import *  # noqa: F403

FIRST = ("load_gain", "modulus")
SECOND = {"factor": (0.999, 0.05), "gain": (1.0005, 1.5), "clearance": (1e-8, 2e-2), "linear": (1e10, 1e3)}


def with_first(f, factors, effect, value):
    """The frame and the loads that it then has."""
    g = copy.deepcopy(f)
    if effect == "load_gain":
        return g, factors * value
    for m in g["materials"].values():
        m["E"] *= value
    return g, factors


def first_of_size(f, factors, effect, weight, target):
    low, high = 0.0, 0.5
    for _ in range(30):
        middle = (low + high) / 2
        g, loads = with_first(f, factors, effect, 1 + middle)
        low, high = (low, middle) if weight.size(readings_of(g, loads) - weight.nominal) >= target else (middle, high)
    return float(f"{1 + high:.4g}")


def places(f):
    out = {"factor": list(f["members"]) + list(f["ends"]), "gain": list(f["sensors"]),
           "clearance": [], "linear": []}
    for node, held in f["supports"].items():
        for freedom in held:
            if freedom.startswith("u"):
                out["clearance"].append(f"support.{node}.{freedom}")
                out["linear"].append(f"support.{node}.{freedom}")
    return out


def second_of_size(f, law, all_places, factors, weight, target, random):
    for place in random.permutation(all_places[law]):
        effect = f"{law}@{place}"
        value = searched(f, effect, SECOND[law], factors, weight, target)
        if weight.size(readings_of(f, factors, effect, value) - weight.nominal) > 0.9 * target:
            return effect, value
    return None


def cosine(weight, a, b):
    a, b = weight.whitened(a - weight.nominal), weight.whitened(b - weight.nominal)
    return abs(a @ b) / math.sqrt((a @ a) * (b @ b))


def make(folder, frames_folder, seeds, only):
    folder.mkdir(parents=True, exist_ok=True)
    truth = {}
    for frame in only or FRAMES:
        f = read_frame(frames_folder / f"{frame}.yaml")
        factors = steps(len(f["cases"]), True)
        weight, all_places = Weight(f, factors), places(f)
        for seed in seeds:
            for first in FIRST:
                for law in SECOND:
                    random = np.random.default_rng([SEED, seed, zlib.crc32(f"{frame} {first} {law}".encode())])
                    target = random.uniform(8, 16)
                    value = first_of_size(f, factors, first, weight, target)
                    drawn = second_of_size(f, law, all_places, factors, weight, target, random)
                    if drawn is None:
                        continue
                    second, size = drawn
                    g, loads = with_first(f, factors, first, value)
                    alike = cosine(weight, readings_of(g, loads), readings_of(f, factors, second, size))
                    if alike > 0.7:  # one of them would stand for both
                        continue
                    name = f"{frame}_{first}_{re.sub('[^A-Za-z0-9]+', '-', second)}_{seed}.csv"
                    readings, _ = laboratory(g, loads, random, second, size)
                    write_set(folder / name, f, factors, readings, True)
                    truth[name] = {"frame": frame, "effects": [first, second], "lambda": round(target, 2),
                                   "values": [value, size], "cosine": round(alike, 2)}
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n", encoding="utf-8")


def verdict(truth, d):
    """'both' (each named, or in a tie with another), 'one', 'unknown', 'nothing', 'other'; whether more was named."""
    ties = d["indistinguishable"]

    def stands_for(named, hidden):
        return named == hidden or any(named in group and hidden in group for group in ties)

    found = [any(stands_for(n, hidden) for n in d["missing"]) for hidden in truth["effects"]]
    if d["verdict"] == "nothing_missing":
        return "nothing"
    what = {2: "both", 1: "one", 0: "other"}[sum(found)]
    if d["verdict"] == "unknown_effect":
        return "unknown"
    return what + (", and more" if len(d["missing"]) > 2 else "")


def judge(folder, program):
    truth = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
    table = collections.Counter()
    for name, t in truth.items():
        d = diagnosed(folder, name, t["frame"], program)
        what = verdict(t, d)
        table[t["frame"], what] += 1
        print(f"{name}: {what}; lambda {t['lambda']}; {d['verdict']}: {', '.join(d['missing'])}; "
              f"ties {d['indistinguishable']}")
    for frame in FRAMES:
        print(f"| {frame} | {', '.join(f'{n} {what}' for (of, what), n in sorted(table.items()) if of == frame)} |")


if __name__ == "__main__":
    run(__doc__, make, judge)
