"""deflect.m in Octave: the numbers of the program, errors by kind, words with blanks and quotes."""

import json
import math
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ["DEFLECT_PROGRAM"]
OCTAVE = shutil.which("octave-cli")


@unittest.skipUnless(OCTAVE, "octave-cli is not installed (apt install octave): deflect.m is not tested")
class Octave(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def octave(self, code):
        script = self.folder / "script.m"
        script.write_text(f"addpath('{ROOT / 'validation/python/matlab'}');\n{code}\n")
        done = subprocess.run([OCTAVE, "--no-gui", "--norc", str(script)], cwd=self.folder, capture_output=True, text=True,
                              env={**os.environ, "HOME": str(self.folder)})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def test_solve(self):
        out = self.octave("""r = deflect("solve", "haptic-6psu", "--pose", [25 25 198.9], "--load", [-50 0 1/3]);
            printf("%.17g\\n", r.msa.displacement, r.analytic.stiffness.');
            disp(isequal(size(r.msa.stiffness), [6 6]));""").split()
        subprocess.run([PROGRAM, "solve", "haptic-6psu", "--pose", "25,25,198.9", f"--load=-50,0,{1 / 3!r}", "--json",
                        self.folder / "out.json", "--quiet"], check=True)
        content = json.loads((self.folder / "out.json").read_text())
        expected = content["msa"]["displacement"] + [x for row in content["analytic"]["stiffness"] for x in row]
        # Octave's jsondecode reads a number to within three units in its last place.
        for read, written in zip(map(float, out[:-1]), expected, strict=True):
            self.assertLessEqual(abs(read - written), 3 * math.ulp(written))
        self.assertEqual(out[-1], "1")

    def test_a_session(self):
        out = self.octave("""deflect("simulate", "haptic-6psu-ideal-joints", "--with", "joint_clearance,gap_mm=0.02", ...
                    "--campaign", "paper", "--seed", 3, "-o", "it's hidden.csv");
            [c, report] = deflect("compare", "haptic-6psu-ideal-joints", "it's hidden.csv");
            disp(c.readings); disp(ischar(report) && ! isempty(strfind(report, "Something is missing")));
            nothing = deflect("new", "--like", "scara", "-o", "mine.yaml");
            disp(isempty(nothing) && exist("mine.yaml", "file") == 2);""").split()
        self.assertEqual(out, ["27", "1", "1"])

    def test_errors_by_kind(self):
        out = self.octave("""function told(varargin)
              try
                deflect(varargin{:});
                disp("no error");
              catch e
                disp([e.identifier " " strrep(e.message, "\\n", " ")]);
              end
            end
            told("solve", "haptic-6pus"); told("solve", "haptic-6psu", "--pose", [1000 0 0]); told("slove");""")
        first, second, third = out.strip().splitlines()
        self.assertRegex(first, "^deflect:InputError .*haptic-6psu")
        self.assertRegex(second, "^deflect:MechanismError ")
        self.assertRegex(third, "^deflect:InputError ")


if __name__ == "__main__":
    unittest.main()
