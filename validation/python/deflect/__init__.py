"""How far a mechanism's tool point, or a frame's sensors, move under load, by two independent theories; compared with
measurements; and which physical effect a model lacks.

>>> import deflect
>>> m = deflect.load("haptic-6psu")
>>> m.solve(pose=[25, 25, 198.9], load=[50, 0, 0]).displacement     # mm, rad

Units are those of files and results: mm, deg for poses, rad for displacements, N, Nmm. units="SI" where arrays go in and
out. Base axes; translation first.
"""

from . import _core, records, schema, schema_fitted, schema_measured, schema_shapes
from .errors import Error, InputError, MechanismError, NumericalError
from .laws import law
from .measurements import Measurements
from .models import Frame, Model, Place, Remark, Sensor, Subject, frame, load
from .records import Record
from .results import (Comparison, Diagnosis, Fit, Foresight, History, Plan, Prediction, Result, Validation, Validity)
from .results_of_shapes import Check, Drawing, FrameSolution, StiffnessMap
from .schema import TheoryAnswer
from .solution import Solution
from .verbs import (built_in, check, compare, diagnose, effects, fit, history, map, plan, predict, read, report, simulate,
                    validate)

__version__: str = _core.version
theories: tuple[str, ...] = _core.theories

__all__ = ["Check", "Comparison", "Diagnosis", "Drawing", "Error", "Fit", "Foresight", "Frame", "FrameSolution", "History",
           "InputError", "Measurements", "MechanismError", "Model", "NumericalError", "Place", "Plan", "Prediction",
           "Record", "Remark", "Result", "Sensor", "Solution", "StiffnessMap", "Subject", "TheoryAnswer", "Validation",
           "Validity", "built_in", "check", "compare", "diagnose", "effects", "fit", "frame", "history", "law", "load",
           "map", "plan", "predict", "read", "records", "report", "schema", "schema_fitted", "schema_measured",
           "schema_shapes", "simulate", "theories", "validate"]
