"""Arguments that cannot be: each is an InputError that names it, what was given and what is wanted; one text or path in
place of a list counts as a list of one."""

import os
import pathlib
import tempfile
import unittest

import numpy as np

import deflect

try:
    import pandas
except ImportError:
    pandas = None

IDEAL = "haptic-6psu-ideal-joints"
HOME = [0, 0, 180]


class Arguments(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.m = deflect.load(IDEAL)
        cls.data = deflect.simulate(cls.m, campaign="paper", seed=4)
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        cls.data.to_csv(cls.folder / "paper.csv")

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def file(self, name, content):
        path = self.folder / name
        path.write_bytes(content)
        return str(path)

    def refused(self, words, call):
        with self.subTest(words):
            with self.assertRaisesRegex(deflect.InputError, words):
                call()


class Sessions(Arguments):
    def test_none(self):
        m = self.m
        self.refused("give at least one session", lambda: deflect.diagnose(m, []))
        self.refused("give at least one version", lambda: deflect.history(self.data, []))
        self.refused("give at least one result", lambda: deflect.report([], self.folder / "page.html"))
        self.refused("points: give at least one", lambda: deflect.validate(m, np.zeros((0, 3))))
        for verb in (deflect.compare, deflect.predict):
            self.refused(r"\[\]: these are no measurements", lambda: verb(m, []))
        self.refused(r"\[\]: these are no measurements", lambda: deflect.fit(m, [], "materials.steel.E"))

    def test_the_same_twice(self):
        path = str(self.folder / "paper.csv")
        for twice in ([self.data, self.data], [path, path], [path, self.data]):
            self.refused("the same numbers twice are no replicates", lambda: deflect.diagnose(self.m, twice))

    def test_the_compiled_module_checks_too(self):
        core = deflect._core
        noise = core.Noise(None, None, False)
        self.refused("give at least one version", lambda: core.history([], ("", ""), noise, 1, None))


class Numbers(Arguments):
    def test_whole_numbers(self):
        m, data = self.m, self.data
        seeds = r"give a whole number from 0 to 2\^64 - 1"
        self.refused("seed = -1: " + seeds, lambda: deflect.simulate(m, seed=-1))
        self.refused("seed = 1.5: " + seeds, lambda: deflect.simulate(m, seed=1.5))
        self.refused(f"seed = {2**70}: " + seeds, lambda: deflect.simulate(m, seed=2**70))
        self.refused("machine = -3: " + seeds, lambda: deflect.simulate(m, machine=-3))
        self.refused("seed = True: ", lambda: deflect.simulate(m, seed=True))
        self.refused("elements = 1.5: give a whole", lambda: m.solve(elements=1.5))
        for threads in (-1, "a", 1025):
            words = f"threads = {threads!r}: give a whole number from 0 to 1024"
            self.refused(words, lambda: m.stiffness(HOME, threads=threads))
            self.refused(words, lambda: deflect.compare(m, data, threads=threads))
            self.refused(words, lambda: deflect.map(m, 2, threads=threads))
        self.refused("bootstrap = 'x': give", lambda: deflect.diagnose(m, data, bootstrap="x"))
        self.refused(r"n: \(3, 3\): give a whole number, or three", lambda: deflect.map(m, (3, 3)))
        self.refused("n = 'a': give a whole number", lambda: deflect.map(m, "a"))
        self.refused("leg = 'a': give a whole number", lambda: m.with_effect("leg_defect", leg="a"))
        self.refused("readings = 2.5: give a whole", lambda: deflect.plan(m, before="paper", readings=2.5))
        largest = deflect.simulate(m, campaign="paper", seed=2**64 - 1)
        self.assertEqual(len(largest), len(self.data))
        self.assertEqual(m.solve(elements=np.int64(2)), m.solve(elements=2.0))

    def test_numbers(self):
        m, data = self.m, self.data
        self.refused("max_force: '10' is no number", lambda: deflect.plan(m, before="paper", max_force="10"))
        self.refused("max_force = -3: give N of zero or more", lambda: deflect.plan(m, before="paper", max_force=-3))
        self.refused("noise: '0.002' is no number", lambda: deflect.simulate(m, noise="0.002"))
        self.refused("sigma: 1j is no number", lambda: deflect.compare(m, data, sigma=1j))
        self.refused("gap_mm: 'a' is no number", lambda: m.with_effect("joint_clearance", gap_mm="a"))
        self.refused("step: 'a' is no number", lambda: m.derivatives("materials.steel.E", HOME, step="a"))
        self.refused("within = nan", lambda: deflect.law(lambda f: f, [0, 1], within=np.nan))
        self.refused("progress: 3 is neither", lambda: deflect.map(m, 2, progress=3))
        self.refused("errata: 'no' is neither True nor False", lambda: deflect.validate(m, errata="no"))

    def test_rows_of_numbers(self):
        m = self.m
        self.refused("pose: text, .'abc'.: real numbers", lambda: m.solve("abc"))
        self.refused("pose: 3: a list of numbers", lambda: m.solve(3))
        self.refused(r"pose: \[\[0, 0, 180\]\]: a list of numbers", lambda: m.solve([HOME]))
        self.refused("pose: there are no numbers", lambda: m.solve(pose=[]))
        self.refused("joints: there are no numbers", lambda: m.solve(joints=[]))
        self.refused("joints: nan is no finite number", lambda: m.solve(joints=[np.nan] * 6))
        self.refused("pose: 2 numbers; 3 or 6 are wanted", lambda: m.solve([1, 2]))
        self.refused("rows of different length", lambda: m.stiffness([HOME, [0, 0]]))

    def test_texts(self):
        m = self.m
        self.refused("path: 3 is no text", lambda: m.edited(3, 3))
        self.refused("name: 3 is no text", lambda: m.named(3))
        self.refused("geometry: 3 is no text", lambda: m.solve(geometry=3))
        self.refused("theories: 3 is no list", lambda: m.solve(theories=3))
        self.refused("effect 3: write a name", lambda: deflect.simulate(m, 3))
        self.refused("3: this is no result", lambda: deflect.report([3], self.folder / "page.html"))


class NoRealNumbers(Arguments):
    """Complex numbers do not lose their imaginary part, dates are no numbers."""

    def test_everywhere(self):
        m, turned, dates = self.m, np.array([0, 0, 180 + 1j]), np.array(["2020", "2021", "2022"], dtype="M8[Y]")
        for what, words in ((turned, "complex numbers"), (list(turned), "complex numbers"), (dates, "dates")):
            self.refused("pose: " + words, lambda: m.solve(what))
            self.refused("load: " + words, lambda: m.solve(load=what))
            self.refused("load: " + words, lambda: m.solve(load=what, units="SI"))
            self.refused("poses: " + words, lambda: m.stiffness(what))
            self.refused("at: " + words, lambda: deflect.predict(m, at=what))
            self.refused("points: " + words, lambda: deflect.validate(m, what))
            self.refused("load: " + words, lambda: deflect.map(m, 2, load=what))
        self.refused("K: complex numbers", lambda: deflect.check(1j * np.eye(6)))
        self.refused("passive: complex numbers", lambda: deflect.check(np.eye(6), passive=1j * np.eye(6)[:, :1]))
        self.refused("the curve: .* is no number", lambda: deflect.law(lambda f: 1j * f, [0, 1]))

    def test_columns(self):
        poses, loads, d = np.tile([0, 0, 180.0], (2, 1)), np.ones((2, 3)), np.zeros((2, 3))

        def made(displacements=d, **columns):
            return deflect.Measurements.from_arrays(poses, loads, displacements, columns=columns)

        self.refused("displacements: complex numbers", lambda: made(1j * d))
        self.refused("column sigma_u_mm: 1j is no number", lambda: made(sigma_u_mm=[1j, 1]))
        self.refused("column sigma_u_mm: .*timedelta64.* is no number",
                     lambda: made(sigma_u_mm=np.array([1, 2], dtype="m8[s]")))
        for one in (0.002, np.float64(0.002), np.array(0.002), "0.002"):
            self.refused("column sigma_u_mm: .*0.002.* is no list", lambda: made(sigma_u_mm=one))
        self.refused("column ux_mm is given twice", lambda: made(ux_mm=[9.0]))
        self.refused("no columns", deflect.Measurements.from_arrays)
        np.testing.assert_array_equal(made([[1, None, 3], [4, 5, 6]]).columns["uy_mm"], [np.nan, 5])

    @unittest.skipUnless(pandas, "pandas is not installed (apt install python3-pandas)")
    def test_of_pandas(self):
        frame = self.data.to_dataframe()
        without = frame.copy()
        without.loc[0, "ux_mm"] = np.nan
        empty = frame.convert_dtypes()
        empty.loc[0, "ux_mm"] = pandas.NA
        self.assertEqual(deflect.compare(self.m, empty).baseline, deflect.compare(self.m, without).baseline)
        for value in (pandas.Timestamp("2020"), pandas.Timedelta(3), 1j):
            self.refused("column ux_mm: .* is no number", lambda: deflect.compare(self.m, frame.assign(ux_mm=value)))
        twice = pandas.concat([frame, frame[["ux_mm"]]], axis=1)
        self.refused("column ux_mm is given twice", lambda: deflect.compare(self.m, twice))
        self.refused("no columns", lambda: deflect.compare(self.m, pandas.DataFrame()))


class Files(Arguments):
    def test_not_utf8(self):
        byte = self.file("lat.csv", b"pose,ux_mm\n0,\xb5\n")
        words = "lat.csv:2: byte 0xB5 is not UTF-8: save the file as UTF-8"
        self.refused(words, lambda: deflect.compare(self.m, byte))
        self.refused(words, lambda: deflect.Measurements.from_csv(byte))
        self.refused(words, lambda: deflect.load(byte))
        self.refused(words, lambda: deflect.report([byte], self.folder / "page.html"))
        self.refused(words, lambda: deflect.read(byte))
        self.refused(words, lambda: deflect.effects(self.m, byte))
        wide = self.file("wide.csv", b"\xff\xfep\x00")
        self.refused("wide.csv:1: the file is UTF-16", lambda: deflect.compare(self.m, wide))
        binary = self.file("binary", b"ELF\n\x00\xd0")
        self.refused("binary:2: there is a NUL byte", lambda: deflect.compare(self.m, binary))

    def test_lists_in_lists(self):
        deep = self.file("deep.json", 100_000 * b"[")
        self.refused("deep.json: this is no result: .*too deeply", lambda: deflect.read(deep))


class ListsOfOne(Arguments):
    def test_one_in_place_of_a_list(self):
        m, data, path = self.m, self.data, "materials.steel.E"
        alone = deflect.history(data, IDEAL)
        self.assertEqual(alone, deflect.history(data, [IDEAL]))
        self.assertEqual(alone, deflect.history(data, m))
        prior = path + "=210 GPa ± 2 %"
        self.assertEqual(deflect.fit(m, data, path, prior=prior), deflect.fit(m, data, [path], prior=[prior]))
        self.assertEqual(deflect.compare(m, data, validation=True, free=path),
                         deflect.compare(m, data, validation=True, free=[path]))
        compared = deflect.compare(m, data)
        compared.save(self.folder / "compared.json")
        for one in (compared, self.folder / "compared.json", str(self.folder / "compared.json")):
            deflect.report(one, self.folder / "page.html")
            self.assertGreater(os.path.getsize(self.folder / "page.html"), 1000)
        self.refused("paths: give at least one", lambda: m.derivatives([], HOME))


class Plans(Arguments):
    def test_what_goes_with_before(self):
        m, data = self.m, self.data
        for name, value in (("group", 2), ("readings", 5), ("probability", 0.5)):
            self.refused(f"{name} is of a plan after a diagnosis", lambda: deflect.plan(m, before=data, **{name: value}))
        self.refused("leave out the diagnosis and its data", lambda: deflect.plan(m, before=data, data=data))
        self.refused("use: wants before=CAMPAIGN", lambda: deflect.plan(m, "diagnosis.json", data, use=data))
        self.refused("give a diagnosis, or before=CAMPAIGN", lambda: deflect.plan(m))


if __name__ == "__main__":
    unittest.main()
