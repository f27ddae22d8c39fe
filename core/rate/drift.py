r"""Noise of an angular rate by the three figures of an Allan plot (IEEE 952): N, B and K.

.. math::
    \Omega_n=N\,w+B\,f+K\int w\,dt,\quad
    \sigma^2(\tau)=\frac{N^2}{\tau}+\frac{2\ln2}\pi B^2+\frac{K^2\tau}3

White noise keeps a value of the deviation :math:`N/\sqrt{T_0}` for :math:`T_0`, 1 ms or one sample: nothing turns at
twice the frequency of a vibrating mass, from where a demodulation would fold noise into the rate. The random walk steps
by :math:`K\sqrt{dt}`. Flicker
is a sum of nine first-order Markov processes, each exact at its own samples, with one variance
:math:`B^2\ln10/\pi` and times of correlation a decade apart, :math:`T_i=10^iT_0`: its density is
:math:`B^2/2\pi f` to within the ripple. Process i takes a step every :math:`10^i` samples, so that a sample costs
1.1 random numbers and all processes share one decay. The Allan deviation is flat at :math:`0.664B` from
:math:`10T_0` to :math:`10^7T_0` within +1 and -4.5 %, and within 1.5 % a decade inside. :math:`T_0` is 1 ms, or ten
samples where these are longer: 0.01 to 10^4 s at 10 kHz and above.
"""

from __future__ import annotations

import math

from core.block import BlockParams, Context, parameter
from core.elementary import exp, expm1, floor, log
from core.kernel import kernel
from core.noise import key, normal
from core.record import Choice, Record, Vector, vector
from core.units import DEG_H_PER_DEG_S, DEG_H_RT_H_PER_DEG_S_RT_S, DEG_RT_H_PER_DEG_RT_S, MS_PER_S

PROCESSES = 9
"""Markov processes of the flicker, one for each decade."""
SHORTEST_MS, SHORTEST_SAMPLES = 1.0, 10.0
"""How long white noise keeps a value, and time of correlation of the fastest process: in ms and at least in samples."""


class DriftParams(BlockParams):
    """Noise of every angular rate."""

    angle_random_walk_deg_rt_h: float = parameter(
        0.0, "angle random walk N", "deg/rt h", equation="noise", ge=0, le=1e6
    )
    bias_instability_deg_h: float = parameter(0.0, "bias instability B", "deg/h", equation="noise", ge=0, le=1e9)
    rate_random_walk_deg_h_rt_h: float = parameter(
        0.0, "rate random walk K", "deg/h/rt h", equation="noise", ge=0, le=1e9
    )


class PackedDrift(Record):
    """Deviations in deg/s, decay and kick of the Markov processes, ticks of a white value and a sample, streams."""

    white: float
    held: float
    flicker: float
    walk: float
    decay: float
    kick: float
    every: Choice
    white_key: float
    walk_key: float
    flicker_keys: Vector = vector(PROCESSES)


class Drift(Record):
    """The random walk in deg/s, and the Markov processes, of unit variance."""

    walk: float
    flicker: Vector = vector(PROCESSES)


def pack_drift(p: PackedDrift, params: DriftParams, context: Context) -> None:
    """Pack the noise of a sample."""
    dt_s = context.dt_ms / MS_PER_S
    held = max(1, round(SHORTEST_MS / context.dt_ms))
    p.white = params.angle_random_walk_deg_rt_h / DEG_RT_H_PER_DEG_RT_S / math.sqrt(held * dt_s)
    p.held = held * context.every
    p.flicker = params.bias_instability_deg_h / DEG_H_PER_DEG_S * math.sqrt(log(10.0) / math.pi)
    p.walk = params.rate_random_walk_deg_h_rt_h / DEG_H_RT_H_PER_DEG_S_RT_S * math.sqrt(dt_s)
    samples = max(SHORTEST_MS / context.dt_ms, SHORTEST_SAMPLES)
    p.decay, p.kick = exp(-1.0 / samples), math.sqrt(-expm1(-2.0 / samples))
    p.every = context.every
    p.white_key, p.walk_key = key(context.seed, "rate.white"), key(context.seed, "rate.walk")
    for i in range(PROCESSES):
        p.flicker_keys[i] = key(context.seed, f"rate.flicker.{i}")


def start_drift(s: Drift, context: Context) -> None:
    """Begin the walk at 0 and the flicker anywhere: it has an infinite past."""
    stream = key(context.seed, "rate.flicker")
    for i in range(PROCESSES):
        s.flicker[i] = normal(stream, float(i))


@kernel
def drift_now(p: PackedDrift, s: Drift, tick: float) -> float:
    """Return the noise of this sample in deg/s and advance to the next."""
    noise = s.walk
    if p.white > 0.0:
        noise += p.white * normal(p.white_key, floor(tick / p.held))
    if p.walk > 0.0:
        s.walk += p.walk * normal(p.walk_key, tick)
    if p.flicker > 0.0:
        total = 0.0
        for i in range(PROCESSES):
            total += s.flicker[i]
        noise += p.flicker * total
        sample = int(tick / p.every)
        for i in range(PROCESSES):
            s.flicker[i] = p.decay * s.flicker[i] + p.kick * normal(p.flicker_keys[i], float(sample))
            if sample % 10 != 0:
                break
            sample //= 10
    return noise
