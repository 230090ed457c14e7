"""`pip install` from the checkout, without a network: the package and its data in another folder, away from the build."""

import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PACKAGE = pathlib.Path(__file__).resolve().parent.parent.parent / "validation/python"
NEEDED = [name for name in ("pip", "setuptools", "wheel") if importlib.util.find_spec(name) is None]


class Install(unittest.TestCase):
    @unittest.skipIf(NEEDED, f"not installed: {' '.join(NEEDED)} (apt install python3-pip): pip install is not tried")
    def test_pip_install(self):
        before = sorted(PACKAGE.rglob("*"))
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-m", "pip", "install", "--no-index", "--no-deps",
                                   "--no-build-isolation", "--no-cache-dir", "--target", folder, str(PACKAGE)],
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            code = ("import deflect; m = deflect.load('haptic-6psu'); print(deflect.__file__, deflect.__version__, "
                    "*m.solve([25, 25, 198.9], [50, 0, 0]).displacement.tolist(), len(deflect.effects())); "
                    "m.export('loaded.msh')  # by the module with Gmsh")
            environment = {**os.environ, "PYTHONPATH": folder}
            out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=folder,
                                 env=environment).stdout.split()
            self.assertTrue(out[0].startswith(folder), out[0])
            self.assertTrue((pathlib.Path(folder) / "loaded.msh").exists())
            here = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                                  cwd=folder).stdout.split()
            self.assertEqual(out[1:], here[1:])
        self.assertEqual([f for f in sorted(PACKAGE.rglob("*")) if "__pycache__" not in str(f)],
                         [f for f in before if "__pycache__" not in str(f)], "pip left files in the checkout")


if __name__ == "__main__":
    unittest.main()
