"""Kalman filters side by side, one for each hypothesis: what every bank of them shares."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal

import numpy as np
from scipy.linalg import solve_discrete_are

from core.block import Block, BlockParams, Context, Oscillator, Port, inlined, kernel, parameter, settled
from core.device.oscillator import transition
from core.diagnose.hypothesis import BankParams, Hypothesis, assumed_noise, lacking
from core.diagnose.lanes import LANE, lanes

COUNT, PROCESS, SENSOR, STEADY, PRINTED, EVERY, AT_START, MEMORY, LEAST_DRIVE, LANES = range(10)
"""Packed parameters of every bank; the lanes of the models follow, then a bank's own."""
PHI11, PHI12, PHI21, PHI22, GAMMA1, GAMMA2, GAIN1, GAIN2, PSI, INVERSE_PSI, WIDTH = range(11)
"""Lanes of the parameters."""
STARTED, LAST_CHARGE, LEVEL, OWN = range(4)
"""State of every bank; the lanes of the filters follow, then a bank's own."""
X1, X2, P11, P12, P22, RESIDUAL, NIS, COVARIANCE, INVERSE, HALF_LOG, DEPTH = range(11)
"""Lanes of the state; half the logarithm of the residual covariance is kept while it stays."""
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


@inlined
def filter_step(p: Any, s: Any, i: int, lane: int, u: float, z: float, first: bool, seen: bool) -> int:
    r"""Predict one filter, unless this is its first sample; correct it, if there is a measurement.

    .. math:: x^-=\Phi x+\Gamma u,\quad P^-=\Phi P\Phi^T+\Gamma Q\Gamma^T

    .. math:: r=z-Hx^-,\quad\psi=HP^-H^T+R,\quad K=P^-H^T/\psi,\quad x=x^-+Kr,\quad P=(I-KH)P^-

    What is decided is the same for all filters, so it chooses between values and not between ways: a loop of this
    stays one of vectors. Returns 1 if the residual covariance has changed, so that its logarithm is no longer right.
    """
    a = LANES + i
    b = OWN + i
    printed = p[PRINTED] != 0.0
    c11 = s[b + P11 * lane]
    c12 = s[b + P12 * lane]
    c22 = s[b + P22 * lane]
    f11 = p[a + PHI11 * lane]
    f12 = p[a + PHI12 * lane]
    f21 = p[a + PHI21 * lane]
    f22 = p[a + PHI22 * lane]
    g1 = p[a + GAMMA1 * lane]
    g2 = p[a + GAMMA2 * lane]
    q1 = f11 * c11 + f12 * c12
    q2 = f11 * c12 + f12 * c22
    q3 = f21 * c11 + f22 * c12
    q4 = f21 * c12 + f22 * c22
    noise = g1 * p[PROCESS]
    c11 = c11 if first else q1 * f11 + q2 * f12 + g1 * noise
    c12 = c12 if first else q1 * f21 + q2 * f22 + g2 * noise
    c22 = c22 if first else q3 * f21 + q4 * f22 + g2 * g2 * p[PROCESS]
    total = c11 + p[SENSOR]
    # the text prints psi without R, and without assumed noise that would end at nothing
    psi = max(c11, LEAST * p[SENSOR]) if printed else total
    inverse = 1.0 / psi
    innovation = 1.0 / total if printed else inverse
    k1 = c11 * innovation
    k2 = c12 * innovation
    correct_state(p, s, i, lane, u, z, first, seen, k1, k2, inverse)
    s[b + P11 * lane] = c11 - k1 * c11 if seen else c11
    s[b + P12 * lane] = c12 - k1 * c12 if seen else c12
    s[b + P22 * lane] = c22 - k2 * c12 if seen else c22
    changed = 1 if psi != s[b + COVARIANCE * lane] else 0
    s[b + COVARIANCE * lane] = psi
    return changed


@inlined
def correct_state(
    p: Any, s: Any, i: int, lane: int, u: float, z: float, first: bool, seen: bool, k1: float, k2: float, inverse: float
) -> None:
    """Predict the state of one filter and correct it by a known gain."""
    a = LANES + i
    b = OWN + i
    x1 = s[b + X1 * lane]
    x2 = s[b + X2 * lane]
    moved1 = p[a + PHI11 * lane] * x1 + p[a + PHI12 * lane] * x2 + p[a + GAMMA1 * lane] * u
    moved2 = p[a + PHI21 * lane] * x1 + p[a + PHI22 * lane] * x2 + p[a + GAMMA2 * lane] * u
    x1 = x1 if first else moved1
    x2 = x2 if first else moved2
    residual = settled(z - x1) if seen else 0.0
    s[b + X1 * lane] = settled(x1 + k1 * residual)
    s[b + X2 * lane] = settled(x2 + k2 * residual)
    s[b + RESIDUAL * lane] = residual
    s[b + INVERSE * lane] = inverse
    s[b + NIS * lane] = residual * residual * inverse


@inlined
def filters_step(
    p: Any, s: Any, w: Any, n: int, u: float, z: float, first: bool, seen: bool, at: int, nis: int
) -> bool:
    """Predict and correct all filters; show the residuals at ``at`` of the signals, their squares over psi at ``nis``.

    Returns whether a residual covariance has changed, so that its logarithm is no longer right.
    """
    changed = 0
    if p[STEADY] == 0.0:
        for i in range(n):
            changed += filter_step(p, s, i, LANE, u, z, first, seen)
    else:
        for i in range(n):
            a = LANES + i
            psi = p[a + PSI * LANE]
            correct_state(
                p, s, i, LANE, u, z, first, seen, p[a + GAIN1 * LANE], p[a + GAIN2 * LANE], p[a + INVERSE_PSI * LANE]
            )
            changed += 1 if psi != s[OWN + COVARIANCE * LANE + i] else 0
            s[OWN + COVARIANCE * LANE + i] = psi
    for i in range(n):
        w[at + i] = s[OWN + RESIDUAL * LANE + i]
        w[nis + i] = s[OWN + NIS * LANE + i]
    return changed != 0


@kernel
def take_logarithms(s: Any, n: int) -> None:
    """Keep half the logarithm of every residual covariance."""
    for i in range(n):
        s[OWN + HALF_LOG * LANE + i] = 0.5 * math.log(s[OWN + COVARIANCE * LANE + i])


@inlined
def judge(s: Any, log: int, likelihood: int, n: int, evidence: bool) -> float:
    """Write the logarithms the residuals leave, from those at ``log`` to ``likelihood``; return the largest."""
    best = -math.inf
    for i in range(n):
        before = s[log + i]
        after = before - (0.5 * s[OWN + NIS * LANE + i] + s[OWN + HALF_LOG * LANE + i])
        after = after if evidence else before
        s[likelihood + i] = after
        best = max(best, after)
    return best


@kernel
def hand_over(s: Any, lane: int, source: int, target: int) -> None:
    """Let a filter go on from where another is: its state and its covariance."""
    for row in (X1, X2, P11, P12, P22):
        s[OWN + row * lane + target] = s[OWN + row * lane + source]


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
        table = lanes(WIDTH, len(hypotheses))
        steady = getattr(params, "form", "") == "steady"
        printed = getattr(params, "residual_covariance", "") == "printed"
        for i, hypothesis in enumerate(hypotheses):
            device = hypothesis.oscillator(context.device)
            phi = transition(device.mass, device.damping, device.stiffness, context.dt_ms)
            rest = device.static_gain
            gamma = ((1.0 - phi[0]) * rest, -phi[2] * rest)
            table[:6, i] = (*phi, *gamma)
            if steady:
                table[GAIN1 : PSI + 1, i] = steady_gain(phi, gamma, q, r, printed)
                table[INVERSE_PSI, i] = 1.0 / table[PSI, i]
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
        return [float(value) for value in (*head, *table.ravel())]

    @classmethod
    def at_rest(cls, params: Any, context: Context, more: tuple[float, ...] = (), count: int = 0) -> list[float]:
        """All filters at rest, as uncertain as the parameters say; then lanes of a bank's own, each of one value."""
        table = lanes(DEPTH + len(more), count or len(params.hypotheses))
        table[P11] = params.initial_std_um**2
        table[P22] = (params.initial_std_um * context.device.natural_frequency) ** 2
        for row, value in enumerate(more, DEPTH):
            table[row] = value
        return [0.0] * OWN + [float(value) for value in table.ravel()]


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
