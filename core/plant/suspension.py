r"""Elastic energy of the suspension in x, y and theta, and all its derivatives.

.. math:: U=\tfrac12k_1x^2+\tfrac14k_3x^4+\tfrac12k_y(x)\,(y-y_s)^2+\tfrac12k_\theta(x)\,(\theta-\theta_s)^2

.. math:: k_y=\frac{k_{y0}}{1+(x/x_y)^2},\quad k_\theta=\frac{k_{\theta0}}{1+(x/x_\theta)^2},\quad
    y_s=y_2x^2,\quad \theta_s=\theta_1x+\theta_3x^3

The stiffness sideways falls with the travel because bent beams give way along their length. The force along x is the
derivative of the whole energy, so energy is conserved.
"""

from __future__ import annotations

from core.kernel import kernel
from core.record import Record


class Suspension(Record):
    r"""Stiffnesses, their fall with the travel, and the rest position of the shuttle across it.

    In the order of the fields :math:`k_1`, uN/um, :math:`k_3`, uN/um^3; :math:`k_{y0}`, uN/um, :math:`1/x_y^2`, 1/um^2;
    :math:`k_{\theta0}`, uN um, :math:`1/x_\theta^2`, 1/um^2; :math:`y_2`, 1/um, :math:`\theta_1`, rad/um,
    :math:`\theta_3`, rad/um^3.
    """

    stiffness: float
    cubic: float
    lateral_stiffness: float
    lateral_softening: float
    rotation_stiffness: float
    rotation_softening: float
    sideways: float
    turn: float
    turn_cubic: float


@kernel
def elastic_energy(k: Suspension, x: float, y: float, theta: float) -> float:
    """Return the energy, uN um, for checks: the loop needs only its derivatives."""
    off = y - k.sideways * x * x
    turned = theta - (k.turn + k.turn_cubic * x * x) * x
    sideways = k.lateral_stiffness * off * off / (1.0 + x * x * k.lateral_softening)
    turning = k.rotation_stiffness * turned * turned / (1.0 + x * x * k.rotation_softening)
    return float(0.5 * (k.stiffness * x * x + 0.5 * k.cubic * x * x * x * x + sideways + turning))


@kernel
def elastic_force(k: Suspension, x: float, y: float, theta: float) -> tuple[float, float, float]:
    """Return minus the gradient of the energy: two forces, uN, and a torque, uN um."""
    squared = x * x
    dy = 1.0 + squared * k.lateral_softening
    dt = 1.0 + squared * k.rotation_softening
    both = 1.0 / (dy * dt)
    softer_y = both * dt
    softer_t = both * dy
    off = y - k.sideways * squared
    turned = theta - (k.turn + k.turn_cubic * squared) * x
    fy = k.lateral_stiffness * softer_y * off
    mz = k.rotation_stiffness * softer_t * turned
    fx = (k.stiffness + k.cubic * squared) * x
    fx -= fy * (off * softer_y * k.lateral_softening * x + 2.0 * k.sideways * x)
    fx -= mz * (turned * softer_t * k.rotation_softening * x + k.turn + 3.0 * k.turn_cubic * squared)
    return -fx, -fy, -mz
