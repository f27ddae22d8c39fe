r"""Difference equations of the hypotheses, which all self-tuning banks share.

.. math:: z_i=b_0u_{i-1}+b_1u_{i-2}-a_1z_{i-1}-a_2z_{i-2}=h_i^T\theta

The two voltages are means over their intervals, weighed as the nominal device does (`core.voltage`).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from core import voltage
from core.block import Context, Oscillator, Stage, parameter
from core.diagnose.bank import Bank
from core.diagnose.hypothesis import BankParams, assumed_noise
from core.diagnose.lanes import LANE
from core.diagnose.weights import floored
from core.elementary import log
from core.estimation import diagonal, triangle
from core.kernel import flush_tiny, kernel
from core.ports import output, tap
from core.record import Choice, Record, Vector, vector
from core.voltage import (
    Gathered,
    Interval,
    ObservedPorts,
    gather,
    interval_of,
    observed,
    shuttle_memory,
    weighed_voltages,
)

REGRESSOR = Stage("Regressor", "applied measured", "h")
SIZE = 4
"""Number of coefficients."""


class ArxEstimate(Record):
    """Estimated coefficients, and the lower triangle of their covariance."""

    theta: Vector = vector(SIZE)
    covariance: Vector = vector(triangle(SIZE))


def coefficients(device: Oscillator, dt_ms: float) -> tuple[float, float, float, float]:
    """Return b0, b1, a1, a2 of a device under a held voltage."""
    return voltage.difference_equation(device, device.static_gain, dt_ms)


def coefficients_of(params: Any, context: Context) -> list[tuple[float, float, float, float]]:
    """Return the coefficients of every hypothesis."""
    return [coefficients(item.oscillator(context.device), context.dt_ms) for item in params.hypotheses]


def put_at_hypotheses(banks: Iterable[ArxEstimate], params: Any, context: Context) -> None:
    """Let the estimator of every hypothesis begin there."""
    for bank, theta in zip(banks, coefficients_of(params, context), strict=False):
        bank.theta[:] = theta
        bank.covariance[:] = diagonal(SIZE, params.initial_covariance)


@kernel
def gather_voltage(p: ArxBank.Packed, s: ArxBank.State, x: ArxBank.Ports) -> None:
    """Add the voltage of a tick to the interval."""
    gather(p.interval, s.gathered, x.applied, x.middle, x.end)


@kernel
def between_updates(p: ArxBank.Packed, x: ArxBank.Ports) -> bool:
    """Say whether a bank that runs every N ticks does not run at this one."""
    return bool(p.every != 1.0 and int(x.tick) % int(p.every) != 0)


@kernel
def regress(p: ArxBank.Packed, s: ArxBank.State, x: ArxBank.Ports) -> float:
    """Write the regressor of this sample, and return the filtered measurement it should explain.

    Voltage and measurement pass the same filter 1/A(q), if there is one. A missing measurement is replaced by the last
    one.
    """
    z = observed(x)
    u, later = weighed_voltages(p.interval, s.gathered)
    s.power = flush_tiny(p.memory * s.power + (1.0 - p.memory) * u * u)
    a1 = p.filter_a1
    a2 = p.filter_a2
    if not math.isfinite(z):
        z = (1.0 + a1) * s.z1 + a2 * s.z2
    u = flush_tiny(u - a1 * s.u1 - a2 * s.u2)
    if a1 != 0.0 or a2 != 0.0:
        later = later - a1 * s.later1 - a2 * s.later2
    later = flush_tiny(later)
    z = flush_tiny(z - a1 * s.z1 - a2 * s.z2)
    s.h[0] = u
    s.h[1] = s.later1
    s.h[2] = -s.z1
    s.h[3] = -s.z2
    s.u2 = s.u1
    s.u1 = u
    s.later2 = s.later1
    s.later1 = later
    s.z2 = s.z1
    s.z1 = z
    return float(z)


@kernel
def predicted(p: ArxBank.Packed, h: Vector, i: int) -> float:
    """Return the prediction of hypothesis i from a regressor."""
    return float(h[0] * p.b0[i] + h[1] * p.b1[i] + h[2] * p.a1[i] + h[3] * p.a2[i])


@kernel
def unexplained(theta: Vector, h: Vector, z: float) -> float:
    """Return ``z`` less the prediction of estimated coefficients."""
    residual = z
    for j in range(SIZE):
        residual -= h[j] * theta[j]
    return float(residual)


@kernel
def driven(p: ArxBank.Packed, s: ArxBank.State) -> bool:
    """Say whether there is drive enough for residuals to be evidence; without it the quietest equation would win."""
    return bool(s.power >= p.least_power)


@kernel
def judge(p: WeighedBank.Packed, s: WeighedBank.State, x: ArxBank.Ports, i: int, residual: float) -> float:
    """Show the residual of hypothesis i; write and return its logarithm with the log-likelihood of the residual."""
    nis = residual * residual / p.variance[i]
    x.residual[i] = residual
    x.nis[i] = nis
    likelihood = s.log[i]
    if driven(p, s):
        likelihood = likelihood - 0.5 * nis - p.half_log[i]
    s.likelihood[i] = likelihood
    return float(likelihood)


class ArxParams(BankParams):
    """Assumptions of every self-tuning bank."""

    sensor_noise_um: float | None = parameter(
        None, "assumed sensor noise; the sensor's own unless given", "um", gt=0, le=100
    )
    assumed_noise_scale: float = parameter(1.0, "factor on the assumed variance", gt=0, le=1e4)
    least_drive_v: float = parameter(
        1e-3, "drive (rms over the shuttle's own memory) below which residuals are no evidence", "V", ge=0, le=100
    )


class ArxBank(Bank):
    """Base of every self-tuning bank."""

    class Packed(Record):
        """Hypotheses and ticks between two updates; filter, memory and least power of the voltage; the equations.

        Each hypothesis has four coefficients, the variance of the equation error, and half its logarithm.
        """

        count: Choice
        every: Choice
        filter_a1: float
        filter_a2: float
        memory: float
        least_power: float
        interval: Interval
        b0: Vector = vector(LANE)
        b1: Vector = vector(LANE)
        a1: Vector = vector(LANE)
        a2: Vector = vector(LANE)
        variance: Vector = vector(LANE)
        half_log: Vector = vector(LANE)

    class State(Record):
        """Mean square of the voltage; two filtered samples of it, of its later effect, and of the measurement.

        Then the interval, and the regressor.
        """

        power: float
        u1: float
        u2: float
        later1: float
        later2: float
        z1: float
        z2: float
        gathered: Gathered
        h: Vector = vector(SIZE)

    class Ports(ObservedPorts):
        """Measurement and voltage, and the residual and probability of each hypothesis."""

        probability: Vector = output("1", "probability of the hypothesis", each="hypotheses")
        residual: Vector = tap("um", "residual of the difference equation", each="hypotheses")
        nis: Vector = tap("1", "the same squared over its variance", each="hypotheses")

    @classmethod
    def filters_signals(cls, params: Any) -> bool:
        """Say whether voltage and measurement pass the filter 1/A(q) of the healthy device."""
        return False

    @classmethod
    def fill_equations(cls, p: Packed, params: Any, context: Context) -> None:
        r"""Pack the difference equations, and the variance of their error.

        White sensor noise of variance :math:`\sigma^2` makes an equation error of
        :math:`\sigma^2(1+a_1^2+a_2^2)`; behind the filter 1/A it is white again, and as large as the noise.
        """
        noise_um = params.sensor_noise_um or assumed_noise(context)
        variance = noise_um * noise_um * params.assumed_noise_scale
        filtered = cls.filters_signals(params)
        _, _, a1, a2 = coefficients(context.device, context.dt_ms)
        p.count = len(params.hypotheses)
        p.every = context.every
        p.filter_a1, p.filter_a2 = (a1, a2) if filtered else (0.0, 0.0)
        p.memory = shuttle_memory(context.device, context.dt_ms)
        p.least_power = params.least_drive_v * params.least_drive_v
        p.interval = interval_of(context)
        for i, theta in enumerate(coefficients_of(params, context)):
            _, _, a1, a2 = theta
            error = variance if filtered else variance * (1.0 + a1 * a1 + a2 * a2)
            p.b0[i], p.b1[i], p.a1[i], p.a2[i] = theta
            p.variance[i], p.half_log[i] = error, 0.5 * log(error)

    @classmethod
    def caution(cls, params: Any, context: Context, hz: float) -> str:
        """Name the hypothesis whose difference equation loses most of its response to a tone."""
        return voltage.caution(context, {item.name: item.oscillator(context.device) for item in params.hypotheses}, hz)


class WeighedBank(ArxBank):
    """Base of the banks that weigh their hypotheses sample by sample, with a floor under the probabilities."""

    class Packed(ArxBank.Packed):
        """The floor and its logarithm."""

        floor: float
        log_floor: float

    class State(ArxBank.State):
        """Logarithms of the probabilities, and the logarithms of this sample before they are normalised."""

        log: Vector = vector(LANE)
        likelihood: Vector = vector(LANE)

    @classmethod
    def floor(cls, params: Any) -> float:
        """Return the smallest probability."""
        return float(params.probability_floor)

    @classmethod
    def fill_bank(cls, p: Packed, params: Any, context: Context) -> None:
        """Pack the equations and the floor."""
        cls.fill_equations(p, params, context)
        p.floor, p.log_floor = floored(params.probability_floor)

    @classmethod
    def fill_alike(cls, s: State, params: Any) -> None:
        """Begin with all hypotheses alike."""
        n = len(params.hypotheses)
        s.log[:n] = -log(n)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.Packed.blank()
        cls.fill_bank(p, params, context)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """At rest, before the first sample, all hypotheses alike."""
        s = cls.State.zeros()
        cls.fill_alike(s, params)
        return s
