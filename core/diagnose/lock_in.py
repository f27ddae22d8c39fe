"""Multiple-model estimation from the residuals at the frequency of the drive only."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, Equation, FloatArray, Stage, parameter
from core.diagnose import window
from core.diagnose.filters import between_updates, filters_step, informed
from core.diagnose.kalman import FILTERS, KalmanBank, KalmanParams
from core.diagnose.lanes import LANE
from core.diagnose.weights import floored, take_floored_softmax
from core.elementary import cos, log, sin
from core.kernel import whole
from core.ports import tap
from core.record import Vector, vector


class LockIn(KalmanBank):
    r"""Residual correlation: only the part of a residual at the frequency of the drive is evidence.

    .. math:: T_k=b_k^TG^{-1}b_k,\quad b_k=\sum_W\frac{r_k}{\sqrt{\psi_k}}z,\quad G=\sum_W zz^T,\quad
        z=\binom{\cos\omega t}{\sin\omega t},\qquad\ell_k\leftarrow\ell_k-\frac{T_k}{2W}

    A fault of the device moves the response at the tone; hum and wrongly stated noise do not. It needs a known tone
    and is about a quarter of a window slower (the idea of Hanlon and Maybeck 2000, which the text cites and does not
    use).
    """

    title = "Residual-correlation bank (lock-in)"
    lengths = ("window",)
    equations = (
        Equation(
            "tone",
            r"T_k=b_k^TG^{-1}b_k,\quad b_k=\sum_W\frac{r_k}{\sqrt{\psi_k}}z,\quad G=\sum_W zz^T,"
            r"\quad z=(\cos\omega t,\sin\omega t)^T",
        ),
        Equation("evidence", r"\ell_k\leftarrow\ell_k-\frac{T_k}{2W}", "Hanlon and Maybeck 2000, in idea"),
    )
    structure = (
        FILTERS,
        Stage("Demodulation", "residual covariance", "tone", ("tone",)),
        Stage("Evidence", "log tone", "likelihood", ("evidence",)),
        Stage("Weights", "likelihood", "log probability"),
    )

    class Params(KalmanParams):
        """Assumptions of the Kalman filters, and parameters of this bank."""

        probability_floor: float = parameter(1e-3, "smallest probability", equation="5.2.3.2.6", ge=0, le=0.05)
        window: int | None = parameter(
            None, "samples of the window; a period of the tone unless given", ge=2, le=4096, live=False
        )
        tone_hz: float | None = parameter(None, "tone; the reference's unless given", "Hz", gt=0, le=1e6)

    class Packed(window.Packed):
        """Parameters of filters and window; floor under probabilities and its logarithm."""

        probability_floor: float
        log_floor: float

    class State(window.State):
        """Filters and window; logarithms of probabilities, and the logarithms of this sample."""

        log: Vector = vector(LANE)
        likelihood: Vector = vector(LANE)

    class Ports(KalmanBank.Ports):
        """Ports of every bank, and the tone."""

        tone: Vector = tap("1", "part of the residuals at the tone, 2 on average", each="hypotheses")

    judged_by = "tone"
    evidence = r"-\frac{T_k}{2W}"

    @classmethod
    def log_likelihood(
        cls, params: Any, context: Context, residual: FloatArray, covariance: FloatArray, tone: float
    ) -> float:
        """Return the evidence of a sample: the part of the residuals at the tone, spread over the window."""
        return -0.5 * tone / window.length(params, context)

    @classmethod
    def floor(cls, params: Any) -> float:
        """Return the smallest probability."""
        return float(params.probability_floor)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.filters(cls.Packed.blank(), params, context)
        window.fill(p, params, context, window.length(params, context), window.room(params))
        p.probability_floor, p.log_floor = floored(params.probability_floor)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """All filters at zero, all hypotheses alike, the window empty."""
        s = cls.at_rest(cls.State.zeros(window.room(params)), params, context)
        s.log[:] = -log(len(params.hypotheses))
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Predict, correct, demodulate the residuals, weigh by their part at the tone."""
        n = int(p.count)
        if between_updates(p, s, x, 0, whole(n)):
            return
        evidence = informed(p, s, x)
        place = window.begin(p, s)
        turn = window.angle(p, x.tick)
        cosine = cos(turn)
        sine = sin(turn)
        along, across = window.leaning(p, cosine, sine)
        span = p.span
        half = 0.5 / p.samples
        filters_step(p, s, x, n)
        window.push(s, n, place, cosine, sine)
        best = -math.inf
        for i in range(n):
            tone = window.tone(s, i, along, across, span)
            x.tone[i] = tone
            log = s.log[i]
            if evidence:
                log -= half * tone
            s.likelihood[i] = log
            best = max(best, log)
        take_floored_softmax(s.log, s.likelihood, x.probability, n, best, p.probability_floor, p.log_floor)
