r"""Flicker noise: a sum of first-order Markov processes with times of correlation a decade apart.

Nine processes, each exact at its own samples, have one variance and the times :math:`T_i=10^iT_0`. With a variance of
:math:`c^2\ln10`, the one-sided density of the sum is :math:`c^2/f` to within the ripple, and its Allan deviation is
flat at :math:`\sqrt{2\ln2}\,c` from :math:`10T_0` to :math:`10^7T_0` within +1 and -4.5 %, and within 1.5 % a decade
inside. Process i takes a step every :math:`10^i` samples, so that a sample costs 1.1 random numbers and all processes
share one decay.
"""

from __future__ import annotations

import math

from core.block import Context
from core.elementary import exp, expm1, log
from core.kernel import kernel
from core.noise import key, normal
from core.record import Choice, Record, Vector, vector

PROCESSES = 9
"""Markov processes, one for each decade."""
ROOT_VARIANCE = math.sqrt(log(10.0))
"""Deviation of a process over the root of the density at 1 Hz."""


class PackedFlicker(Record):
    """Deviation of a process, decay and kick of the processes, ticks of a sample, streams."""

    size: float
    decay: float
    kick: float
    every: Choice
    keys: Vector = vector(PROCESSES)


class Flicker(Record):
    """The Markov processes, of unit variance."""

    processes: Vector = vector(PROCESSES)


def pack_flicker(p: PackedFlicker, context: Context, stream: str, size: float, samples: float) -> None:
    """Pack the processes.

    Parameters
    ----------
    p : PackedFlicker
        Written.
    context : Context
        Of the block.
    stream : str
        Name of the noise streams.
    size : float
        Deviation of a process.
    samples : float
        Time of correlation of the fastest process.
    """
    p.size = size
    p.decay, p.kick = exp(-1.0 / samples), math.sqrt(-expm1(-2.0 / samples))
    p.every = context.every
    for i in range(PROCESSES):
        p.keys[i] = key(context.seed, f"{stream}.{i}")


def start_flicker(s: Flicker, context: Context, stream: str) -> None:
    """Begin anywhere: the noise has an infinite past."""
    own = key(context.seed, stream)
    for i in range(PROCESSES):
        s.processes[i] = normal(own, float(i))


@kernel
def flicker_now(p: PackedFlicker, s: Flicker, tick: float) -> float:
    """Return the noise of this sample and advance to the next."""
    total = 0.0
    for i in range(PROCESSES):
        total += s.processes[i]
    sample = int(tick / p.every)
    for i in range(PROCESSES):
        s.processes[i] = p.decay * s.processes[i] + p.kick * normal(p.keys[i], float(sample))
        if sample % 10 != 0:
            break
        sample //= 10
    return p.size * total
