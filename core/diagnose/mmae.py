"""Kalman bank with multiple-model adaptive estimation."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np
from scipy.linalg import solve_discrete_are

from core.block import Block, Context, Equation, FloatArray, Oscillator, Port, parameter, settled
from core.device.oscillator import transition
from core.diagnose.hypothesis import BankParams, assumed_noise

COUNT, FLOOR, LOG_FLOOR, PROCESS, SENSOR, STEADY, PRINTED, EVERY, LANES = range(9)
PHI11, PHI12, PHI21, PHI22, GAMMA1, GAMMA2, GAIN1, GAIN2, PSI = range(9)  # lanes of p
X1, X2, P11, P12, P22, LOG, COVARIANCE, LOG_COVARIANCE, LIKELIHOOD = range(9)  # lanes of s
MEASURED, APPLIED, CHARGE, PROBABILITY, RESIDUAL, NIS = range(6)
START, LAST_CHARGE, OWN = 0, 1, 2
LEAST = 1e-12
"""Least residual covariance, as a share of R."""


def mmae_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Predict and correct every filter, then weigh the hypotheses."""
    n = int(p[COUNT])
    z = w[io[MEASURED]]
    # a bank that runs every N ticks is given the mean voltage of the ticks between
    u = w[io[APPLIED]] if p[EVERY] == 1.0 else (w[io[CHARGE]] - s[LAST_CHARGE]) / p[EVERY]
    s[LAST_CHARGE] = w[io[CHARGE]]
    first = s[START] == 0.0
    s[START] = 1.0
    seen = math.isfinite(z)
    best = -math.inf
    for i in range(n):
        a = LANES + i
        b = OWN + i
        x1 = s[b + X1 * n]
        x2 = s[b + X2 * n]
        f11 = p[a + PHI11 * n]
        f12 = p[a + PHI12 * n]
        f21 = p[a + PHI21 * n]
        f22 = p[a + PHI22 * n]
        g1 = p[a + GAMMA1 * n]
        g2 = p[a + GAMMA2 * n]
        c11 = s[b + P11 * n]
        c12 = s[b + P12 * n]
        c22 = s[b + P22 * n]
        if not first:
            # x- = Phi x + Gamma u,  P- = Phi P Phi' + Gamma Q Gamma'
            y1 = f11 * x1 + f12 * x2 + g1 * u
            x2 = f21 * x1 + f22 * x2 + g2 * u
            x1 = y1
            q1 = f11 * c11 + f12 * c12
            q2 = f11 * c12 + f12 * c22
            q3 = f21 * c11 + f22 * c12
            q4 = f21 * c12 + f22 * c22
            c11 = q1 * f11 + q2 * f12 + g1 * g1 * p[PROCESS]
            c12 = q1 * f21 + q2 * f22 + g1 * g2 * p[PROCESS]
            c22 = q3 * f21 + q4 * f22 + g2 * g2 * p[PROCESS]
        residual = settled(z - x1) if seen else 0.0
        # psi = H P- H' + R ; the text prints it without R, and without assumed noise that would end at nothing
        psi = max(c11, LEAST * p[SENSOR]) if p[PRINTED] != 0.0 else c11 + p[SENSOR]
        innovation = c11 + p[SENSOR]
        k1 = c11 / innovation
        k2 = c12 / innovation
        if p[STEADY] != 0.0:
            k1 = p[a + GAIN1 * n]
            k2 = p[a + GAIN2 * n]
            psi = p[a + PSI * n]
        if seen:
            x1 += k1 * residual
            x2 += k2 * residual
            if p[STEADY] == 0.0:
                c22 -= k2 * c12
                c12 -= k1 * c12
                c11 -= k1 * c11
        if psi != s[b + COVARIANCE * n]:
            s[b + COVARIANCE * n] = psi
            s[b + LOG_COVARIANCE * n] = 0.5 * math.log(psi)
        nis = residual * residual / psi
        log = s[b + LOG * n]
        if seen:
            log += -0.5 * nis - s[b + LOG_COVARIANCE * n]
        s[b + LIKELIHOOD * n] = log
        best = max(best, log)
        s[b + X1 * n] = settled(x1)
        s[b + X2 * n] = settled(x2)
        s[b + P11 * n] = c11
        s[b + P12 * n] = c12
        s[b + P22 * n] = c22
        w[io[RESIDUAL] + i] = residual
        w[io[NIS] + i] = nis

    # p_k ~ p_k exp(-r^2/2psi)/sqrt(psi) in logarithms, then the floor
    total = 0.0
    for i in range(n):
        share = math.exp(s[OWN + i + LIKELIHOOD * n] - best)
        w[io[PROBABILITY] + i] = share
        total += share
    after = 0.0
    for i in range(n):
        share = max(w[io[PROBABILITY] + i] / total, p[FLOOR])
        w[io[PROBABILITY] + i] = share
        after += share
    shift = best + math.log(total * after)
    log_floor = p[LOG_FLOOR] - math.log(after)
    for i in range(n):
        share = w[io[PROBABILITY] + i]
        floored = p[FLOOR] > 0.0 and share == p[FLOOR]
        s[OWN + i + LOG * n] = log_floor if floored else s[OWN + i + LIKELIHOOD * n] - shift
        w[io[PROBABILITY] + i] = share / after


class Mmae(Block):
    r"""A Kalman filter for each hypothesis, weighed by how well it predicts (5.2.3).

    .. math:: x^-=\Phi x+\Gamma u,\quad P^-=\Phi P\Phi^T+\Gamma Q\Gamma^T,\quad \psi=HP^-H^T+R

    .. math:: r=z-Hx^-,\quad K=P^-H^T/\psi,\quad
        p_k\leftarrow\frac{p_k\,\psi_k^{-1/2}e^{-r_k^2/2\psi_k}}{\sum_j p_j\,\psi_j^{-1/2}e^{-r_j^2/2\psi_j}}

    Probabilities are kept as logarithms and above a floor. Without a floor the recursion as printed locks: after
    2000 healthy samples no fault of 1000 samples can repay the odds.
    """

    title = "Kalman bank (MMAE)"
    inputs = (
        Port("measured", "um", "measured displacement", source="sensor.displacement"),
        Port("applied", "V", "voltage applied over the sample that ends now", source="drive.voltage"),
        Port("charge", "V", "running sum of the applied voltage", source="drive.charge"),
    )
    outputs = (Port("probability", "1", "probability of the hypothesis", each="hypotheses"),)
    taps = (
        Port("residual", "um", "measured minus predicted displacement", each="hypotheses"),
        Port(
            "nis",
            "1",
            "normalised residual squared, 1 on average for a true and well tuned model",
            each="hypotheses",
        ),
    )
    equations = (
        Equation(
            "filter",
            r"x^-=\Phi x+\Gamma u,\; r=z-Hx^-,\; x^+=x^-+Kr,\; K=P^-H^T\psi^{-1}",
            "5.2.3.1.1-7",
            printed=r"\hat x(t_i)\ \text{on both sides, with the gain of the predictor } \Phi P H^T\psi^{-1}",
            why="either the filter form or the predictor form, not a mixture; the residual is taken before the update",
        ),
        Equation(
            "residual covariance",
            r"\psi=HP^-H^T+R",
            "5.2.3.2.1",
            printed=r"\psi=CPC^T",
            why="without R the filter believes its residuals hundreds of times too much: 732 false switches a "
            "run instead of 1",
        ),
        Equation(
            "probabilities",
            r"\ell_k\leftarrow\ell_k-\tfrac{r_k^2}{2\psi_k}-\tfrac12\ln\psi_k,"
            r"\quad p_k=\max(\mathrm{softmax}_k\,\ell,\;p_{min})",
            "5.2.3.2.6",
            printed=r"p_k(t_i)=\frac{f_k\,p_k(t_{i-1})}{\sum_j f_j\,p_j(t_{i-1})}",
            why="as printed the probabilities of the faults sink for ever while the device is healthy, and steps "
            "2 to 6 are never found",
        ),
    )

    class Params(BankParams):
        """Assumptions of the bank."""

        process_noise_v: float = parameter(
            0.3, "assumed noise on the voltage, rms per sample", "V", equation="5.2.3.1.2", ge=0, le=100
        )
        sensor_noise_um: float | None = parameter(
            None, "assumed sensor noise; what the sensor has unless given", "um", gt=0, le=100
        )
        assumed_noise_scale: float = parameter(1.0, "factor on both assumed variances", gt=0, le=1e4)
        probability_floor: float = parameter(
            1e-3, "smallest probability; 0 as printed", equation="5.2.3.2.6", ge=0, le=0.05
        )
        form: Literal["recursive", "steady"] = parameter("recursive", "covariances propagated, or gains at their limit")
        residual_covariance: Literal["correct", "printed"] = parameter(
            "correct", "psi with or without R", equation="5.2.3.2.1"
        )
        initial_std_um: float = parameter(
            1.0, "uncertainty of the displacement at the start", "um", gt=0, le=100, live=False
        )

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants without mass or spring."""
        return "" if device.mass > 0.0 and device.stiffness > 0.0 else "needs a device with mass and spring"

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step; steady gains from the Riccati equation."""
        scale = params.assumed_noise_scale
        q = params.process_noise_v**2 * scale
        r = (params.sensor_noise_um or assumed_noise(context)) ** 2 * scale
        floor = params.probability_floor
        n = len(params.hypotheses)
        lanes = np.zeros((9, n))
        steady = params.form == "steady"
        printed = params.residual_covariance == "printed"
        for i, hypothesis in enumerate(params.hypotheses):
            device = hypothesis.oscillator(context.device)
            phi = transition(device.mass, device.damping, device.stiffness, context.dt_ms)
            rest = device.static_gain
            gamma = ((1.0 - phi[0]) * rest, -phi[2] * rest)
            lanes[:6, i] = (*phi, *gamma)
            if steady:
                lanes[6:, i] = steady_gain(phi, gamma, q, r, printed)
        head = [n, floor, math.log(floor) if floor > 0 else 0.0, q, r, steady, printed, context.every]
        return np.concatenate([np.array(head, dtype=np.float64), lanes.ravel()])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """All filters at rest, all hypotheses alike."""
        n = len(params.hypotheses)
        lanes = np.zeros((9, n))
        lanes[P11] = params.initial_std_um**2
        lanes[P22] = (params.initial_std_um * context.device.natural_frequency) ** 2
        lanes[LOG] = -math.log(n)
        return np.concatenate([np.zeros(OWN), lanes.ravel()])

    step = mmae_step


def steady_gain(
    phi: tuple[float, float, float, float], gamma: tuple[float, float], q: float, r: float, printed: bool
) -> tuple[float, float, float]:
    """Return the filter gain and residual covariance in the limit."""
    transition_matrix = np.array(phi).reshape(2, 2)
    # a little noise on both states keeps the Riccati equation solvable when none is assumed
    noise = np.outer(gamma, gamma) * q + np.eye(2) * 1e-18
    prior = solve_discrete_are(transition_matrix.T, np.array([[1.0], [0.0]]), noise, np.array([[r]]))
    psi = prior[0, 0] + r
    return prior[0, 0] / psi, prior[1, 0] / psi, max(prior[0, 0], LEAST * r) if printed else psi
