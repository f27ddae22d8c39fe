"""The only place where units are converted.

Outside the compiled loop device parameters are SI and displacement is um. Inside it everything is
um, ms, V, so that forces are uN (mg um/ms^2), stiffness uN/um, damping uN ms/um: adaptation gains and
initial covariances depend on units, and in metres they would have to be of the order of 1e16.
"""

from __future__ import annotations

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
    return float(UN_PER_N * in_newton_squared_per_internal**0.5)
