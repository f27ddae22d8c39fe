r"""A force that makes a drive axis follow the carrier, :math:`x_m=A\sin\theta`, and learns the necessary force.

.. math:: F=f_s\sin\theta'+f_c\cos\theta'-c_d\dot e,\quad e=x-x_m,\quad\theta'=\theta+\omega h/2,\quad
    \dot f_s=\lambda c_d\omega E_c,\;\dot f_c=-\lambda c_d\omega E_s

where :math:`E_s,E_c` are the components of the error along the carrier. The damping :math:`c_d=2m\sigma` decides the
response at the resonance, :math:`E=-jF/c_d\omega`, so that the force settles with the rate :math:`\lambda=\sigma/4`.
A held force is late by half a sample, which :math:`\theta'` makes up for.
"""

from __future__ import annotations

from core.control.two_axis import components
from core.kernel import kernel
from core.record import Record


class TrackingGains(Record):
    """Desired amplitude, damping added, gain of the adaptation per sample."""

    target: float
    added_damping: float
    gain: float


class Phasor(Record):
    """Amplitudes of a force in step with the desired displacement and with its velocity, uN."""

    sine: float
    cosine: float


def fill_tracking(p: TrackingGains, target: float, mass: float, damping: float, omega: float, dt_ms: float) -> None:
    """Pack the law for a mass in mg whose errors die away with a rate in 1/ms, at a carrier of rad/ms."""
    p.target = target
    p.added_damping = 2.0 * mass * damping
    p.gain = 0.25 * damping * p.added_damping * omega * dt_ms


@kernel
def follow(
    p: TrackingGains,
    f: Phasor,
    q: float,
    velocity: float,
    carrier: tuple[float, float, float, float, float],
    engaged: float,
) -> tuple[float, float]:
    """Return the force on a mass and its error, and learn while the law drives.

    Parameters
    ----------
    q, velocity : float
        Measured, um and um/ms.
    carrier : tuple of float
        Its frequency in rad/ms, its sine and cosine now, and both half a sample later.
    """
    omega, sine, cosine, ahead_sine, ahead_cosine = carrier
    e = q - p.target * sine
    v = velocity - p.target * omega * cosine
    force = f.sine * ahead_sine + f.cosine * ahead_cosine - p.added_damping * v
    if engaged != 0.0:
        in_step, with_velocity = components(e, v, omega, sine, cosine)
        f.sine += p.gain * with_velocity
        f.cosine -= p.gain * in_step
    return force, e
