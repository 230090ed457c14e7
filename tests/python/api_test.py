"""What is public: explained, with types, and the stubs are those of the compiled module."""

import ast
import inspect
import pathlib
import re
import unittest

import deflect
from deflect import _core

PACKAGE = pathlib.Path(deflect.__file__).parent
STUBS = ast.parse((PACKAGE / "_core.pyi").read_text(encoding="utf-8"))


def members_of(kind):
    """Public methods and properties that a class of this package defines, by name."""
    out = {}
    for base in kind.__mro__:
        if base.__module__.startswith("deflect"):
            for name, value in vars(base).items():
                if not name.startswith("_") and (callable(value) or isinstance(value, (property, classmethod))
                                                 or hasattr(value, "func")):
                    out.setdefault(name, value)
    return out


def function_of(member):
    for part in ("fget", "func", "__func__"):
        member = getattr(member, part, None) or member
    return member


def public_functions():
    """(name, function) of functions, methods and properties."""
    for name in deflect.__all__:
        value = getattr(deflect, name)
        if inspect.isclass(value):
            for member, each in members_of(value).items():
                yield f"{name}.{member}", function_of(each)
        elif inspect.isfunction(value):
            yield name, value


class Explained(unittest.TestCase):
    def test_all_is_what_there_is(self):
        self.assertEqual(sorted(set(deflect.__all__)), sorted(deflect.__all__))
        public = {n for n in vars(deflect) if not n.startswith("_")}
        modules = {n for n in public if inspect.ismodule(getattr(deflect, n))}
        self.assertEqual(public - modules, set(deflect.__all__) - modules)

    def test_every_public_name_has_a_docstring(self):
        for name in deflect.__all__:
            value = getattr(deflect, name)
            if inspect.isclass(value) or inspect.ismodule(value):
                self.assertTrue(vars(value).get("__doc__"), name)
        for name, function in public_functions():
            self.assertTrue(function.__doc__, f"{name} has no docstring")

    def test_parts_of_results_too(self):
        for module in (deflect.schema, deflect.schema_measured, deflect.schema_fitted, deflect.schema_shapes):
            for name, kind in vars(module).items():
                if inspect.isclass(kind) and kind.__module__ == module.__name__:
                    self.assertTrue(kind.__doc__ and not kind.__doc__.startswith(name + "("), name)

    def test_functions_say_their_errors_and_shapes(self):
        """Verbs and what computes name the exceptions; what takes or gives arrays says their shapes."""
        for name in ("compare", "diagnose", "fit", "predict", "simulate", "plan", "history", "validate", "map", "effects",
                     "check", "report", "read", "load", "frame", "law", "Model.solve", "Model.stiffness",
                     "Model.displacement", "Model.solve_many", "Model.derivatives", "Model.export", "Frame.solve",
                     "Subject.edited", "Subject.with_effect", "Subject.show", "Measurements.from_arrays"):
            words = dict(public_functions())[name].__doc__
            self.assertRegex(words, r"Error|errors? .*as for|Arguments and errors", name)
        for name in ("Model.solve", "Model.stiffness", "Model.displacement", "Model.derivatives", "Model.home",
                     "Measurements.from_arrays", "Measurements.columns", "StiffnessMap.columns", "Comparison.residuals",
                     "Solution.displacement", "Solution.stiffness", "FrameSolution.members", "check", "validate"):
            self.assertRegex(dict(public_functions())[name].__doc__, r"\((n|m|k|\d)(, ?(n|m|k|\d|number of paths))*,?\)", name)

    def test_every_argument_is_in_the_docstring_or_says_itself(self):
        """Arguments of the verbs whose unit or form the name does not tell are explained."""
        for name in ("compare", "diagnose", "fit", "predict", "simulate", "plan", "check"):
            function = getattr(deflect, name)
            for argument in inspect.signature(function).parameters:
                if argument in ("model", "threads", "progress", "group", "readings", "probability", "max_force",
                                "max_moment", "forces_only", "max_cases", "poses", "max_poses", "seed", "use", "aim", "theories",
                                "tolerances", "outliers", "geometry", "elements", "machine"):
                    continue  # as the options of the program
                self.assertRegex(function.__doc__, rf"``{argument}|\b{argument}\b|as for compare", f"{name}({argument})")


class Typed(unittest.TestCase):
    def test_every_public_function_has_types(self):
        for name, function in public_functions():
            signature = inspect.signature(function)
            self.assertIsNot(signature.return_annotation, inspect.Signature.empty, f"{name}: return type")
            for argument in list(signature.parameters.values()):
                if argument.name not in ("self", "cls", "memo"):
                    self.assertIsNot(argument.annotation, inspect.Parameter.empty, f"{name}({argument.name})")

    def test_the_package_says_that_it_is_typed(self):
        self.assertTrue((PACKAGE / "py.typed").exists())

    def test_stubs_are_of_the_compiled_module(self):
        """Every name, and as many arguments."""
        stubs = {node.name if hasattr(node, "name") else node.target.id: node for node in STUBS.body
                 if isinstance(node, (ast.FunctionDef, ast.ClassDef, ast.AnnAssign))}
        private = {"NamedText", "Progress"}
        self.assertEqual({n for n in vars(_core) if not n.startswith("_")}, set(stubs) - private)
        for name, node in stubs.items():
            if isinstance(node, ast.FunctionDef):
                self.assertEqual(self.arguments_of(getattr(_core, name)), len(node.args.args), name)
            elif isinstance(node, ast.ClassDef):
                self.check_class(node, getattr(_core, name))

    def arguments_of(self, function):
        """pybind11 writes the signature in the first line: "solve(arg0: …, arg1: …) -> …"."""
        return len(re.findall(r"\barg\d+:|\bself:", function.__doc__.splitlines()[0]))

    def check_class(self, node, kind):
        stubs = {m.name: m for m in node.body if isinstance(m, ast.FunctionDef)}
        attributes = {m.target.id for m in node.body if isinstance(m, ast.AnnAssign)}
        found = {n for n in vars(kind) if not n.startswith("_")}
        self.assertEqual(found, {n for n in stubs if n != "__init__"} | attributes, node.name)
        for name, stub in stubs.items():
            self.assertEqual(self.arguments_of(getattr(kind, name)), len(stub.args.args), f"{node.name}.{name}")


if __name__ == "__main__":
    unittest.main()
