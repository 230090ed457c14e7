"""Pictures of results by matplotlib, tables by pandas, and what a notebook shows."""

import base64
import contextlib
import io
import re
import subprocess
import sys
import tempfile
import types
import unittest
import unittest.mock

import numpy as np

import deflect
from every_result import IDEAL, results

try:
    import matplotlib.image
except ImportError:
    matplotlib = None
try:
    import pandas
except ImportError:
    pandas = None

@unittest.skipUnless(matplotlib, "matplotlib is not installed (apt install python3-matplotlib): no pictures")
class Pictures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.results = results()

    def pixels(self, figure):
        out = io.BytesIO()
        figure.savefig(out, format="png", dpi=100)
        out.seek(0)
        return matplotlib.image.imread(out)[:, :, :3]

    def test_every_kind_of_result_is_drawn(self):
        for name, result in self.results.items():
            with self.subTest(name):
                figure = result.plot()
                self.assertAlmostEqual(figure.get_figwidth() * 25.4, 170 if isinstance(result, deflect.StiffnessMap) else 160, places=6)
                pixels = self.pixels(figure)
                dark = (pixels.min(axis=2) < 0.9)
                self.assertGreater(dark.mean(), 0.005, "the picture is empty")
                # Nothing stands beyond the paper: its edge, half a millimetre, is white.
                for edge in (pixels[:2], pixels[-2:], pixels[:, :2], pixels[:, -2:]):
                    self.assertEqual(edge.min(), 1, "something is cut off at the edge")

    def test_no_text_stands_on_another(self):
        """Boxes of texts of one kind (headings, numbers of one axis) do not overlap."""
        for name, result in self.results.items():
            figure = result.plot()
            figure.canvas.draw()
            boxes = [(t.get_text(), t.get_window_extent()) for t in figure.texts if t.get_text()]
            for axes in (a for a in figure.axes if a.axison):
                for labels in (axes.get_xticklabels(), axes.get_yticklabels()):
                    shown = [(t.get_text(), t.get_window_extent()) for t in labels if t.get_text() and t.get_visible()]
                    self.apart(name, shown)
            self.apart(name, boxes)

    def apart(self, name, boxes):
        for i, (first, a) in enumerate(boxes):
            for second, b in boxes[i + 1:]:
                across, up = min(a.x1, b.x1) - max(a.x0, b.x0), min(a.y1, b.y1) - max(a.y0, b.y0)
                self.assertFalse(across > 1 and up > 1, f"{name}: '{first}' and '{second}' overlap")

    def test_numbers_of_fig10_are_drawn(self):
        """Points of the upper panel are the displacements, stems of the lower one what the theories differ by."""
        study = self.results["validation"]
        upper, lower = study.plot().axes[1:3]
        drawn = sorted(y for line in upper.lines for y in line.get_ydata())
        expected = sorted(p[theory]["xyz".index(p["load_axis"])] for p in study.points for theory in ("analytic", "msa"))
        np.testing.assert_array_equal(drawn, expected)
        differences = sorted((p["analytic"][k] - p["msa"][k]) for p in study.points
                             for k in ["xyz".index(p["load_axis"])])
        residuals = sorted(y for line in lower.lines if len(line.get_xdata()) == 9 for y in line.get_ydata())
        scale = {"fm": 1e12, "pm": 1e9, "nm": 1e6}[re.search(r"\((.m)\)", lower.get_ylabel()).group(1)]
        np.testing.assert_allclose(residuals, scale * np.array(differences), rtol=1e-12)

    def test_residuals_are_drawn(self):
        compared = self.results["comparison"]
        residuals = compared.residuals
        self.assertEqual(set(residuals["component"]), {"ux", "uy", "uz"})
        np.testing.assert_allclose(residuals["measured"] - residuals["predicted"], residuals["residual"], atol=1e-8)
        rms = np.sqrt((residuals["residual"]**2).mean())
        self.assertAlmostEqual(rms, compared.baseline["rmse_mm"], delta=1e-6)
        drawn = np.concatenate([line.get_ydata() for axes in compared.plot().axes for line in axes.lines
                                if len(line.get_ydata()) == compared.readings])
        np.testing.assert_allclose(sorted(drawn), sorted(1e3 * residuals["residual"]))

    def test_of_files_too(self):
        """A result that was read is drawn as the one that was written, but for residuals, which no file holds."""
        with tempfile.TemporaryDirectory() as folder:
            for name, result in self.results.items():
                with self.subTest(name):
                    result.save(folder + "/result.json")
                    read = deflect.read(folder + "/result.json")
                    if not isinstance(result, deflect.Comparison):
                        self.assertEqual(len(read.plot().axes), len(result.plot().axes))
                        continue
                    with self.assertRaisesRegex(deflect.InputError, "does not hold the residuals.*compare again"):
                        read.plot()
                    self.assertIn("<table", read._repr_html_())
            fit = self.results["fit"]
            fit.save(folder + "/fit.json")
            with self.assertRaisesRegex(AttributeError, "the file of a Fit has no 'model'"):
                deflect.read(folder + "/fit.json").model

    def test_into_a_figure_of_ones_own(self):
        from matplotlib.figure import Figure

        mine = Figure()
        self.assertIs(self.results["validation"].plot(mine), mine)
        self.assertTrue(mine.axes)

    def test_style_is_left_as_it_was(self):
        before = dict(matplotlib.rcParams)
        self.results["history"].plot()
        self.assertEqual(dict(matplotlib.rcParams), before)

    def test_notebooks_show_sentence_picture_table_and_report(self):
        for name, result in self.results.items():
            shown = result._repr_html_()
            self.assertIn("<table", shown, name)
            self.assertIn("<details>", shown, name)
            if name == "slice":
                continue
            png = base64.b64decode(re.search(r"base64,([^']*)'", shown).group(1))
            self.assertTrue(png.startswith(b"\x89PNG"), name)
            self.assertLess(len(shown), 300e3, name)
        self.assertIn(self.results["diagnosis"].sentence[:30], self.results["diagnosis"]._repr_html_())


@unittest.skipUnless(pandas, "pandas is not installed (apt install python3-pandas): no tables of it")
class Tables(unittest.TestCase):
    def test_rows_are_the_table(self):
        study = deflect.validate("haptic-6psu")
        table = study.to_dataframe()
        self.assertEqual(len(table), len(study.points))
        self.assertEqual(list(table["load_N"]), [p["load_N"] for p in study.points])
        self.assertEqual(len(deflect.frame("logan-5-8").solve().to_dataframe()), 4)
        data = deflect.simulate(IDEAL, campaign="paper", seed=1)
        again = deflect.Measurements.from_dataframe(data.to_dataframe())
        np.testing.assert_array_equal(again.columns["ux_mm"], data.columns["ux_mm"])
        self.assertEqual(deflect.compare(IDEAL, data.to_dataframe()).baseline, deflect.compare(IDEAL, data).baseline)


class Progress(unittest.TestCase):
    def test_in_a_terminal_a_line(self):
        with contextlib.redirect_stderr(io.StringIO()) as told:
            deflect.map(IDEAL, 3, progress=True)
        self.assertTrue(told.getvalue().startswith("\r"))
        self.assertTrue(told.getvalue().endswith("\rmap 100 %\n"), told.getvalue())

    def test_in_a_notebook_a_bar(self):
        """With what a notebook's kernel offers: an output that is written anew in its place."""
        shown = []

        class Handle:
            update = staticmethod(shown.append)

        def display(words, display_id):
            shown.append(words)
            return Handle if display_id else None

        kernel = types.SimpleNamespace(get_ipython=lambda: types.SimpleNamespace(kernel=True))
        shown_by = types.SimpleNamespace(HTML=str, display=display)
        with unittest.mock.patch.dict(sys.modules, {"IPython": kernel, "IPython.display": shown_by}):
            with contextlib.redirect_stderr(io.StringIO()) as told:
                deflect.map(IDEAL, 3, progress=True)
        self.assertEqual(told.getvalue(), "")
        self.assertIn("value='0.000'", shown[0])
        self.assertEqual(shown[-1], "<progress value='1.000' max='1'></progress> map 100 %")


class Without(unittest.TestCase):
    def test_what_is_missing_is_said(self):
        """Where matplotlib and pandas cannot be imported: what to install; results are shown all the same."""
        code = ("import sys; sys.modules['matplotlib'] = None; sys.modules['pandas'] = None\n"
                "import deflect\n"
                "s = deflect.load('haptic-6psu').solve(load=[50, 0, 0])\n"
                "for f in (s.plot, s.to_dataframe):\n"
                "    try: f()\n"
                "    except ImportError as e: print(e)\n"
                "print('<table' in s._repr_html_(), '<img' in s._repr_html_())\n")
        out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.splitlines()
        self.assertIn("apt install python3-matplotlib", out[0])
        self.assertIn("apt install python3-pandas", out[1])
        self.assertEqual(out[2], "True False")
