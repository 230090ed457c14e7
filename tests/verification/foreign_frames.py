#!/usr/bin/env python3
"""Measurements of the built-in frames with a hidden effect, by a program that shares nothing with deflect.

  foreign_frames.py OUT_DIR               writes FRAME_EFFECT.csv and truth.json
  foreign_frames.py --nominal FRAME.yaml  prints what the frame as drawn does under each load case, as JSON

A frame is a dense stiffness matrix of Euler-Bernoulli members (12x12); released and sprung ends are condensed, trusses
are bars. A support or spring with a law other than a linear one is left out of the matrix; its force f is then the one
unknown of a scalar contact problem,

  delta = a - C f,   delta = law(f),

a the displacement that the loads cause there without it, C the compliance there. Play has three states (free, at either
end), a one-sided support two, elastic-Coulomb friction three (it sticks, or slips in either sense), each solved in
closed form.

What a laboratory would deliver (foreign_laboratory.py). Sizes are chosen so that the signature lambda of an effect lies
between 9 and 19 where the effect has a free size.

Needs numpy and PyYAML. The same seed gives the same files.
"""
import argparse
import json
import pathlib
import re
import sys
import zlib

import numpy as np

from foreign_laboratory import *  # noqa: F403

# Effects by frame: id, value in SI (None: its size is searched), range of the search, equivalents by construction.
# Of equivalents: two ends of members that meet alone at a node, where nothing reads the node's rotation.
SETS = {
    "truss-45": [
        ("linear@support.P0a.ux", None, (1e10, 1e5), []),
        ("clearance@support.P0c.ux", None, (1e-7, 2e-3), []),
        ("clearance@support.P0a.ux", 1e-3, None, []),  # so wide that nothing touches
        ("pull@support.P0b.ux", None, (1e-11, 1e-5), []),
        ("factor@C1b", None, (0.999, 0.05), []),
        ("factor@D0bc", 0.02, None, []),
        ("gain@F_C0a", 1.05, None, []),
        ("factor@side", 1.06, None, []),
        ("stiction@tip_z", None, (1e-7, 1e-3), []),
        ("elsewhere@corner/P3b/P3a", 1, None, []),
    ],
    "portal-semi-rigid": [
        ("linear@support.A.ry", None, (1e9, 1e3), ["linear@left.start.rz"]),
        ("clearance@support.D.ux", None, (1e-7, 5e-3), []),
        ("factor@beam_1.start.ry", None, (0.999, 0.05), []),
        ("linear@beam_1.end.ry", None, (1e9, 1e3), ["linear@beam_2.start.ry"]),
        ("pull@support.D.ry", None, (1e-11, 1e-3), []),
        ("factor@right", None, (0.999, 0.1), []),
        ("modulus", 1.04, None, []),
        ("factor@twist", 1.06, None, []),
        ("gain@turn_C", 1.05, None, []),
        ("stiction@top_x", None, (1e-7, 1e-3), []),
        ("elsewhere@twist/C/B", 1, None, []),
    ],
    "lattice-girder": [
        ("restraint@support.r4.ux", None, (1e2, 1e9), []),
        ("friction@support.r4.ux", None, (1, 1e5), []),
        ("pull@support.r4.uz", None, (1e-11, 1e-4), []),
        ("linear@support.l4.uz", None, (1e11, 1e5), []),
        ("clearance@support.r0.uz", None, (1e-7, 5e-3), []),
        ("clearance@support.l0.uz", 2e-3, None, []),  # as wide as the motion
        ("factor@lfall1", None, (0.999, 0.02), []),
        ("factor@rrise0", 0.02, None, []),
        ("stiction@slide_x", None, (1e-7, 1e-3), []),
        ("elsewhere@right lane/r2/r1", 1, None, []),
    ],
    "beam-on-springs": [
        ("factor@spring.pad2.uz", None, (0.999, 0.1), []),
        ("factor@spring.pad4.uz", 0.02, None, []),
        ("clearance@spring.pad3.uz", None, (1e-7, 5e-3), []),
        ("clearance@spring.pad1.uz", 1e-3, None, []),  # so wide that nothing touches
        ("clearance@spring.pad5.uz", 2e-3, None, []),  # that touches under the largest loads alone
        ("pull@spring.pad5.uz", None, (1e-11, 1e-5), []),
        ("linear@rail3.end.ry", None, (1e10, 1e4), ["linear@rail4.start.ry"]),
        ("friction@support.N0.uz", None, (1, 1e6), ["friction@spring.pad0.uz"]),
        ("modulus", 1.04, None, []),
        ("factor@at 3", 1.06, None, []),
        ("restraint@support.N0.ry", None, (1e2, 1e9), []),
        ("stiction@z0", None, (1e-7, 1e-3), []),
        ("elsewhere@at 3/N3/N4", 1, None, []),
    ],
}
# Mistakes of recording: frame, kind, what of. They are made in a healthy frame.
MISTAKES = [
    ("truss-45", "swapped", ("tip_z", "mid_z")),
    ("portal-semi-rigid", "sign", ("mid_z",)),
    ("beam-on-springs", "pounds", ("at 3",)),
    ("lattice-girder", "metres", ("wind_y",)),
    ("beam-on-springs", "zero", ("z6",)),
]


def make_mistake(path, f, kind, what, random):
    """Returns the words of the truth."""
    factors = steps(len(f["cases"]), False)
    readings, _ = laboratory(f, factors, random)
    at = [list(f["sensors"]).index(name) for name in what if name in f["sensors"]]
    units, columns, wrong = {}, None, list(what)
    if kind == "swapped":
        readings[:, at] = readings[:, at[::-1]]
    elif kind == "sign":
        readings[:, at[0]] *= -1
    elif kind == "metres":
        units = {what[0]: 1e-3}
    elif kind == "zero":
        readings[:, at[0]] += 0.05e-3
    elif kind == "pounds":
        (node, key), value = next(iter(f["cases"][what[0]].items()))
        columns = []
        for k, name in enumerate(f["cases"]):
            if name == what[0]:
                columns.append((f"node.{node}.{key}_N", factors[:, k] * value / POUND_FORCE))
                wrong = [f"node.{node}.{key}"]
            else:
                columns.append((f"load.{name}", factors[:, k]))
    write_set(path, f, factors, readings, False, units, columns)
    return wrong, {"swapped": "two channels swapped", "sign": "a channel with the wrong sign",
                   "metres": "a channel in m under a name in mm", "zero": "a channel with a constant offset of 0.05 mm",
                   "pounds": "a load column in lbf under a name in N"}[kind]


def make_all(folder, frames_folder, only=None):
    folder.mkdir(parents=True, exist_ok=True)
    truth = {}
    for frame in FRAMES:
        if only and frame not in only:
            continue
        f = read_frame(frames_folder / f"{frame}.yaml")
        weights = {loops: Weight(f, steps(len(f["cases"]), loops)) for loops in (False, True)}
        for k in range(2):
            name = f"{frame}_healthy-{k + 1}.csv"
            random = np.random.default_rng([SEED, zlib.crc32(name.encode())])
            factors = steps(len(f["cases"]), k == 1)
            write_set(folder / name, f, factors, laboratory(f, factors, random)[0], k == 1)
            truth[name] = {"frame": frame, "effect": None, "parameters": {}, "lambda": 0, "acceptable": []}
        for effect, value, limits, equivalents in SETS[frame]:
            name = f"{frame}_{re.sub('[^A-Za-z0-9]+', '-', effect)}.csv"
            random = np.random.default_rng([SEED, zlib.crc32(name.encode())])
            loops = effect.split("@")[0] in LOOPS
            factors, weight = steps(len(f["cases"]), loops), weights[loops]
            if value is None:
                value = searched(f, effect, limits, factors, weight, random.uniform(9, 19))
            value = effect_value(f, effect, value)
            size = weight.size(readings_of(f, factors, effect, value) - weight.nominal)
            readings, built = laboratory(f, factors, random, effect, value)
            write_set(folder / name, f, factors, readings, loops)
            truth[name] = {"frame": frame, "effect": effect, "parameters": parameters_of(f, effect, value),
                           "as_built": as_built(f, built, effect, value), "value_SI": value,
                           "lambda": round(size, 2), "acceptable": equivalents}
            if effect.startswith("elsewhere"):
                truth[name]["mistake"] = "a load at another node"
        for of, kind, what in MISTAKES:
            if of != frame:
                continue
            name = f"{frame}_{kind}-{'-'.join(what).replace(' ', '-')}.csv"
            random = np.random.default_rng([SEED, zlib.crc32(name.encode())])
            wrong, words = make_mistake(folder / name, f, kind, what, random)
            truth[name] = {"frame": frame, "effect": f"recording@{'+'.join(wrong)}", "mistake": words, "parameters": {},
                           "acceptable": [f"zero@{what[0]}"] if kind == "zero" else []}
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n", encoding="utf-8")
    return truth


def nominal(path):
    f = read_frame(path)
    s = Solved(f)
    out = {}
    for c, case in enumerate(f["cases"]):
        out[case] = {
            "displacements": {n: [float(s.u[s.index[n, d], c]) for d in FREEDOMS] for n in f["nodes"]},
            "reactions": {n: [float(s.ground[s.index[n, d], c]) if d in held else 0.0 for d in FREEDOMS]
                          for n, held in f["supports"].items()},
            "members": {n: [[float(x) for x in s.section(n, share)[:, c]] for share in (0, 1)] for n in f["members"]},
            "sensors": {n: float(s.readings[c, k]) for k, n in enumerate(f["sensors"])}}
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("out", type=pathlib.Path, nargs="?")
    parser.add_argument("--frames", type=pathlib.Path,
                        default=pathlib.Path(__file__).resolve().parents[2] / "validation" / "frames")
    parser.add_argument("--only", nargs="+", choices=FRAMES)
    parser.add_argument("--nominal", type=pathlib.Path, metavar="FRAME.yaml")
    options = parser.parse_args()
    if options.nominal:
        json.dump(nominal(options.nominal), sys.stdout, indent=1)
    elif options.out:
        make_all(options.out, options.frames, options.only)
    else:
        parser.error("name the folder for the sets")


if __name__ == "__main__":
    main()
