"""Laws and effects written in Python: as entries of the catalogue, in both theories, found by the diagnosis."""

import gc
import threading
import unittest
import weakref

import numpy as np

import deflect

IDEAL = "haptic-6psu-ideal-joints"


def clamp(**changes):
    """guide_root_compliance of the catalogue, with edits by a function."""
    entry = next(e for e in deflect.effects() if e["effect"] == "guide_root_compliance")
    own = {"name": "own_clamp", "title": entry["title"], "scope": entry["scope"],
           "parameters": {p["name"]: {k: p[k] for k in ("start", "low", "high", "scale", "vanishes", "about") if k in p}
                          for p in entry["parameters"]}}

    def edits(p):
        k = p["stiffness_Nmm_per_rad"]
        return [{"at": e["at"], e["action"]: {"law": "linear", "stiffness": f"{k!r} Nmm/rad"}} for e in entry["edits"]]

    return {**own, "edits": edits, **changes}


class Laws(unittest.TestCase):
    def test_both_theories_follow_the_curve(self):
        """A law between platform and tool is in series with the machine: the deflections add up."""
        m = deflect.load(IDEAL)
        curve = lambda f: 0.03 * f / (f + 12)  # noqa: E731
        forces = [0, 2, 4, 7, 10, 15, 20, 30, 45, 70, 100]
        with_law = m.edited("tool.tz", deflect.law(curve, forces, within=0.02), "append")
        for force in (4, 20, 70, -20):
            alone = m.solve(load=[0, 0, force]).by_theory
            for name, answer in with_law.solve(load=[0, 0, force]).by_theory.items():
                self.assertAlmostEqual(answer.displacement[2] - alone[name].displacement[2],
                                       np.sign(force) * curve(abs(force)), delta=1e-11)

    def test_different_under_push_and_pull(self):
        law = deflect.law(lambda f: 1e-3 * f if f > 0 else 2e-3 * f, [-50, 0, 50])
        m = deflect.load(IDEAL)
        with_law = m.edited("tool.tz", law, "append")
        for force, expected in ((10, 0.01), (-10, -0.02)):
            d = [x.solve(load=[0, 0, force]).displacement[2] for x in (with_law, m)]
            self.assertAlmostEqual(d[0] - d[1], expected, delta=1e-11)

    def test_on_a_rotation(self):
        m = deflect.load(IDEAL)
        law = deflect.law(lambda M: 0.5 * M, [0, 1, 2], rotation=True)
        d = [x.solve(load=[0, 0, 0, 0, 0, 1000]).displacement[5] for x in (m.edited("tool.rz", law, "append"), m)]
        self.assertAlmostEqual(d[0] - d[1], 0.5e-3, delta=1e-12)

    def test_refused(self):
        for curve, loads, words in ((lambda f: f + 1, [0, 1], "at no load"), (lambda f: -f, [0, 1], "does not rise"),
                                    (lambda f: f, [1, 2], "0 among"), (lambda f: f, [0], "at least two"),
                                    (lambda f: f, [-2, 0], "above 0"), (lambda f: f**0.5, [0, 100], "more loads"),
                                    (lambda f: float("nan"), [0, 1], "no number")):
            with self.assertRaisesRegex(deflect.InputError, words):
                deflect.law(curve, loads)


class Effects(unittest.TestCase):
    def test_as_the_entry_of_the_catalogue(self):
        m = deflect.load(IDEAL)
        own = m.with_effect(clamp(), stiffness_Nmm_per_rad=3e6)
        entry = m.with_effect("guide_root_compliance", stiffness_Nmm_per_rad=3e6)
        self.assertEqual(own, entry)

    def test_simulated_and_diagnosed_as_the_entry(self):
        m = deflect.load(IDEAL)
        values = {"stiffness_Nmm_per_rad": 5e6}
        data = deflect.simulate(m, ("own_clamp", values), effects=[clamp()], seed=3, campaign="paper")
        self.assertEqual(data.text, deflect.simulate(m, ("guide_root_compliance", values), seed=3, campaign="paper").text)
        found = deflect.diagnose(m, data, effects=[clamp()], bootstrap=99)
        by_name = {c["effect"]: c for c in found.candidates}
        own, entry = by_name["own_clamp"], by_name["guide_root_compliance"]
        # The same model by another way: numbers set in place, or the description read anew.
        self.assertAlmostEqual(own["parameters"][0]["value"] / entry["parameters"][0]["value"], 1, delta=1e-5)
        self.assertAlmostEqual(own["rmse_mm"] / entry["rmse_mm"], 1, delta=1e-6)
        self.assertTrue(any({"own_clamp", "guide_root_compliance"} <= set(tie) for tie in found.indistinguishable),
                        found.indistinguishable)

    def test_fitted_as_the_entry(self):
        """By a function, by the catalogue and by the number that the effect brings: one fit."""
        m = deflect.load(IDEAL)
        data = deflect.simulate(m, ("guide_root_compliance", {"stiffness_Nmm_per_rad": 5e6}), campaign="paper", seed=3)
        own = deflect.fit(m, data, clamp())
        entry = deflect.fit(m, data, ("guide_root_compliance", {"stiffness_Nmm_per_rad": 2e6}))
        self.assertEqual(own.parameters[0].path, "own_clamp.stiffness_Nmm_per_rad")
        self.assertEqual((own.parameters[0].of.effect, own.parameters[0].unit), ("own_clamp", "Nmm/rad"))
        self.assertEqual(entry.parameters[0].before, 2e6)
        for one in (own, entry):
            p = one.parameters[0]
            self.assertTrue(p.low95 < 5e6 < p.high95, p)
            self.assertAlmostEqual(p.value / own.parameters[0].value, 1, delta=0.02 * p.deviation)
            self.assertAlmostEqual(p.deviation / own.parameters[0].deviation, 1, delta=1e-3)
            self.assertLess(one.after.rmse_mm, one.before.rmse_mm)
        self.assertEqual(own.model, m.with_effect(clamp(), stiffness_Nmm_per_rad=own.parameters[0].value))
        at = {"at": [25, 25, 198.9], "load": [50, 0, 0]}
        first = deflect.predict(m, **at, fit=own, effects=[clamp()])
        self.assertEqual(deflect.predict(own.model, **at, fit=own, effects=[clamp()]), first)
        second = deflect.predict(m, **at, fit=entry)
        for a, b in zip(first.numbers, second.numbers):
            self.assertAlmostEqual(a.value, b.value, delta=1e-2 * abs(a.high95 - a.low95))
            self.assertAlmostEqual(a.deviation.parameters / b.deviation.parameters, 1, delta=0.01)
        with self.assertRaisesRegex(deflect.InputError, "own_clamp"):
            deflect.predict(m, **at, fit=own)
        si = deflect.predict(m, at=[0.025, 0.025, 0.1989], load=[50, 0, 0], fit=entry, units="SI")
        self.assertAlmostEqual(si.numbers[0].value / second.numbers[0].value, 1, delta=1e-9)

    def test_fitted_beside_a_number_with_a_prior(self):
        m = deflect.load(IDEAL)
        data = deflect.simulate(m, ("guide_root_compliance", {"stiffness_Nmm_per_rad": 5e6}), campaign="paper", seed=3)
        f = deflect.fit(m, data, [clamp(), "materials.steel.E"],
                        prior={"own_clamp.stiffness_Nmm_per_rad": "5e6 Nmm/rad ± 10 %", "materials.steel.E": "210 GPa ± 1 %"})
        self.assertEqual([p.path for p in f.parameters], ["materials.steel.E", "own_clamp.stiffness_Nmm_per_rad"])
        self.assertEqual(f.parameters[1].prior.mean, 5e6)
        self.assertEqual(f.correlation.shape, (2, 2))

    def test_fit_refuses(self):
        m = deflect.load(IDEAL)
        data = deflect.simulate(m, campaign="paper", seed=3)
        with self.assertRaisesRegex(deflect.InputError, "did you mean 'guide_root_compliance'"):
            deflect.fit(m, data, "guide_root_complianse")
        with self.assertRaisesRegex(deflect.InputError, "leg_defect.*one leg"):
            deflect.fit(m, data, "leg_defect")
        leg = deflect.fit(m, data, ("leg_defect", {"leg": 4}))
        self.assertTrue(leg.parameters[0].path.startswith("leg_defect[4]."))

    def test_listed_and_applied(self):
        listed = {e["effect"]: e for e in deflect.effects(IDEAL, [clamp()])}["own_clamp"]
        self.assertTrue(listed["applies"])
        self.assertFalse({e["effect"]: e for e in deflect.effects("truss-45", [clamp()])}["own_clamp"]["applies"])

    def test_of_a_frame(self):
        truss = deflect.load("truss-45")
        heavier = {"name": "stiffer", "parameters": {"factor": {"start": 1.2, "low": 0.5, "high": 2, "vanishes": 1}},
                   "edits": lambda p: [{"at": "materials.steel.E", "multiply": p["factor"]}]}
        self.assertEqual(truss.with_effect(heavier, factor=1.1), truss.edited("materials.steel.E", 1.1, "multiply"))
        self.assertEqual(truss.with_effect(heavier, factor=1), truss)  # where it vanishes
        self.assertEqual(truss.with_effect({**heavier, "edits": lambda p: []}, factor=1.1), truss)

    def test_mistakes_in_the_function(self):
        m = deflect.load(IDEAL)
        with self.assertRaisesRegex(ZeroDivisionError, "division"):
            m.with_effect(clamp(edits=lambda p: 1 / 0), stiffness_Nmm_per_rad=1e6)
        with self.assertRaisesRegex(deflect.InputError, "effect own_clamp.*no_such_part"):
            m.with_effect(clamp(edits=lambda p: [{"at": "no_such_part.tz", "set": 1}]), stiffness_Nmm_per_rad=1e6)

        def too_soft(p):
            raise deflect.InputError("too soft to stand")

        with self.assertRaisesRegex(deflect.InputError, "effect own_clamp: too soft to stand"):
            m.with_effect(clamp(edits=too_soft), stiffness_Nmm_per_rad=1e6)
        with self.assertRaisesRegex(deflect.InputError, "start"):
            deflect.effects(own=[clamp(parameters={"stiffness_Nmm_per_rad": {"low": 1, "high": 2}})])

        def raises_in_the_search(p):
            if threading.current_thread() is not threading.main_thread() and p["stiffness_Nmm_per_rad"] != 1e7:
                raise RuntimeError("of the function")
            return clamp()["edits"](p)

        data = deflect.simulate(m, ("guide_root_compliance", {"stiffness_Nmm_per_rad": 5e6}), campaign="paper", seed=1)
        with self.assertRaisesRegex(RuntimeError, "of the function"):
            deflect.diagnose(m, data, effects=[clamp(edits=raises_in_the_search)], bootstrap=99)

    def test_functions_are_let_go(self):
        class Edits:
            def __call__(self, p):
                return clamp()["edits"](p)

        edits = Edits()
        gone = weakref.ref(edits)
        deflect.load(IDEAL).with_effect(clamp(edits=edits), stiffness_Nmm_per_rad=1e6)
        del edits
        gc.collect()
        self.assertIsNone(gone())


class Derivatives(unittest.TestCase):
    def test_of_what_is_proportional(self):
        """All compliance is 1/E where joints are ideal: dd/dlnE = −d. A central difference errs by step²."""
        m, load = deflect.load(IDEAL), [50, 20, -10, 100, 0, 0]
        poses = m.home + np.random.default_rng(1).uniform(-15, 15, (4, 6)) * [1, 1, 1, 0.2, 0.2, 0.2]
        for theory in deflect.theories:
            d = m.displacement(poses, load, theory=theory)
            D = m.derivatives(["materials.*.E", "materials.steel.E"], poses, load, theory=theory)
            self.assertEqual(D.shape, (4, 6, 2))
            for k in range(2):
                np.testing.assert_allclose(D[:, :, k], -d, atol=2e-8 * np.abs(d).max())
        self.assertEqual(m.derivatives("materials.steel.E", poses[0], load).shape, (6, 1))


if __name__ == "__main__":
    unittest.main()
