r"""A mass that moves along two axes of a plane that turns."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from core.block import FloatArray, Oscillator
from core.elementary import atan2


@dataclass(frozen=True)
class PushPull:
    """Two combs along an axis, as the loop takes them.

    Parameters
    ----------
    gradient : float
        dC/dx of one comb, uN/V^2.
    bias_v : float
        Of both combs; the voltage is added to one of them and taken from the other.
    """

    gradient: float
    bias_v: float

    @property
    def per_volt(self) -> float:
        r"""Force per volt, :math:`2\frac{dC}{dx}V_b`, uN/V."""
        return 2.0 * self.gradient * self.bias_v


@dataclass(frozen=True)
class TuningPlates:
    r"""Plates on both sides of the mass along y, at the same voltage against it, as the loop takes them.

    .. math:: F_y=\tfrac12V^2\frac{dC}{dy}=\frac{pV^2gy}{(g^2-y^2)^2},\quad k_e=-\tfrac12V^2\frac{d^2C}{dy^2}\Big|_0
        =-\frac{pV^2}{g^3},\quad p=2\varepsilon_0A

    Parameters
    ----------
    pull : float
        p, uN um^2/V^2.
    gap : float
        g, um.
    """

    pull: float
    gap: float

    @property
    def per_v2(self) -> float:
        """Softening per squared volt, uN/um."""
        return self.pull / (self.gap * self.gap * self.gap)

    def pull_in_v(self, stiffness: float) -> float:
        r"""Return the voltage that takes all of a stiffness in uN/um away, :math:`\sqrt{kg^3/p}`."""
        return math.sqrt(stiffness / self.per_v2)


@dataclass(frozen=True, kw_only=True)
class TwoAxis(Oscillator):
    r"""A mass on two coupled axes, x driven and y sensing, in the units of the loop.

    .. math:: M\ddot q+(D+2m_c\Omega S)\dot q+Kq=F,\quad q=(x,y),\quad S=\begin{bmatrix}0&-1\\1&0\end{bmatrix}

    The inherited fields describe x with y at zero; ``force`` is 1, because the drive is a force.

    Parameters
    ----------
    mass_y, coriolis_mass : float
        Mass that moves along y, and mass that the turning of the plane acts on, mg.
    damping_xy, damping_y : float
        uN ms/um.
    stiffness_xy, stiffness_y : float
        uN/um.
    amplitude : float
        Amplitude x is meant to swing with, um.
    comb_x, comb_y : PushPull, optional
        Combs along the axes.
    tuning : TuningPlates, optional
        Plates that soften the spring along y.
    """

    mass_y: float
    coriolis_mass: float
    damping_xy: float
    damping_y: float
    stiffness_xy: float
    stiffness_y: float
    amplitude: float = 1.0
    comb_x: PushPull | None = None
    comb_y: PushPull | None = None
    tuning: TuningPlates | None = None

    @property
    def in_air(self) -> bool:
        """Not: a gyroscope is sealed in a package, whose gas is part of its damping."""
        return False

    @property
    def static_gain(self) -> float:
        """None: it is driven by forces, so no voltage is a displacement."""
        return 0.0

    @property
    def masses(self) -> FloatArray:
        """Return M."""
        return np.diag([self.mass, self.mass_y])

    @property
    def dampings(self) -> FloatArray:
        """Return D."""
        return np.array([[self.damping, self.damping_xy], [self.damping_xy, self.damping_y]])

    @property
    def stiffnesses(self) -> FloatArray:
        """Return K."""
        return np.array([[self.stiffness, self.stiffness_xy], [self.stiffness_xy, self.stiffness_y]])

    def scaled(self, stiffness: float, damping: float) -> TwoAxis:
        """Return the device with all stiffness and all damping multiplied."""
        return replace(
            self,
            stiffness=stiffness * self.stiffness,
            stiffness_xy=stiffness * self.stiffness_xy,
            stiffness_y=stiffness * self.stiffness_y,
            damping=damping * self.damping,
            damping_xy=damping * self.damping_xy,
            damping_y=damping * self.damping_y,
        )

    @property
    def free_stiffness_y(self) -> float:
        r"""Stiffness along y with x free, :math:`k_{yy}-k_{xy}^2/k_{xx}`, uN/um."""
        return self.stiffness_y - self.stiffness_xy * self.stiffness_xy / self.stiffness

    def tuned(self, volts: float) -> TwoAxis:
        """Return the device with a voltage on its tuning electrode."""
        taken = 0.0 if self.tuning is None else self.tuning.per_v2 * volts * volts
        return replace(self, stiffness_y=self.stiffness_y - taken)

    def modes(self) -> list[tuple[float, float]]:
        r"""Return frequency (rad/ms) and quality factor of the damped modes that ring, the lowest first.

        They are :math:`|\lambda|` and :math:`-|\lambda|/2\,\mathrm{Re}\,\lambda` of the eigenvalues of
        :math:`\begin{bmatrix}0&1\\-M^{-1}K&-M^{-1}D\end{bmatrix}` without rotation; a mode beyond critical damping has
        none, and the quality factor of a mode without damping is infinite.
        """
        inverse = 1.0 / np.diag(self.masses)[:, None]
        system = np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse * self.stiffnesses, -inverse * self.dampings]])
        rates = [complex(rate) for rate in np.linalg.eigvals(system) if rate.imag > 0.0]
        return sorted((abs(rate), -0.5 * abs(rate) / rate.real if rate.real < 0.0 else math.inf) for rate in rates)

    @property
    def fastest(self) -> float:
        """Frequency of the upper undamped mode, rad/ms."""
        return math.sqrt(max(self._squares()))

    @property
    def drive_frequency(self) -> float:
        r"""Frequency of the undamped mode nearest to x, rad/ms, at which a device with y free is driven.

        With y held at zero x rings at ``natural_frequency`` instead, :math:`\sqrt{k_{xx}/m_x}`.
        """
        low, high = self._squares()
        stiffer_y = self.stiffness_y / self.mass_y >= self.stiffness / self.mass
        return math.sqrt(low if stiffer_y else high)

    def _squares(self) -> tuple[float, float]:
        """Return the squared frequencies of the undamped modes, the lowest first, without cancellation."""
        x, y = self.stiffness / self.mass, self.stiffness_y / self.mass_y
        cross = self.stiffness_xy * self.stiffness_xy / (self.mass * self.mass_y)
        reach = 0.5 * math.sqrt((x - y) * (x - y) + 4.0 * cross)
        shift = 2.0 * cross / (abs(x - y) + 2.0 * reach) if cross > 0.0 else 0.0
        return min(x, y) - shift, max(x, y) + shift

    @property
    def stiffness_axis(self) -> float:
        r"""Angle of the axis of stiffness nearest to x, rad, :math:`\tfrac12\arctan\frac{2k_{xy}}{k_{xx}-k_{yy}}`."""
        if self.stiffness_xy == 0.0:
            return 0.0
        apart = self.stiffness - self.stiffness_y
        if apart == 0.0:
            return 0.25 * math.pi
        return 0.5 * atan2(math.copysign(2.0, apart) * self.stiffness_xy, abs(apart))

    def sense(self, omega: float) -> complex:
        r"""Return the dynamic stiffness of y, uN/um, :math:`k_{yy}-m_y\omega^2+j\omega d_{yy}`."""
        return complex(self.stiffness_y - self.mass_y * omega * omega, omega * self.damping_y)

    def coupled(self, omega: float) -> complex:
        r"""Return y over x without rotation, :math:`G=-(k_{xy}+j\omega d_{xy})/(k_{yy}-m_y\omega^2+j\omega d_{yy})`."""
        return -complex(self.stiffness_xy, omega * self.damping_xy) / self.sense(omega)

    def tilt(self, omega: float) -> float:
        r"""Return the angle of the long axis of the locus, rad, :math:`\tfrac12\arctan2\mathrm{Re}G/(1-|G|^2)`."""
        g = self.coupled(omega)
        return 0.5 * atan2(2.0 * g.real, 1.0 - abs(g) ** 2)

    def scale(self, omega: float) -> float:
        r"""Return y over x and rate, ms/rad, the size of :math:`2m_c\omega/(k_{yy}-m_y\omega^2+j\omega d_{yy})`."""
        return 2.0 * self.coriolis_mass * omega / abs(self.sense(omega))

    def zero_rate(self, omega: float) -> float | None:
        r"""Return the reading without rotation, rad/ms, from the part of y in step with the velocity of x.

        .. math:: \Omega_0=\frac1{2m_c}\left[d_{xy}-\frac{k_{xy}d_{yy}}{k_{yy}-m_y\omega^2}\right]

        None where the modes are nearer than the bandwidth of y: the rate is then not in that part.
        """
        sense = self.sense(omega)
        if abs(sense.real) <= abs(sense.imag):
            return None
        return (self.damping_xy - self.stiffness_xy * self.damping_y / sense.real) / (2.0 * self.coriolis_mass)

    def rate_of_force(self, force_per_um: float) -> float:
        r"""Return a force along y per amplitude of x as a rate, :math:`f/2m_c\omega_x`, rad/ms, with y held at zero."""
        return force_per_um / (2.0 * self.coriolis_mass * self.natural_frequency)

    def cross_stiffness(self, rate: float) -> float:
        r"""Return the cross stiffness that reads as a rate with y held at zero, :math:`2m_c\omega_x\Omega_q`, uN/um."""
        return 2.0 * self.coriolis_mass * self.natural_frequency * rate
