"""Every command of the session in the README has its line in Python: the same numbers to the last digit, the same files."""

import json
import os
import pathlib
import re
import shlex
import subprocess
import tempfile
import unittest

import deflect

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ["DEFLECT_PROGRAM"]
IDEAL = "haptic-6psu-ideal-joints"


def session_of(readme):
    """The commands below "A session", without comments."""
    block = readme.read_text(encoding="utf-8").split("## A session\n```\n")[1].split("```")[0]
    return [line.split("#")[0].strip().removeprefix("build/deflect ") for line in block.strip().splitlines()]


class Session(unittest.TestCase):
    """A test for each command; they come in the order of the README, since one reads what another wrote."""

    #: by command, filled by the tests below
    seen: set = set()

    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.addClassCleanup(os.chdir, os.getcwd())
        os.chdir(scratch.name)
        pathlib.Path("build").mkdir()

    def program(self, command, name=None):
        """What the command of the README prints; "result.json" has its --json where ``name`` is given."""
        line = next(line for line in session_of(ROOT / "README.md") if line.startswith(command))
        self.seen.add(line)
        words = shlex.split(line) + (["--json", "result.json", "--quiet"] if name else [])
        return subprocess.run([PROGRAM, *words], check=True, capture_output=True, text=True).stdout

    def assert_same(self, command, result):
        self.program(command, "json")
        content = json.loads(pathlib.Path("result.json").read_text())
        content.pop("provenance")
        self.maxDiff = 2000
        self.assertEqual(result.to_dict(), content)

    def test_01_new(self):
        self.program("new --like scara -o mine.yaml")
        deflect.load("scara").named("mine").save("of_python.yaml")
        self.assertEqual(deflect.load("mine.yaml"), deflect.load("of_python.yaml"))

    def test_02_show(self):
        drawing = deflect.load("mine.yaml").show()
        self.assert_same("show mine.yaml --report drawing.html", drawing)
        deflect.report(drawing, "page.html")
        # The page of the program has its description and the command, too.
        page, whole = pathlib.Path("page.html").read_text(), pathlib.Path("drawing.html").read_text()
        self.assertEqual(page.split("<script")[0], whole.split("<script")[0])

    def test_03_devices(self):
        listed = [line.split()[0] for line in self.program("devices").splitlines()]
        self.assertEqual(deflect.built_in()["machine"], listed)

    def test_04_solve(self):
        m = deflect.load("haptic-6psu")
        self.assert_same("solve haptic-6psu --pose", m.solve(pose=[25, 25, 198.9, 0, 0, 0], load=[50, 0, 0]))
        self.assert_same("solve haptic-6psu --joints", m.solve(joints=[90] * 6, load=[0, 0, 50], geometry="finite"))

    def test_05_validate(self):
        self.assert_same("validate haptic-6psu", deflect.validate("haptic-6psu", errata=True, mesh_study=True))

    def test_06_map(self):
        self.assert_same("map haptic-6psu", deflect.map("haptic-6psu", 21))

    def test_07_export(self):
        self.program("export haptic-6psu")
        first, second = deflect.load("haptic-6psu").export("of_python.vtu", load=[50, 0, 0])
        self.assertEqual((first, second), ("of_python.vtu", "of_python-deflected.vtu"))
        for end in (".vtu", "-deflected.vtu"):
            self.assertEqual(pathlib.Path("of_python" + end).read_bytes(), pathlib.Path("build/loaded" + end).read_bytes())

    def test_08_frame(self):
        self.assert_same("frame logan-5-8", deflect.frame("logan-5-8").solve())

    def test_09_effects(self):
        self.program("effects guide_root_compliance", "json")
        explained = [e for e in deflect.effects() if e["effect"] == "guide_root_compliance"]
        self.assertEqual(explained, json.loads(pathlib.Path("result.json").read_text()))

    def test_10_add(self):
        self.program("add haptic-6psu")
        softer = deflect.load("haptic-6psu").with_effect("guide_root_compliance", stiffness_Nmm_per_rad=5e6)
        # All but "about", to which the program adds what was added.
        lines = [[line for line in m.named("softer").yaml.splitlines() if not line.startswith("about: ")]
                 for m in (softer, deflect.load("softer.yaml"))]
        self.assertEqual(*lines)

    def test_11_simulate(self):
        self.program("simulate")
        hidden = deflect.simulate(IDEAL, ("joint_clearance", {"gap_mm": 0.02}))
        self.assertEqual(hidden.text, pathlib.Path("hidden.csv").read_text())

    def test_12_compare(self):
        self.assert_same("compare", deflect.compare(IDEAL, "hidden.csv"))

    def test_13_diagnose(self):
        self.assert_same("diagnose", deflect.diagnose(IDEAL, "hidden.csv"))

    def test_14_plan(self):
        planned = deflect.plan(IDEAL, before="paper")
        self.assert_same("plan", planned)
        self.assertEqual(planned.measurements.text, pathlib.Path("better.csv").read_text())
        self.assertEqual(len(planned.rows()), len(planned.given["detectable"]))

    def test_99_every_command_was_seen(self):
        self.assertEqual(sorted(self.seen), sorted(session_of(ROOT / "README.md")))


class ReadmeOfThePackage(unittest.TestCase):
    def test_its_session_runs(self):
        """The first block of validation/python/README.md, as it stands there."""
        text = (ROOT / "validation/python/README.md").read_text(encoding="utf-8")
        session = re.search(r"## The session of the main README\n```python\n(.*?)```", text, re.DOTALL).group(1)
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                exec(compile(session, "README.md", "exec"), {})  # noqa: S102
            finally:
                os.chdir(before)


if __name__ == "__main__":
    unittest.main()
