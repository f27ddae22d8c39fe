"""Consistency-based diagnosis: which hypotheses the last samples do not contradict."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.special import chdtri

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

CYCLES, DT, WINDOW, CAPACITY, POWER_LIMIT, TONE_LIMIT, ALONE_FOR, NONE_FOR, LEAN = range(9)
ALONE, ALONE_RUN, NONE_RUN, SLIDING = range(4)
VERDICT, CANDIDATES = PROBABILITY + 1, PROBABILITY + 2
RESIDUAL_TAP, NIS_TAP, CONSISTENT_TAP, POWER_TAP, TONE_TAP = range(PROBABILITY + 3, PROBABILITY + 8)
NORMAL, DETECTED, ISOLATED, AMBIGUOUS, UNKNOWN = range(5)
VERDICTS = ("normal", "detected", "isolated", "ambiguous", "unknown fault")


def consistency_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Predict, correct, test every hypothesis, conclude."""
    n = int(p[COUNT])
    if coasts(p, s, w, io, LANE, 0, n):
        return
    own = LANES + WIDTH * LANE
    state = OWN + DEPTH * LANE
    at = state + SLIDING
    capacity = int(p[own + CAPACITY])
    place = window.begin(s, at, capacity, p[own + WINDOW], p[own + CYCLES])
    turn = window.angle(w, p[own + CYCLES], p[own + DT])
    cosine = math.cos(turn)
    sine = math.sin(turn)
    along, across = window.leaning(p, own + LEAN, cosine, sine)
    span = p[own + LEAN + window.SPAN]
    filters_step(p, s, w, io, n, RESIDUAL_TAP)
    window.push(s, at, n, capacity, place, cosine, sine)
    candidates = 0
    last = -1
    healthy = False
    for i in range(n):
        power = window.power(s, at, i)
        tone = window.tone(s, at, i, along, across, span)
        consistent = power <= p[own + POWER_LIMIT] and tone <= p[own + TONE_LIMIT]
        w[io[POWER_TAP] + i] = power
        w[io[TONE_TAP] + i] = tone
        w[io[CONSISTENT_TAP] + i] = 1.0 if consistent else 0.0
        if consistent:
            candidates += 1
            last = i
            healthy = healthy or i == 0
    alone = last if candidates == 1 else -1
    s[state + ALONE_RUN] = s[state + ALONE_RUN] + 1.0 if alone == s[state + ALONE] else 1.0
    s[state + ALONE] = alone
    s[state + NONE_RUN] = s[state + NONE_RUN] + 1.0 if candidates == 0 else 0.0
    verdict = 1.0
    if healthy:
        verdict = 0.0
    elif candidates > 1:
        verdict = 3.0
    elif alone >= 0 and s[state + ALONE_RUN] >= p[own + ALONE_FOR]:
        verdict = 2.0
    elif s[state + NONE_RUN] >= p[own + NONE_FOR]:
        verdict = 4.0
    if driven(p, s):  # without drive everything is consistent with everything
        w[io[VERDICT]] = verdict
        w[io[CANDIDATES]] = candidates
    if candidates == 0:
        for i in range(n):
            w[io[PROBABILITY] + i] = 1.0 / n
    else:
        for i in range(n):
            w[io[PROBABILITY] + i] = w[io[CONSISTENT_TAP] + i] / candidates


class Consistency(KalmanBank):
    r"""Which hypotheses are consistent with what was applied and measured, (U, Y) in the behaviour of k or not.

    .. math:: k\text{ consistent}\iff \sum_W\frac{r_k^2}{\psi_k}\le\chi^2_W(1-\alpha)\;\text{and}\;
        \frac{2}{W}\Bigl|\sum_W\frac{r_k}{\sqrt{\psi_k}}e^{-j\omega t}\Bigr|^2\le\chi^2_2(1-\alpha)

    Normal while the first hypothesis is consistent. Otherwise a fault is detected; it is isolated once exactly one
    other has been consistent for a while, ambiguous while several are, unknown once none has been for a while.
    Isolated means not inconsistent with: what has the same response at the tone cannot be told apart.

    The probability is an equal share among the consistent ones, or among all when none is. The filters must assume
    the noise there is: with pseudo-noise the test is biased.
    """

    sample_by_sample = False
    title = "Consistency test"
    outputs = (
        *KalmanBank.outputs,
        Port("verdict", "1", "0 normal, 1 detected, 2 isolated, 3 ambiguous, 4 unknown fault"),
        Port("candidates", "1", "number of consistent hypotheses"),
    )
    taps = (
        *KalmanBank.taps,
        Port("consistent", "1", "1 while the hypothesis is consistent with the window", each="hypotheses"),
        Port("power", "1", "power of the normalised residuals over the window", each="hypotheses"),
        Port("tone", "1", "part of the normalised residuals at the tone, 2 on average", each="hypotheses"),
    )
    equations = (
        Equation(
            "behaviour",
            r"(U,Y)\in\mathcal B_k\iff S_k\le\chi^2_W(1-\alpha),\;T_k\le\chi^2_2(1-\alpha)",
            "5.1.3, 5.1.6",
            printed=r"\beta=\{(u,y):\,y=k_{sys}u\}",
            why="a dynamic system is no number: the same input gives many outputs, depending on what went before",
        ),
        Equation("power", r"S_k=\textstyle\sum_W r_k^2/\psi_k"),
        Equation(
            "tone",
            r"T_k=b_k^TG^{-1}b_k,\quad b_k=\textstyle\sum_W r_k\psi_k^{-1/2}z,\quad G=\sum_W zz^T,"
            r"\quad z=(\cos\omega t,\sin\omega t)^T",
        ),
    )

    class Params(KalmanParams):
        """Assumptions of the test."""

        process_noise_v: float = parameter(
            0.01, "assumed noise on the voltage, rms per sample: what there is", "V", equation="5.2.3.1.2", ge=0, le=100
        )
        window: int = parameter(50, "samples of the window", equation="5.1.6.1", ge=2, le=4096, live=False)
        significance: float = parameter(1e-5, "chance that a test calls a true hypothesis false", gt=0, le=0.5)
        tone_hz: float | None = parameter(None, "tone; that of the reference unless given", "Hz", gt=0, le=1e6)
        isolated_after: int = parameter(50, "samples with the same one left", ge=1, le=1_000_000)
        unknown_after: int = parameter(200, "samples with none left", ge=1, le=1_000_000)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        own = [
            window.tone_hz(params, context) / 1e3,
            context.dt_ms / context.every,
            float(params.window),
            float(params.window),
            float(chdtri(params.window, params.significance)),
            float(chdtri(2, params.significance)),
            float(params.isolated_after),
            float(params.unknown_after),
            *window.lean(params, context, params.window),
        ]
        return np.array(cls.filters(params, context) + own)

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """All filters at rest, nothing concluded, the window empty."""
        return np.array(cls.at_rest(params, context) + [-1.0, 0.0, 0.0] + [0.0] * window.size(params.window))

    step = consistency_step
