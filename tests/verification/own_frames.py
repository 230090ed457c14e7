#!/usr/bin/env python3
"""Frames by a direct stiffness method of their own, for foreign_laboratory.py.

Reads a frame file and solves it under factors on its load cases: Euler-Bernoulli members, trusses, releases and
semi-rigid ends by static condensation, supports, springs, plane frames. What sensors read follows, with an effect at
one place whose law is solved in the order of the readings. Nothing of deflect is used; SI throughout.
"""
import copy
import math
import pathlib
import re

import numpy as np
import yaml

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


END_FREEDOMS = ("tx", "ty", "tz", "rx", "ry", "rz")


def row_of_end(end, freedom):
    """Of the 12 in member axes."""
    return END_FREEDOMS.index(freedom) + (6 if end == "end" else 0)


def member_stiffness(f, name, apart=None):
    """12x12 in member axes, the transformation, the length and the rigidities; `apart`: (end, freedom) whose spring is
    left out, so that this freedom is the member's own."""
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
    springs = [(row_of_end(end, freedom), stiffness)
               for (of, end, freedom), stiffness in ((key.split("."), v) for key, v in f["ends"].items())
               if of == name and (end, freedom) != apart]
    return with_end_springs(k, springs), np.kron(np.eye(4), axes), length, (modulus * area, modulus * iy, modulus * iz)


class Solved:
    """Responses of the linear frame, less the connection at `port`, to its load cases. A port is (node, freedom), or
    (member, end, freedom): there the member's own rotation is one unknown more, and its spring stays."""

    def __init__(self, f, port=None, spring=None):
        self.f = f
        nodes = {name: i for i, name in enumerate(f["nodes"])}
        self.index = {(n, d): 6 * i + k for n, i in nodes.items() for k, d in enumerate(FREEDOMS)}
        at_end = port is not None and len(port) == 3
        size = 6 * len(nodes) + at_end
        k = np.zeros((size, size))
        gap = np.zeros(size)  # what the port's opening is of the unknowns
        if port is not None and not at_end:
            gap[self.index[port]] = 1
        self.members = {}
        for name, m in f["members"].items():
            own = port[1:] if at_end and port[0] == name else None
            local, t, length, rigidity = member_stiffness(f, name, own)
            at = np.r_[6 * nodes[m["from"]]:6 * nodes[m["from"]] + 6, 6 * nodes[m["to"]]:6 * nodes[m["to"]] + 6]
            if own:
                row = row_of_end(*own)
                gap[at], gap[-1] = t[row], -1
                t = np.c_[t, np.zeros(12)]
                t[row] = 0
                t[row, -1] = 1
                at = np.r_[at, size - 1]
                k += np.outer(gap, gap) * f["ends"][".".join(port)]
            k[np.ix_(at, at)] += t.T @ local @ t
            self.members[name] = (local @ t, at, length, rigidity)
        for name, s in f["springs"].items():
            if name != spring:
                at = self.index[s["node"], s["freedom"]]
                k[at, at] += s["stiffness"]
        held = {self.index[n, d] for n, freedoms in f["supports"].items() for d in freedoms}
        if f["plane"] != "none":
            normal = "xyz".index(({"x", "y", "z"} - set(f["plane"])).pop())
            out = [normal] + [3 + i for i in range(3) if i != normal]
            held |= {6 * i + d for i in nodes.values() for d in out}
        if port is not None and not at_end:
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
            loads[:, -1] = -gap  # the force f in the connection acts against its opening
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
            self.a, self.c = gap @ self.u[:, :-1], -(gap @ self.u[:, -1])

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


def place_of(f, place, beside=False):
    """The port of a place 'support.A.ux', 'node.A.ux', 'spring.pad1.uz' or 'beam.start.ry', the spring that is left
    out, its compliance. A law beside a spring leaves it where it is."""
    kind, name, freedom = place.split(".")
    if kind in ("support", "node"):
        return (name, freedom), None, 0.0
    if kind in f["members"]:
        return (kind, name, freedom), None, 0.0
    spring = f["springs"][name]
    return (spring["node"], freedom), None if beside else name, 0.0 if beside else 1 / spring["stiffness"]


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
        port, spring, beside = place_of(f, place, law == "friction")
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
