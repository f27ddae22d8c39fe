r"""Noise of an angular rate by the three figures of an Allan plot (IEEE 952): N, B and K.

.. math::
    \Omega_n=N\,w+B\,f+K\int w\,dt,\quad
    \sigma^2(\tau)=\frac{N^2}{\tau}+\frac{2\ln2}\pi B^2+\frac{K^2\tau}3

White noise keeps a value of the deviation :math:`N/\sqrt{T_0}` for :math:`T_0`, 1 ms or one sample: nothing turns at
twice the frequency of a vibrating mass, from where a demodulation would fold noise into the rate. The random walk steps
by :math:`K\sqrt{dt}`. Flicker is the noise of ``core.flicker`` with the density :math:`B^2/2\pi f` on both sides, flat
at :math:`0.664B`. :math:`T_0` is 1 ms, or ten samples where these are longer: flat from 0.01 to 10^4 s at 10 kHz and
above.
"""

from __future__ import annotations

import math

from core.block import BlockParams, Context, parameter
from core.elementary import floor, log
from core.flicker import Flicker, PackedFlicker, flicker_now, pack_flicker, start_flicker
from core.kernel import kernel
from core.noise import key, normal
from core.record import Record
from core.units import DEG_H_PER_DEG_S, DEG_H_RT_H_PER_DEG_S_RT_S, DEG_RT_H_PER_DEG_RT_S, MS_PER_S

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
    """Deviations in deg/s, ticks of a white value, streams, the flicker."""

    white: float
    held: float
    walk: float
    white_key: float
    walk_key: float
    flicker: PackedFlicker


class Drift(Record):
    """The random walk in deg/s, and the flicker."""

    walk: float
    flicker: Flicker


def pack_drift(p: PackedDrift, params: DriftParams, context: Context) -> None:
    """Pack the noise of a sample."""
    dt_s = context.dt_ms / MS_PER_S
    held = max(1, round(SHORTEST_MS / context.dt_ms))
    p.white = params.angle_random_walk_deg_rt_h / DEG_RT_H_PER_DEG_RT_S / math.sqrt(held * dt_s)
    p.held = held * context.every
    p.walk = params.rate_random_walk_deg_h_rt_h / DEG_H_RT_H_PER_DEG_S_RT_S * math.sqrt(dt_s)
    p.white_key, p.walk_key = key(context.seed, "rate.white"), key(context.seed, "rate.walk")
    size = params.bias_instability_deg_h / DEG_H_PER_DEG_S * math.sqrt(log(10.0) / math.pi)
    samples = max(SHORTEST_MS / context.dt_ms, SHORTEST_SAMPLES)
    pack_flicker(p.flicker, context, "rate.flicker", size, samples)


def start_drift(s: Drift, context: Context) -> None:
    """Begin the walk at 0 and the flicker anywhere."""
    start_flicker(s.flicker, context, "rate.flicker")


@kernel
def drift_now(p: PackedDrift, s: Drift, tick: float) -> float:
    """Return the noise of this sample in deg/s and advance to the next."""
    noise = s.walk
    if p.white > 0.0:
        noise += p.white * normal(p.white_key, floor(tick / p.held))
    if p.walk > 0.0:
        s.walk += p.walk * normal(p.walk_key, tick)
    if p.flicker.size > 0.0:
        noise += flicker_now(p.flicker, s.flicker, tick)
    return noise
