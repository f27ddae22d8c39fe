"""Base of the banks of Kalman filters, which have one filter for each hypothesis."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal, TypeVar

import numpy as np

from core.block import BlockParams, Context, Equation, FloatArray, Stage, parameter
from core.diagnose.bank import Bank
from core.diagnose.filters import LEAST, TAKE_MIDDLE, TAKE_PARABOLA, TAKE_START, StatePorts
from core.diagnose.hypothesis import BankParams, Hypothesis, assumed_noise
from core.diagnose.lanes import Filters, PackedFilters
from core.elementary import cos, sin
from core.format import format_short
from core.matrix import product, riccati
from core.voltage import MOST_LOST, Tick, over_tick, shuttle_memory

P = TypeVar("P", bound=PackedFilters)
S = TypeVar("S", bound=Filters)


FILTERS = Stage(
    "Kalman filters",
    "measured applied",
    "residual nis covariance",
    ("filter", "residual covariance"),
)
"""The stages before every conclusion of a bank."""


class FilterParams(BlockParams):
    """Assumptions of a Kalman filter."""

    process_noise_v: float = parameter(
        0.3, "assumed noise on the voltage, rms per sample", "V", equation="5.2.3.1.2", ge=0, le=100
    )
    sensor_noise_um: float | None = parameter(
        None, "assumed sensor noise; the sensor's own unless given", "um", gt=0, le=100
    )
    assumed_noise_scale: float = parameter(1.0, "factor on both assumed variances", gt=0, le=1e4)
    voltage: Literal["parabola", "middle", "start"] = parameter(
        "parabola",
        "voltage taken for a tick: the parabola through its start, middle and end, or one of these as if it were held; "
        "of a held drive all the same",
    )
    least_drive_v: float = parameter(
        1e-3, "drive (rms over the shuttle's own memory) below which residuals are no evidence", "V", ge=0, le=100
    )
    initial_std_um: float = parameter(
        1.0, "uncertainty of the displacement at the start", "um", gt=0, le=100, live=False
    )


class KalmanParams(FilterParams, BankParams):
    """Assumptions of a bank of Kalman filters, and its hypotheses."""


class KalmanBank(Bank):
    """Base of every bank of Kalman filters: it has the filters; its subclasses draw the conclusions."""

    equations: ClassVar[tuple[Equation, ...]] = (
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
    )
    Params: ClassVar[type[BlockParams]] = KalmanParams
    gains = (("gain_displacement",), ("gain_velocity",))

    class Packed(PackedFilters):
        """Parameters of the filters."""

    class State(Filters):
        """The filters."""

    class Ports(StatePorts):
        """Ports of every bank of filters."""

    @classmethod
    def takes_steady_gains(cls, params: Any) -> bool:
        """Return whether the gains are the steady gains."""
        return False

    @classmethod
    def leaves_sensor_noise_out(cls, params: Any) -> bool:
        """Return whether the residual covariance is the formula of the text, without R."""
        return False

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        return cls.filters(cls.Packed.blank(), params, context)

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """All filters at zero."""
        return cls.at_rest(cls.State.zeros(), params, context)

    @classmethod
    def filters(cls, p: P, params: Any, context: Context, hypotheses: list[Hypothesis] | None = None) -> P:
        """Pack the filters of a bank, with steady gains from the Riccati equation if it offers them."""
        hypotheses = hypotheses or params.hypotheses
        scale = params.assumed_noise_scale
        noise_um = params.sensor_noise_um or assumed_noise(context)
        q = params.process_noise_v * params.process_noise_v * scale
        r = noise_um * noise_um * scale
        steady, printed = cls.takes_steady_gains(params), cls.leaves_sensor_noise_out(params)
        devices = [hypothesis.oscillator(context.device) for hypothesis in hypotheses]
        h, n = context.dt_ms / context.every, len(devices)
        moving = [over_tick(device, device.force, h, context.analogue) for device in devices]
        ticks = Tick(np.array(moving).T)  # each number of all models
        p.tick11[:n], p.tick12[:n], p.tick21[:n], p.tick22[:n] = ticks.phi11, ticks.phi12, ticks.phi21, ticks.phi22
        p.push1[:n], p.push2[:n] = ticks.push1, ticks.push2
        if context.analogue:
            p.middle1[:n], p.middle2[:n], p.end1[:n], p.end2[:n] = ticks.middle1, ticks.middle2, ticks.end1, ticks.end2
        push = np.array([ticks.push1, ticks.push2]).T
        each = np.array([ticks.phi11, ticks.phi12, ticks.phi21, ticks.phi22]).T.reshape(n, 2, 2)
        caused = push[:, :, None] * push[:, None, :] * q
        if context.every > 1:
            spans = [over_ticks(*own, context.every) for own in zip(each, caused, strict=True)]
            each, caused = map(np.array, zip(*spans, strict=True))
        phi, noise = each.T, caused.T
        p.phi11[:n], p.phi12[:n], p.phi21[:n], p.phi22[:n] = phi[0, 0], phi[1, 0], phi[0, 1], phi[1, 1]
        p.noise11[:n], p.noise12[:n], p.noise22[:n] = noise[0, 0], noise[1, 0], noise[1, 1]
        if steady:
            gains = [steady_gain(*own, r, printed) for own in zip(each, caused, strict=True)]
            p.gain1[:n], p.gain2[:n], p.psi[:n], p.steady22[:n] = np.transpose(gains)
            p.inverse_psi[:n] = 1.0 / p.psi[:n]
            p.steady11[:n], p.steady12[:n] = p.gain1[:n] * r, p.gain2[:n] * r
        p.count = len(hypotheses)
        p.sensor = r
        p.steady = steady
        p.printed = printed
        p.every = context.every
        p.taken = _taken(params, context)
        p.memory = shuttle_memory(context.device, context.dt_ms)
        p.least_drive = params.least_drive_v * params.least_drive_v
        return p

    @classmethod
    def at_rest(cls, s: S, params: Any, context: Context) -> S:
        """Put all filters at zero, with the initial uncertainty of the parameters."""
        std, speed = params.initial_std_um, params.initial_std_um * context.device.natural_frequency
        s.p11[:] = std * std
        s.p22[:] = speed * speed
        return s

    @classmethod
    def caution(cls, params: Any, context: Context, hz: float) -> str:
        r"""Warn if an analogue drive is taken for held: a tone loses :math:`1-\sin x/x`, and more if late by x."""
        x = math.pi * 1e-3 * hz * context.dt_ms / context.every
        if not context.analogue or params.voltage == "parabola" or x <= 0.0:
            return ""
        late = x if params.voltage == "start" else 0.0
        lost = abs(1.0 - sin(x) / x * complex(cos(late), -sin(late)))
        text = f"takes the {params.voltage} of a tick of an analogue drive for held"
        share, drive = format_short(100.0 * lost, "%", 2), format_short(hz, "Hz")
        return f"{text}: {share} of the drive at {drive} are lost to it" if lost > MOST_LOST else ""


def _taken(params: Any, context: Context) -> int:
    """Return which voltage the filters assume over a tick."""
    if params.voltage == "start":
        return TAKE_START
    return TAKE_PARABOLA if context.analogue and params.voltage == "parabola" else TAKE_MIDDLE


def over_ticks(tick: FloatArray, noise: FloatArray, ticks: int) -> tuple[FloatArray, FloatArray]:
    r"""Return the transition over some ticks, and the covariance that their noise has caused at the end of them.

    .. math:: \Phi=\varphi^N,\qquad W=\sum_{j=0}^{N-1}\varphi^jw(\varphi^T)^j

    The noise is independent from tick to tick; a noise voltage held for all of them would cause far more. The sum over
    twice as many ticks is :math:`W+\Phi W\Phi^T`.

    Parameters
    ----------
    tick, noise : array of shape (2, 2)
        Transition of a tick, and the covariance that noise causes in it.
    ticks : int
        N.
    """
    if ticks == 1:
        return tick, noise
    half, part = over_ticks(tick, noise, ticks // 2)
    phi, total = product(half, half), part + product(half, part, half.T)
    if ticks % 2:
        phi, total = product(tick, phi), noise + product(tick, total, tick.T)
    return phi, total


def steady_gain(phi: FloatArray, noise: FloatArray, r: float, printed: bool) -> tuple[float, float, float, float]:
    """Return the filter gain, the residual covariance and the variance of the corrected velocity, in the limit.

    Parameters
    ----------
    phi, noise : array of shape (2, 2)
        Transition between two samples, and the covariance that noise causes between them.
    r : float
        Variance of a measurement, um^2.
    printed : bool
        Leave R out of the residual covariance, as the text does.
    """
    # a little noise on both states keeps the Riccati equation solvable when none is assumed
    prior = riccati(phi, np.array([[1.0, 0.0]]), noise + np.eye(2) * 1e-18, np.array([[r]]))
    psi = prior[0, 0] + r
    k1, k2 = prior[0, 0] / psi, prior[1, 0] / psi
    return k1, k2, max(prior[0, 0], LEAST * r) if printed else psi, prior[1, 1] - k2 * prior[0, 1]
