#!/usr/bin/env python3
"""Sets of the built-in frames in which one member has hardly any of its stiffness left, by the solver of own_frames.py.

  foreign_soft.py OUT_DIR --seeds 1 2 3      writes FRAME_soft-MEMBER_SEED.csv and truth.json
  foreign_soft.py --judge OUT_DIR DEFLECT    diagnoses them with the program DEFLECT and counts, as a table

The member and its factor, from a hundredth to 0.3, are drawn by lot from the seed; what changes the readings by
lambda < 9 is drawn again. Of each seed one set has each load case once, as the campaign "paper" has, and one the
steps of foreign_frames.py. Where a member is that soft it moves the readings in another direction than a little
softer: its stiffnesses against tension, bending and torsion matter by turns.
"""
import collections
import json
import math
import zlib

import numpy as np

from foreign_alike import verdict
from foreign_laboratory import *  # noqa: F403

CAMPAIGNS = ("paper", "steps")
LEAST = 9


def draw(f, factors, weight, random):
    for _ in range(50):
        effect = f"factor@{random.choice(list(f['members']))}"
        value = float(f"{math.exp(random.uniform(math.log(0.01), math.log(0.3))):.3g}")
        size = weight.size(readings_of(f, factors, effect, value) - weight.nominal)
        if size >= LEAST:
            return effect, value, size
    raise ValueError(f"{f['name']}: no member shows")


def make(folder, frames_folder, seeds, only):
    folder.mkdir(parents=True, exist_ok=True)
    truth = {}
    for frame in only or FRAMES:
        f = read_frame(frames_folder / f"{frame}.yaml")
        for campaign in CAMPAIGNS:
            factors = np.eye(len(f["cases"])) if campaign == "paper" else steps(len(f["cases"]), False)
            weight = Weight(f, factors)
            for seed in seeds:
                random = np.random.default_rng([SEED, seed, zlib.crc32(f"{frame} soft {campaign}".encode())])
                effect, value, size = draw(f, factors, weight, random)
                name = f"{frame}_soft-{effect.split('@')[1]}-{campaign}_{seed}.csv"
                readings, built = laboratory(f, factors, random, effect, value)
                write_set(folder / name, f, factors, readings, False)
                truth[name] = {"frame": frame, "kind": campaign, "effect": effect, "lambda": round(size, 2),
                               "value_SI": value, "acceptable": [], "parameters": parameters_of(f, effect, value),
                               "as_built": as_built(f, built, effect, value)}
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n", encoding="utf-8")


def holds(t, d):
    """Whether the interval of the candidate holds the factor as it was built; None where it was not fitted."""
    for c in d["candidates"]:
        if c["effect"] == t["effect"] and c["parameters"]:
            return c["parameters"][0]["low95"] <= t["as_built"]["factor"] <= c["parameters"][0]["high95"]
    return None


def judge(folder, program):
    truth = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
    table, intervals = collections.Counter(), collections.Counter()
    for name, t in truth.items():
        d = diagnosed(folder, name, t["frame"], program)
        what, _, _ = verdict(t, d)
        table[t["frame"], t["kind"], what] += 1
        intervals[holds(t, d)] += 1
        print(f"{name}: {what}; factor {t['value_SI']}, lambda {t['lambda']}; {d['verdict']}: "
              f"{', '.join(d['missing'])}; holds {holds(t, d)}")
    print_table(table, CAMPAIGNS)
    print(f"intervals that hold the factor as built: {intervals[True]} of {intervals[True] + intervals[False]}")


if __name__ == "__main__":
    run(__doc__, make, judge)
