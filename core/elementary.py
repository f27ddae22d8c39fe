"""Elementary functions of steps: one place, so that they can be exchanged for others.

They are those of the machine's mathematical library. Roots, absolute values and tests for finite numbers are
instructions of the processor and stay with ``math``.
"""

from __future__ import annotations

from math import atan2, cos, exp, floor, log, pow, sin, tanh

__all__ = ["atan2", "cos", "exp", "floor", "log", "pow", "sin", "tanh"]
