#!/usr/bin/env python3
"""Measurements of the built-in stewart-6ups with one leg, or all of them, worn, by a program that shares nothing with
deflect.

  foreign_legs.py OUT_DIR --seeds 1 2 3       writes EFFECT_SEED.csv and truth.json
  foreign_legs.py --judge OUT_DIR DEFLECT     diagnoses them with the program DEFLECT and counts

A leg is a line from a universal joint on the base to a ball joint on the platform. It carries a force f along itself
and becomes longer by e(f): cylinder, rod and slide as drawn, and what is hidden in it. The forces balance the load at
the tool point where the platform stands under it, and the platform stands where the legs are as long as they have
become: solved by iteration to 1e-15 m. Friction stands beside the spring of the slide and begins relaxed at each pose.
Loads go up, down and to the other side in steps along x, y and z. Which leg, and its size, are drawn by lot. Needs
numpy. The same seed gives the same files.
"""
import argparse
import json
import math
import pathlib
import subprocess

import numpy as np

SIGMA = 2e-3  # mm
BASE = [(2997.144665, -130.858162), (2997.144665, 130.858162), (-1385.245840, 2661.032500),
        (-1611.898825, 2530.174337), (-1611.898825, -2530.174337), (-1385.245840, -2661.032500)]
PLATFORM = [(642.787610, -766.044443), (642.787610, 766.044443), (342.020143, 939.692621),
            (-984.807753, 173.648178), (-984.807753, -173.648178), (342.020143, -939.692621)]
B, C = (np.array([(x, y, 0.0) for x, y in points]) for points in (BASE, PLATFORM))
CYLINDER, E, SLIDE = 2365.35, 210e3, 1e5  # mm, N/mm^2, N/mm
POSES = [(0, 0, 2000), (250, 200, 2200), (-250, 150, 1850), (150, -250, 1900), (-200, -200, 2150)]
LOADS = [force * step / 4 * np.eye(3)[axis] for axis in range(3) for force in (4000, -4000)
         for step in (1, 2, 3, 4, 3, 2, 1, 0)]


def rotation(v):
    """exp of a small rotation vector, to the fourth order."""
    K = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + K + K @ K / 2 + K @ K @ K / 6 + K @ K @ K @ K / 24


def lines(p, turned):
    """Lengths, and the wrench at the tool point of a unit force in each leg that pulls its ends together."""
    arms = C @ rotation(turned).T
    along = p + arms - B
    lengths = np.linalg.norm(along, axis=1)
    n = along / lengths[:, None]
    return lengths, -np.hstack([n, np.cross(arms, n)])


class Leg:
    """e(f), mm, of one leg at one pose; hidden: law and values, or none."""

    def __init__(self, length, hidden):
        area = math.pi / 4 * (100**2 - 60**2)
        self.members = CYLINDER / (E * area) + (length - CYLINDER) / (E * math.pi / 4 * 60**2)
        self.law, self.values = hidden or ("", ())
        self.slip = 0

    def slide(self, f):
        if self.law != "friction":
            return f / SLIDE, self.slip
        most, k = self.values
        e = (f + k * self.slip) / (SLIDE + k)  # it sticks
        if abs(k * (e - self.slip)) > most:
            e = (f - math.copysign(most, k * (e - self.slip))) / SLIDE
        return e, e - float(np.clip(k * (e - self.slip), -most, most)) / k

    def worn(self, f):
        if self.law == "clearance":
            return math.copysign(self.values[0], f) if f else 0
        if self.law == "hardening":
            stiffness, reference = self.values
            e = f / stiffness
            for _ in range(60):
                e -= (stiffness * e * (1 + (e / reference)**2) - f) / (stiffness * (1 + 3 * (e / reference)**2))
            return e
        return 0

    def longer(self, f):
        return self.members * f + self.slide(f)[0] + self.worn(f)

    def loaded(self, f):
        self.slip = self.slide(f)[1]


def displacement(p, legs, drawn, load):
    """Of the tool point, mm; the legs keep where their frictions have slipped to."""
    at, turned = np.array(p, float), np.zeros(3)
    for _ in range(100):
        lengths, W = lines(at, turned)
        forces = np.linalg.solve(W.T, -np.concatenate([load, np.zeros(3)]))
        off = drawn + [leg.longer(f) for leg, f in zip(legs, forces)] - lengths
        # Where the platform moves by d, a leg becomes longer by -W d.
        step = np.linalg.solve(-W, off)
        at, turned = at + step[:3], turned + step[3:]
        if np.abs(step).max() < 1e-12:
            break
    for leg, f in zip(legs, forces):
        leg.loaded(f)
    return at - p


def hidden_in(law, random):
    """By law its values and the parameters' names."""
    if law == "clearance":
        values = [random.uniform(0.008, 0.03)]
        return values, {"gap_mm": values[0]}
    if law == "hardening":
        values = [random.uniform(3e4, 8e4), random.uniform(0.01, 0.02)]
        return values, {"stiffness_N_per_mm": values[0], "reference_mm": values[1]}
    values = [random.uniform(500, 1000), random.uniform(1e5, 3e5)]
    return values, {"force_N": values[0], "stiffness_N_per_mm": values[1]}


def write(path, legs_of, random):
    rows = ["pose,sequence,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,fx_N,fy_N,fz_N,ux_mm,uy_mm,uz_mm,sigma_u_mm"]
    for k, pose in enumerate(POSES):
        drawn = lines(np.array(pose, float), np.zeros(3))[0]
        legs = [Leg(length, hidden) for length, hidden in zip(drawn, legs_of)]
        for load in LOADS:
            u = displacement(np.array(pose, float), legs, drawn, load) + SIGMA * random.normal(size=3)
            rows.append(",".join([str(k), str(len(rows) - 1), *map(str, pose), "0,0,0", *(f"{f:g}" for f in load),
                                  *(f"{x:.6f}" for x in u), f"{SIGMA:g}"]))
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")


def make(folder, seeds):
    folder.mkdir(parents=True, exist_ok=True)
    truth = {}
    for seed in seeds:
        for number, law, one in [(0, "clearance", True), (1, "friction", True), (2, "hardening", True),
                                 (4, "clearance", False), (5, "friction", False), (6, "", False)]:
            random = np.random.default_rng([2026, seed, number])
            leg = int(random.integers(6)) if one else None
            name = f"{law or 'healthy'}{'-in-one-leg' if one else ''}_{seed}.csv"
            truth[name] = {"effect": None}
            hidden = None
            if law:
                values, parameters = hidden_in(law, random)
                hidden = (law, values)
                truth[name] = {"effect": f"{law}@{'leg.' if one else ''}slide.tz", "leg": leg + 1 if one else None,
                               "parameters": parameters}
                if not one and law == "clearance":
                    truth[name]["effect"] = "actuator_backlash"
            write(folder / name, [hidden if not one or i == leg else None for i in range(6)], random)
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n", encoding="utf-8")


def judge(folder, program):
    count = {}
    for name, truth in json.loads((folder / "truth.json").read_text(encoding="utf-8")).items():
        told = folder / "told.json"
        subprocess.run([program, "diagnose", "stewart-6ups", folder / name, "--json", told, "--quiet"], check=True)
        d = json.loads(told.read_text(encoding="utf-8"))
        found = {(e["effect"], e["site"]) for e in d["found"]}
        found |= {(e["effect"], e["site"]) for tie in d["ties"] for rival in tie["rivals"] for e in rival["effects"]}
        names = set(d["missing"]).union(*d["indistinguishable"])
        site = f"leg {truth['leg']}" if truth.get("leg") else None
        if truth["effect"] is None:
            right = d["verdict"] == "nothing_missing"
        else:
            right = truth["effect"] in names and len(d["missing"]) == 1 and (
                site is None or any(s == site and e == truth["effect"] for e, s in found)
                or all(s == site for _, s in found))
        word = "right" if right else "unknown" if d["verdict"] == "unknown_effect" else "wrong"
        count[word] = count.get(word, 0) + 1
        print(f"{word:8} {name:32} {truth['effect']} {site or ''}: {d['verdict']}, {sorted(found)} of {sorted(names)}")
    print(count)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", nargs="+", type=int, default=[1])
    parser.add_argument("--judge", action="store_true")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("program", nargs="?", default="deflect")
    a = parser.parse_args()
    if a.judge:
        judge(a.folder, a.program)
    else:
        make(a.folder, a.seeds)


if __name__ == "__main__":
    main()
