#!/usr/bin/env python3
"""Measurements of the arm in foreign_arms/arm.yaml with a hidden effect, by a program that shares nothing with deflect.

  foreign_arms.py OUT_DIR     writes EFFECT.csv and truth.json

The arm is a product of exponentials. With phi the elastic rotations of all joints, p and R place every joint and the
tool, and a load (F, M) at the tool turns joint i about its axis a_i by the moment

  m_i = a_i . (M + (p_T - p_i) x F),     phi_i = law_i(m_i),

with places, axes and arms of the deformed arm: solved by iteration to 1e-13. A drive with friction beside its spring k
shares the moment: friction carries f = clamp(k_f (phi - slip), -f_max, f_max), found in closed form, and begins relaxed
at each pose. What a laboratory would deliver: drives and lengths off the drawing within the tolerances of the file, a
true load a little off the recorded one at each reading, noise. Needs numpy. The same seed gives the same files.
"""
import argparse
import json
import math
import pathlib
import zlib

import numpy as np

X, Y, Z = np.eye(3)
# Name, offset before it (m), axis, home (deg), stiffness of the drive (Nm/rad), of its bearing or none.
JOINTS = [("turret", (0, 0, 0), Z, 0, 4e5, None), ("shoulder", (0.080, 0, 0.420), Y, 20, 3e5, 2e6),
          ("elbow", (0, 0, 0.650), Y, 75, 2e5, None), ("roll", (0, 0.030, 0.560), Z, 0, 6e4, None),
          ("pitch", (0, 0, 0), Y, 60, 5e4, None), ("wrist", (0, 0, 0.090), Z, 0, 3e4, None)]
FLANGE = (0.040, 0, 0.110)
SIGMA = 3e-6  # m
NAMES = [j[0] for j in JOINTS]


def rotation(v):
    """exp of the rotation vector v."""
    angle = np.linalg.norm(v)
    K = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    if angle < 1e-8:
        return np.eye(3) + K + K @ K / 2
    return np.eye(3) + math.sin(angle) / angle * K + (1 - math.cos(angle)) / angle**2 * (K @ K)


class Arm:
    """One arm as built; `hidden`: name -> values of what acts on it."""

    def __init__(self, random, scale, hidden):
        self.stiffness = [k * (1 + 0.02 * scale * random.normal()) for *_, k, _ in JOINTS]
        self.bearing = [k for *_, k in JOINTS]
        self.offsets = [np.array(o, float) for _, o, *_ in JOINTS] + [np.array(FLANGE, float)]
        for o in self.offsets:
            moved = o != 0  # lengths that the drawing has
            o += moved * 1e-4 * scale * random.normal(size=3)
        self.hidden = hidden
        self.slips = {}

    def value(self, name):
        return self.hidden.get(name)

    def point(self, name):
        return np.array(self.hidden.get(name, (0, 0, 0)))

    def turn(self, i, m, slips):
        """Elastic rotation vector of joint i, axes of the joint with z its own, under the moment m there."""
        name, k = NAMES[i], self.stiffness[i]
        own = m[2]
        if (factor := self.value("factor@%s.rz" % name)) is not None:
            k *= factor
        extra = 0.0
        if (gap := self.value("clearance@%s.rz" % name)) is not None:
            extra += gap * np.sign(own)
        for sense, law in ((1, "pull"), (-1, "push")):
            if (c := self.value("%s@%s.rz" % (law, name))) is not None and own * sense > 0:
                extra += c * own
        if (c := self.value("motor_compliance")) is not None:
            extra += own / c
        if (friction := self.value("friction@%s.rz" % name)) is not None:
            most, kf = friction
            slip = self.slips.get(i, 0.0)
            phi = (own + kf * slip) / (k + kf)  # sticks
            if abs(kf * (phi - slip)) > most:
                sense = np.sign(phi - slip)
                phi = (own - sense * most) / k
                slip = phi - sense * most / kf
            slips[i] = slip
            about = phi
        else:
            about = own / k
        tilt = 1 / self.bearing[i] if self.bearing[i] else 0.0
        if (factor := self.value("factor@%s.tilt" % name)) is not None:
            tilt /= factor
        if (c := self.value("linear@%s.tilt" % name)) is not None:
            tilt += 1 / c
        return np.array([tilt * m[0], tilt * m[1], about + extra])

    def place(self, q, phi, base):
        """Origins and axes of the joints after their motion, the tool point, the tool's axes."""
        R, p, origins, frames = rotation(base[3:]), base[:3].copy(), [], []
        for i, (_, _, axis, home, *_) in enumerate(JOINTS):
            p = p + R @ self.offsets[i]
            # Axes of the joint: z along its axis, the shortest turn from z of the chain.
            A = np.eye(3) if axis is Z else rotation(-math.pi / 2 * X)
            R = R @ rotation(q[i] * axis)
            frames.append(R @ A)
            origins.append(p)
            R = R @ A @ rotation(phi[i]) @ A.T
        return origins, frames, p + R @ self.offsets[-1], R

    def tool(self, q, load):
        """Place of the point that is read (m) under a load (N, Nm), from the state of friction that the last one left."""
        F = load[:3].copy()
        if (mass := self.value("self_weight")) is not None:
            F[2] -= 9.80665 * mass
        phi, base = [np.zeros(3)] * 6, np.zeros(6)
        for _ in range(200):
            origins, frames, p, R = self.place(q, phi, base)
            slips, before = {}, phi
            M = load[3:] + np.cross(R @ self.point("moved@load"), load[:3])
            moment = [frames[i].T @ (M + np.cross(p - origins[i], F)) for i in range(6)]
            phi = [self.turn(i, moment[i], slips) for i in range(6)]
            if (coupling := self.value("coupling")) is not None:  # the elbow's moment turns the shoulder too
                phi[1] = phi[1] + np.array([0, 0, coupling * moment[2][2] / self.stiffness[2]])
            m_base = M + np.cross(p, F)
            if (k := self.value("base_tilt")) is not None:
                base[3:] = [m_base[0] / k, m_base[1] / k, 0]
            if (k := self.value("base_compliance")) is not None:
                base[:3] = F / np.array([k[0], k[0], k[1]])
            if max(np.abs(a - b).max() for a, b in zip(phi, before)) < 1e-13:
                break
        else:
            raise RuntimeError("no equilibrium")
        self.slips.update(slips)
        _, _, p, R = self.place(q, phi, base)
        if (k := self.value("tool_compliance")) is not None:
            p = p + R @ ((R.T @ F) / np.array([k[0], k[0], k[1]]))
        return p + R @ self.point("moved@sensor")


def campaign(random, poses, cycles):
    """(pose, q, load) in the order taken: forces along the axes with both senses and sizes, moments, or cycles."""
    out = []
    for pose in range(poses):
        q = [math.radians(home + random.uniform(-25, 25)) for *_, home, _, _ in JOINTS]
        if cycles:
            for axis in range(3):
                for step in (0.5, 1, 0.5, 0, -0.5, -1, -0.5, 0):
                    out.append((pose, q, 200 * step * np.eye(6)[axis]))
            continue
        for share in (-1, -0.4, 0.4, 1):
            for axis in range(3):
                out.append((pose, q, 200 * share * np.eye(6)[axis]))
        for axis in range(3, 6):
            for sense in (-1, 1):
                out.append((pose, q, 40 * sense * np.eye(6)[axis]))
    return out


def measured(name, hidden, seed, scale=1.0, cycles=False, poses=16):
    random = np.random.default_rng([seed, zlib.crc32(name.encode())])
    arm = Arm(random, scale, hidden)
    rows, plan = [], campaign(random, poses, cycles)
    at, bare = None, Arm(random, 0, {k: hidden[k] for k in hidden if k == "moved@sensor"})
    bare.offsets = arm.offsets
    for n, (pose, q, load) in enumerate(plan):
        if pose != at:
            at, arm.slips = pose, {}
            there = bare.tool(q, np.zeros(6))  # as assembled, weightless
        true = load * (1 + 0.003 * scale * random.normal())
        if (gain := hidden.get("load_gain")) is not None:
            true = gain * true
        if (turned := hidden.get("load_misalignment")) is not None:
            R = rotation(np.array(turned))
            true = np.concatenate([R @ true[:3], R @ true[3:]])
        d = arm.tool(q, true) - there
        if (turned := hidden.get("sensor_misalignment")) is not None:
            d = rotation(np.array(turned)) @ d
        if (drift := hidden.get("sensor_drift")) is not None:
            d = d + np.array(drift) * n / len(plan)
        if (wave := hidden.get("wave")) is not None:  # of the hall's temperature
            d = d + wave * np.array([1, 0.5, -0.7]) * math.sin(9 * n / len(plan))
        d = d + SIGMA * random.normal(size=3)
        rows.append(["p%d" % pose] + ["%.9f" % x for x in q] + ["%g" % x for x in load[:3]] +
                    ["%g" % (1e3 * x) for x in load[3:]] + ["%.6f" % (1e3 * x) for x in d] + ["%g" % (1e3 * SIGMA), n])
    return rows


HEADER = (["pose"] + ["q%d_rad" % (i + 1) for i in range(6)] +
          "fx_N fy_N fz_N mx_Nmm my_Nmm mz_Nmm ux_mm uy_mm uz_mm sigma_u_mm sequence".split())

# Name of the set, what is hidden (SI), further arguments, whether no effect describes it.
SETS = [
    ("healthy-1", {}, {}, False), ("healthy-2", {}, {}, False), ("healthy-3", {}, {"cycles": True}, False),
    ("doubled-1", {}, {"scale": 2.0}, False), ("doubled-2", {}, {"scale": 2.0}, False),
    ("elbow-softer", {"factor@elbow.rz": 0.8}, {}, False),
    ("shoulder-bearing", {"factor@shoulder.tilt": 3 / 7}, {}, False),
    ("elbow-bearing", {"linear@elbow.tilt": 2e6}, {}, False),
    ("roll-bearing", {"linear@roll.tilt": 6e5}, {}, False),
    ("elbow-play", {"clearance@elbow.rz": 2e-5}, {}, False), ("turret-play", {"clearance@turret.rz": 3e-5}, {}, False),
    ("shoulder-friction", {"friction@shoulder.rz": (25.0, 4e5)}, {"cycles": True}, False),
    ("elbow-friction", {"friction@elbow.rz": (15.0, 2e5)}, {"cycles": True}, False),
    ("elbow-pull", {"pull@elbow.rz": 1.2e-6}, {}, False), ("shoulder-push", {"push@shoulder.rz": 8e-7}, {}, False),
    ("gears", {"motor_compliance": 1.5e6}, {}, False),
    ("base-tilts", {"base_tilt": 4e6}, {}, False), ("base-shifts", {"base_compliance": (2e7, 2e7)}, {}, False),
    ("tool-yields", {"tool_compliance": (2e7, 2e7)}, {}, False),
    ("payload", {"self_weight": 3.0}, {}, False),
    ("gain", {"load_gain": 1.06}, {}, False), ("cell-turned", {"load_misalignment": (0.02, -0.01, 0.015)}, {}, False),
    ("tracker-turned", {"sensor_misalignment": (0.01, 0.015, -0.01)}, {}, False),
    ("load-moved", {"moved@load": (0.01, -0.006, 0.02)}, {}, False),
    ("reflector-moved", {"moved@sensor": (0.008, 0.005, -0.012)}, {}, False),
    ("drift", {"sensor_drift": (2e-5, -1e-5, 1.5e-5)}, {}, False),
    ("base-and-play", {"base_tilt": 3e6, "clearance@elbow.rz": 3e-5}, {}, False),
    ("bearing-and-payload", {"linear@elbow.tilt": 1.5e6, "self_weight": 3.0}, {}, False),
    ("coupling", {"coupling": 0.25}, {}, True), ("wave", {"wave": 1.5e-5}, {}, True),
]


def in_units(name, value):
    """The parameters of deflect's effect of that name, in their units."""
    law = name.split("@")[0]
    if law in ("factor", "load_gain"):
        return {"factor": value}
    if law == "clearance":
        return {"gap_rad": value}
    if law in ("pull", "push"):
        return {"yields_rad_per_Nmm": 1e-3 * value}
    if law in ("linear", "motor_compliance", "base_tilt"):
        return {"stiffness_Nmm_per_rad": 1e3 * value}
    if law == "friction":
        return {"moment_Nmm": 1e3 * value[0], "stiffness_Nmm_per_rad": 1e3 * value[1]}
    if law == "self_weight":
        return {"mass_kg": value}
    if law in ("load_misalignment", "sensor_misalignment"):
        return dict(zip(("rx_rad", "ry_rad", "rz_rad"), value))
    if law in ("sensor_drift", "moved"):
        return dict(zip(("x_mm", "y_mm", "z_mm"), (1e3 * x for x in value)))
    return {"lateral_N_per_mm": 1e-3 * value[0], "axial_N_per_mm": 1e-3 * value[1]}


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("out")
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--only", help="names of sets, separated by commas")
    a = p.parse_args()
    out, truth = pathlib.Path(a.out), {}
    out.mkdir(parents=True, exist_ok=True)
    for name, hidden, how, unknown in SETS:
        if a.only and name not in a.only.split(","):
            continue
        rows = measured(name, hidden, a.seed, **how)
        (out / (name + ".csv")).write_text("\n".join(",".join(map(str, r)) for r in [HEADER] + rows) + "\n")
        truth[name] = {"unknown": unknown,
                       "effects": {} if unknown else {k: in_units(k, v) for k, v in hidden.items()}}
    (out / "truth.json").write_text(json.dumps(truth, indent=1) + "\n")


if __name__ == "__main__":
    main()
