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
the gains of its sensors; each reading has a true load a little off the recorded one, and noise. Sizes are chosen so that
the signature lambda of an effect lies between 9 and 19 where the effect has a free size: lambda^2 = d' S^-1 d, d the
change of all readings by the effect, S the covariance of noise, tolerances, gains and loads together.

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
import yaml

FRAMES = ("truss-45", "portal-semi-rigid", "lattice-girder", "beam-on-springs")
FREEDOMS = ("ux", "uy", "uz", "rx", "ry", "rz")
WRENCH = ("fx", "fy", "fz", "mx", "my", "mz")
UNITS = {"": 1, "m": 1, "mm": 1e-3, "um": 1e-6, "rad": 1, "mrad": 1e-3, "N": 1, "kN": 1e3, "Nm": 1, "kNm": 1e3,
         "GPa": 1e9, "%": 1e-2, "um/m": 1e-6, "N/um": 1e6, "N/mm": 1e3, "kN/mm": 1e6, "kNm/rad": 1e3, "Nm/rad": 1}
COLUMN = {"length": ("mm", 1e-3), "angle": ("rad", 1), "force": ("N", 1), "moment": ("Nmm", 1e-3),
          "strain": ("um_per_m", 1e-6)}
POUND_FORCE = 4.4482216152605
SEED = 20260


def quantity(text):
    """'20 N/um' in SI."""
    if isinstance(text, (int, float)):
        return float(text)
    number, unit = re.fullmatch(r"\s*([-+0-9.eE]+)\s*(.*?)\s*", text).groups()
    return float(number) * UNITS[unit]


def section_properties(s):
    """A, Iy, Iz, J of a section whose lengths are numbers in m."""
    if s["shape"] == "tube":
        outer, inner = s["outer_diameter"], s["inner_diameter"]
        second = math.pi * (outer ** 4 - inner ** 4) / 64
        return math.pi * (outer ** 2 - inner ** 2) / 4, second, second, 2 * second
    b, h = s["width_y"], s["height_z"]
    if s["shape"] == "box":
        t = s["wall"]
        inner_b, inner_h = b - 2 * t, h - 2 * t
        middle, around = (b - t) * (h - t), 2 * (b + h - 2 * t)
        return (b * h - inner_b * inner_h, (b * h ** 3 - inner_b * inner_h ** 3) / 12,
                (h * b ** 3 - inner_h * inner_b ** 3) / 12, 4 * middle ** 2 * t / around + around * t ** 3 / 3)
    if s["shape"] == "I":
        web, flange = s["web"], s["flange"]
        high = h - 2 * flange
        return (2 * b * flange + high * web, (b * h ** 3 - (b - web) * high ** 3) / 12,
                (2 * flange * b ** 3 + high * web ** 3) / 12, (2 * b * flange ** 3 + high * web ** 3) / 3)
    raise ValueError(s["shape"])


def local_stiffness(ea, eiy, eiz, gj, length):
    """12x12 of [u v w rx ry rz] at both ends, member axes."""
    k = np.zeros((12, 12))
    for stiffness, i, j in ((ea / length, 0, 6), (gj / length, 3, 9)):
        k[np.ix_([i, j], [i, j])] += stiffness * np.array([[1, -1], [-1, 1]])
    for ei, at, sign in ((eiz, [1, 5, 7, 11], 1), (eiy, [2, 4, 8, 10], -1)):
        a, b, c, d = 12 / length ** 3, sign * 6 / length ** 2, 4 / length, 2 / length
        k[np.ix_(at, at)] += ei * np.array([[a, b, -a, b], [b, c, -b, d], [-a, -b, a, -b], [b, d, -b, c]])
    return k


def with_end_springs(k, springs):
    """The member behind springs at some of its ends' freedoms; 0 is a release."""
    for at, stiffness in springs:
        column = k[:, at]
        k = k - np.outer(column, column) / (k[at, at] + stiffness)
    return k


def read_frame(path):
    """The file as plain data in SI units."""
    raw = yaml.safe_load(pathlib.Path(path).read_text(encoding="utf-8"))
    f = {"name": raw["name"], "plane": raw.get("plane", "none"), "materials": {}, "sections": {}, "members": {},
         "supports": {}, "springs": {}, "ends": {}, "gains": {}, "cases": {}, "sensors": {}, "loss": {}}
    for name, m in raw["materials"].items():
        f["materials"][name] = {"E": quantity(m["E"]), "nu": float(m["nu"])}
    for name, s in raw["sections"].items():
        f["sections"][name] = {k: v if k == "shape" else quantity(v) for k, v in s.items()}
    f["nodes"] = {name: np.array([quantity(x) for x in at]) for name, at in raw["nodes"].items()}
    for name, m in raw["members"].items():
        axis = f["nodes"][m["to"]] - f["nodes"][m["from"]]
        upright = np.linalg.norm(axis[:2]) < 1e-3 * np.linalg.norm(axis)
        towards = m.get("y_axis", [1, 0, 0] if upright else [0, 0, 1])
        f["members"][name] = {"from": m["from"], "to": m["to"], "section": m["section"], "material": m["material"],
                              "truss": m.get("truss", False), "factor": 1.0, "towards": np.array(towards, float)}
        for end in ("start", "end"):
            for freedom, law in m.get(end, {}).items():
                assert law["law"] == "linear"
                f["ends"][f"{name}.{end}.{freedom}"] = quantity(law["stiffness"])
    held = {"pinned": ["ux", "uy", "uz"], "clamped": list(FREEDOMS)}
    for node, s in raw["supports"].items():
        f["supports"][node] = list(held[s]) if isinstance(s, str) else list(s)
    for name, s in raw.get("springs", {}).items():
        (freedom, stiffness), = ((k, v) for k, v in s.items() if k != "node")
        f["springs"][name] = {"node": s["node"], "freedom": freedom, "stiffness": quantity(stiffness)}
    for name, case in raw["loads"].items():
        f["cases"][name] = {(node, key): quantity(v) for node, w in case["nodes"].items() for key, v in w.items()}
    for name, s in raw["sensors"].items():
        gain = re.fullmatch(r"1 ± ([0-9.]+) %", s.get("gain", "1 ± 0 %"))
        f["sensors"][name] = dict(s, sigma=quantity(s["sigma"]), gain_sigma=float(gain[1]) / 100)
        f["gains"][name] = 1.0
    f["tolerances"] = raw["tolerances"]
    return f


def member_axes(f, m):
    """Length, and rows x, y, z of the member's axes."""
    x = f["nodes"][m["to"]] - f["nodes"][m["from"]]
    length = np.linalg.norm(x)
    x = x / length
    y = m["towards"] - x * (m["towards"] @ x)
    y /= np.linalg.norm(y)
    return length, np.array([x, y, np.cross(x, y)])


def member_stiffness(f, name):
    """12x12 in member axes, the transformation, the length and the rigidities."""
    m = f["members"][name]
    material = f["materials"][m["material"]]
    modulus = material["E"] * m["factor"]
    area, iy, iz, j = section_properties(f["sections"][m["section"]])
    length, axes = member_axes(f, m)
    k = local_stiffness(modulus * area, modulus * iy, modulus * iz, modulus / (2 + 2 * material["nu"]) * j, length)
    if m["truss"]:
        bar = np.zeros((12, 12))
        bar[np.ix_([0, 6], [0, 6])] = k[np.ix_([0, 6], [0, 6])]
        k = bar
    names = ("tx", "ty", "tz", "rx", "ry", "rz")
    springs = [(names.index(freedom) + (6 if end == "end" else 0), stiffness)
               for (of, end, freedom), stiffness in ((key.split("."), v) for key, v in f["ends"].items()) if of == name]
    return with_end_springs(k, springs), np.kron(np.eye(4), axes), length, (modulus * area, modulus * iy, modulus * iz)


class Solved:
    """Responses of the linear frame, less the connection at `port` (node, freedom), to its load cases."""

    def __init__(self, f, port=None, spring=None):
        self.f = f
        nodes = {name: i for i, name in enumerate(f["nodes"])}
        self.index = {(n, d): 6 * i + k for n, i in nodes.items() for k, d in enumerate(FREEDOMS)}
        size = 6 * len(nodes)
        k = np.zeros((size, size))
        self.members = {}
        for name, m in f["members"].items():
            local, t, length, rigidity = member_stiffness(f, name)
            at = np.r_[6 * nodes[m["from"]]:6 * nodes[m["from"]] + 6, 6 * nodes[m["to"]]:6 * nodes[m["to"]] + 6]
            k[np.ix_(at, at)] += t.T @ local @ t
            self.members[name] = (local @ t, at, length, rigidity)
        self.unsupported = k.copy()
        for name, s in f["springs"].items():
            if name != spring:
                at = self.index[s["node"], s["freedom"]]
                k[at, at] += s["stiffness"]
        held = {self.index[n, d] for n, freedoms in f["supports"].items() for d in freedoms}
        self.unsupported[list(held)] = self.unsupported[list(held)]
        if f["plane"] != "none":
            normal = "xyz".index(({"x", "y", "z"} - set(f["plane"])).pop())
            out = [normal] + [3 + i for i in range(3) if i != normal]
            held |= {6 * i + d for i in nodes.values() for d in out}
        if port is not None:
            held.discard(self.index[port])
        for n, freedoms in f["loss"].items():  # linear springs in supports, or at free freedoms
            for d, stiffness in freedoms.items():
                at = self.index[n, d]
                held.discard(at)
                k[at, at] += stiffness
        scale = np.abs(k).max()
        free = [i for i in range(size) if i not in held and np.abs(k[i]).max() > 1e-14 * scale]
        loads = np.zeros((size, len(f["cases"]) + (port is not None)))
        for c, case in enumerate(f["cases"].values()):
            for (node, key), value in case.items():
                loads[self.index[node, FREEDOMS[WRENCH.index(key)]], c] = value
        if port is not None:
            loads[self.index[port], -1] = -1  # the force f in the connection acts on the node as -f
        self.u = np.zeros_like(loads)
        scaling = 1 / np.sqrt(np.diag(k)[free])
        matrix = k[np.ix_(free, free)] * np.outer(scaling, scaling)
        for _ in range(2):  # one step of refinement
            rest = loads - k @ self.u
            self.u[free] += scaling[:, None] * np.linalg.solve(matrix, scaling[:, None] * rest[free])
        self.loads = loads
        self.ground = k @ self.u - loads  # what rigid supports exert
        self.readings = np.array([self.read(s) for s in f["sensors"].values()]).T
        if port is not None:
            at = self.index[port]
            self.a, self.c = self.u[at, :-1], -self.u[at, -1]

    def section(self, name, share):
        """[N, Vy, Vz, T, My, Mz] on the face with the outward normal +x; a row for each, a column for each load."""
        kt, at, length, _ = self.members[name]
        end = (kt @ self.u[at])[6:]
        rest = (1 - share) * length
        return np.array([end[0], end[1], end[2], end[3], end[4] - rest * end[2], end[5] + rest * end[1]])

    def read(self, s):
        if "node" in s:
            return self.u[self.index[s["node"], s["direction"]]]
        if "support" in s:
            freedom = FREEDOMS[WRENCH.index(s["reaction"])]
            at = self.index[s["support"], freedom]
            out = self.ground[at].copy()
            loss = self.f["loss"].get(s["support"], {}).get(freedom)
            if loss is not None:
                out -= loss * self.u[at]
            return out
        forces = self.section(s["member"], s.get("strain", {}).get("at", s.get("at", 0.5)))
        if "force" in s:
            return forces[("axial", "Vy", "Vz", "T", "My", "Mz").index(s["force"])]
        ea, eiy, eiz = self.members[s["member"]][3]
        y, z = (quantity(s["strain"].get(k, 0)) for k in "yz")
        return forces[0] / ea - y * forces[5] / eiz + z * forces[4] / eiy


def kind_of(sensor):
    """Of which quantity its readings are."""
    if "node" in sensor:
        return "angle" if sensor["direction"].startswith("r") else "length"
    if "strain" in sensor:
        return "strain"
    what = sensor.get("reaction", sensor.get("force"))
    return "moment" if what[0] == "m" or what in ("T", "My", "Mz") else "force"


def port_forces(law, value, a, c, beside):
    """Force in a connection for the sequence a of displacements without it; `beside` is its compliance in series."""
    out, slip = [], 0.0
    for each in a:
        if law == "clearance":
            force = 0.0 if abs(each) <= value else (each - math.copysign(value, each)) / (c + beside)
        elif law in ("pull", "push"):
            yields = (each > 0) == (law == "pull")
            force = each / (c + beside + (value if yields else 0))
        elif law == "friction":
            limit, stiffness = value
            force = stiffness * (each - slip) / (1 + stiffness * c)
            if abs(force) > limit:
                force = math.copysign(limit, force)
                slip = each - c * force - force / stiffness
        else:
            raise ValueError(law)
        out.append(force)
    return np.array(out)


def place_of(f, place):
    """The port of a place 'support.A.ux' or 'spring.pad1.uz', the spring that is left out, its compliance."""
    kind, name, freedom = place.split(".")
    if kind == "support":
        return (name, freedom), None, 0.0
    spring = f["springs"][name]
    return (spring["node"], freedom), name, 1 / spring["stiffness"]


def readings_of(f, factors, effect=None, value=None):
    """True readings, a row for each row of factors on the load cases; gains and lagging sensors included."""
    f = copy.deepcopy(f)
    law, _, place = (effect or "").partition("@")
    stick = None
    port = None
    if law == "modulus":
        for m in f["materials"].values():
            m["E"] *= value
    elif law == "factor" and place in f["members"]:
        f["members"][place]["factor"] *= value
    elif law == "factor" and place in f["ends"]:
        f["ends"][place] *= value
    elif law == "factor" and place.startswith("spring."):
        f["springs"][place.split(".")[1]]["stiffness"] *= value
    elif law == "factor" and place in f["cases"]:
        f["cases"][place] = {k: v * value for k, v in f["cases"][place].items()}
    elif law == "elsewhere":  # a load of a case stands at another node
        case, node, other = place.split("/")
        f["cases"][case] = {(other if n == node else n, key): v for (n, key), v in f["cases"][case].items()}
    elif law == "gain":
        f["gains"][place] *= value
    elif law == "stiction":
        stick = (place, value)
    elif law in ("linear", "restraint") and place.startswith("support."):
        _, node, freedom = place.split(".")
        f["loss"].setdefault(node, {})[freedom] = value
    elif law == "linear":
        f["ends"][place] = 1 / (1 / value + (1 / f["ends"][place] if place in f["ends"] else 0))
    elif law in ("clearance", "pull", "push", "friction"):
        port, spring, beside = place_of(f, place)
    elif law:
        raise ValueError(effect)
    if port:
        solved = Solved(f, port, spring)
        forces = port_forces(law, value, factors @ solved.a, solved.c, beside)
        out = factors @ solved.readings[:-1] + np.outer(forces, solved.readings[-1])
        for k, s in enumerate(f["sensors"].values()):  # the reaction of the connection itself
            if "support" in s and port == (s["support"], FREEDOMS[WRENCH.index(s["reaction"])]):
                out[:, k] = -forces
    else:
        out = factors @ Solved(f).readings
    out = out * np.array([f["gains"][name] for name in f["sensors"]])
    if stick:
        column, held = list(f["sensors"]).index(stick[0]), 0.0
        for i, true in enumerate(out[:, column].copy()):
            held = min(max(held, true - stick[1]), true + stick[1])
            out[i, column] = held
    return out


def tolerance_moves(f):
    """One function for each number that is off on its own: it moves it in a frame by so many standard deviations."""
    moves = []

    def add(table, key, field, size, relative):
        def move(g, times):
            entry = g[table]
            if field is not None:
                entry, at = entry[key], field
            else:
                at = key
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


def steps(cases, loops):
    """Rows of factors on the load cases."""
    rows = []
    for _ in range(2):
        for k in range(cases):
            for factor in ((0, .25, .5, 1, .5, .25, 0, -.25, -.5, -1, -.5, -.25, 0) if loops else (1, -1, .5, -.5, .25)):
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
        ("factor@beam_1.start.ry", None, (0.999, 0.05), ["linear@left.end.rz"]),
        ("linear@beam_1.end.ry", None, (1e9, 1e3), ["linear@beam_2.start.ry"]),
        ("pull@support.D.ry", None, (1e-11, 1e-3), []),
        ("factor@right", None, (0.999, 0.1), []),
        ("modulus", 1.04, None, []),
        ("factor@twist", 1.06, None, []),
        ("gain@turn_C", 1.05, None, []),
    ],
    "lattice-girder": [
        ("restraint@support.r4.ux", None, (1e2, 1e9), []),
        ("friction@support.r4.ux", None, (1, 1e5), []),
        ("pull@support.r4.uz", None, (1e-11, 1e-4), []),
        ("linear@support.l4.uz", None, (1e11, 1e5), []),
        ("clearance@support.r0.uz", None, (1e-7, 5e-3), []),
        ("factor@lfall1", None, (0.999, 0.02), []),
        ("factor@rrise0", 0.02, None, []),
        ("stiction@slide_x", None, (1e-7, 1e-3), []),
        ("elsewhere@right lane/r2/r1", 1, None, []),
    ],
    "beam-on-springs": [
        ("factor@spring.pad2.uz", None, (0.999, 0.1), []),
        ("factor@spring.pad4.uz", 0.02, None, []),
        ("clearance@spring.pad3.uz", None, (1e-7, 5e-3), []),
        ("pull@spring.pad5.uz", None, (1e-11, 1e-5), []),
        ("linear@rail3.end.ry", None, (1e10, 1e4), ["linear@rail4.start.ry"]),
        ("friction@support.N0.uz", None, (1, 1e6), []),
        ("modulus", 1.04, None, ["factor@sections.rail.height_z"]),
        ("factor@at 3", 1.06, None, []),
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
    port, spring, _ = place_of(f, place)
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
    rotation = place.split(".")[-1].startswith("r") and law in ("linear", "restraint", "clearance", "pull", "push")
    if law == "elsewhere":
        return {}
    if law == "friction":
        return {"force_N": value[0], "stiffness_N_per_mm": value[1] / 1e3}
    if law == "stiction":
        unit, size = COLUMN[kind_of(f["sensors"][place])]
        return {f"stick_{unit}": float(f"{value / size:.9g}")}
    if NAMES[law] == "stiffness":
        return {"stiffness_Nmm_per_rad": value * 1e3} if rotation else {"stiffness_N_per_mm": value / 1e3}
    if NAMES[law] == "gap":
        return {"gap_rad": value} if rotation else {"gap_mm": float(f"{value * 1e3:.9g}")}
    if NAMES[law] == "yields":
        return {"yields_rad_per_Nmm": float(f"{value / 1e3:.9g}")} if rotation else {"yields_mm_per_N": float(f"{value * 1e3:.9g}")}
    return {NAMES[law]: value}


def laboratory(f, factors, random, effect=None, value=None):
    """Readings as recorded."""
    built = copy.deepcopy(f)
    for move in tolerance_moves(f):
        move(built, random.standard_normal())
    load = quantity(f["tolerances"].get("load", 0))
    true = factors * (1 + load * random.standard_normal((len(factors), 1)))
    sigma = np.array([s["sigma"] for s in f["sensors"].values()])
    exact = readings_of(built, true, effect, value)
    return exact + sigma * random.standard_normal(exact.shape)


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
    readings = laboratory(f, factors, random)
    at = [list(f["sensors"]).index(name) for name in what if name in f["sensors"]]
    units, columns = {}, None
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
            else:
                columns.append((f"load.{name}", factors[:, k]))
    write_set(path, f, factors, readings, False, units, columns)
    return {"swapped": "two channels swapped", "sign": "a channel with the wrong sign",
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
            write_set(folder / name, f, factors, laboratory(f, factors, random), k == 1)
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
            write_set(folder / name, f, factors, laboratory(f, factors, random, effect, value), loops)
            truth[name] = {"frame": frame, "effect": effect, "parameters": parameters_of(f, effect, value),
                           "value_SI": value, "lambda": round(size, 2), "acceptable": equivalents}
            if effect.startswith("elsewhere"):
                truth[name]["mistake"] = "a load at another node"
        for of, kind, what in MISTAKES:
            if of != frame:
                continue
            name = f"{frame}_{kind}-{'-'.join(what).replace(' ', '-')}.csv"
            random = np.random.default_rng([SEED, zlib.crc32(name.encode())])
            words = make_mistake(folder / name, f, kind, what, random)
            truth[name] = {"frame": frame, "effect": f"recording@{'+'.join(what)}", "mistake": words, "parameters": {},
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
