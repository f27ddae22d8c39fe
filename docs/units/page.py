r"""Page's test: cumulative sums of open-loop residuals, one for each hypothesis against the first."""

from typing import Any

from core.block import Context, Equation, parameter
from core.device.oscillator import held
from core.diagnose.hypothesis import BankParams, assumed_noise
from core.diagnose.judge import Judge
from core.diagnose.lanes import LANE
from core.elementary import exp
from core.ports import output, tap
from core.record import Record, Vector, vector


class Page(Judge):
    r"""Page's test on open-loop models (Page 1954; Basseville and Nikiforov 1993, section 2.2).

    The first hypothesis is the healthy device. Without a fault, the mean time to a false alarm is at least :math:`e^h`
    samples for each hypothesis (Lorden 1971). The models know the voltage alone, so they need a device that is stable.
    """

    title = "Page's test, open loop"
    equations = (
        Equation("sum", r"g_k\leftarrow\max\bigl(0,\;g_k+(r_0^2-r_k^2)/2\sigma^2\bigr)", "Page 1954"),
        Equation("limit", r"g_k\leftarrow\max\bigl(0,\;g_k-\max(0,\;\max_jg_j-2h)\bigr)"),
        Equation("alarm", r"\max_kg_k>h"),
        Equation("probability", r"P_k\propto e^{g_k},\quad g_0=h"),
    )
    weaknesses = (
        "a model shows a change of the device only when the old motion has decayed",
        "noise on the voltage moves the device and none of the models, and is not allowed for",
    )

    class Params(BankParams):
        """The hypotheses, and the threshold."""

        threshold: float = parameter(10.0, "sum at which there is an alarm, h", "nat", gt=0, le=300)

    class Packed(Judge.Packed):
        """Threshold, inverse variance of the sensor, and each model over a sample."""

        threshold: float
        inverse: float
        phi11: Vector = vector(LANE)
        phi12: Vector = vector(LANE)
        phi21: Vector = vector(LANE)
        phi22: Vector = vector(LANE)
        push1: Vector = vector(LANE)
        push2: Vector = vector(LANE)

    class State(Record):
        """Displacement and velocity of each model, its sum."""

        displacement: Vector = vector(LANE)
        velocity: Vector = vector(LANE)
        sum: Vector = vector(LANE)

    class Ports(Judge.Ports):
        """The ports of every diagnoser on hypotheses; alarm and sums."""

        alarm: float = output("1", "1 while a sum is beyond the threshold")
        sum: Vector = tap("nat", "cumulative sum against the first hypothesis", each="hypotheses")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the models of all hypotheses."""
        p = cls.Packed.blank()
        noise = assumed_noise(context)
        p.inverse = 1.0 / (noise * noise)
        device = context.device
        for i, one in enumerate(params.hypotheses):
            free11, free12, free21, free22, push1, push2 = held(
                device.mass * one.mass, device.damping * one.damping, device.stiffness * one.stiffness, context.dt_ms
            )
            p.phi11[i], p.phi12[i], p.phi21[i], p.phi22[i] = free11, free12, free21, free22
            p.push1[i], p.push2[i] = device.force * one.gain * push1, device.force * one.gain * push2
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Advance the models, add up the log-likelihood ratios, compare with the threshold."""
        healthy = 0.0
        most = 0.0
        for i in range(int(p.count)):
            y, v = s.displacement[i], s.velocity[i]
            s.displacement[i] = p.phi11[i] * y + p.phi12[i] * v + p.push1[i] * x.applied
            s.velocity[i] = p.phi21[i] * y + p.phi22[i] * v + p.push2[i] * x.applied
            r = x.measured - s.displacement[i]
            square = r * r * p.inverse
            if i == 0:
                healthy = square
            else:
                s.sum[i] = max(0.0, s.sum[i] + 0.5 * (healthy - square))
                most = max(most, s.sum[i])
            x.residual[i] = r
            x.nis[i] = square
        # a sum far beyond the threshold would keep the alarm after the fault is gone
        over = max(0.0, most - 2.0 * p.threshold)
        best = max(most - over, p.threshold)
        total = 0.0
        for i in range(int(p.count)):
            s.sum[i] = max(0.0, s.sum[i] - over)
            x.sum[i] = s.sum[i]
            odds = exp((p.threshold if i == 0 else s.sum[i]) - best)
            x.probability[i] = odds
            total += odds
        for i in range(int(p.count)):
            x.probability[i] = x.probability[i] / total
        x.alarm = 1.0 if most > p.threshold else 0.0
