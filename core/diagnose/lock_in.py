"""Multiple-model estimation that only listens at the frequency of the drive."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Context, Equation, FloatArray, Port, parameter
from core.diagnose import window
from core.diagnose.filters import (
    COUNT,
    DEPTH,
    LANES,
    OWN,
    PROBABILITY,
    WIDTH,
    coasts,
    filters_step,
    informed,
)
from core.diagnose.kalman import KalmanBank, KalmanParams
from core.diagnose.lanes import LANE
from core.diagnose.weights import floored, weigh

FLOOR, LOG_FLOOR, CYCLES, DT, WINDOW, CAPACITY, LEAN = range(7)
LOG, LIKELIHOOD, SLIDING = DEPTH, DEPTH + 1, DEPTH + 2
RESIDUAL_TAP, NIS_TAP, TONE_TAP = range(PROBABILITY + 1, PROBABILITY + 4)


def lock_in_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Predict, correct, demodulate the residuals, weigh by what of them is at the tone."""
    n = int(p[COUNT])
    if coasts(p, s, w, io, LANE, 0, n):
        return
    own = LANES + WIDTH * LANE
    evidence = informed(p, s, w, io)
    at = OWN + SLIDING * LANE
    capacity = int(p[own + CAPACITY])
    place = window.begin(s, at, capacity, p[own + WINDOW], p[own + CYCLES])
    turn = window.angle(w, p[own + CYCLES], p[own + DT])
    cosine = math.cos(turn)
    sine = math.sin(turn)
    along, across = window.leaning(p, own + LEAN, cosine, sine)
    span = p[own + LEAN + window.SPAN]
    half = 0.5 / p[own + WINDOW]
    filters_step(p, s, w, io, n, RESIDUAL_TAP)
    window.push(s, at, n, capacity, place, cosine, sine)
    best = -math.inf
    for i in range(n):
        tone = window.tone(s, at, i, along, across, span)
        w[io[TONE_TAP] + i] = tone
        log = s[OWN + LOG * LANE + i]
        if evidence:
            log -= half * tone
        s[OWN + LIKELIHOOD * LANE + i] = log
        best = max(best, log)
    weigh(
        s,
        OWN + LOG * LANE,
        OWN + LIKELIHOOD * LANE,
        w,
        io[PROBABILITY],
        n,
        best,
        p[own + FLOOR],
        p[own + LOG_FLOOR],
    )


class LockIn(KalmanBank):
    r"""Residual correlation: only what of a residual is at the frequency of the drive is evidence.

    .. math:: T_k=b_k^TG^{-1}b_k,\quad b_k=\sum_W\frac{r_k}{\sqrt{\psi_k}}z,\quad G=\sum_W zz^T,\quad
        z=\binom{\cos\omega t}{\sin\omega t},\qquad\ell_k\leftarrow\ell_k-\frac{T_k}{2W}

    A fault of the device moves the response at the tone, hum and noise stated wrongly do not. It needs a known tone
    and is about a quarter of a window slower (the idea of Hanlon and Maybeck 2000, which the text cites and does not
    use).
    """

    title = "Residual-correlation bank (lock-in)"
    taps = (*KalmanBank.taps, Port("tone", "1", "part of the residuals at the tone, 2 on average", each="hypotheses"))
    equations = (
        Equation(
            "tone",
            r"T_k=b_k^TG^{-1}b_k,\quad b_k=\sum_W\frac{r_k}{\sqrt{\psi_k}}z,\quad G=\sum_W zz^T,"
            r"\quad z=(\cos\omega t,\sin\omega t)^T",
        ),
        Equation("evidence", r"\ell_k\leftarrow\ell_k-\frac{T_k}{2W}", "Hanlon and Maybeck 2000, in idea"),
    )

    class Params(KalmanParams):
        """Assumptions of the bank."""

        probability_floor: float = parameter(1e-3, "smallest probability", equation="5.2.3.2.6", ge=0, le=0.05)
        window: int | None = parameter(
            None, "samples of the window; a period of the tone unless given", ge=2, le=4096, live=False
        )
        tone_hz: float | None = parameter(None, "tone; that of the reference unless given", "Hz", gt=0, le=1e6)

    evidence = r"-\frac{T_k}{2W}"

    @classmethod
    def log_likelihood(cls, params: Any, context: Context, residual: float, covariance: float, tone: float) -> float:
        """Return the evidence of a sample: what of the residuals is at the tone, spread over the window."""
        return -0.5 * tone / window.length(params, context)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        own = [
            *floored(params.probability_floor),
            window.tone_hz(params, context) / 1e3,
            context.dt_ms / context.every,
            float(window.length(params, context)),
            float(window.room(params)),
            *window.lean(params, context, window.length(params, context)),
        ]
        return np.array(cls.filters(params, context) + own)

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """All filters at rest, all hypotheses alike, the window empty."""
        n = len(params.hypotheses)
        sliding = [0.0] * window.size(window.room(params))
        return np.array(cls.at_rest(params, context, (-math.log(n), 0.0)) + sliding)

    step = lock_in_step
