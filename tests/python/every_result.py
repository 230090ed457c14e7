"""A result of every kind, by name: for tests of what all results have."""

import functools

import numpy as np

import deflect

IDEAL = "haptic-6psu-ideal-joints"
FREE = """name: a bar on one hinge
materials: {steel: {E: 200 GPa, nu: 0.3}}
sections: {bar: {shape: round, diameter: 20 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [1 m, 0 m, 0 m]}
members: {a: {from: A, to: B, section: bar, material: steel}}
supports: {A: [ux, uy, uz, rx, rz], B: [uy]}
loads: {down: {nodes: {B: {fz: -1 kN}}}}
"""
PLAY = """name: play
kinematics: {family: chains}
leg:
  slide: {joint: prismatic}
  motor: {joint: motor, rz: {law: linear, stiffness: 1e6 Nmm/rad}}
  pad: {joint: slider, tz: {law: clearance, gap: 0.1 mm}}
  arm: {offset: [200 mm, 0 mm, 0 mm]}
"""


@functools.cache
def results():
    m = deflect.load(IDEAL)
    data = deflect.simulate(m, ("joint_clearance", {"gap_mm": 0.02}), campaign="paper", seed=5)
    healthy = deflect.simulate(m, campaign="paper", seed=6)
    fitted = deflect.fit(m, data, "materials.steel.E", prior={"materials.steel.E": "210 GPa ± 2 %"})
    diagnosed = deflect.diagnose(m, data, bootstrap=99)
    # A platform and an actuator that yield look alike under forces.
    tied = deflect.simulate(m, ("platform_flexibility", {"stiffness_N_per_mm": 1500}), campaign="paper", seed=5)
    tie = deflect.diagnose(m, tied, bootstrap=99)
    solution = m.solve([20, 0, 180], [50, 0, 0])
    truss = deflect.load("truss-45")
    return {
        "solution": solution, "finite": m.solve(load=[50, 0, 0], geometry="finite"),
        "play": deflect.load(PLAY).solve(load=[0, 0, 0, 1, 0, 0]),
        "misfit": deflect.load("tripteron").edited("misfits", [{"leg": 1, "base": {"shift": ["0.1 mm", "0 mm", "0 mm"]}}])
        .solve(load=[5, 0, 0]),
        "validation": deflect.validate("haptic-6psu"),
        "errata": deflect.validate("haptic-6psu", errata=True, as_printed="passive-joints"),
        "map": deflect.map(m, 4), "slice": deflect.map(m, 4, x=0), "loaded": deflect.map(m, 3, load=[0, 0, 50]),
        "frame": deflect.frame("logan-5-8").solve(), "comparison": deflect.compare(m, data),
        "validity": deflect.compare(m, data, validation=True),
        "used": deflect.compare(m, data, validation=True, use=data, fit=fitted, calibration=healthy),
        "diagnosis": diagnosed, "tie": tie, "fit": fitted, "prediction": deflect.predict(m, data),
        "history": deflect.history(data, [m, fitted.model]), "foresight": deflect.plan(m, before="paper"),
        "plan": deflect.plan(m, tie, tied, readings=3),
        "truss": deflect.compare(truss, deflect.simulate(truss, campaign="paper")),
        "drawing": m.show(), "drawn frame": truss.show(), "cannot stand": deflect.frame(FREE).show(),
        "check": deflect.check(solution.stiffness), "failed check": deflect.check(np.diag([1.0, 1, 1, 1, 1, -1])),
        "reference": deflect.check(2 * solution.stiffness, reference=solution.stiffness)}
