"""Kalman filters side by side, one for each hypothesis: what every bank of them shares."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal

import numpy as np
from scipy.linalg import solve_discrete_are

from core.block import Block, BlockParams, Context, Oscillator, Port, kernel, parameter, settled
from core.device.oscillator import transition
from core.diagnose.hypothesis import BankParams, Hypothesis, assumed_noise, lacking

COUNT, PROCESS, SENSOR, STEADY, PRINTED, EVERY, AT_START, MEMORY, LEAST_DRIVE, LANES = range(10)
"""Packed parameters of every bank; the lanes of the models follow, then a bank's own."""
PHI11, PHI12, PHI21, PHI22, GAMMA1, GAMMA2, GAIN1, GAIN2, PSI, WIDTH = range(10)
"""Lanes of the parameters, each as long as there are models."""
STARTED, LAST_CHARGE, LEVEL, OWN = range(4)
"""State of every bank; the lanes of the filters follow, then a bank's own."""
X1, X2, P11, P12, P22, RESIDUAL, COVARIANCE, INVERSE, HALF_LOG, DEPTH = range(10)
"""Lanes of the state; the inverse and half the logarithm of the residual covariance are kept while it stays."""
MEASURED, APPLIED, MIDDLE, CHARGE, PROBABILITY = range(5)
"""Ports of every bank."""
LEAST = 1e-12
"""Least residual covariance, as a share of R."""


@kernel
def applied_voltage(p: Any, s: Any, w: Any, io: Any) -> float:
    """Return the voltage of the interval that ends now, and keep its mean square over the shuttle's own memory.

    A bank that runs every N ticks is given the mean voltage of the ticks between.
    """
    if p[EVERY] != 1.0:
        u = (w[io[CHARGE]] - s[LAST_CHARGE]) / p[EVERY]
    elif p[AT_START] != 0.0:
        u = w[io[APPLIED]]
    else:
        u = w[io[MIDDLE]]
    s[LAST_CHARGE] = w[io[CHARGE]]
    s[LEVEL] = settled(p[MEMORY] * s[LEVEL] + (1.0 - p[MEMORY]) * u * u)
    return float(u)


@kernel
def driven(p: Any, s: Any) -> bool:
    """Say whether there is drive enough for residuals to be evidence."""
    return bool(s[LEVEL] >= p[LEAST_DRIVE])


@kernel
def filter_step(p: Any, s: Any, i: int, n: int, u: float, z: float, first: bool, seen: bool) -> float:
    r"""Predict one filter, unless this is its first sample; correct it, if there is a measurement; return r^2/psi.

    .. math:: x^-=\Phi x+\Gamma u,\quad P^-=\Phi P\Phi^T+\Gamma Q\Gamma^T

    .. math:: r=z-Hx^-,\quad\psi=HP^-H^T+R,\quad K=P^-H^T/\psi,\quad x=x^-+Kr,\quad P=(I-KH)P^-
    """
    a = LANES + i
    b = OWN + i
    steady = p[STEADY] != 0.0
    x1 = s[b + X1 * n]
    x2 = s[b + X2 * n]
    c11 = s[b + P11 * n]
    c12 = s[b + P12 * n]
    c22 = s[b + P22 * n]
    if not first:
        f11 = p[a + PHI11 * n]
        f12 = p[a + PHI12 * n]
        f21 = p[a + PHI21 * n]
        f22 = p[a + PHI22 * n]
        g1 = p[a + GAMMA1 * n]
        g2 = p[a + GAMMA2 * n]
        moved = f11 * x1 + f12 * x2 + g1 * u
        x2 = f21 * x1 + f22 * x2 + g2 * u
        x1 = moved
        if not steady:
            q1 = f11 * c11 + f12 * c12
            q2 = f11 * c12 + f12 * c22
            q3 = f21 * c11 + f22 * c12
            q4 = f21 * c12 + f22 * c22
            noise = g1 * p[PROCESS]
            c11 = q1 * f11 + q2 * f12 + g1 * noise
            c12 = q1 * f21 + q2 * f22 + g2 * noise
            c22 = q3 * f21 + q4 * f22 + g2 * g2 * p[PROCESS]
    if steady:
        psi = p[a + PSI * n]
    elif p[PRINTED] != 0.0:
        # the text prints psi without R, and without assumed noise that would end at nothing
        psi = max(c11, LEAST * p[SENSOR])
    else:
        psi = c11 + p[SENSOR]
    if psi != s[b + COVARIANCE * n]:
        s[b + COVARIANCE * n] = psi
        s[b + INVERSE * n] = 1.0 / psi
        s[b + HALF_LOG * n] = 0.5 * math.log(psi)
    inverse = s[b + INVERSE * n]
    residual = 0.0
    if seen:
        residual = settled(z - x1)
        if steady:
            k1 = p[a + GAIN1 * n]
            k2 = p[a + GAIN2 * n]
        else:
            innovation = inverse if p[PRINTED] == 0.0 else 1.0 / (c11 + p[SENSOR])
            k1 = c11 * innovation
            k2 = c12 * innovation
            c22 -= k2 * c12
            c12 -= k1 * c12
            c11 -= k1 * c11
        x1 += k1 * residual
        x2 += k2 * residual
    s[b + X1 * n] = settled(x1)
    s[b + X2 * n] = settled(x2)
    s[b + P11 * n] = c11
    s[b + P12 * n] = c12
    s[b + P22 * n] = c22
    s[b + RESIDUAL * n] = residual
    return float(residual * residual * inverse)


@kernel
def hand_over(s: Any, n: int, source: int, target: int) -> None:
    """Let a filter go on from where another is: its state and its covariance."""
    for lane in (X1, X2, P11, P12, P22):
        s[OWN + lane * n + target] = s[OWN + lane * n + source]


class FilterParams(BlockParams):
    """Assumptions of a Kalman filter."""

    process_noise_v: float = parameter(
        0.3, "assumed noise on the voltage, rms per sample", "V", equation="5.2.3.1.2", ge=0, le=100
    )
    sensor_noise_um: float | None = parameter(
        None, "assumed sensor noise; what the sensor has unless given", "um", gt=0, le=100
    )
    assumed_noise_scale: float = parameter(1.0, "factor on both assumed variances", gt=0, le=1e4)
    voltage: Literal["middle", "start"] = parameter(
        "middle", "voltage taken for an interval; of a held drive the same, of an analogue one the start is wrong"
    )
    least_drive_v: float = parameter(
        1e-3, "drive (rms over the shuttle's own memory) below which residuals are no evidence", "V", ge=0, le=100
    )
    initial_std_um: float = parameter(
        1.0, "uncertainty of the displacement at the start", "um", gt=0, le=100, live=False
    )


class KalmanParams(FilterParams, BankParams):
    """Assumptions of a bank of Kalman filters, and its hypotheses."""


class KalmanBank(Block):
    """Base of every bank of Kalman filters: the filters, not what is concluded from them."""

    Params: ClassVar[type[BlockParams]] = KalmanParams
    inputs: ClassVar[tuple[Port, ...]] = (
        Port("measured", "um", "measured displacement", source="sensor.displacement"),
        Port("applied", "V", "voltage applied at the start of the sample that ends now", source="drive.voltage"),
        Port("middle", "V", "voltage applied in the middle of the sample that ends now", source="drive.middle"),
        Port("charge", "V", "running sum of the applied voltage", source="drive.charge"),
    )
    outputs: ClassVar[tuple[Port, ...]] = (
        Port("probability", "1", "probability of the hypothesis", each="hypotheses"),
    )
    taps: ClassVar[tuple[Port, ...]] = (
        Port("residual", "um", "measured minus predicted displacement", each="hypotheses"),
        Port(
            "nis",
            "1",
            "normalised residual squared, 1 on average for a true and well tuned model",
            each="hypotheses",
        ),
    )

    sample_by_sample: ClassVar[bool] = True
    """Whether a posterior is a prior times a likelihood, so that a single sample can be explained."""

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants without mass or spring."""
        return lacking(device)

    @classmethod
    def prior(cls, params: Any, before: list[float]) -> list[float]:
        """Return the probabilities before a measurement from those after the one before."""
        return before

    @classmethod
    def log_likelihood(cls, params: Any, context: Context, residual: float, covariance: float, tone: float) -> float:
        """Return the logarithm of the density of a residual."""
        return gaussian(residual, covariance)

    @classmethod
    def filters(cls, params: Any, context: Context, hypotheses: list[Hypothesis] | None = None) -> list[float]:
        """Pack what every bank needs; steady gains from the Riccati equation, for those that offer them."""
        hypotheses = hypotheses or params.hypotheses
        scale = params.assumed_noise_scale
        q = params.process_noise_v**2 * scale
        r = (params.sensor_noise_um or assumed_noise(context)) ** 2 * scale
        lanes = np.zeros((WIDTH, len(hypotheses)))
        steady = getattr(params, "form", "") == "steady"
        printed = getattr(params, "residual_covariance", "") == "printed"
        for i, hypothesis in enumerate(hypotheses):
            device = hypothesis.oscillator(context.device)
            phi = transition(device.mass, device.damping, device.stiffness, context.dt_ms)
            rest = device.static_gain
            gamma = ((1.0 - phi[0]) * rest, -phi[2] * rest)
            lanes[:6, i] = (*phi, *gamma)
            if steady:
                lanes[6:, i] = steady_gain(phi, gamma, q, r, printed)
        memory = memory_ms(context)
        head = [
            len(hypotheses),
            q,
            r,
            steady,
            printed,
            context.every,
            params.voltage == "start",
            math.exp(-context.dt_ms / memory),
            params.least_drive_v**2,
        ]
        return [*map(float, head), *lanes.ravel().tolist()]

    @classmethod
    def at_rest(cls, params: Any, context: Context, count: int = 0) -> list[float]:
        """All filters at rest, as uncertain as the parameters say."""
        lanes = np.zeros((DEPTH, count or len(params.hypotheses)))
        lanes[P11] = params.initial_std_um**2
        lanes[P22] = (params.initial_std_um * context.device.natural_frequency) ** 2
        return [0.0] * OWN + lanes.ravel().tolist()


def gaussian(residual: float, covariance: float) -> float:
    """Return the logarithm of the normal density."""
    return -0.5 * (residual * residual / covariance + math.log(2.0 * math.pi * covariance))


def memory_ms(context: Context) -> float:
    """Return how long the shuttle remembers, 2m/beta; a cycle at least."""
    device = context.device
    cycle = 2.0 * math.pi / device.natural_frequency
    return max(2.0 * device.mass / device.damping, cycle) if device.damping > 0.0 else cycle


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
