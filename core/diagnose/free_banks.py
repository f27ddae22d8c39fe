"""Self-tuning banks that all learn from the device, as an example of a design that fails."""

from __future__ import annotations

import math
from typing import Any, Literal

from core.block import Context, Equation, Stage, parameter
from core.diagnose.arx import (
    REGRESSOR,
    SIZE,
    ArxEstimate,
    ArxParams,
    WeighedBank,
    between_updates,
    gather_voltage,
    judge,
    put_at_hypotheses,
    regress,
    unexplained,
)
from core.diagnose.lanes import LANE
from core.diagnose.weights import take_floored_softmax, winner_of
from core.estimation import estimate
from core.record import Records, Vector, several, vector


class FreeBanks(WeighedBank):
    r"""Each bank starts at its hypothesis and then learns from the device: all of them become the device.

    .. math:: \hat\theta_k(0)=\theta_k,\qquad \hat\theta_k\leftarrow\hat\theta_k+\frac{\eta h}{\lambda+h^T\eta h}r_k

    With one input and one output to learn from, the residuals of all banks are the same within a hundred samples, and
    nothing distinguishes them any more. When only the winner learns, it learns the fault it should have reported.
    """

    title = "Free self-tuning banks"
    weaknesses = (
        "It does not tell the devices of 5.2.4 apart at any frequency from 200 Hz to 2 kHz: it is right for 11 % of "
        "the samples, as often as damping is the fault.",
    )
    equations = (
        Equation(
            "free estimates",
            r"\hat\theta_k\to\hat\theta\ \text{for all}\ k",
            "5.3.3.8 in each bank",
            printed=r"\text{each bank tunes itself to the measured output}",
            why="banks that follow the device are no hypotheses any more",
        ),
    )
    structure = (
        REGRESSOR,
        Stage("Residuals", "banks h measured", "residual nis"),
        Stage("Likelihoods", "log nis", "likelihood"),
        Stage("Weights", "likelihood", "log probability"),
        Stage("Estimators", "residual h", "banks", ("free estimates",)),
    )

    class Params(ArxParams):
        """Who learns, and how fast."""

        adapting: Literal["all", "winner"] = parameter("all", "banks that learn")
        forgetting: float = parameter(0.86, "forgetting factor", equation="5.3.3.8", ge=0.5, le=1)
        probability_floor: float = parameter(1e-3, "smallest probability", equation="5.2.3.2.6", ge=0, le=0.05)
        initial_covariance: float = parameter(
            1e8, "covariance at the start, over unit matrix", equation="5.3.4.1", gt=0, le=1e12, live=False
        )
        trace_limit: float = parameter(1e10, "trace beyond which the covariance stays as it is", gt=0, le=1e100)

    class Packed(WeighedBank.Packed):
        """Forgetting factor, whether only the winner learns, limit of the covariances."""

        forgetting: float
        winner_only: float
        trace_limit: float

    class State(WeighedBank.State):
        """Scratch, and an estimator for each bank."""

        product: Vector = vector(SIZE)
        banks: Records[ArxEstimate] = several(LANE)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.Packed.blank()
        cls.fill_bank(p, params, context)
        p.winner_only = float(params.adapting == "winner")
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Every bank at its hypothesis, all alike."""
        s = cls.State.zeros()
        cls.fill_alike(s, params)
        put_at_hypotheses(s.banks, params, context)
        return s

    @staticmethod
    def step(p: Packed, s: State, x: WeighedBank.Ports) -> None:
        """Weigh every bank by its prediction, and let it learn."""
        gather_voltage(p, s, x)
        if between_updates(p, x):
            return
        n = int(p.count)
        z = regress(p, s, x)
        best = -math.inf
        for i in range(n):
            best = max(best, judge(p, s, x, i, unexplained(s.banks[i].theta, s.h, z)))
        take_floored_softmax(s.log, s.likelihood, x.probability, n, best, p.floor, p.log_floor)
        winner = winner_of(x.probability, n)
        for i in range(n):
            if p.winner_only == 0.0 or i == winner:
                bank, error = s.banks[i], x.residual[i]
                estimate(
                    bank.theta, bank.covariance, s.h, s.product, SIZE, error, p.forgetting, p.forgetting, p.trace_limit
                )
