"""The README's session in Python: every number of the program's --json and every byte of its files, by functions."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import deflect

PROGRAM = os.environ["DEFLECT_PROGRAM"]


def without_provenance(content):
    return {name: value for name, value in content.items() if name != "provenance"}


class Session(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        os.chdir(cls.folder)  # so that both call files by the same name
        cls.program("simulate haptic-6psu-ideal-joints --with joint_clearance,gap_mm=0.02 --campaign rich --seed 3 "
                    "-o hidden.csv")
        cls.program("simulate haptic-6psu-ideal-joints --campaign paper --seed 4 -o paper.csv")

    @classmethod
    def tearDownClass(cls):
        os.chdir("/")
        cls.scratch.cleanup()

    @classmethod
    def program(cls, words):
        subprocess.run([PROGRAM, *words.split(), "--quiet"], check=True, cwd=cls.folder)

    def json_of(self, words):
        self.program(f"{words} --json out.json")
        return without_provenance(json.loads((self.folder / "out.json").read_text()))

    def assert_same(self, words, result):
        self.maxDiff = 2000
        self.assertEqual(result.content, self.json_of(words))

    def test_solve(self):
        m = deflect.load("haptic-6psu")
        self.assert_same("solve haptic-6psu --pose 25,25,198.9,0,0,0 --load 50,0,0",
                         m.solve([25, 25, 198.9], [50, 0, 0]))
        self.assert_same("solve haptic-6psu --joints 90,90,90,90,90,90 --load 0,0,50 --geometry finite",
                         m.solve(joints=[90] * 6, load=[0, 0, 50], geometry="finite"))
        self.assert_same("solve haptic-6psu --pose 0,0,180 --load 0,50,0,1,2,3 --theories msa",
                         m.solve([0, 0, 180], [0, 50, 0, 1, 2, 3], theories=["msa"]))

    def test_validate(self):
        self.assert_same("validate haptic-6psu --errata --as-printed passive-joints",
                         deflect.validate("haptic-6psu", errata=True, as_printed="passive-joints"))

    def test_map(self):
        self.assert_same("map haptic-6psu --n 5,4,3", deflect.map("haptic-6psu", (5, 4, 3)))
        boxed = deflect.map("haptic-6psu", 3, x=(-20, 20), y=0, z=(150, 190), load=[0, 0, 50])
        self.assert_same("map haptic-6psu --n 3 --x=-20,20 --y 0 --z 150,190 --load 0,0,50", boxed)
        self.assertEqual(len(boxed.rows()), 9)
        # A row is the pose that it says: its stiffness under the load is K⁻¹'s translational block inverted.
        row = boxed.rows()[5]
        self.assertEqual([row["x_mm"], row["y_mm"], row["z_mm"]], [20, 0, 170])
        K = deflect.load("haptic-6psu").stiffness([20, 0, 170], [0, 0, 50], theory="msa")
        np.testing.assert_allclose(row["msa.stiffness_z_N_per_mm"], 1 / np.linalg.inv(K)[2, 2], rtol=1e-7)

    def test_frame(self):
        self.assert_same("frame logan-5-8", deflect.frame("logan-5-8").solve())

    def test_effects_and_add(self):
        self.program("effects --device haptic-6psu --json effects.json")
        self.assertEqual(deflect.effects("haptic-6psu"), json.loads((self.folder / "effects.json").read_text()))
        self.program("add haptic-6psu guide_root_compliance --set stiffness_Nmm_per_rad=5e6 -o softer.yaml")
        softer = deflect.load("haptic-6psu").with_effect("guide_root_compliance", stiffness_Nmm_per_rad=5e6)
        of_file = deflect.load("softer.yaml")
        np.testing.assert_array_equal(softer.solve(load=[50, 0, 0]).stiffness, of_file.solve(load=[50, 0, 0]).stiffness)

    def test_simulate(self):
        hidden = deflect.simulate("haptic-6psu-ideal-joints", ("joint_clearance", {"gap_mm": 0.02}), seed=3)
        self.assertEqual(hidden.text, (self.folder / "hidden.csv").read_text())
        self.assertEqual(hidden.hidden[0]["effect"], "joint_clearance")
        frame = deflect.simulate("truss-45", campaign="paper", seed=2)
        self.program("simulate truss-45 --campaign paper --seed 2 -o frame.csv")
        self.assertEqual(frame.text, (self.folder / "frame.csv").read_text())

    def test_compare(self):
        self.assert_same("compare haptic-6psu-ideal-joints hidden.csv",
                         deflect.compare("haptic-6psu-ideal-joints", "hidden.csv"))
        self.assert_same("compare haptic-6psu-ideal-joints paper.csv --validation",
                         deflect.compare("haptic-6psu-ideal-joints", "paper.csv", validation=True))

    def test_diagnose(self):
        found = deflect.diagnose("haptic-6psu-ideal-joints", "paper.csv", bootstrap=99)
        self.assert_same("diagnose haptic-6psu-ideal-joints paper.csv --bootstrap 99", found)
        self.assertEqual(found.verdict, found.content["verdict"])

    def test_fit_and_predict(self):
        path = "materials.steel.E"
        fitted = deflect.fit("haptic-6psu-ideal-joints", "paper.csv", path, prior={path: "210 GPa ± 2 %"})
        self.program("fit haptic-6psu-ideal-joints paper.csv --free materials.steel.E -o fitted.yaml --json plain.json")
        plain = deflect.fit("haptic-6psu-ideal-joints", "paper.csv", [path])
        self.assertEqual(plain.content, without_provenance(json.loads((self.folder / "plain.json").read_text())))
        self.assertNotEqual(plain, fitted)
        self.assert_same("predict fitted.yaml --at 25,25,198.9 --load 50,0,0 --fit plain.json",
                         deflect.predict("fitted.yaml", at=[25, 25, 198.9], load=[50, 0, 0], fit=plain))
        self.assert_same("predict haptic-6psu-ideal-joints --plan paper.csv --sigma 0.002",
                         deflect.predict("haptic-6psu-ideal-joints", "paper.csv", sigma=0.002))

    def test_plan_finds_what_was_diagnosed(self):
        """There or beside the diagnosis; a platform and an actuator that yield look alike under forces."""
        m = "haptic-6psu-ideal-joints"
        self.program(f"simulate {m} --with platform_flexibility,stiffness_N_per_mm=1500 --campaign paper --seed 5 -o t.csv")
        self.program(f"diagnose {m} t.csv --bootstrap 99 --json tie.json")
        self.assert_same(f"plan {m} tie.json --readings 1 --poses measured --forces-only",
                         deflect.plan(m, "tie.json", readings=1, poses="measured", forces_only=True))
        with self.assertRaisesRegex(deflect.InputError, "no replicates"):
            deflect.plan(m, "tie.json", ["t.csv", "t.csv"])
        with self.assertRaisesRegex(deflect.InputError, "give at least one session"):
            deflect.plan(m, "tie.json", [])
        found = deflect.measurements.diagnosed_sessions
        self.assertEqual(found("tie.json"), [((self.folder / "t.csv").read_text(), "t.csv")])
        self.assertEqual(found(deflect.read("tie.json")), found("tie.json"))
        moved = self.folder / "moved"
        moved.mkdir()
        for name in ("tie.json", "t.csv"):
            (self.folder / name).rename(moved / name)
        self.assertEqual(found(moved / "tie.json"), [((moved / "t.csv").read_text(), str(moved / "t.csv"))])
        with self.assertRaisesRegex(deflect.InputError, "'t.csv', are not there: give data too"):
            deflect.plan(m, deflect.read(moved / "tie.json"))
        two = json.loads((moved / "tie.json").read_text())
        two["data"] = "t.csv + paper.csv"  # sessions of one campaign
        (moved / "two.json").write_text(json.dumps(two))
        self.assertEqual([origin for _, origin in found(moved / "two.json")], [str(moved / "t.csv"), "paper.csv"])

    def test_history(self):
        self.program("add haptic-6psu-ideal-joints joint_clearance --set gap_mm=0.02 -o with.yaml")
        self.assert_same("history hidden.csv haptic-6psu-ideal-joints with.yaml",
                         deflect.history("hidden.csv", ["haptic-6psu-ideal-joints", "with.yaml"]))


class Data(unittest.TestCase):
    def test_arrays_are_a_file(self):
        """Readings that the model predicts itself, from arrays: nothing is missing in them."""
        m = deflect.load("haptic-6psu-ideal-joints")
        poses = np.repeat([[0, 0, 173.9], [20, 0, 180], [0, 20, 170]], 6, axis=0)
        loads = np.tile(np.vstack([50 * np.eye(3), -50 * np.eye(3)]), (3, 1))
        d = m.displacement(poses, loads)
        data = deflect.Measurements.from_arrays(poses, loads, d[:, :3], columns={"sigma_u_mm": np.full(18, 0.01)})
        self.assertEqual(len(data), 18)
        np.testing.assert_array_equal(data.columns["ux_mm"], d[:, 0])
        self.assertEqual(len(set(data.columns["pose"])), 3)
        compared = deflect.compare(m, data)
        self.assertEqual(compared.readings, 18)
        # Loads are read in N and displacements in mm, and both back: rounding alone is left of the linear answer; the
        # deformed shape, in which measurements are predicted, changes it by the square of the rotation.
        self.assertLess(compared.baseline["rmse_mm"], 0.05 * np.abs(d[:, :3]).max())
        si = poses / 1e3
        again = deflect.Measurements.from_arrays(si, loads, d[:, :3] / 1e3, columns={"sigma_u_mm": np.full(18, 0.01)},
                                                 units="SI")
        for name, values in data.columns.items():
            if name != "pose":
                np.testing.assert_allclose(again.columns[name], values, rtol=1e-14)
        with tempfile.TemporaryDirectory() as folder:
            data.to_csv(folder + "/data.csv")
            self.assertEqual(deflect.Measurements.from_csv(folder + "/data.csv"), data)

    def test_errors_name_line_and_column(self):
        with self.assertRaisesRegex(deflect.InputError, "arrays.*fq_N|fq_N"):
            deflect.compare("haptic-6psu", deflect.Measurements.from_arrays(
                [[0, 0, 180.0]], [[50, 0, 0.0]], [[1, 0, 0.0]], columns={"fq_N": [1.0]}))
        with self.assertRaisesRegex(deflect.InputError, "different length"):
            deflect.Measurements.from_arrays([[0, 0, 180]], [[1, 0, 0], [0, 1, 0]])


if __name__ == "__main__":
    unittest.main()
