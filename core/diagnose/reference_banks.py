"""Self-tuning banks that each learn from a simulated sub-system of their own."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core import estimation
from core.block import TICK, Context, Equation, FloatArray, parameter, settled
from core.diagnose.arx import (
    COUNT,
    LANES,
    OWN,
    PROBABILITY,
    SIZE,
    WIDTH,
    ArxBank,
    ArxParams,
    gathers,
    judge,
    regress,
    unexplained,
)
from core.diagnose.hypothesis import assumed_noise
from core.diagnose.weights import floored, weigh
from core.noise import key, normal

FORGETTING, LIMIT, FLOOR, LOG_FLOOR, NOISE, KEYS = range(6)
H, G, PRODUCT, LOG = OWN, OWN + 4, OWN + 8, OWN + 12
"""State: regressors of the device and of a record, scratch; then two lanes of logarithms, and the banks."""
CLEAN1, CLEAN2, SEEN1, SEEN2, DEPTH = 14, 15, 16, 17, 18
"""A bank: four coefficients, half a covariance, then its record: two samples as they are, two as measured."""


def reference_banks_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Let every bank learn from its own record, and weigh it by what it makes of the device."""
    if gathers(p, s, w, io):
        return
    n = int(p[COUNT])
    own = LANES + WIDTH * n
    z = regress(p, s, w, io, H)
    first = LOG + 2 * n
    forgetting = p[own + FORGETTING]
    best = -math.inf
    for i in range(n):
        bank = first + DEPTH * i
        best = max(best, judge(p, s, w, io, LOG, i, n, unexplained(s, z, H, bank)))
        # its own sub-system under the same voltage, as its own sensor would see it
        at = LANES + i
        clean = (
            s[H] * p[at] + s[H + 1] * p[at + n] - s[bank + CLEAN1] * p[at + 2 * n] - s[bank + CLEAN2] * p[at + 3 * n]
        )
        seen = clean + p[own + NOISE] * normal(p[own + KEYS + i], w[TICK])
        s[G] = s[H]
        s[G + 1] = s[H + 1]
        s[G + 2] = -s[bank + SEEN1]
        s[G + 3] = -s[bank + SEEN2]
        error = unexplained(s, seen, G, bank)
        estimation.least_squares(s, bank, bank + SIZE, G, PRODUCT, SIZE, error, forgetting, forgetting, p[own + LIMIT])
        s[bank + CLEAN2] = s[bank + CLEAN1]
        s[bank + CLEAN1] = settled(clean)
        s[bank + SEEN2] = s[bank + SEEN1]
        s[bank + SEEN1] = seen
    weigh(s, LOG, LOG + n, w, io[PROBABILITY], n, best, p[own + FLOOR], p[own + LOG_FLOOR])


class ReferenceBanks(ArxBank):
    r"""Each bank identifies a sub-system of its own, which runs beside the device, and is tried on the device.

    .. math:: \hat\theta_k\ \text{from}\ (u,z_k),\qquad r_k=z-h^T\hat\theta_k

    The records never change, so the forgetting factor has hardly anything to do with the verdict.
    """

    title = "Self-tuning banks with records of their own"
    weaknesses = (
        "Under one sine below 1 kHz noise decides more than the device: over the seven steps of 5.2.4, at 20 kHz and "
        "10 nm, it is right for 99 % of the samples at 2 kHz, 98 % at 1 kHz, 74 % at 500 Hz and 61 % at 200 Hz.",
        "With 50 nm of noise it is right for 99 % at 2 kHz and 72 % at 1 kHz; IMM is right for 92 % there.",
    )
    equations = (Equation("residual", r"r_k=z_i-h_i^T\hat\theta_k,\quad \hat\theta_k\leftarrow(u,z_k)", "5.3.2-3"),)

    class Params(ArxParams):
        """Memory and floor."""

        forgetting: float = parameter(0.86, "forgetting factor", equation="5.3.3.8", ge=0.5, le=1)
        probability_floor: float = parameter(1e-3, "smallest probability", equation="5.2.3.2.6", ge=0, le=0.05)
        initial_covariance: float = parameter(
            1e8, "covariance at the start, over unit matrix", equation="5.3.4.1", gt=0, le=1e12, live=False
        )
        trace_limit: float = parameter(1e10, "trace beyond which the covariance stays as it is", gt=0, le=1e100)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        noise = params.sensor_noise_um or assumed_noise(context)
        own = [params.forgetting, params.trace_limit, *floored(params.probability_floor), noise]
        keys = [key(context.seed, f"diagnose.record.{i}") for i in range(len(params.hypotheses))]
        return np.array(cls.equations_of(params, context) + own + keys)

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Every bank at its hypothesis, every record at rest."""
        n = len(params.hypotheses)
        lanes = np.array(cls.equations_of(params, context)[LANES:]).reshape(WIDTH, n)
        covariance = estimation.diagonal(SIZE, params.initial_covariance)
        banks = [value for i in range(n) for value in (*lanes[:SIZE, i], *covariance, 0.0, 0.0, 0.0, 0.0)]
        return np.array([0.0] * LOG + [-math.log(n)] * n + [0.0] * n + banks)

    step = reference_banks_step
