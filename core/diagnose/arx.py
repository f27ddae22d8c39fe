r"""Difference equations of the hypotheses: what every self-tuning bank shares.

.. math:: z_i=b_0u_{i-1}+b_1u_{i-2}-a_1z_{i-1}-a_2z_{i-2}=h_i^T\theta

The two voltages are means over their intervals, weighed as the nominal device does (`core.voltage`).
"""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np

from core import voltage
from core.block import TICK, Block, Context, Oscillator, Port, kernel, parameter, settled
from core.diagnose.hypothesis import BankParams, assumed_noise, lacking
from core.diagnose.kalman import gaussian, shuttle_memory

COUNT, EVERY, FILTER1, FILTER2, MEMORY, LEAST_DRIVE, INTERVAL = range(7)
LANES = INTERVAL + voltage.INTERVAL_SIZE
"""Packed parameters of every bank; the lanes of the hypotheses follow, then a bank's own."""
THETA, VARIANCE, HALF_LOG, WIDTH = 0, 4, 5, 6
"""Lanes of the parameters: the four coefficients, the variance of the equation error, half its logarithm."""
LEVEL, U1, U2, LATER1, LATER2, Z1, Z2, GATHERED = range(8)
"""State of every bank: mean square of the voltage, two samples of it, of what of it acts later, and of the measurement,
filtered; then the interval."""
OWN = GATHERED + voltage.STATES
MEASURED, APPLIED = range(2)
PROBABILITY, RESIDUAL_TAP, NIS_TAP = range(
    APPLIED + len(voltage.APPLIED_PORTS), APPLIED + len(voltage.APPLIED_PORTS) + 3
)
"""Ports of every bank."""
SIZE = 4
"""Number of coefficients."""


def coefficients(device: Oscillator, dt_ms: float) -> tuple[float, float, float, float]:
    """Return b0, b1, a1, a2 of a device under a held voltage."""
    return voltage.difference_equation(device, device.static_gain, dt_ms)


@kernel
def gathers(p: Any, s: Any, w: Any, io: Any) -> bool:
    """Take in the voltage of a tick; say whether a bank that runs every N of them is between two of its turns."""
    voltage.follow(p, INTERVAL, s, GATHERED, w[io[APPLIED]], w[io[APPLIED + 1]], w[io[APPLIED + 2]])
    return bool(p[EVERY] != 1.0 and w[TICK] % p[EVERY] != 0.0)


@kernel
def regress(p: Any, s: Any, w: Any, io: Any, h: int) -> float:
    """Write the regressor of this sample to ``h`` in the state, and return what it should explain.

    Voltage and measurement pass the same filter 1/A(q), if there is one. What was not measured is taken to be where
    the sample before was.
    """
    z = w[io[MEASURED]]
    u, later = voltage.weighed(p, INTERVAL, s, GATHERED)
    s[LEVEL] = settled(p[MEMORY] * s[LEVEL] + (1.0 - p[MEMORY]) * u * u)
    a1 = p[FILTER1]
    a2 = p[FILTER2]
    if not math.isfinite(z):
        z = (1.0 + a1) * s[Z1] + a2 * s[Z2]
    u = settled(u - a1 * s[U1] - a2 * s[U2])
    if a1 != 0.0 or a2 != 0.0:
        later = later - a1 * s[LATER1] - a2 * s[LATER2]
    later = settled(later)
    z = settled(z - a1 * s[Z1] - a2 * s[Z2])
    s[h] = u
    s[h + 1] = s[LATER1]
    s[h + 2] = -s[Z1]
    s[h + 3] = -s[Z2]
    s[U2] = s[U1]
    s[U1] = u
    s[LATER2] = s[LATER1]
    s[LATER1] = later
    s[Z2] = s[Z1]
    s[Z1] = z
    return float(z)


@kernel
def said(p: Any, s: Any, h: int, i: int, n: int) -> float:
    """Return what hypothesis i makes of the regressor."""
    at = LANES + i
    return float(s[h] * p[at] + s[h + 1] * p[at + n] + s[h + 2] * p[at + 2 * n] + s[h + 3] * p[at + 3 * n])


@kernel
def unexplained(s: Any, z: float, h: int, theta: int) -> float:
    """Return what coefficients kept at ``theta`` of the state do not explain of ``z``."""
    residual = z
    for j in range(SIZE):
        residual -= s[h + j] * s[theta + j]
    return float(residual)


@kernel
def driven(p: Any, s: Any) -> bool:
    """Say whether there is drive enough for residuals to be evidence; without it the quietest equation would win."""
    return bool(s[LEVEL] >= p[LEAST_DRIVE])


@kernel
def judge(p: Any, s: Any, w: Any, io: Any, log: int, i: int, n: int, residual: float) -> float:
    """Show the residual of hypothesis i; write and return the logarithm it leaves it with, from that at ``log``."""
    nis = residual * residual / p[LANES + VARIANCE * n + i]
    w[io[RESIDUAL_TAP] + i] = residual
    w[io[NIS_TAP] + i] = nis
    left = s[log + i]
    if driven(p, s):
        left = left - 0.5 * nis - p[LANES + HALF_LOG * n + i]
    s[log + n + i] = left
    return float(left)


class ArxParams(BankParams):
    """What every self-tuning bank assumes."""

    sensor_noise_um: float | None = parameter(
        None, "assumed sensor noise; what the sensor has unless given", "um", gt=0, le=100
    )
    assumed_noise_scale: float = parameter(1.0, "factor on the assumed variance", gt=0, le=1e4)
    least_drive_v: float = parameter(
        1e-3, "drive (rms over the shuttle's own memory) below which residuals are no evidence", "V", ge=0, le=100
    )


class ArxBank(Block):
    """Base of every self-tuning bank."""

    inputs: ClassVar[tuple[Port, ...]] = (
        Port("measured", "um", "measured displacement", source="sensor.displacement"),
        *voltage.APPLIED_PORTS,
    )
    outputs: ClassVar[tuple[Port, ...]] = (
        Port("probability", "1", "probability of the hypothesis", each="hypotheses"),
    )
    taps: ClassVar[tuple[Port, ...]] = (
        Port("residual", "um", "what the difference equation does not explain", each="hypotheses"),
        Port("nis", "1", "the same squared over its variance", each="hypotheses"),
    )

    every_tick: ClassVar[bool] = True

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

    evidence: ClassVar[str] = ""
    """What `log_likelihood` is, in LaTeX; nothing for the logarithm of the normal density."""

    @classmethod
    def log_likelihood(cls, params: Any, context: Context, residual: float, covariance: float, tone: float) -> float:
        """Return the logarithm of the density of a residual."""
        return gaussian(residual, covariance)

    @classmethod
    def equations_of(cls, params: Any, context: Context) -> list[float]:
        r"""Pack the difference equations, and the variance of their error.

        White sensor noise of variance :math:`\sigma^2` makes an equation error of
        :math:`\sigma^2(1+a_1^2+a_2^2)`; behind the filter 1/A it is white again, and as large as the noise.
        """
        variance = (params.sensor_noise_um or assumed_noise(context)) ** 2 * params.assumed_noise_scale
        filtered = getattr(params, "prefilter", False)
        nominal = coefficients(context.device, context.dt_ms)
        lanes = np.zeros((WIDTH, len(params.hypotheses)))
        for i, hypothesis in enumerate(params.hypotheses):
            theta = coefficients(hypothesis.oscillator(context.device), context.dt_ms)
            error = variance if filtered else variance * (1.0 + theta[2] ** 2 + theta[3] ** 2)
            lanes[:, i] = (*theta, error, 0.5 * math.log(error))
        head = [
            len(params.hypotheses),
            context.every,
            *(nominal[2:] if filtered else (0.0, 0.0)),
            shuttle_memory(context),
            params.least_drive_v**2,
            *voltage.pack_interval(context),
        ]
        return [*map(float, head), *lanes.ravel().tolist()]

    @classmethod
    def caution(cls, params: Any, context: Context, hz: float) -> str:
        """Tell of the hypothesis whose response to a tone is missed most."""
        return voltage.caution(context, {item.name: item.oscillator(context.device) for item in params.hypotheses}, hz)
