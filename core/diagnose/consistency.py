"""Consistency-based diagnosis: which hypotheses the last samples do not contradict."""

from __future__ import annotations

import math
from typing import Any

from core.block import BlockParams, Context, Equation, Stage, parameter
from core.diagnose import window
from core.diagnose.chance import chi_square
from core.diagnose.filters import between_updates, driven, filters_step
from core.diagnose.kalman import FILTERS, KalmanBank, KalmanParams
from core.elementary import cos, sin
from core.kernel import kernel, whole
from core.ports import output, tap
from core.record import Record, Vector

NORMAL, DETECTED, ISOLATED, AMBIGUOUS, UNKNOWN = 0, 1, 2, 3, 4
VERDICTS = ("normal", "detected", "isolated", "ambiguous", "unknown fault")


class ConclusionParams(BlockParams):
    """How long a verdict must hold."""

    isolated_after: int = parameter(50, "samples with the same one left", ge=1, le=1_000_000)
    unknown_after: int = parameter(200, "samples with none left", ge=1, le=1_000_000)


class PackedConclusion(Record):
    """Samples before a verdict is given."""

    isolated_after: float
    unknown_after: float


class Conclusion(Record):
    """The only candidate or -1, its samples so far, and the samples without any candidate."""

    alone: float
    alone_run: float
    none_run: float


@kernel
def concluded(p: PackedConclusion, s: Conclusion, candidates: int, last: int, healthy: bool) -> int:
    """Return the verdict for a number of consistent hypotheses, the last of them, and whether the first is one."""
    alone = last if candidates == 1 else -1
    s.alone_run = s.alone_run + 1.0 if alone == s.alone else 1.0
    s.alone = alone
    s.none_run = s.none_run + 1.0 if candidates == 0 else 0.0
    verdict = DETECTED
    if healthy:
        verdict = NORMAL
    elif candidates > 1:
        verdict = AMBIGUOUS
    elif alone >= 0 and s.alone_run >= p.isolated_after:
        verdict = ISOLATED
    elif s.none_run >= p.unknown_after:
        verdict = UNKNOWN
    return verdict


class Consistency(KalmanBank):
    r"""Finds the hypotheses consistent with input and measurement: (U, Y) in the behaviour of k or not.

    .. math:: k\text{ consistent}\iff \sum_W\frac{r_k^2}{\psi_k}\le\chi^2_W(1-\alpha)\;\text{and}\;
        \frac{2}{W}\Bigl|\sum_W\frac{r_k}{\sqrt{\psi_k}}e^{-j\omega t}\Bigr|^2\le\chi^2_2(1-\alpha)

    Normal while the first hypothesis is consistent. Otherwise a fault is detected; it is isolated once exactly one
    other has been consistent for a while, ambiguous while several are, unknown once none has been for a while. Isolated
    only means not contradicted: hypotheses with the same response at the tone are indistinguishable.

    The probability is an equal share among the consistent ones, or among all when none is. The filters must assume
    the noise there is: with pseudo-noise the test is biased.
    """

    sample_by_sample = False
    title = "Consistency test"
    lengths = ("window",)
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
    structure = (
        FILTERS,
        Stage("Power of the window", "residual covariance", "power", ("power",)),
        Stage("Demodulation", "residual covariance", "tone cosine sine", ("tone",)),
        Stage("Tests", "power tone", "consistent", ("behaviour",)),
        Stage("Verdict", "consistent", "candidates verdict probability"),
    )

    class Params(KalmanParams, ConclusionParams):
        """Assumptions of the test."""

        process_noise_v: float = parameter(
            0.01, "assumed noise on the voltage, rms per sample: what there is", "V", equation="5.2.3.1.2", ge=0, le=100
        )
        window: int = parameter(50, "samples of the window", equation="5.1.6.1", ge=2, le=4096, live=False)
        significance: float = parameter(1e-5, "chance that a test calls a true hypothesis false", gt=0, le=0.5)
        tone_hz: float | None = parameter(None, "tone; the reference's unless given", "Hz", gt=0, le=1e6)

    class Packed(window.Packed, PackedConclusion):
        """Parameters of filters and window; limits of the tests."""

        power_limit: float
        tone_limit: float

    class State(window.State, Conclusion):
        """Filters and window, and the verdict so far."""

    class Ports(KalmanBank.Ports):
        """Ports of every bank; the verdict, and the tests behind it."""

        verdict: float = output("1", "0 normal, 1 detected, 2 isolated, 3 ambiguous, 4 unknown fault")
        candidates: float = output("1", "number of consistent hypotheses")
        consistent: Vector = tap("1", "1 while the hypothesis is consistent with the window", each="hypotheses")
        power: Vector = tap("1", "power of the normalised residuals over the window", each="hypotheses")
        tone: Vector = tap("1", "part of the normalised residuals at the tone, 2 on average", each="hypotheses")
        cosine: Vector = tap("1", "that part by the cosine of the tone, 1 at the limit of the test", each="hypotheses")
        sine: Vector = tap("1", "that part by the sine of the tone, 1 at the limit of the test", each="hypotheses")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.filters(cls.Packed.blank(), params, context)
        window.fill(p, params, context, params.window, params.window)
        p.power_limit = chi_square(params.window, params.significance)
        p.tone_limit = chi_square(2, params.significance)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """All filters at zero, no verdict, the window empty."""
        s = cls.at_rest(cls.State.zeros(params.window), params, context)
        s.alone = -1.0
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Predict, correct, test every hypothesis, conclude."""
        n = int(p.count)
        if between_updates(p, s, x, 0, whole(n)):
            return
        place = window.begin(p, s)
        turn = window.angle(p, x.tick)
        cosine = cos(turn)
        sine = sin(turn)
        along, across = window.leaning(p, cosine, sine)
        span = p.span
        filters_step(p, s, x, n)
        window.push(s, n, place, cosine, sine)
        candidates = 0
        last = -1
        healthy = False
        for i in range(n):
            power = window.power(s, i)
            tone = window.tone(s, i, along, across, span)
            consistent = power <= p.power_limit and tone <= p.tone_limit
            x.power[i] = power
            x.tone[i] = tone
            c = s.cosine_sum[i]
            d = s.sine_sum[i]
            size = c * c + d * d
            scale = math.sqrt(max(tone, 0.0) / (p.tone_limit * size)) if size > 0.0 else 0.0
            x.cosine[i] = c * scale
            x.sine[i] = d * scale
            x.consistent[i] = 1.0 if consistent else 0.0
            if consistent:
                candidates += 1
                last = i
                healthy = healthy or i == 0
        verdict = concluded(p, s, candidates, last, healthy)
        if driven(p, s):  # without drive every hypothesis is consistent with the measurement
            x.verdict = verdict
            x.candidates = candidates
        if candidates == 0:
            for i in range(n):
                x.probability[i] = 1.0 / n
        else:
            for i in range(n):
                x.probability[i] = x.consistent[i] / candidates
