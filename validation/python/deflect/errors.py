"""Exceptions by kind, as the exit codes of the program: input 2, mechanism 3, numerical 4."""

from __future__ import annotations


class Error(Exception):
    """Base of the three."""


class InputError(Error, ValueError):
    """Bad input: a file, an argument or a value. The message names file, line, path, value and remedy."""


class MechanismError(Error):
    """An impossible model: a pose out of reach, a mechanism that cannot stand.

    ``motions``: where it cannot stand, the ways in which it moves without resistance: a list of
    ``{"words": str, "bodies": [str], "held_by_locking": [str]}``; else empty.
    """

    def __init__(self, message: str, motions: list[dict] | None = None) -> None:
        super().__init__(message)
        self.motions = list(motions or [])

    def __reduce__(self):
        return type(self), (self.args[0], self.motions)


class NumericalError(Error, ArithmeticError):
    """Correct input whose solution was not found, or whose answer fails a check."""
