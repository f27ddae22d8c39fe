"""H-infinity loop shaping: the controller that bears the largest change of the device about its nominal values."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from core.block import Block, BlockParams, Context, Equation, Oscillator, Stage, parameter
from core.control.controller import unsuited_second_order
from core.control.nominal import Following, FollowingPorts, followed, following
from core.device.oscillator import held
from core.kernel import flush_tiny
from core.ports import tap
from core.record import Record


class HInfinity(Block):
    r"""Loop shaping by normalised coprime factors (McFarlane and Glover 1992; Skogestad and Postlethwaite 2005, 9.4).

    .. math:: u=u_m+C(s)\,e,\quad C=\frac kF\,WK,\quad\left\|\begin{bmatrix}I\\K\end{bmatrix}(I+G_sK)^{-1}
        \begin{bmatrix}I&G_s\end{bmatrix}\right\|_\infty\le\gamma,\quad G_s=\frac{W}{s^2+2\zeta s+1}

    In the time of 1/w0 both Riccati equations of a resonator have a solution in roots. The loop is stable for every
    device with a :math:`\nu`-gap from the nominal device, both weighed by W, below :math:`1/\gamma` (Vinnicombe 1993).
    """

    title = "H-infinity loop shaping"
    place = 6
    equations = (
        Equation("law", r"u=u_m+C(s)\,e,\quad C=\frac kF\,\frac{c_1s+c_0}{s^2+d_1s+d_0},\quad e=y_m-y"),
        Equation(
            "Riccati equations",
            r"A^TX+XA-XBB^TX+C^TC=0,\quad AZ+ZA^T-ZC^TCZ+BB^T=0",
            "Skogestad and Postlethwaite 9.70-71",
        ),
        Equation(
            "norm",
            r"\gamma=\epsilon\sqrt{1+\lambda_{max}(XZ)},\quad\epsilon>1",
            "Skogestad and Postlethwaite 9.69",
        ),
    )
    structure = (
        Stage("Controller", "model measured", "error state rate", ("norm", "Riccati equations")),
        Stage("Law", "reference model model_velocity state rate", "voltage", ("law",)),
    )
    weaknesses = (
        "It is designed in continuous time: with few samples in 1/w0 the loop loses much of its margin.",
        "It has no integral action: under a device that differs from the nominal device an error stays.",
    )

    class Params(BlockParams):
        """Shape of the loop, and how far the bound is from the least."""

        weight: float = parameter(10.0, "loop gain W at zero frequency before the design", gt=0.01, le=1e3)
        above_least: float = parameter(1.1, "bound of the norm over the least of all controllers", gt=1.001, le=10)

    class Packed(Record):
        """The voltage of the model's motion, the controller over a sample, and the volts of its state and rate."""

        following: Following
        phi11: float
        phi12: float
        phi21: float
        phi22: float
        push1: float
        push2: float
        of_state: float
        of_rate: float

    class State(Record):
        """State of the controller and its rate, and the error at the last sample."""

        state: float
        rate: float
        error: float

    class Ports(FollowingPorts):
        """Ports of a controller, the velocity of the model, and the error."""

        error: float = tap("um", "model minus measured displacement")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse devices without mass, damping or spring, and models that do not come to rest."""
        whole = min(device.mass, device.damping, device.stiffness) > 0.0
        reason = unsuited_second_order(device, model)
        return reason or ("" if whole else "needs a device with mass, damping and spring")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the controller over a sample: its poles are the poles of an oscillator, driven by the error."""
        device, p = context.device, cls.Packed.zeros()
        if device.force == 0.0:
            return p  # nothing moves this device
        p.following = following(device, context.model)
        found = designed(device.damping_ratio, params.weight, params.above_least)
        h = context.dt_ms * device.natural_frequency
        p.phi11, p.phi12, p.phi21, p.phi22, p.push1, p.push2 = held(1.0, found.d1, found.d0, h)
        volts = device.stiffness / device.force
        p.of_state, p.of_rate = volts * found.c0, volts * found.c1
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Advance the controller by the mean error of the sample that ends now."""
        e = x.model - x.measured
        x.error = e
        if not math.isfinite(e):
            e = s.error
        mean = 0.5 * (s.error + e)
        s.error = e
        state = s.state
        rate = s.rate
        s.state = flush_tiny(p.phi11 * state + p.phi12 * rate + p.push1 * mean)
        s.rate = flush_tiny(p.phi21 * state + p.phi22 * rate + p.push2 * mean)
        x.voltage = followed(p.following, x) + p.of_state * s.state + p.of_rate * s.rate


@dataclass(frozen=True)
class Designed:
    """The bound of the norm, and the controller :math:`(c_1s+c_0)/(s^2+d_1s+d_0)` with the weight."""

    bound: float
    c1: float
    c0: float
    d1: float
    d0: float


def designed(damping_ratio: float, weight: float, above_least: float) -> Designed:
    r"""Design the controller of :math:`W/(s^2+2\zeta s+1)`.

    The poles of regulator and filter are the roots of :math:`s^2+\alpha_1s+\alpha_0` with
    :math:`\alpha_0=\sqrt{1+W^2},\;\alpha_1=\sqrt{a_1^2-2+2\alpha_0}`, the spectral factor of
    :math:`(s^2+a_1s+1)(s^2-a_1s+1)+W^2`. The first column of Z and the last of X follow from them, then the rest.
    """
    w, a1 = weight, 2.0 * damping_ratio
    beyond = w * w / (1.0 + math.sqrt(1.0 + w * w))  # alpha0 - 1, without cancellation
    alpha1 = math.sqrt(a1 * a1 + 2.0 * beyond)
    more = 2.0 * beyond / (alpha1 + a1)  # alpha1 - a1
    x12, x22 = beyond / (w * w), more / (w * w)
    x11 = a1 * x12 + x22 + w * w * x12 * x22
    z11, z12 = more, beyond - a1 * more
    z22 = z11 + a1 * z12 + z11 * z12
    # XZ, its largest eigenvalue, and the bound
    p11, p12, p21, p22 = x11 * z11 + x12 * z12, x11 * z12 + x12 * z22, x12 * z11 + x22 * z12, x12 * z12 + x22 * z22
    half, across = 0.5 * (p11 + p22), 0.5 * (p11 - p22)
    bound = above_least * math.sqrt(1.0 + half + math.sqrt(max(across * across + p12 * p21, 0.0)))
    # the measurement enters by H = g^2 (L')^-1 ZC', L = (1 - g^2) I + XZ
    square = bound * bound
    l11, l22 = 1.0 - square + p11, 1.0 - square + p22
    scale = square / (l11 * l22 - p12 * p21)
    h1, h2 = scale * (l22 * z11 - p21 * z12), scale * (l11 * z12 - p12 * z11)
    # A - BB'X + HC, whose first row is (h1, 1), and -B'X, whose sign makes the feedback negative
    below, damped = h2 - 1.0 - beyond, -a1 - more
    return Designed(
        bound,
        c1=-(beyond * h1 + more * h2),
        c0=-(beyond * (h2 - damped * h1) + more * (below * h1 - h1 * h2)),
        d1=-h1 - damped,
        d0=h1 * damped - below,
    )
