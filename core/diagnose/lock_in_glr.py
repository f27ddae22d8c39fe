"""Lock-in detector: a generalised likelihood ratio for any change of the response at the tone."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, Equation, Stage, parameter
from core.diagnose import window
from core.diagnose.filters import between_updates, driven, filters_step
from core.diagnose.kalman import FILTERS, KalmanBank, KalmanParams
from core.diagnose.lanes import LANE
from core.diagnose.weights import take_softmax
from core.elementary import cos, sin
from core.kernel import whole
from core.ports import output, tap
from core.record import Vector, vector


class LockInGlr(KalmanBank):
    r"""Alarm when the residual of the healthy device has a part at the tone that noise does not explain.

    .. math:: T_0=\max_{Y}2\ln\frac{f(r\mid Y)}{f(r\mid0)}=b_0^TG^{-1}b_0\sim\chi^2_2,\quad
        b_0=\sum_W\frac{r_0}{\sqrt{\psi_0}}z,\quad G=\sum_W zz^T,\quad z=\binom{\cos\omega t}{\sin\omega t}

    The ratio is maximised over the unknown change of the phasor, so it needs no list of faults. A longer window detects
    smaller changes, and detects them later. The list only serves to name the change: the threshold is the head start of
    the healthy device.
    """

    sample_by_sample = False
    title = "Lock-in detector (GLR)"
    lengths = ("window",)
    equations = (
        Equation(
            "ratio",
            r"T_0=b_0^TG^{-1}b_0\sim\chi^2_2,\quad b_0=\sum_W\frac{r_0}{\sqrt{\psi_0}}z,\quad G=\sum_W zz^T,"
            r"\quad z=(\cos\omega t,\sin\omega t)^T",
        ),
    )
    structure = (
        FILTERS,
        Stage("Demodulation", "residual covariance", "tone", ("ratio",)),
        Stage("Threshold", "tone", "alarm"),
        Stage("Weights", "tone", "probability"),
    )

    class Params(KalmanParams):
        """Assumptions of the test."""

        process_noise_v: float = parameter(
            0.01, "assumed noise on the voltage, rms per sample", "V", equation="5.2.3.1.2", ge=0, le=100
        )
        window: int = parameter(100, "samples of the window", ge=2, le=4096, live=False)
        tone_hz: float | None = parameter(None, "tone; the reference's unless given", "Hz", gt=0, le=1e6)
        threshold: float = parameter(23.0, "T at which there is an alarm", gt=0, le=1e6)

    class Packed(window.Packed):
        """Parameters of filters and window; T that raises the alarm."""

        threshold: float

    class State(window.State):
        """Filters and window; logarithms of this sample."""

        likelihood: Vector = vector(LANE)

    class Ports(KalmanBank.Ports):
        """Ports of every bank; alarm and tone."""

        alarm: float = output("1", "1 while the healthy device does not explain the tone")
        tone: Vector = tap("1", "part of the residuals at the tone, 2 on average", each="hypotheses")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.filters(cls.Packed.blank(), params, context)
        window.fill(p, params, context, params.window, params.window)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """All filters at zero, the window empty."""
        return cls.at_rest(cls.State.zeros(params.window), params, context)

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Predict, correct, demodulate, compare with the threshold."""
        n = int(p.count)
        if between_updates(p, s, x, 0, whole(n)):
            return
        place = window.begin(p, s)
        turn = window.angle(p, x.tick)
        cosine = cos(turn)
        sine = sin(turn)
        along, across = window.leaning(p, cosine, sine)
        span = p.span
        threshold = p.threshold
        filters_step(p, s, x, n)
        window.push(s, n, place, cosine, sine)
        best = -math.inf
        for i in range(n):
            tone = window.tone(s, i, along, across, span)
            x.tone[i] = tone
            log = -0.5 * tone
            if i == 0:
                x.alarm = 1.0 if tone > threshold and driven(p, s) else 0.0
                log += 0.5 * threshold
            s.likelihood[i] = log
            best = max(best, log)
        take_softmax(s.likelihood, x.probability, n, best)
