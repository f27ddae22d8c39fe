"""The only place where units are converted.

Outside the compiled loop device parameters are SI and displacement is um. Inside it everything is
um, ms, V, so that forces are uN (mg um/ms^2), stiffness uN/um, damping uN ms/um: adaptation gains and
initial covariances depend on units, and in metres they would have to be of the order of 1e16.
"""

from __future__ import annotations

import math

EPSILON_0 = 8.8541878128e-12
"""Permittivity of vacuum, F/m (CODATA 2018)."""

BOLTZMANN = 1.380649e-23
"""Boltzmann constant, J/K (exact)."""

MG_PER_KG = 1e6
UN_PER_N = 1e6
UN_MS_UM_PER_NS_M = 1e3
"""Damping: 1 N s/m = 1e6 uN * 1e3 ms / 1e6 um."""
UN_UM_PER_N_M = 1.0
"""Stiffness: 1 N/m is 1 uN/um."""
UM_PER_M = 1e6
MS_PER_S = 1e3
FF_PER_F = 1e15
PM_PER_UM = 1e6
DEG_PER_RAD = 180.0 / math.pi
RAD_MS_PER_DEG_S = math.pi / 180.0 / MS_PER_S
"""Angular rate: degrees per second to radians per millisecond."""
DEG_H_PER_DEG_S = 3600.0
DEG_RT_H_PER_DEG_RT_S = 60.0
"""Angle random walk: 1 deg/rt s is 1 deg/s/rt Hz, and an hour has 60^2 s."""
DEG_H_RT_H_PER_DEG_S_RT_S = 216e3
"""Rate random walk: 1 deg/s/rt s = 3600 deg/h * 60 / rt h."""


def mass_mg(mass_kg: float) -> float:
    """Kilograms to milligrams."""
    return mass_kg * MG_PER_KG


def damping_un_ms_um(damping_ns_m: float) -> float:
    """N s/m to uN ms/um."""
    return damping_ns_m * UN_MS_UM_PER_NS_M


def stiffness_un_um(stiffness_n_m: float) -> float:
    """N/m to uN/um."""
    return stiffness_n_m * UN_UM_PER_N_M


def force_un_per_v(force_n_per_v: float) -> float:
    """N/V to uN/V."""
    return force_n_per_v * UN_PER_N


def thermal_force_un(temperature_k: float, dt_ms: float) -> float:
    r"""Held thermomechanical force per square root of damping, uN / sqrt(uN ms/um).

    A white force of two-sided density :math:`2 k_B T \beta`, held over one sample, has the standard
    deviation :math:`\sqrt{2 k_B T \beta / dt}`. The step multiplies by the root of the damping, which faults change.
    """
    per_si_damping: float = 2.0 * BOLTZMANN * temperature_k / (dt_ms / MS_PER_S)
    in_newton_squared_per_internal = per_si_damping / UN_MS_UM_PER_NS_M
    return float(UN_PER_N * math.sqrt(in_newton_squared_per_internal))


def um_of_pm(pm: float) -> float:
    """Picometres to micrometres, or nm/s to um/ms."""
    return pm * 1e-6


def noise_of_sample(density: float, dt_ms: float) -> float:
    """Return the standard deviation of a sample of noise that is white up to half the sample rate; unit per rtHz."""
    return float(density * math.sqrt(0.5 * MS_PER_S / dt_ms))


def thermal_density_un(temperature_k: float) -> float:
    r"""Root of the one-sided density of the thermomechanical force per root of damping, uN / sqrt(Hz uN ms/um).

    It is :math:`\sqrt{4k_BT\beta}`, which is also the standard deviation of that force held over half a second.
    """
    return thermal_force_un(temperature_k, 0.5 * MS_PER_S)


def rate_rad_ms(deg_per_s: float) -> float:
    """deg/s to rad/ms."""
    return deg_per_s * RAD_MS_PER_DEG_S


def rate_deg_s(rad_per_ms: float) -> float:
    """rad/ms to deg/s."""
    return rad_per_ms / RAD_MS_PER_DEG_S


def hz_of_rad_ms(rad_per_ms: float) -> float:
    """Angular frequency in rad/ms to a frequency in Hz."""
    return MS_PER_S * rad_per_ms / (2.0 * math.pi)
