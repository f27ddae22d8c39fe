"""Self-tuning banks that each learn from a simulated sub-system of their own."""

from __future__ import annotations

import math
from typing import Any

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
from core.diagnose.hypothesis import assumed_noise
from core.diagnose.lanes import LANE
from core.diagnose.weights import take_floored_softmax
from core.estimation import estimate
from core.kernel import flush_tiny
from core.noise import key, normal
from core.record import Records, Vector, several, vector


class ReferenceEstimator(ArxEstimate):
    """An estimator and its own record: two true samples and two measured ones."""

    clean1: float
    clean2: float
    seen1: float
    seen2: float


class ReferenceBanks(WeighedBank):
    r"""Each bank identifies its own sub-system, which runs in parallel with the device, and is tried on the device.

    .. math:: \hat\theta_k\ \text{from}\ (u,z_k),\qquad r_k=z-h^T\hat\theta_k

    The records never change, so the forgetting factor hardly affects the verdict.
    """

    title = "Self-tuning banks with records of their own"
    weaknesses = (
        "Under one sine below 1 kHz noise decides more than the device: over the seven steps of 5.2.4, at 20 kHz and "
        "10 nm, it is right for 99 % of the samples at 2 kHz, 98 % at 1 kHz, 74 % at 500 Hz and 61 % at 200 Hz.",
        "With 50 nm of noise it is right for 99 % at 2 kHz and 72 % at 1 kHz; IMM is right for 92 % there.",
    )
    equations = (Equation("residual", r"r_k=z_i-h_i^T\hat\theta_k,\quad \hat\theta_k\leftarrow(u,z_k)", "5.3.2-3"),)
    structure = (
        REGRESSOR,
        Stage("Estimators with records of their own", "h", "banks", ("residual",)),
        Stage("Residuals", "banks h measured", "residual nis", ("residual",)),
        Stage("Likelihoods", "log nis", "likelihood"),
        Stage("Weights", "likelihood", "log probability"),
    )

    class Params(ArxParams):
        """Memory and floor."""

        forgetting: float = parameter(0.86, "forgetting factor", equation="5.3.3.8", ge=0.5, le=1)
        probability_floor: float = parameter(1e-3, "smallest probability", equation="5.2.3.2.6", ge=0, le=0.05)
        initial_covariance: float = parameter(
            1e8, "covariance at the start, over unit matrix", equation="5.3.4.1", gt=0, le=1e12, live=False
        )
        trace_limit: float = parameter(1e10, "trace beyond which the covariance stays as it is", gt=0, le=1e100)

    class Packed(WeighedBank.Packed):
        """Forgetting factor, limit of the covariances, noise of the records and the key of each."""

        forgetting: float
        trace_limit: float
        noise_um: float
        keys: Vector = vector(LANE)

    class State(WeighedBank.State):
        """Regressor of a record, scratch, and the banks."""

        g: Vector = vector(SIZE)
        product: Vector = vector(SIZE)
        banks: Records[ReferenceEstimator] = several(LANE)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.Packed.blank()
        cls.fill_bank(p, params, context)
        p.noise_um = params.sensor_noise_um or assumed_noise(context)
        for i in range(len(params.hypotheses)):
            p.keys[i] = key(context.seed, f"diagnose.record.{i}")
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Every bank at its hypothesis, every record zero."""
        s = cls.State.zeros()
        cls.fill_alike(s, params)
        put_at_hypotheses(s.banks, params, context)
        return s

    @staticmethod
    def step(p: Packed, s: State, x: WeighedBank.Ports) -> None:
        """Let every bank learn from its own record, and weigh it by its prediction of the device."""
        gather_voltage(p, s, x)
        if between_updates(p, x):
            return
        n = int(p.count)
        z = regress(p, s, x)
        best = -math.inf
        for i in range(n):
            bank = s.banks[i]
            best = max(best, judge(p, s, x, i, unexplained(bank.theta, s.h, z)))
            # the bank's sub-system under the same voltage, as its own sensor would measure it
            clean = s.h[0] * p.b0[i] + s.h[1] * p.b1[i] - bank.clean1 * p.a1[i] - bank.clean2 * p.a2[i]
            seen = clean + p.noise_um * normal(p.keys[i], x.tick)
            s.g[0] = s.h[0]
            s.g[1] = s.h[1]
            s.g[2] = -bank.seen1
            s.g[3] = -bank.seen2
            error = unexplained(bank.theta, s.g, seen)
            estimate(
                bank.theta, bank.covariance, s.g, s.product, SIZE, error, p.forgetting, p.forgetting, p.trace_limit
            )
            bank.clean2 = bank.clean1
            bank.clean1 = flush_tiny(clean)
            bank.seen2 = bank.seen1
            bank.seen1 = seen
        take_floored_softmax(s.log, s.likelihood, x.probability, n, best, p.floor, p.log_floor)
