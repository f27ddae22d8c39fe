r"""Identifiers of the sampled plant, :math:`z_{i+1}=h_i^T\theta,\;\theta=[b_0,b_1,a_1,a_2]` (5.3.3.1-4)."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, ClassVar, Literal

import numpy as np

from core import voltage
from core.block import Context, FloatArray, Oscillator, Port, kernel, parameter
from core.device.oscillator import held
from core.estimation import diagonal, trace, triangle
from core.identify.identifier import (
    APPLIED,
    DAMPING_SCALE,
    DRIVE_GAIN,
    ENABLED,
    ERROR,
    ESTIMATE,
    EXCITATION,
    MASS_SCALE,
    MEASURED,
    OWN_PARAMETER,
    OWN_PORT,
    STIFFNESS_SCALE,
    TRUTH,
    Identifier,
    IdentifierParams,
    between_turns,
    excite,
    room,
    show_truth,
    worst,
)

N = 4
MASS, DAMPING, STIFFNESS, FORCE, DT, INITIAL, LIMIT, NOISE = range(OWN_PARAMETER, OWN_PARAMETER + 8)
INTERVAL = NOISE + triangle(N)
OWN_P = INTERVAL + voltage.INTERVAL_SIZE
START, LAST_Y, OLDER_Y, LAST_U, LATER_U, OLDER_U, WAS_ENABLED = range(7)
THETA, PHI, PRODUCT, COVARIANCE, TRUE, SCALES, GATHERED = 7, 11, 15, 19, 29, 33, 37
GRAM = GATHERED + voltage.STATES
OWN_S = GRAM + room(N)
ESTIMATE_PORT, ERROR_PORT, TRUTH_PORT, COEFFICIENT, COEFFICIENT_TRUE, RESIDUAL, EXCITATION_PORT = range(
    OWN_PORT, OWN_PORT + 7
)
TRACE = EXCITATION_PORT + 3
OWN_TAP = TRACE + 1
COEFFICIENTS = ("b0", "b1", "a1", "a2")
TAPS = (
    TRUTH,
    Port("coefficient", "mixed", "estimated coefficients of the sampled plant", labels=COEFFICIENTS),
    Port("coefficient_true", "mixed", "true coefficients of the sampled plant", labels=COEFFICIENTS),
    Port("residual", "um", "measured minus predicted displacement"),
    *EXCITATION,
    Port("covariance_trace", "mixed", "trace of the covariance"),
)


class DiscreteParams(IdentifierParams):
    """What every identifier of the sampled plant may be told."""

    initial_covariance: float = parameter(1e8, "covariance at the start, as a multiple of I", gt=0, le=1e15)
    covariance_limit: float = parameter(1e10, "largest trace of the covariance, 0 for none", ge=0, le=1e18)
    start: Literal["nominal", "zero"] = parameter("nominal", "estimate at the start", equation="5.3.3.8", live=False)
    least_excitation: float = parameter(
        1e-9, "least relative excitation that counts as identifiable", "1", equation="A.9.1", ge=0, le=1
    )


class Discrete(Identifier):
    """Base of the identifiers of the sampled plant."""

    outputs: ClassVar[tuple[Port, ...]] = (ESTIMATE, ERROR)
    taps: ClassVar[tuple[Port, ...]] = TAPS

    @classmethod
    def sampled(cls, params: Any, context: Context) -> list[float]:
        """Pack everything up to what the law itself needs."""
        device = context.device
        known = [device.mass, device.damping, device.stiffness, device.force, context.dt_ms]
        noise = diagonal(N, context.sensor_noise_um**2)
        noise[0] = noise[2] = 0.0  # the two voltages
        limits = [params.initial_covariance, params.covariance_limit]
        return [*cls.shared(params, context), *known, *limits, *noise, *voltage.pack_interval(context)]

    @classmethod
    def begin(cls, params: Any, context: Context) -> FloatArray:
        """Return the estimate and the covariance at the start."""
        start = np.zeros(OWN_S)
        start[COVARIANCE : COVARIANCE + 10] = diagonal(N, params.initial_covariance)
        start[WAS_ENABLED] = 1.0
        if params.start == "nominal":
            start[THETA : THETA + N] = nominal(context.device, context.dt_ms)
        return start

    @classmethod
    def caution(cls, params: Any, context: Context, hz: float) -> str:
        """Tell what of the response to a tone is missed once a part of the device is another by a tenth."""
        own = context.device
        tenth = {part: replace(own, **{part: 1.1 * getattr(own, part)}) for part in ("mass", "stiffness", "damping")}
        return voltage.caution(context, {f"1.1 times the {part}": device for part, device in tenth.items()}, hz)


def nominal(device: Oscillator, dt_ms: float) -> tuple[float, float, float, float]:
    """Return b0, b1, a1 and a2 of a device whose voltage is held."""
    found = sampled(device.mass, device.damping, device.stiffness, device.force, dt_ms)
    return float(found[0]), float(found[1]), float(found[2]), float(found[3])


@kernel
def sampled(
    mass: float, damping: float, stiffness: float, force: float, dt: float
) -> tuple[float, float, float, float]:
    r"""Return :math:`b_0,b_1,a_1,a_2` of :math:`y_i=b_0u_{i-1}+b_1u_{i-2}-a_1y_{i-1}-a_2y_{i-2}`."""
    a, b, c, d, reach, push = held(mass, damping, stiffness, dt)
    return force * reach, force * (b * push - d * reach), -(a + d), a * d - b * c


@kernel
def gathers(p: Any, s: Any, w: Any, io: Any) -> bool:
    """Take in the voltage of a tick; say whether it is between two turns."""
    voltage.follow(p, INTERVAL, s, GATHERED, w[io[APPLIED]], w[io[APPLIED + 1]], w[io[APPLIED + 2]])
    return between_turns(p, w)


@kernel
def observe(p: Any, s: Any, w: Any, io: Any) -> tuple[bool, float]:
    """Form the regressor, and return whether there was a sample and its difference from the prediction."""
    y = w[io[MEASURED]]
    seen = math.isfinite(y)
    if not seen:
        y = s[LAST_Y]
    first = s[START] < 3.0
    s[START] = min(s[START] + 1.0, 3.0)
    s[OLDER_U] = s[LATER_U]
    s[LAST_U], s[LATER_U] = voltage.weighed(p, INTERVAL, s, GATHERED)
    s[PHI], s[PHI + 1], s[PHI + 2], s[PHI + 3] = s[LAST_U], s[OLDER_U], -s[LAST_Y], -s[OLDER_Y]
    s[OLDER_Y] = s[LAST_Y]
    s[LAST_Y] = y
    e = y
    for i in range(N):
        e -= s[THETA + i] * s[PHI + i]
    if p[ENABLED] != 0.0 and s[WAS_ENABLED] == 0.0:
        restart(p, s)
    s[WAS_ENABLED] = p[ENABLED]
    return seen and not first and p[ENABLED] != 0.0, e


@kernel
def restart(p: Any, s: Any) -> None:
    """Trust the estimate no more than at the start."""
    for i in range(10):
        s[COVARIANCE + i] = 0.0
    for i in range(N):
        s[COVARIANCE + i * (i + 3) // 2] = p[INITIAL]


@kernel
def report(p: Any, s: Any, w: Any, io: Any, residual: float) -> None:
    r"""Write estimate, truth, error and excitation.

    Of the poles :math:`z=e^{(-\sigma\pm j\omega_d)h}` and the static gain g:
    :math:`k=F/g,\;m=k/(\sigma^2+\omega_d^2),\;\beta=2\sigma m`. While the poles are not those of a damped plant, the
    last values stay.
    """
    show_truth(w, io, TRUTH_PORT)
    changed = False
    for i in range(N):
        value = w[io[(MASS_SCALE, STIFFNESS_SCALE, DAMPING_SCALE, DRIVE_GAIN)[i]]]
        changed = changed or value != s[SCALES + i]
        s[SCALES + i] = value
    if changed:
        s[TRUE], s[TRUE + 1], s[TRUE + 2], s[TRUE + 3] = sampled(
            p[MASS] * s[SCALES],
            p[DAMPING] * s[SCALES + 2],
            p[STIFFNESS] * s[SCALES + 1],
            p[FORCE] * s[SCALES + 3],
            p[DT],
        )
    at, true = io[COEFFICIENT], io[COEFFICIENT_TRUE]
    for i in range(N):
        w[at + i] = s[THETA + i]
        w[true + i] = s[TRUE + i]
    b0, b1, a1, a2 = s[THETA], s[THETA + 1], s[THETA + 2], s[THETA + 3]
    whole = 1.0 + a1 + a2
    if 0.0 < a2 < 1.0 and whole > 0.0 and b0 + b1 != 0.0:
        sigma = -0.5 * math.log(a2) / p[DT]
        turn = -0.5 * a1 / math.sqrt(a2)
        if turn > -1.0:
            angle = (math.acos(turn) if turn <= 1.0 else math.acosh(turn)) / p[DT]
            square = sigma * sigma + (angle * angle if turn <= 1.0 else -angle * angle)
            stiffness = p[FORCE] * whole / (b0 + b1)
            mass = stiffness / square
            w[io[ESTIMATE_PORT]] = mass / p[MASS]
            w[io[ESTIMATE_PORT] + 1] = stiffness / p[STIFFNESS]
            w[io[ESTIMATE_PORT] + 2] = 2.0 * sigma * mass / p[DAMPING]
    w[io[RESIDUAL]] = residual
    w[io[ERROR_PORT]] = worst(s, THETA, w, true, N)
    excite(p, NOISE, s, GRAM, PHI, N, w, io, EXCITATION_PORT)
    w[io[TRACE]] = trace(s, COVARIANCE, N)
