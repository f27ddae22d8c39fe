r"""Exact transition of a damped oscillator over one interval."""

from __future__ import annotations

import math

import numpy as np

from core.elementary import cos, exp, expm1, sin
from core.kernel import kernel
from core.matrix import exponential

SOFT = 5e-8
r"""Of :math:`1-\varphi_{11}`, roughly, where it has a rounding error of :math:`10^{-8}`."""
TERMS = 22
"""Terms of a series whose ratios are at most 1/n: the next is below 1e-20."""


@kernel
def transition(mass: float, damping: float, stiffness: float, h: float) -> tuple[float, float, float, float]:
    r"""Return the free transition matrix of :math:`m\ddot x+\beta\dot x+kx=0` over ``h``.

    .. math:: \Phi = e^{-\sigma h}
        \begin{bmatrix} c+\sigma s & s\\ -\omega_0^2 s & c-\sigma s\end{bmatrix},
        \quad \sigma=\frac{\beta}{2m},\; s=\frac{\sin\omega_d h}{\omega_d},\; c=\cos\omega_d h

    Beyond critical damping the two rates of decay, :math:`r_{1,2}=\sigma\mp\sqrt{\sigma^2-\omega_0^2}`, take the place
    of the oscillation. Each is computed without cancellation, and no factor of a product grows beyond all bounds:

    .. math:: e^{-\sigma h}s=e^{-r_1h}\frac{1-e^{-(r_2-r_1)h}}{r_2-r_1},\quad
        e^{-\sigma h}c=\tfrac12(e^{-r_1h}+e^{-r_2h})

    Parameters
    ----------
    mass, damping, stiffness : float
        mg, uN ms/um, uN/um; the mass is positive.
    h : float
        Interval, ms.

    Returns
    -------
    tuple of float
        phi11, phi12 (ms), phi21 (1/ms), phi22.
    """
    sigma = damping / (2.0 * mass)
    square = stiffness / mass
    discriminant = square - sigma * sigma
    if discriminant < 0.0:
        apart = math.copysign(2.0 * math.sqrt(-discriminant), sigma)
        fast = sigma + 0.5 * apart
        slow = square / fast
        c = 0.5 * (exp(-slow * h) + exp(-fast * h))
        s = exp(-slow * h) * -expm1(-apart * h) / apart
        return c + sigma * s, s, -square * s, c - sigma * s
    decay = exp(-sigma * h)
    if discriminant > 0.0:
        omega = math.sqrt(discriminant)
        c = cos(omega * h)
        s = sin(omega * h) / omega
    else:
        c = 1.0
        s = h
    return decay * (c + sigma * s), decay * s, -square * decay * s, decay * (c - sigma * s)


@kernel
def held(mass: float, damping: float, stiffness: float, h: float) -> tuple[float, float, float, float, float, float]:
    r"""Return transition and effect of a unit force held over ``h``, for any :math:`m\ddot x+\beta\dot x+kx=f`.

    Mass, stiffness and damping may be 0, and the last two negative, as in a transfer function:

    .. math:: \gamma_2=\frac{\varphi_{12}}{m},\quad
        \gamma_1=\frac{1-\varphi_{11}}{k}\;\Big(\frac{h^2}{2m}\text{ without spring and damper}\Big)

    with :math:`\gamma_1` as `yielded` where the spring has hardly begun to act, and without mass
    :math:`\varphi_{11}=e^{-kh/\beta}`.

    Parameters
    ----------
    mass, damping, stiffness : float
        mg, uN ms/um, uN/um; not all of mass and damping 0.
    h : float
        Interval, ms.

    Returns
    -------
    tuple of float
        phi11, phi12, phi21, phi22, gamma1 (um/uN), gamma2 (um/ms/uN); without mass all but phi11 and gamma1 are 0.
    """
    if mass == 0.0:
        decay = exp(-stiffness * h / damping)
        reach = h / damping if stiffness == 0.0 else -expm1(-stiffness * h / damping) / stiffness
        return decay, 0.0, 0.0, 0.0, reach, 0.0
    a, b, c, d = transition(mass, damping, stiffness, h)
    if not is_soft(mass, damping, stiffness, h):
        reach = (1.0 - a) / stiffness
    elif stiffness != 0.0 or damping != 0.0:
        reach = yielded(mass, damping, stiffness, h)
    else:
        reach = 0.5 * h * h / mass
    return a, b, c, d, reach, b / mass


@kernel
def is_soft(mass: float, damping: float, stiffness: float, h: float) -> bool:
    r"""Say whether a spring has hardly begun to act after ``h``, so that :math:`1-\varphi_{11}` has lost its digits."""
    return abs(stiffness) * h * h < SOFT * (mass + abs(damping) * h)


@kernel
def yielded(mass: float, damping: float, stiffness: float, h: float) -> float:
    r"""Return how far a unit force moves an oscillator with a soft spring within ``h``, without cancellation.

    Of a weak damper by the series of the motion, of a strong one by its two rates of decay:

    .. math:: \gamma_1=\frac{h}{m(r_2-r_1)}\bigl[E(r_1h)-E(r_2h)\bigr],\quad E(z)=\frac{1-e^{-z}}{z}

    Parameters
    ----------
    mass, damping, stiffness, h : float
        As of ``held``; the mass is positive.
    """
    z = damping * h / mass
    if abs(z) > 1.0:
        sigma = 0.5 * damping / mass
        square = stiffness / mass
        apart = math.copysign(2.0 * math.sqrt(sigma * sigma - square), sigma)
        fast = sigma + 0.5 * apart
        return h / (mass * apart) * (shrunk(square / fast * h) - shrunk(fast * h))
    w = stiffness * h * h / mass
    before = 0.0
    term = 0.5 * h * h / mass
    total = term
    for n in range(3, TERMS):
        after = -(z * term + w * before / (n - 1.0)) / n
        before = term
        term = after
        total += term
    return total


@kernel
def shrunk(z: float) -> float:
    r"""Return :math:`(1-e^{-z})/z`."""
    return -expm1(-z) / z if z != 0.0 else 1.0


def parabola(
    mass: float, damping: float, stiffness: float, h: float, gain: float = 1.0
) -> tuple[float, float, float, float]:
    r"""Return the gain of displacement and velocity over ``h`` from a unit of :math:`\dot f`, then of :math:`\ddot f`.

    The motion obeys :math:`m\ddot x+\beta\dot x+kx=gf`; its matrix exponential has f and its two derivatives as further
    states.

    Parameters
    ----------
    mass, damping, stiffness : float
        mg, uN ms/um, uN/um; without mass the velocity follows the displacement.
    h : float
        Interval, ms.
    gain : float
        g.
    """
    a = np.diag([1.0, 0.0, 1.0, 1.0], 1)
    if mass > 0.0:
        a[1, :3] = np.array([-stiffness, -damping, gain]) / mass
    else:
        a[0, :3] = np.array([-stiffness, 0.0, gain]) / damping
    states = exponential(a * h)
    return states[0, 3], states[1, 3], states[0, 4], states[1, 4]


def within(
    mass: float, damping: float, stiffness: float, h: float, gain: float = 1.0
) -> tuple[float, float, float, float]:
    r"""Return the gain of displacement and velocity from a unit of :math:`f_{1/2}-f_0`, then of :math:`f_1-f_0`.

    The force is the parabola through its values at the start, in the middle and at the end of an interval, like the
    force on the plant under an analogue drive:

    .. math:: h\dot f=4(f_{1/2}-f_0)-(f_1-f_0),\qquad h^2\ddot f=4(f_1-f_0)-8(f_{1/2}-f_0)

    Parameters
    ----------
    mass, damping, stiffness, h, gain : float
        As of ``parabola``.
    """
    x1, v1, x2, v2 = parabola(mass, damping, stiffness, h, gain)
    x1, v1, x2, v2 = x1 / h, v1 / h, 4.0 * x2 / (h * h), 4.0 * v2 / (h * h)
    return 4.0 * x1 - 2.0 * x2, 4.0 * v1 - 2.0 * v2, x2 - x1, v2 - v1
