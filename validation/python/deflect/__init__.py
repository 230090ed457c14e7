"""How far a mechanism's tool point, or a frame's sensors, move under load, by two independent theories; compared with
measurements; and which physical effect a model lacks.

>>> import deflect
>>> m = deflect.load("haptic-6psu")
>>> m.solve(pose=[25, 25, 198.9], load=[50, 0, 0]).displacement     # mm, rad

Units are those of files and results: mm, deg for poses, rad for displacements, N, Nmm. units="SI" where arrays go in and
out. Base axes; translation first.
"""

from . import _core
from .errors import Error, InputError, MechanismError, NumericalError
from .laws import law
from .measurements import Measurements
from .models import Frame, Model, Place, Remark, Sensor, Subject, frame, load
from .results import (Comparison, Diagnosis, Fit, FrameSolution, History, Plan, Prediction, Result, StiffnessMap,
                      Validation, Validity)
from .solution import Solution, TheoryAnswer
from .verbs import built_in, compare, diagnose, effects, fit, history, map, plan, predict, simulate, validate

__version__ = _core.version
theories = _core.theories

__all__ = ["Comparison", "Diagnosis", "Error", "Fit", "Frame", "FrameSolution", "History", "InputError", "Measurements",
           "MechanismError", "Model", "NumericalError", "Place", "Plan", "Prediction", "Remark", "Result", "Sensor",
           "Solution", "StiffnessMap", "Subject", "TheoryAnswer", "Validation", "Validity", "built_in", "compare",
           "diagnose", "effects", "fit", "frame", "history", "law", "load", "map", "plan", "predict", "simulate", "theories",
           "validate"]
