"""The worked scripts run, draw their pictures, and are what the notebooks show."""

import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

EXAMPLES = pathlib.Path(__file__).resolve().parent.parent.parent / "validation/python/examples"
sys.path.insert(0, str(EXAMPLES))

import make_notebooks  # noqa: E402

try:
    import matplotlib  # noqa: F401
except ImportError:
    matplotlib = None

PICTURES = {"own_figures": ["fig10", "fig11", "fig11-of-map"], "truss": ["truss", "truss-residuals", "truss-diagnosis"],
            "missing_effect": ["residuals", "modulus", "diagnosis", "history"], "measurement_plan": ["alike"],
            "own_effect": ["own-effect", "own-fit", "own-history", "own-curve"]}


def size_of(png):
    data = png.read_bytes()
    assert data.startswith(b"\x89PNG\r\n\x1a\n"), png
    return struct.unpack(">II", data[16:24])


class Examples(unittest.TestCase):
    def test_they_are_these(self):
        self.assertEqual({f.stem for f in make_notebooks.scripts()}, set(PICTURES))

    def test_notebooks_are_the_scripts_with_outputs(self):
        for script in make_notebooks.scripts():
            file = script.with_suffix(".ipynb")
            self.assertLess(file.stat().st_size, 300e3, file)
            cells = json.loads(file.read_text(encoding="utf-8"))["cells"]
            self.assertEqual([(c["cell_type"], "".join(c["source"])) for c in cells], make_notebooks.cells_of(script),
                             f"{file.name} is not of {script.name}: run make_notebooks.py {script.stem}")
            outputs = [o for c in cells for o in c.get("outputs", [])]
            self.assertTrue(any("image/png" in o.get("data", {}) or "text/html" in o.get("data", {}) for o in outputs))
            self.assertFalse([o for o in outputs if o["output_type"] == "error"])


@unittest.skipUnless(matplotlib, "matplotlib is not installed (apt install python3-matplotlib): examples are not run")
class Run(unittest.TestCase):
    """A test for each script, made below."""

    def run_script(self, name):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-W", "error", str(EXAMPLES / f"{name}.py")], cwd=folder,
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            for picture in PICTURES[name]:
                width, height = size_of(pathlib.Path(folder) / f"{picture}.png")
                self.assertGreater(min(width, height), 200)


for each in PICTURES:
    setattr(Run, f"test_{each}", lambda self, name=each: self.run_script(name))

if __name__ == "__main__":
    unittest.main()
