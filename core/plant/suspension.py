r"""Elastic energy of the suspension in x, y and theta, and all its derivatives.

.. math:: U=\tfrac12k_1x^2+\tfrac14k_3x^4+\tfrac12k_y(x)\,(y-y_s)^2+\tfrac12k_\theta(x)\,(\theta-\theta_s)^2

.. math:: k_y=\frac{k_{y0}}{1+(x/x_y)^2},\quad k_\theta=\frac{k_{\theta0}}{1+(x/x_\theta)^2},\quad
    y_s=y_2x^2,\quad \theta_s=\theta_1x+\theta_3x^3

The stiffness sideways falls with the travel because bent beams give way along their length. Since the force along x is
the derivative of the whole of it, energy is kept.
"""

from __future__ import annotations

from typing import Any

from core.block import inlined, kernel

K1, K3, KY, XY, KT, XT, Y2, T1, T3 = range(9)
"""Where they stand in the array: uN/um, uN/um^3, uN/um, 1/um^2 (1/xy^2), uN um, 1/um^2, 1/um, rad/um, rad/um^3."""


@kernel
def elastic_energy(k: Any, x: float, y: float, theta: float) -> float:
    """Return the energy, uN um: for checks, the loop needs only its derivatives."""
    off = y - k[Y2] * x * x
    turned = theta - (k[T1] + k[T3] * x * x) * x
    sideways = k[KY] * off * off / (1.0 + x * x * k[XY])
    turning = k[KT] * turned * turned / (1.0 + x * x * k[XT])
    return float(0.5 * (k[K1] * x * x + 0.5 * k[K3] * x * x * x * x + sideways + turning))


@inlined
def elastic_force(k: Any, x: float, y: float, theta: float) -> tuple[float, float, float]:
    """Return minus the gradient of the energy: two forces, uN, and a torque, uN um."""
    squared = x * x
    dy = 1.0 + squared * k[XY]
    dt = 1.0 + squared * k[XT]
    both = 1.0 / (dy * dt)
    softer_y = both * dt
    softer_t = both * dy
    off = y - k[Y2] * squared
    turned = theta - (k[T1] + k[T3] * squared) * x
    fy = k[KY] * softer_y * off
    mz = k[KT] * softer_t * turned
    fx = (k[K1] + k[K3] * squared) * x
    fx -= fy * (off * softer_y * k[XY] * x + 2.0 * k[Y2] * x)
    fx -= mz * (turned * softer_t * k[XT] * x + k[T1] + 3.0 * k[T3] * squared)
    return -fx, -fy, -mz
