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

What a laboratory would deliver: the frame is off the drawing within the tolerances that its file declares, and so are
the gains of its sensors; each reading has a true load a little off the recorded one, and noise. Sizes are chosen so
that the signature lambda of an effect lies between 9 and 19 where the effect has a free size: lambda^2 = d' S^-1 d, d
the change of all readings by the effect, S the covariance of noise, tolerances, gains and loads together.

Needs numpy and PyYAML. The same seed gives the same files.
"""
import argparse
import copy
import itertools
import json
import math
import pathlib
import re
import sys
import zlib

import numpy as np

from own_frames import *  # noqa: F403

FRAMES = ("truss-45", "portal-semi-rigid", "lattice-girder", "beam-on-springs")


def tolerance_moves(f):
    """One function for each number that is off on its own: it moves it in a frame by so many standard deviations."""
    moves = []

    def add(table, key, field, size, relative):
        def move(g, times):
            entry, at = (g[table], key) if field is None else (g[table][key], field)
            entry[at] = entry[at] + times * size * (entry[at] if relative else 1)
        moves.append(move)

    axes = [i for i in range(3) if f["plane"] == "none" or "xyz"[i] in f["plane"]]
    for key, text in f["tolerances"].items():
        size, relative = quantity(text), text.endswith("%")
        if key == "modulus":
            for name in f["materials"]:
                add("materials", name, "E", size, relative)
        elif key == "node.position":
            for name in f["nodes"]:
                for i in axes:
                    add("nodes", name, i, size, relative)
        elif key == "member.factor":
            for name in f["members"]:
                add("members", name, "factor", size, relative)
        elif key == "section.wall":
            for name in f["sections"]:
                add("sections", name, "wall", size, relative)
        elif key == "spring.uz.stiffness":
            for name in f["springs"]:
                add("springs", name, "stiffness", size, relative)
        elif key.startswith("member."):
            for name in f["ends"]:
                if name.split(".", 1)[1] == key[len("member."):-len(".stiffness")]:
                    add("ends", name, None, size, relative)
        elif key != "load":
            raise ValueError(key)
    for name, s in f["sensors"].items():
        if s["gain_sigma"] > 0:
            add("gains", name, None, s["gain_sigma"], False)
    return moves


class Weight:
    """Noise, tolerances, gains and loads as one covariance of all readings of a campaign."""

    def __init__(self, f, factors):
        sigma = np.array([s["sigma"] for s in f["sensors"].values()])
        nominal = readings_of(f, factors)
        load = quantity(f["tolerances"].get("load", 0))
        s = np.diag(np.tile(sigma ** 2, len(factors)))
        width = len(sigma)
        for i, row in enumerate(nominal):
            s[i * width:(i + 1) * width, i * width:(i + 1) * width] += np.outer(row, row) * load ** 2
        columns = []
        for move in tolerance_moves(f):
            two = []
            for times in (0.1, -0.1):
                g = copy.deepcopy(f)
                move(g, times)
                two.append(readings_of(g, factors))
            columns.append(((two[0] - two[1]) / 0.2).ravel())
        j = np.array(columns).T
        self.factor = np.linalg.cholesky(s + j @ j.T)
        self.nominal = nominal

    def whitened(self, change):
        return np.linalg.solve(self.factor, change.ravel())

    def size(self, change):
        return float(np.linalg.norm(self.whitened(change)))


LOOP = (0, .25, .5, 1, .5, .25, 0, -.25, -.5, -1, -.5, -.25, 0)


def steps(cases, loops):
    """Rows of factors on the load cases."""
    rows = []
    for _ in range(2):
        for k in range(cases):
            for factor in LOOP if loops else (1, -1, .5, -.5, .25):
                row = [0.0] * cases
                row[k] = factor
                rows.append(row)
        if not loops:
            for n, (i, j) in enumerate(itertools.combinations(range(cases), 2)):
                row = [0.0] * cases
                row[i], row[j] = 1.0, -1.0 if n % 2 else 1.0
                rows.append(row)
    return np.array(rows)


# Effects by frame: id, value in SI (None: its size is searched), range of the search, equivalents by construction.
# Of equivalents: two ends of members that meet alone at a node, where nothing reads the node's rotation.
FRICTION = 3  # the search is for the limit; the stiffness is this times the one that the frame has there
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
LOOPS = ("clearance", "pull", "push", "friction", "stiction")
NAMES = {"linear": "stiffness", "restraint": "stiffness", "clearance": "gap", "pull": "yields", "push": "yields",
         "factor": "factor", "gain": "gain", "stiction": "stick", "modulus": "factor"}


def friction_value(f, place, limit):
    """With its stiffness, chosen by the stiffness of the frame there."""
    port, spring, _ = place_of(f, place, True)
    return limit, float(f"{FRICTION / Solved(f, port, spring).c:.3g}")


def effect_value(f, effect, x):
    law, _, place = effect.partition("@")
    return friction_value(f, place, x) if law == "friction" else x


def searched(f, effect, limits, factors, weight, target):
    """The value with the wanted lambda, to three digits; the end of the range if it is never reached."""
    def size(x):
        return weight.size(readings_of(f, factors, effect, effect_value(f, effect, x)) - weight.nominal)

    small, large = (math.log(x) for x in limits)
    grid = [small + (large - small) * i / 24 for i in range(25)]
    for low, high in zip(grid, grid[1:]):
        if size(math.exp(high)) >= target:
            for _ in range(14):
                middle = (low + high) / 2
                low, high = (low, middle) if size(math.exp(middle)) >= target else (middle, high)
            return float(f"{math.exp(high):.3g}")
    return float(f"{max((math.exp(x) for x in grid), key=size):.3g}")


def parameters_of(f, effect, value):
    """In the units of deflect's ids."""
    law, _, place = effect.partition("@")
    rotation = place.split(".")[-1].startswith("r") and (law in NAMES or law == "friction")
    if law == "elsewhere":
        return {}
    if law == "friction":
        return ({"moment_Nmm": float(f"{value[0] * 1e3:.9g}"), "stiffness_Nmm_per_rad": value[1] * 1e3} if rotation else
                {"force_N": value[0], "stiffness_N_per_mm": value[1] / 1e3})
    if law == "stiction":
        unit, size = COLUMN[kind_of(f["sensors"][place])]
        return {f"stick_{unit}": float(f"{value / size:.9g}")}
    if NAMES[law] == "stiffness":
        return {"stiffness_Nmm_per_rad": value * 1e3} if rotation else {"stiffness_N_per_mm": value / 1e3}
    if NAMES[law] == "gap":
        return {"gap_rad": value} if rotation else {"gap_mm": float(f"{value * 1e3:.9g}")}
    if NAMES[law] == "yields":
        if rotation:
            return {"yields_rad_per_Nmm": float(f"{value / 1e3:.9g}")}
        return {"yields_mm_per_N": float(f"{value * 1e3:.9g}")}
    return {NAMES[law]: value}


def as_built(f, built, effect, value):
    """Of a factor or gain: with what the tolerance drew for the same number; deflect cannot tell the two apart."""
    law, _, place = effect.partition("@")
    drawn = None
    if law == "gain":
        drawn = built["gains"][place]
    elif law == "modulus":
        drawn = next(built["materials"][m]["E"] / f["materials"][m]["E"] for m in f["materials"])
    elif law == "factor" and place in f["members"]:
        drawn = built["members"][place]["factor"]
    elif law == "factor" and place in f["ends"]:
        drawn = built["ends"][place] / f["ends"][place]
    elif law == "factor" and place.startswith("spring."):
        name = place.split(".")[1]
        drawn = built["springs"][name]["stiffness"] / f["springs"][name]["stiffness"]
    return {} if drawn is None else {NAMES[law]: round(value * drawn, 6)}


def laboratory(f, factors, random, effect=None, value=None):
    """Readings as recorded."""
    built = copy.deepcopy(f)
    for move in tolerance_moves(f):
        move(built, random.standard_normal())
    load = quantity(f["tolerances"].get("load", 0))
    true = factors * (1 + load * random.standard_normal((len(factors), 1)))
    sigma = np.array([s["sigma"] for s in f["sensors"].values()])
    exact = readings_of(built, true, effect, value)
    return exact + sigma * random.standard_normal(exact.shape), built


def write_set(path, f, factors, readings, ordered, units=None, columns=None):
    """columns: load columns by name in place of factors on a case."""
    columns = columns or [(f"load.{name}", factors[:, k]) for k, name in enumerate(f["cases"])]
    head = [name for name, _ in columns] + (["sequence"] if ordered else [])
    rows = [[f"{float(f'{c[i]:.6g}'):g}" if abs(c[i]) < 100 else repr(float(f"{c[i]:.9g}")) for _, c in columns] +
            ([str(i + 1)] if ordered else []) for i in range(len(factors))]
    for k, (name, s) in enumerate(f["sensors"].items()):
        unit, size = COLUMN[kind_of(s)]
        digits = max(0, math.ceil(-math.log10(s["sigma"] / size / 1e3)))
        head.append(f"{name}_{unit}")
        for row, value in zip(rows, readings[:, k] * (units or {}).get(name, 1) / size):
            row.append(f"{value:.{digits + (3 if name in (units or {}) else 0)}f}")
    path.write_text("\n".join(",".join(row) for row in [head] + rows) + "\n", encoding="utf-8")


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


def run(about, make, judge):
    """The command line of a script that makes its own sets and judges what a program says of them."""
    parser = argparse.ArgumentParser(description=about.split("\n", maxsplit=1)[0])
    parser.add_argument("out", type=pathlib.Path, nargs="?")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1])
    parser.add_argument("--only", nargs="+", choices=FRAMES)
    parser.add_argument("--judge", nargs=2, metavar=("OUT_DIR", "DEFLECT"))
    options = parser.parse_args()
    if options.judge:
        judge(pathlib.Path(options.judge[0]), options.judge[1])
    elif options.out:
        make(options.out, pathlib.Path(__file__).resolve().parents[2] / "validation" / "frames", options.seeds,
             options.only)
    else:
        parser.error("name the folder for the sets")


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
