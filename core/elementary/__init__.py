"""Elementary functions of steps, the project's own: the same bits on every machine, and code a vector unit can run.

A machine's mathematical library picks its code by the processor, so the last bit of a sine differs from one kind of
machine to the next, and a call to it keeps a loop from becoming vector code. These are sums and products in a fixed
order without a branch, each within one unit in the last place. Roots, absolute values, rounding and tests for finite
numbers are instructions of the processor, exact by the standard, and stay with ``math``.
"""

from core.elementary.angle import atan2
from core.elementary.circle import cos, sin, sin_of_turns
from core.elementary.exponential import exp, expm1
from core.elementary.hyperbolic import tanh
from core.elementary.logarithm import log
from core.elementary.rounding import floor

__all__ = ["atan2", "cos", "exp", "expm1", "floor", "log", "sin", "sin_of_turns", "tanh"]
