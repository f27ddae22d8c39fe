r"""Identifiers of the continuous plant: voltage and displacement filtered by :math:`1/(s+\lambda)^2` (3.2.3, 3.3.2)."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal

import numpy as np
from scipy.linalg import solve_discrete_lyapunov

from core.block import Context, FloatArray, Port, kernel, parameter
from core.estimation import (
    DRIVEN_SIZE,
    FILTER_SIZE,
    advance_filter,
    drive_filter,
    driven_filter,
    second_derivative,
    state_filter,
    triangle,
)
from core.identify.identifier import (
    APPLIED,
    DAMPING_SCALE,
    DRIVE_GAIN,
    ERROR,
    ESTIMATE,
    EXCITATION,
    MASS_SCALE,
    MEASURED,
    OWN_PARAMETER,
    OWN_PORT,
    STIFFNESS_SCALE,
    TRUTH,
    ExcitationParams,
    Identifier,
    IdentifierParams,
    between_turns,
    coefficients,
    excite,
    room,
    show_truth,
    worst,
)
from core.voltage import moved

HELD, FILTER, VOLTAGE_FILTER, NOMINAL, RANGE = (
    OWN_PARAMETER + n for n in (0, 1, 1 + FILTER_SIZE, 1 + FILTER_SIZE + DRIVEN_SIZE, 4 + FILTER_SIZE + DRIVEN_SIZE)
)
NOISE = RANGE + 1
OWN_P = NOISE + triangle(3)
START, LAST_Y, U_FILTER, Y_FILTER, PHI, THETA = 0, 1, 2, 4, 6, 9
GRAM = THETA + 3
OWN_S = GRAM + room(3)
ESTIMATE_PORT, ERROR_PORT, TRUTH_PORT, COEFFICIENT, COEFFICIENT_TRUE, RESIDUAL, EXCITATION_PORT = range(
    OWN_PORT, OWN_PORT + 7
)
OWN_TAP = EXCITATION_PORT + 3
COEFFICIENTS = ("gain", "a1", "a2")
TAPS = (
    TRUTH,
    Port("coefficient", "mixed", "estimated kp, a1 and a2, in um, V and 1/w0", labels=COEFFICIENTS),
    Port("coefficient_true", "mixed", "true kp, a1 and a2", labels=COEFFICIENTS),
    Port("residual", "um", "filtered acceleration minus what the estimate says it is"),
    *EXCITATION,
)


class FilterParams(ExcitationParams):
    """The filters."""

    filter_pole: float = parameter(
        1.0, "double pole of the filters over w0", equation="3.2.3.4", gt=0.05, le=10, live=False
    )
    between: Literal["line", "held"] = parameter(
        "line",
        "displacement between samples: on a straight line, or held, which biases by half a sample",
        equation="3.3.2.5",
    )


class FilteredParams(FilterParams, IdentifierParams):
    """What every identifier of kp, a1 and a2 may be told."""

    start: Literal["nominal", "zero"] = parameter("nominal", "estimate at the start", equation="3.3.2.8", live=False)
    range_ratio: float = parameter(100.0, "largest coefficient over nominal (projection), 0 for none", ge=0, le=1e6)


class Filtered(Identifier):
    """Base of the identifiers of kp, a1 and a2."""

    outputs: ClassVar[tuple[Port, ...]] = (ESTIMATE, ERROR)
    taps: ClassVar[tuple[Port, ...]] = TAPS

    @classmethod
    def filters(cls, params: Any, context: Context) -> list[float]:
        """Pack everything up to what the law itself needs."""
        h = context.dt_ms * context.device.natural_frequency
        held = float(params.between == "held")
        filters = state_filter(params.filter_pole, h)
        return [
            *cls.shared(params, context),
            held,
            *filters,
            *driven_filter(params.filter_pole, h / context.every, context.analogue),
            *coefficients(context.device),
            getattr(params, "range_ratio", 0.0),
            *noise_gram(params.filter_pole, h, held, context.sensor_noise_um),
        ]

    @classmethod
    def begin(cls, params: Any, context: Context) -> FloatArray:
        """Return filters at rest and the estimate at the start."""
        start = np.zeros(OWN_S)
        if getattr(params, "start", "nominal") == "nominal":
            start[THETA : THETA + 3] = coefficients(context.device)
        return start


def noise_gram(pole: float, h: float, held: float, noise_um: float) -> list[float]:
    r"""Return the lower triangle of the mean of :math:`\varphi\varphi^T` that white noise of the measurement makes.

    A sample takes part twice, at the end of an interval and at the start of the next:
    :math:`q_{i+1}=\Phi q_i+b_0n_i+b_1n_{i+1}`, whose covariance is the solution of a Lyapunov equation in
    :math:`[q,n]`.
    """
    packed = np.array(state_filter(pole, h))

    def advanced(q: tuple[float, float], before: float, now: float) -> FloatArray:
        s = np.array(q)
        advance_filter(packed, 0, s, 0, before, now)
        return s

    whole = np.zeros((3, 3))
    whole[:2] = np.column_stack(
        [advanced((1.0, 0.0), 0.0, 0.0), advanced((0.0, 1.0), 0.0, 0.0), advanced((0.0, 0.0), 1.0, held)]
    )
    new = np.append(advanced((0.0, 0.0), 0.0, 1.0 - held), 1.0)
    covariance = noise_um**2 * solve_discrete_lyapunov(whole, np.outer(new, new))
    return [0.0, 0.0, float(covariance[1, 1]), 0.0, float(covariance[1, 0]), float(covariance[0, 0])]


@kernel
def gathers(p: Any, s: Any, w: Any, io: Any) -> bool:
    """Let the filter of the voltage follow a tick; say whether it is between two turns."""
    if s[START] != 0.0:
        u, middle, end = moved(w, io, APPLIED)
        drive_filter(p, VOLTAGE_FILTER, s, U_FILTER, u, middle, end)
    return between_turns(p, w)


@kernel
def observe(p: Any, s: Any, w: Any, io: Any) -> tuple[bool, float]:
    r"""Filter the displacement, and return whether there was a sample and :math:`z-\theta^T\varphi` (3.3.2.6-7)."""
    y = w[io[MEASURED]]
    seen = math.isfinite(y)
    if not seen:
        y = s[LAST_Y]
    if s[START] == 0.0:
        s[START] = 1.0
        s[LAST_Y] = y
        return False, 0.0
    advance_filter(p, FILTER, s, Y_FILTER, s[LAST_Y], s[LAST_Y] if p[HELD] != 0.0 else y)
    s[LAST_Y] = y
    s[PHI], s[PHI + 1], s[PHI + 2] = s[U_FILTER], -s[Y_FILTER + 1], -s[Y_FILTER]
    return seen, second_derivative(p, FILTER, s, Y_FILTER, y) - prediction(s)


@kernel
def prediction(s: Any) -> float:
    """Return theta' phi."""
    return float(s[THETA] * s[PHI] + s[THETA + 1] * s[PHI + 1] + s[THETA + 2] * s[PHI + 2])


@kernel
def bounds(p: Any, i: int) -> tuple[float, float]:
    """Return the interval of a coefficient: its nominal value over and times the range."""
    near, far = p[NOMINAL + i] / p[RANGE], p[NOMINAL + i] * p[RANGE]
    return min(near, far), max(near, far)


@kernel
def report(p: Any, s: Any, w: Any, io: Any, residual: float) -> None:
    """Write estimate, truth, error and excitation."""
    show_truth(w, io, TRUTH_PORT)
    mass = w[io[MASS_SCALE]]
    true = io[COEFFICIENT_TRUE]
    w[true] = p[NOMINAL] * w[io[DRIVE_GAIN]] / mass
    w[true + 1] = p[NOMINAL + 1] * w[io[DAMPING_SCALE]] / mass
    w[true + 2] = p[NOMINAL + 2] * w[io[STIFFNESS_SCALE]] / mass
    at = io[COEFFICIENT]
    for i in range(3):
        w[at + i] = s[THETA + i]
    if s[THETA] != 0.0:
        heavier = p[NOMINAL] / s[THETA]
        w[io[ESTIMATE_PORT]] = heavier
        w[io[ESTIMATE_PORT] + 1] = heavier * s[THETA + 2] / p[NOMINAL + 2]
        w[io[ESTIMATE_PORT] + 2] = heavier * s[THETA + 1] / p[NOMINAL + 1]
    w[io[RESIDUAL]] = residual
    w[io[ERROR_PORT]] = worst(s, THETA, w, true, 3)
    excite(p, NOISE, s, GRAM, PHI, 3, w, io, EXCITATION_PORT)
