"""How a laboratory measures a frame of own_frames.py that has an effect, for the scripts that make sets of them.

A frame is off the drawing within the tolerances that its file declares, and so are the gains of its sensors; each
reading has a true load a little off the recorded one, and noise. The signature of an effect is lambda: lambda^2 =
d' S^-1 d, d the change of all readings by the effect, S the covariance of noise, tolerances, gains and loads together.
"""
import argparse
import copy
import itertools
import json
import math
import pathlib
import subprocess

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


FRICTION = 3  # the search is for the limit; the stiffness is this times the one that the frame has there
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


def diagnosed(folder, name, frame, program):
    """What the program says of a set, as it was written before or now."""
    out = folder / (name[:-4] + ".json")
    if not out.exists():
        subprocess.run([program, "diagnose", frame, str(folder / name), "--json", str(out), "--quiet", "--bootstrap",
                        "199"], check=True)
    return json.loads(out.read_text(encoding="utf-8"))


def print_table(table, kinds):
    """Counts by frame, kind and verdict."""
    for kind in kinds:
        for frame in FRAMES:
            counts = [f"{n} {what}" for (of, k, what), n in sorted(table.items()) if (of, k) == (frame, kind)]
            print(f"| {kind} | {frame} | {', '.join(counts)} |")


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
