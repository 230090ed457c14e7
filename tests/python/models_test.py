"""Machines and frames as values: how they come, what they say of themselves, how they are changed, and their errors."""

import concurrent.futures
import copy
import json
import pathlib
import pickle
import tempfile
import unittest
import warnings

import numpy as np

import deflect

TRUSS = """name: two bars
materials: {steel: {E: 200 GPa, nu: 0.3}}
sections: {bar: {shape: round, diameter: 20 mm}}
nodes: {A: [-1 m, 0 m, 0 m], B: [1 m, 0 m, 0 m], T: [0 m, 0 m, 1 m]}
members:
  a: {from: A, to: T, section: bar, material: steel}
  b: {from: B, to: T, section: bar, material: steel}
supports: {A: pinned, B: pinned, T: [uy]}
loads: {down: {nodes: {T: {fz: -1 kN}}}}
"""


class Loaded(unittest.TestCase):
    def test_by_name_path_text_and_dict(self):
        m = deflect.load("haptic-6psu")
        self.assertIsInstance(m, deflect.Model)
        self.assertEqual(m.name, "haptic-6psu")
        self.assertEqual(deflect.load(m.yaml), m)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "mine.yaml"
            path.write_text(m.yaml)
            self.assertEqual(deflect.load(path), m)
            self.assertEqual(deflect.load(str(path)), m)

    def test_a_dict_is_a_file(self):
        """The fields of the frame as dicts and lists, quantities as text."""
        bar = {"section": "bar", "material": "steel"}
        fields = {
            "name": "two bars", "materials": {"steel": {"E": "200 GPa", "nu": 0.3}},
            "sections": {"bar": {"shape": "round", "diameter": "20 mm"}},
            "nodes": {"A": ["-1 m", "0 m", "0 m"], "B": ["1 m", "0 m", "0 m"], "T": ["0 m", "0 m", "1 m"]},
            "members": {"a": {"from": "A", "to": "T", **bar}, "b": {"from": "B", "to": "T", **bar}},
            "supports": {"A": "pinned", "B": "pinned", "T": ["uy"]}, "loads": {"down": {"nodes": {"T": {"fz": "-1 kN"}}}}}
        self.assertEqual(deflect.load(fields), deflect.load(TRUSS))

    def test_what_it_says_of_itself(self):
        m = deflect.load("haptic-6psu")
        self.assertEqual(m.home.shape, (6,))
        self.assertEqual(m.legs, 6)
        self.assertIn("guide_root_compliance", [e["effect"] for e in m.effects()])
        places = m.places()
        self.assertTrue(all(p.path and p.kind for p in places))
        self.assertEqual(len({(p.id, p.leg) for p in places}), len(places))
        self.assertIn("haptic-6psu", deflect.built_in()["machine"])
        self.assertIn("logan-5-8", deflect.built_in()["frame"])

    def test_edits_and_effects_give_another(self):
        m = deflect.load("haptic-6psu-ideal-joints")
        before = m.yaml
        load = [50, 0, 0]
        softer = m.edited("materials.*.E", 0.5, "multiply")
        # All that yields is of materials with E and nu (ideal joints): half the moduli are twice the displacement.
        np.testing.assert_allclose(softer.solve(load=load).displacement, 2 * m.solve(load=load).displacement, rtol=1e-9,
                                   atol=1e-12)
        yields = m.with_effect("guide_root_compliance", stiffness_Nmm_per_rad=5e6)
        self.assertGreater(yields.solve(load=load).displacement[0], m.solve(load=load).displacement[0])
        self.assertEqual(m.yaml, before)

    def test_another_name_keeps_the_comments(self):
        scara = deflect.load("scara")
        self.assertIn("#", scara.source)
        for name in ("mine", "a: b #c", "1e3"):
            mine = scara.named(name)
            self.assertEqual(mine.name, name)
            self.assertEqual(mine.source.count("#"), scara.source.count("#") + name.count("#"))
            with tempfile.TemporaryDirectory() as folder:
                mine.save(folder + "/mine.yaml")
                self.assertEqual(deflect.load(folder + "/mine.yaml"), mine)

    def test_places_and_sensors(self):
        m, truss = deflect.load("haptic-6psu"), deflect.load("truss-45")
        self.assertEqual(m.sensors(), [])
        sensors = truss.sensors()
        self.assertTrue(all(s.name and s.unit for s in sensors))
        data = deflect.simulate(truss, campaign="paper", seed=1)
        self.assertTrue({f"{s.name}_{s.unit}" for s in sensors} <= set(data.columns))
        for place in truss.places() + m.places():
            again = pickle.loads(pickle.dumps(place))
            self.assertEqual(again, place)
            self.assertEqual(copy.copy(place), place)

    def test_pickle_and_copy(self):
        m = deflect.load("haptic-6psu")
        f = deflect.frame(TRUSS)
        s = m.solve([25, 25, 198.9], [50, 0, 0])
        for each in (m, f, s, f.solve(), deflect.validate(m)):
            for other in (pickle.loads(pickle.dumps(each)), copy.copy(each), copy.deepcopy(each)):
                self.assertEqual(each, other)
        data = deflect.simulate("haptic-6psu-ideal-joints", campaign="paper")
        compared = deflect.compare("haptic-6psu-ideal-joints", data)
        again = pickle.loads(pickle.dumps(compared))
        self.assertEqual(again, compared)
        np.testing.assert_array_equal(again.residuals["residual"], compared.residuals["residual"])
        self.assertEqual(pickle.loads(pickle.dumps(data)), data)
        other = pickle.loads(pickle.dumps(s))
        np.testing.assert_array_equal(other.displacement, s.displacement)
        np.testing.assert_array_equal(other.stiffness, s.stiffness)
        self.assertEqual(other.report, s.report)


class Solved(unittest.TestCase):
    def test_by_theory(self):
        s = deflect.load("haptic-6psu").solve(pose=[25, 25, 198.9], load=[50, 0, 0])
        self.assertEqual(list(s.by_theory), ["analytic", "msa"])
        content = json.loads(s.json)
        for name, answer in s.by_theory.items():
            np.testing.assert_array_equal(answer.displacement, content[name]["displacement"])
            np.testing.assert_array_equal(answer.stiffness, content[name]["stiffness"])
        self.assertAlmostEqual(sum(s.parts.values()), 1, places=12)
        # The README's numbers, as printed there.
        np.testing.assert_allclose(s.displacement[:3], [0.707443, -0.002118, -0.017002], atol=5e-7)

    def test_SI(self):
        m = deflect.load("haptic-6psu")
        mm = m.solve([25, 25, 198.9, 1, 2, 3], [50, 0, 0, 100, 0, 0])
        si = m.solve([0.025, 0.025, 0.1989, *np.deg2rad([1, 2, 3])], [50, 0, 0, 0.1, 0, 0], units="SI")
        np.testing.assert_allclose(si.displacement[:3], mm.displacement[:3] / 1e3, rtol=1e-9)
        np.testing.assert_allclose(si.displacement[3:], mm.displacement[3:], rtol=1e-9)
        # Slides in m, by joints as by pose.
        joints = {j["name"]: j for j in m.solve().content["joints"]}
        self.assertTrue(all("value_rad" in j for j in joints.values()) or all("value_mm" in j for j in joints.values()))
        at = [j.get("value_rad", j.get("value_mm")) for j in joints.values()]
        slides = "value_mm" in next(iter(joints.values()))
        of_joints = m.solve(joints=[q / 1e3 if slides else q for q in at], load=[50, 0, 0], units="SI")
        np.testing.assert_allclose(of_joints.displacement, m.solve(load=[50, 0, 0], units="SI").displacement, rtol=1e-6,
                                   atol=1e-12)
        # What a stiffness is for: K d = F in the same units, of a linear machine.
        ideal = deflect.load("haptic-6psu-ideal-joints")
        F = np.array([50, 0, 0, 0.1, 0, 0])
        s = ideal.solve(load=F, units="SI")
        np.testing.assert_allclose(s.stiffness @ s.displacement, F, atol=1e-7)

    def test_a_frame(self):
        """Two bars at 45 degrees under P: N = −P/√2 each, and T sinks by P L / (2 E A sin²45) with L = √2 m."""
        f = deflect.frame(TRUSS)
        r = f.solve()
        self.assertEqual(f.load_cases, ["down"])
        area = np.pi * 10**2
        at = r.displacements()
        # The bars are rigidly connected and bend, too: of the order (r/L)² of the force.
        np.testing.assert_allclose(at["uz_mm"][at["node"].index("T")], -1000 * np.sqrt(2) * 1000 / (200e3 * area),
                                   rtol=1e-3)
        members = r.members("down")
        self.assertEqual(members["member"], ["a", "b"])
        np.testing.assert_allclose(members["end.N_N"], -1000 / np.sqrt(2), rtol=1e-3)
        self.assertEqual(r.reactions()["fz_N"].shape, (3,))
        self.assertEqual(len(r.rows()), 3)
        nodes, members = f.nodes(), f.members()
        self.assertEqual(nodes["node"], ["A", "B", "T"])
        np.testing.assert_allclose(nodes["z_mm"], [0, 0, 1000])
        self.assertTrue(nodes["held"][0])
        self.assertEqual((members["member"], members["start_mm"].shape), (["a", "b"], (2, 3)))
        np.testing.assert_allclose(members["length_mm"], np.sqrt(2) * 1000)


class Errors(unittest.TestCase):
    def test_by_kind(self):
        m = deflect.load("haptic-6psu")
        with self.assertRaisesRegex(deflect.InputError, "did you mean 'haptic-6psu'"):
            deflect.load("haptic-6pus")
        with self.assertRaisesRegex(deflect.InputError, "materials.steal"):
            m.edited("materials.steal.E", "200 GPa")
        with self.assertRaisesRegex(deflect.InputError, "text:2"):
            deflect.load("name: a\nnonsense: 1\nfamily: chains\n")
        with self.assertRaises(deflect.MechanismError):
            m.solve([1000, 0, 0])
        with self.assertRaises(ValueError):  # an InputError is one
            m.solve([1, 2])
        with self.assertRaises(deflect.InputError):
            m.solve([np.nan, 0, 200])
        with self.assertRaisesRegex(deflect.InputError, "wind"):
            deflect.predict(deflect.load("logan-5-8"), at={"wind": 1})

    def test_motions_of_what_cannot_stand(self):
        free = deflect.frame(TRUSS).edited("supports.B", ["uz"])
        with self.assertRaises(deflect.MechanismError) as caught:
            free.edited({"members.a.release_to": ["rx", "ry", "rz"], "members.a.release_from": ["ry"]}).edited(
                "supports.A", ["uz"]).solve()
        motions = caught.exception.motions
        self.assertTrue(motions)
        self.assertTrue(motions[0]["words"])
        again = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual(again.motions, motions)
        self.assertEqual(str(again), str(caught.exception))

    def test_implausible_materials_are_remarked(self):
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            deflect.load(TRUSS.replace("200 GPa", "200 MPa"))
        self.assertEqual([w.category for w in told], [deflect.Remark])


class Threads(unittest.TestCase):
    def test_from_python(self):
        m = deflect.load("haptic-6psu")
        poses = [[x, 0, 198.9] for x in np.linspace(-20, 20, 40)]
        alone = [m.solve(p, [50, 0, 0]).displacement for p in poses]
        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            beside = list(pool.map(lambda p: m.solve(p, [50, 0, 0]).displacement, poses))
        np.testing.assert_array_equal(alone, beside)

    def test_studies_beside_each_other(self):
        """Readings compared, effects written in Python and many poses, in threads at once: as one after another."""
        m = deflect.load("haptic-6psu-ideal-joints")
        data = [deflect.simulate(m, campaign="paper", seed=seed) for seed in range(4)]
        own = {"name": "own", "parameters": {"factor": {"start": 0.9, "low": 0.5, "high": 2, "vanishes": 1}},
               "edits": lambda p: [{"at": "materials.steel.E", "multiply": p["factor"]}]}

        def study(seed):
            poses = m.home + np.random.default_rng(seed).uniform(-10, 10, (300, 6)) * [1, 1, 1, 0.1, 0.1, 0.1]
            return (deflect.compare(m.with_effect(own, factor=1 + 0.01 * seed), data[seed], threads=2).json,
                    m.stiffness(poses, [50, 0, 0], threads=2).tobytes())

        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            self.assertEqual(list(pool.map(study, range(4))), [study(seed) for seed in range(4)])


if __name__ == "__main__":
    unittest.main()
