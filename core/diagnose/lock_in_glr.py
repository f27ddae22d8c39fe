"""Lock-in detector: a generalised likelihood ratio for any change of the response at the tone."""

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
    driven,
    filters_step,
)
from core.diagnose.kalman import KalmanBank, KalmanParams
from core.diagnose.lanes import LANE
from core.diagnose.weights import share_out

CYCLES, DT, WINDOW, THRESHOLD, LEAN = range(5)
LIKELIHOOD, SLIDING = DEPTH, DEPTH + 1
ALARM = PROBABILITY + 1
RESIDUAL_TAP, NIS_TAP, TONE_TAP = range(PROBABILITY + 2, PROBABILITY + 5)


def lock_in_glr_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Predict, correct, demodulate, compare with the threshold."""
    n = int(p[COUNT])
    if coasts(p, s, w, io, LANE, 0, n):
        return
    own = LANES + WIDTH * LANE
    at = OWN + SLIDING * LANE
    capacity = int(p[own + WINDOW])
    place = window.begin(s, at, capacity, p[own + WINDOW], p[own + CYCLES])
    turn = window.angle(w, p[own + CYCLES], p[own + DT])
    cosine = math.cos(turn)
    sine = math.sin(turn)
    along, across = window.leaning(p, own + LEAN, cosine, sine)
    span = p[own + LEAN + window.SPAN]
    threshold = p[own + THRESHOLD]
    filters_step(p, s, w, io, n, RESIDUAL_TAP)
    window.push(s, at, n, capacity, place, cosine, sine)
    best = -math.inf
    for i in range(n):
        tone = window.tone(s, at, i, along, across, span)
        w[io[TONE_TAP] + i] = tone
        log = -0.5 * tone
        if i == 0:
            w[io[ALARM]] = 1.0 if tone > threshold and driven(p, s) else 0.0
            log += 0.5 * threshold
        s[OWN + LIKELIHOOD * LANE + i] = log
        best = max(best, log)
    share_out(s, OWN + LIKELIHOOD * LANE, w, io[PROBABILITY], n, best)


class LockInGlr(KalmanBank):
    r"""Alarm when the residual of the healthy device has a part at the tone that noise does not explain.

    .. math:: T_0=\max_{Y}2\ln\frac{f(r\mid Y)}{f(r\mid0)}=b_0^TG^{-1}b_0\sim\chi^2_2,\quad
        b_0=\sum_W\frac{r_0}{\sqrt{\psi_0}}z,\quad G=\sum_W zz^T,\quad z=\binom{\cos\omega t}{\sin\omega t}

    Maximised over the unknown change of the phasor, so it needs no list of faults; the longer the window, the smaller
    the change it sees and the later. The list only serves to name it: the threshold is the head start of the healthy
    device.
    """

    sample_by_sample = False
    title = "Lock-in detector (GLR)"
    outputs = (*KalmanBank.outputs, Port("alarm", "1", "1 while the healthy device does not explain the tone"))
    taps = (*KalmanBank.taps, Port("tone", "1", "part of the residuals at the tone, 2 on average", each="hypotheses"))
    equations = (
        Equation(
            "ratio",
            r"T_0=b_0^TG^{-1}b_0\sim\chi^2_2,\quad b_0=\sum_W\frac{r_0}{\sqrt{\psi_0}}z,\quad G=\sum_W zz^T,"
            r"\quad z=(\cos\omega t,\sin\omega t)^T",
        ),
    )

    class Params(KalmanParams):
        """Assumptions of the test."""

        process_noise_v: float = parameter(
            0.01, "assumed noise on the voltage, rms per sample", "V", equation="5.2.3.1.2", ge=0, le=100
        )
        window: int = parameter(100, "samples of the window", ge=2, le=4096, live=False)
        tone_hz: float | None = parameter(None, "tone; that of the reference unless given", "Hz", gt=0, le=1e6)
        threshold: float = parameter(23.0, "T at which there is an alarm", gt=0, le=1e6)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        cycles = window.tone_hz(params, context) / 1e3
        own = [cycles, context.dt_ms / context.every, float(params.window), params.threshold]
        return np.array(cls.filters(params, context) + own + window.lean(params, context, params.window))

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """All filters at rest, the window empty."""
        return np.array(cls.at_rest(params, context, (0.0,)) + [0.0] * window.size(params.window))

    step = lock_in_glr_step
