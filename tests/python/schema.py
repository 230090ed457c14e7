"""Results are dataclasses equal to the JSON: one schema, against everything that the program writes."""

import copy
import dataclasses
import json
import os
import pathlib
import pickle
import re
import subprocess
import tempfile
import typing
import unittest

import numpy as np

import deflect
from deflect import _core, records
from deflect.verbs import RESULTS
from every_result import FREE, IDEAL, results

PROGRAM = os.environ["DEFLECT_PROGRAM"]

#: Commands whose --json is read, by lines; files that the lines before have written.
COMMANDS = f"""
solve haptic-6psu --pose 0,0,180 --load 0,0,50
solve tripteron --pose 500,500,500 --load 5,0,0 --theories analytic
solve delta --pose 0,0,-1000 --load 0,0,-5 --geometry second-order
solve scara --joints 0.1,0.2,100,0.3 --load 0,0,-10
solve hybrid --pose 0,0,-1440 --load 10,0,0
validate stewart-6ups
map gantry --n 3 --theories msa
map haptic-6psu --n 3 --x=-300,300
frame portal
frame sap2000-1-001
frame ansys-vm136
frame beam-on-springs
show delta
show free.yaml
check K.json --key msa.stiffness --device haptic-6psu --pose 20,0,180 --load 50,0,0
simulate {IDEAL} --with leg_defect,leg=4,factor=0.5 -o leg.csv
simulate truss-45 --with factor@D1bc,factor=0.3 -o truss.csv
compare {IDEAL} leg.csv
compare truss-45 truss.csv
compare truss-45 truss.csv --validation
diagnose truss-45 truss.csv --bootstrap 99
fit truss-45 truss.csv --free materials.steel.E --free members.D1bc.factor -o fitted.yaml
predict truss-45 --plan truss.csv
plan truss-45 --before paper -o planned.csv
history truss.csv truss-45 fitted.yaml
"""


class Equal(unittest.TestCase):
    def assert_equal_to(self, name, result, content):
        self.assertEqual(records.differences(type(result), content), [], name)
        self.assertEqual(result.to_dict(), content, name)

    def test_results_of_functions(self):
        for name, result in results().items():
            self.assert_equal_to(name, result, json.loads(result.json))
        self.assertEqual({type(r) for r in results().values()}, set(RESULTS.values()))
        # What is there in some results alone was among them.
        for name, member in (("play", "floating"), ("play", "rigid"), ("misfit", "assembly"), ("truss", "inside"),
                             ("errata", "errata"), ("loaded", "load"), ("used", "use"), ("used", "calibration"),
                             ("cannot stand", "motions"), ("reference", "ratio_to_reference")):
            self.assertTrue(results()[name].content.get(member), f"{name}: {member}")
        self.assertTrue(results()["tie"].ties)

    def test_results_of_the_program(self):
        """With their provenance."""
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            (folder / "free.yaml").write_text(FREE)
            results()["solution"].save(folder / "K.json")
            for line in COMMANDS.strip().splitlines():
                done = subprocess.run([PROGRAM, *line.split(), "--quiet", "--json", "out.json"], cwd=folder,
                                      capture_output=True, text=True)
                self.assertIn(done.returncode, (0, 4), line + done.stderr)
                content = json.loads((folder / "out.json").read_text())
                if content["kind"] == "simulation":
                    continue
                read = deflect.read(folder / "out.json")
                self.assert_equal_to(line, read, content)
                self.assertTrue(read.provenance.program.startswith("deflect "))
            (folder / "out.json").write_text('{"kind": "other"}')
            with self.assertRaises(deflect.InputError):
                deflect.read(folder / "out.json")

    def test_what_readers_of_results_want_is_in_the_schema(self):
        """The table by which `deflect report` checks results says the same of their members."""
        kinds = dict(_core.result_kinds())
        self.assertEqual(set(kinds), set(RESULTS))
        for kind, wanted in kinds.items():
            for path, type_name in wanted:
                with self.subTest(f"{kind}: {path}"):
                    self.check_member(RESULTS[kind], re.findall(r"\w+\??|\[\]|\{\}|@", path), type_name)

    def check_member(self, hint, steps, type_name):
        """The type at the path is the wanted one; what must be there always is. "?": readers do without, as with results
        of versions before."""
        for step in steps:
            origin, arguments = typing.get_origin(hint), typing.get_args(hint)
            if hint is records.Array:
                self.assertEqual(step, "[]")
                hint = float if type_name == "number" else records.Array
            elif step in ("[]", "{}"):
                self.assertIs(origin, list if step == "[]" else dict)
                hint = arguments[-1]
            elif origin is dict:
                hint = arguments[1]
            else:
                fields = {f.name: f for f in records.fields_of(hint)}
                field = next(f for f in fields.values() if f.others) if step == "@" else fields[step.rstrip("?")]
                hint = typing.get_args(field.type)[1 if field.others else 0] if field.maybe or field.others else field.type
                self.assertFalse(field.maybe and not step.endswith("?"))
        expected = {"text": (str,), "number": (float, int), "truth": (bool,), "object": (dict,), "list": (list,),
                    "number_or_null": (typing.Optional[float],)}.get(type_name, (records.Array,))
        found = typing.get_origin(hint) or hint
        if isinstance(found, type) and issubclass(found, records.Record):
            found = dict
        if hint is typing.Any:
            return
        if type_name == "number_or_null":
            self.assertEqual(hint, expected[0])
        elif type_name in ("list", "three", "six"):
            self.assertIn(found, (list, records.Array))
        else:
            self.assertIn(found, expected)

    def test_what_does_not_fit_is_told(self):
        content = json.loads(results()["history"].json)
        content["versions"][0]["new"] = 1
        del content["data"]
        content["versions"][0]["rmse_mm"] = "large"
        self.assertEqual(records.differences(deflect.History, content),
                         [".data: missing", ".versions[0].rmse_mm: 'large' is no float", ".versions[0].new: unknown"])


class Dataclasses(unittest.TestCase):
    def test_fields_are_members(self):
        d = results()["diagnosis"]
        self.assertTrue(dataclasses.is_dataclass(d))
        self.assertEqual({f.name for f in dataclasses.fields(d)} - set(d.content), {"provenance"})
        self.assertEqual(d.candidates[0].parameters[0].value, d.content["candidates"][0]["parameters"][0]["value"])
        self.assertEqual(dataclasses.asdict(d)["baseline"], d.content["baseline"])
        self.assertIn("verdict", dir(d))
        with self.assertRaises(dataclasses.FrozenInstanceError):
            d.verdict = "nothing"
        with self.assertRaisesRegex(AttributeError, "has no 'verdct'; it has kind, verdict"):
            d.verdct  # noqa: B018

    def test_by_name_as_in_the_json(self):
        s = results()["solution"]
        np.testing.assert_array_equal(s["msa"]["displacement"], s.by_theory["msa"].displacement)
        self.assertEqual(s["shares"][0]["part"], s.shares[0].part)
        self.assertEqual(s.get("geometry", "linear"), "linear")
        self.assertIn("analytic", s)
        self.assertNotIn("geometry", s)
        with self.assertRaisesRegex(KeyError, "has no 'geometry'"):
            s["geometry"]
        self.assertEqual(s.stiffness.shape, (6, 6))
        self.assertEqual(results()["fit"].posterior.covariance.shape[0], len(results()["fit"].posterior.names))

    def test_SI_is_of_the_arrays(self):
        m = deflect.load(IDEAL)
        mm, si = m.solve(load=[50, 0, 0]), m.solve(load=[50, 0, 0], units="SI")
        np.testing.assert_array_equal(si.by_theory["msa"].displacement, si.displacement)
        np.testing.assert_allclose(1e3 * si.displacement[:3], mm.displacement[:3], rtol=1e-14)
        self.assertEqual(si.to_dict(), mm.to_dict())
        again = pickle.loads(pickle.dumps(si))
        np.testing.assert_array_equal(again.stiffness, si.stiffness)

    def test_pickle_and_copy_of_every_kind(self):
        for name, result in results().items():
            before = copy.deepcopy(result)  # before its members were asked for, or after
            for other in (pickle.loads(pickle.dumps(result)), copy.copy(result), before):
                self.assertEqual(other, result, name)
                self.assertEqual(other.to_dict(), result.to_dict(), name)
                self.assertEqual(other.report, result.report, name)
                self.assertEqual(other.rows(), result.rows(), name)
        fitted = pickle.loads(pickle.dumps(results()["fit"]))
        self.assertEqual(fitted.model, results()["fit"].model)
        self.assertEqual(fitted.given, results()["fit"].given)
        self.assertEqual(pickle.loads(pickle.dumps(results()["plan"])).measurements, results()["plan"].measurements)
        candidate = results()["diagnosis"].candidates[0]
        for other in (pickle.loads(pickle.dumps(candidate)), copy.copy(candidate), copy.deepcopy(candidate)):
            self.assertEqual(other, candidate)
        self.assertNotEqual(candidate, results()["diagnosis"].candidates[1])

    def test_saved_and_read(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, result in results().items():
                result.save(folder + "/result.json")
                self.assertEqual(deflect.read(folder + "/result.json"), result, name)
