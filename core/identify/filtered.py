r"""Identifiers of the continuous plant: voltage and displacement filtered by :math:`1/(s+\lambda)^2` (3.2.3, 3.3.2)."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np

from core.block import Context, FloatArray, parameter
from core.estimation import (
    DrivenFilter,
    StateFilter,
    driven_filter_of,
    filter_input,
    filter_of,
    filter_voltage,
    filtered_second_derivative,
    triangle,
)
from core.identify.identifier import (
    EstimatePorts,
    ExcitationParams,
    Identifier,
    IdentifierParams,
    IdentifierPorts,
    coefficients,
    excite,
    show_truth,
    worst,
)
from core.kernel import kernel
from core.matrix import lyapunov
from core.ports import tap
from core.record import Vector, vector
from core.voltage import Motion, moves, observed

N = 3
COEFFICIENTS = ("gain", "a1", "a2")


class RegressorFilterParams(ExcitationParams):
    """The filters."""

    filter_pole: float = parameter(
        1.0, "double pole of the filters over w0", equation="3.2.3.4", gt=0.05, le=10, live=False
    )
    between: Literal["line", "held"] = parameter(
        "line",
        "displacement between samples: on a straight line, or held, which biases by half a sample",
        equation="3.3.2.5",
    )


class FilteredParams(RegressorFilterParams, IdentifierParams):
    """Parameters of every identifier of kp, a1 and a2."""

    start: Literal["nominal", "zero"] = parameter("nominal", "estimate at the start", equation="3.3.2.8", live=False)
    range_ratio: float = parameter(100.0, "largest coefficient over nominal (projection), 0 for none", ge=0, le=1e6)


class Filtered(Identifier):
    """Base of the blocks that filter voltage and displacement of the device."""

    class Packed(Identifier.Packed):
        """Whether the displacement is held between samples, the two filters, mean noise of phi phi'."""

        held: float
        displacement_filter: StateFilter
        voltage_filter: DrivenFilter
        noise: Vector = vector(triangle(N))

    class State(Identifier.State):
        """Whether it has run, last displacement, the filtered signals, and the regressor built from them."""

        started: float
        last_y: float
        voltage: Motion
        displacement: Motion
        phi: Vector = vector(N)

    @classmethod
    def fill_filters(cls, p: Packed, params: Any, context: Context) -> None:
        """Pack the filters, and the mean of phi phi' that sensor noise causes behind them."""
        h = context.dt_ms * context.device.natural_frequency
        cls.fill_shared(p, params, context)
        p.held = float(params.between == "held")
        p.displacement_filter = filter_of(params.filter_pole, h)
        p.voltage_filter = driven_filter_of(params.filter_pole, h / context.every, context.analogue)
        p.noise[:] = noise_gram(params.filter_pole, h, p.held, context.sensor_noise_um)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.Packed.blank()
        cls.fill_filters(p, params, context)
        return p


class FilteredEstimator(Filtered):
    """Base of the identifiers of kp, a1 and a2."""

    class Packed(Filtered.Packed):
        """Whether it is enabled, largest coefficient over nominal, the nominal coefficients."""

        enabled: float
        range_ratio: float
        nominal: Vector = vector(N)

    class State(Filtered.State):
        """The estimate."""

        theta: Vector = vector(N)

    class Ports(EstimatePorts):
        """Estimate and truth, as kp, a1 and a2."""

        coefficient: Vector = tap("mixed", "estimated kp, a1 and a2, in um, V and 1/w0", labels=COEFFICIENTS)
        coefficient_true: Vector = tap("mixed", "true kp, a1 and a2", labels=COEFFICIENTS)
        residual: float = tap("um", "filtered acceleration minus its estimate")

    @classmethod
    def fill_nominal(cls, p: Packed, params: Any, context: Context) -> None:
        """Pack the numbers that every identifier of kp, a1 and a2 needs."""
        cls.fill_filters(p, params, context)
        p.nominal[:] = coefficients(context.device)

    @classmethod
    def fill_start(cls, s: State, params: Any, context: Context) -> None:
        """Write the estimate at the start; the filters are at zero."""
        if params.start == "nominal":
            s.theta[:] = coefficients(context.device)

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Start with filters at zero, and the estimate at the start."""
        s = cls.State.zeros()
        cls.fill_start(s, params, context)
        return s


def noise_gram(pole: float, h: float, held: float, noise_um: float) -> list[float]:
    r"""Return the lower triangle of the mean of :math:`\varphi\varphi^T` that white noise of the measurement causes.

    Each sample acts twice, at the end of an interval and at the start of the next:
    :math:`q_{i+1}=\Phi q_i+b_0n_i+b_1n_{i+1}`; its covariance is the solution of a Lyapunov equation in
    :math:`[q,n]`.
    """
    packed = filter_of(pole, h)

    def advanced(q: tuple[float, float], before: float, now: float) -> FloatArray:
        motion = Motion(np.array(q))
        filter_input(packed, motion, before, now)
        return np.asarray(motion.array)

    whole = np.zeros((3, 3))
    whole[:2] = np.column_stack(
        [advanced((1.0, 0.0), 0.0, 0.0), advanced((0.0, 1.0), 0.0, 0.0), advanced((0.0, 0.0), 1.0, held)]
    )
    new = np.append(advanced((0.0, 0.0), 0.0, 1.0 - held), 1.0)
    covariance = noise_um**2 * lyapunov(whole, np.outer(new, new))
    return [0.0, 0.0, float(covariance[1, 1]), 0.0, float(covariance[1, 0]), float(covariance[0, 0])]


@kernel
def follow_voltage(p: Filtered.Packed, s: Filtered.State, x: IdentifierPorts) -> None:
    """Advance the filter of the voltage over a tick."""
    if s.started != 0.0:
        u, middle, end = moves(x)
        filter_voltage(p.voltage_filter, s.voltage, u, middle, end)


@kernel
def observe(p: Filtered.Packed, s: Filtered.State, x: IdentifierPorts) -> tuple[bool, float]:
    r"""Filter the displacement; return whether there was a sample, and the :math:`z` it gives (3.3.2.6-7)."""
    y = observed(x)
    seen = math.isfinite(y)
    if not seen:
        y = s.last_y
    if s.started == 0.0:
        s.started = 1.0
        s.last_y = y
        return False, 0.0
    filter_input(p.displacement_filter, s.displacement, s.last_y, s.last_y if p.held != 0.0 else y)
    s.last_y = y
    s.phi[0] = s.voltage.x
    s.phi[1] = -s.displacement.v
    s.phi[2] = -s.displacement.x
    return seen, filtered_second_derivative(p.displacement_filter, s.displacement, y)


@kernel
def prediction(s: FilteredEstimator.State) -> float:
    """Return theta' phi."""
    return float(s.theta[0] * s.phi[0] + s.theta[1] * s.phi[1] + s.theta[2] * s.phi[2])


@kernel
def bounds(p: FilteredEstimator.Packed, i: int) -> tuple[float, float]:
    """Return the bounds of a coefficient: its nominal value divided by the range, and times the range."""
    near, far = p.nominal[i] / p.range_ratio, p.nominal[i] * p.range_ratio
    return min(near, far), max(near, far)


@kernel
def report(
    p: FilteredEstimator.Packed, s: FilteredEstimator.State, x: FilteredEstimator.Ports, residual: float
) -> None:
    """Write estimate, truth, error and excitation."""
    show_truth(x)
    x.coefficient_true[0] = p.nominal[0] * x.drive_gain / x.mass_scale
    x.coefficient_true[1] = p.nominal[1] * x.damping_scale / x.mass_scale
    x.coefficient_true[2] = p.nominal[2] * x.stiffness_scale / x.mass_scale
    for i in range(N):
        x.coefficient[i] = s.theta[i]
    if s.theta[0] != 0.0:
        heavier = p.nominal[0] / s.theta[0]
        x.estimate[0] = heavier
        x.estimate[1] = heavier * s.theta[2] / p.nominal[2]
        x.estimate[2] = heavier * s.theta[1] / p.nominal[1]
    x.residual = residual
    x.error_pct = worst(s.theta, x.coefficient_true, N)
    excite(p, p.noise, s.gram, s.phi, N, x)
