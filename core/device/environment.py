r"""Effects of air, temperature, humidity and age on a resonator.

Numbers marked *recalled* are standard literature values quoted from memory, not from the dissertation, which gives no
law for them: it states that "operating conditions" change damping (3.1.3.1), that humidity increases stiction (1.4.4,
1.5) and that four weeks took 42.8 % of the displacement (3.1.3.2).
"""

from __future__ import annotations

import math
from functools import lru_cache

from core.elementary import exp, log
from core.kernel import kernel

GAS_CONSTANT_AIR = 287.05
"""Specific gas constant of dry air, J/(kg K)."""
ATMOSPHERE_PA = 101325.0
ROOM_K = 300.0
ROOM_PCT = 40.0
"""The state of the air in which the figures of every device are given."""
MODULUS_PER_K = 63e-6
"""Relative fall of Young's modulus of silicon per kelvin (recalled)."""
STRUCTURAL_QUALITY = 2e4
"""Quality factor of the suspension and its anchors without any gas (recalled, order of magnitude)."""
DRY_J_M2, WET_J_M2 = 0.03e-3, 50e-3
"""Adhesion energy of rough polysilicon in dry and in saturated air (recalled: 0.01 to 0.05, 10 to 100 mJ/m^2)."""
CONDENSES_PCT, CONDENSES_OVER_PCT = 60.0, 8.0
"""Humidity at which capillary bridges form, and the range over which they do (assumed)."""
AGED_SHARE = 0.428
"""Share of the displacement lost after four weeks (3.1.3.2, figure 3.1.3.2.3)."""
AGED_WEEKS = 4.0
AGEING_WEEKS = 2.0
"""Time constant of ageing (assumed; the text gives only the end)."""


@kernel
def viscosity(temperature_k: float) -> float:
    r"""Viscosity of air, Pa s, :math:`1.716\cdot10^{-5}(T/273.15)^{3/2}\,383.55/(T+110.4)` (Sutherland, recalled).

    Humidity changes it by less than 1 % and is left out.
    """
    ratio = temperature_k / 273.15
    return 1.716e-5 * ratio * math.sqrt(ratio) * 383.55 / (temperature_k + 110.4)


@kernel
def gas_density(pressure_pa: float, temperature_k: float) -> float:
    r"""Density of air, kg/m^3, :math:`\rho=p/(RT)`."""
    return pressure_pa / (GAS_CONSTANT_AIR * temperature_k)


@kernel
def mean_free_path_um(pressure_pa: float, temperature_k: float) -> float:
    r"""Mean free path of air, um, :math:`\lambda=\frac{\mu}{p}\sqrt{\pi RT/2}` (67.0 nm at 300 K, 1 atm)."""
    return 1e6 * viscosity(temperature_k) / pressure_pa * math.sqrt(0.5 * math.pi * GAS_CONSTANT_AIR * temperature_k)


@kernel
def penetration_depth_um(pressure_pa: float, temperature_k: float, omega: float) -> float:
    r"""Depth to which air moves with the plate, um, :math:`\delta=\sqrt{2\mu/(\rho\omega)}` (in 1.3.7)."""
    return 1e6 * math.sqrt(2.0 * viscosity(temperature_k) / (gas_density(pressure_pa, temperature_k) * omega))


@kernel
def couette(viscosity_pa_s: float, area_um2: float, gap_um: float, path_um: float) -> float:
    r"""Damping of one gap, N s/m, :math:`\beta_C=\mu A/(h+2\lambda)` (1.3.6 with slip at both walls).

    Its limit :math:`\mu A/2\lambda=pA\sqrt{M/2\pi RT}` is the exact free-molecular value. In 1.3.6 the gap is
    called t, which is the structural thickness in 1.3.2.
    """
    return 1e-6 * viscosity_pa_s * area_um2 / (gap_um + 2.0 * path_um)


@kernel
def gas_damping(
    pressure_pa: float,
    temperature_k: float,
    plan_um2: float,
    film_um: float,
    comb_um2: float,
    gap_um: float,
    omega: float,
) -> float:
    r"""Damping by the gas, N s/m: 1.3.7 with slip in every gap.

    .. math:: \beta=\mu\left[A\left(\frac1{d+2\lambda}+\frac1{\delta+2\lambda}\right)+\frac{A_c}{g+2\lambda}\right]

    Parameters
    ----------
    pressure_pa, temperature_k : float
        State of the air.
    plan_um2, film_um : float
        Plan area over the film, its thickness.
    comb_um2, gap_um : float
        Facing area of the combs, gap between fingers.
    omega : float
        Angular frequency of the motion, rad/s.
    """
    mu = viscosity(temperature_k)
    path = mean_free_path_um(pressure_pa, temperature_k)
    depth = penetration_depth_um(pressure_pa, temperature_k, omega)
    below = couette(mu, plan_um2, film_um, path)
    above = couette(mu, plan_um2, depth, path)
    return below + above + couette(mu, comb_um2, gap_um, path)


@kernel
def damping_scale(
    pressure_pa: float,
    temperature_k: float,
    plan_um2: float,
    film_um: float,
    comb_um2: float,
    gap_um: float,
    omega: float,
    structural_share: float,
) -> float:
    r"""Damping over that at 300 K and 1 atm, exactly 1 there.

    .. math:: \beta/\beta_0=(1-\sigma)\,\frac{b(p,T)}{b(p_0,T_0)}+\sigma,\quad \sigma=Q_0/Q_i

    with :math:`b` of ``gas_damping`` and the structural share :math:`\sigma`. The nominal damping of a device is
    therefore kept for any film.
    """
    if pressure_pa == ATMOSPHERE_PA and temperature_k == ROOM_K:
        return 1.0
    here = gas_damping(pressure_pa, temperature_k, plan_um2, film_um, comb_um2, gap_um, omega)
    there = gas_damping(ATMOSPHERE_PA, ROOM_K, plan_um2, film_um, comb_um2, gap_um, omega)
    return (1.0 - structural_share) * here / there + structural_share


@kernel
def squeezed_share(pressure_pa: float, temperature_k: float, gap_um: float) -> float:
    r"""Squeeze film over the squeeze film of a continuous gas at 300 K.

    .. math:: \frac{\mu}{\mu_0}\,\frac1{1+9.638\,K_n^{1.159}},\quad K_n=\lambda/g

    (Veijola et al. 1995, recalled.) It is 0.85 between fingers in open air: there a gap of 2.1 um is 31 mean free
    paths. The gap is the undeflected gap; the gas in a gap that closes is rarefied a little more.
    """
    knudsen = mean_free_path_um(pressure_pa, temperature_k) / gap_um
    rarefied = 1.0 + 9.638 * exp(1.159 * log(knudsen))
    return viscosity(temperature_k) / viscosity(ROOM_K) / rarefied


def structural_share(quality_factor: float) -> float:
    r"""Share of the nominal damping that the gas does not cause, :math:`\sigma=Q_0/Q_i`, at most 1."""
    return min(1.0, quality_factor / STRUCTURAL_QUALITY)


@kernel
def stiffness_scale(temperature_k: float) -> float:
    r"""Stiffness over that at 300 K, :math:`E/E_0=1-63\cdot10^{-6}(T-300)` (recalled): -31.5 ppm/K in f0."""
    return 1.0 - MODULUS_PER_K * (temperature_k - ROOM_K)


@lru_cache(maxsize=256)
def adhesion_j_m2(humidity_pct: float) -> float:
    r"""Adhesion energy of two polysilicon surfaces, J/m^2.

    .. math:: W=W_d\,(W_w/W_d)^{s},\quad s=\frac1{1+e^{-(H-60)/8}}

    The ends are recalled, the shape between them is assumed; the text states only that humidity increases stiction.
    """
    wet = 1.0 / (1.0 + exp(-(humidity_pct - CONDENSES_PCT) / CONDENSES_OVER_PCT))
    return DRY_J_M2 * exp(wet * log(WET_J_M2 / DRY_J_M2))


def friction_scale(humidity_pct: float) -> float:
    r"""Friction of touching surfaces over that at 40 %, :math:`F_s(H)/F_s(40)=W(H)/W(40)`.

    Adhesion presses the surfaces together, so friction is proportional to its energy. This is an assumption: the text
    states only that humidity increases stiction (1.4.4, 1.5).
    """
    return adhesion_j_m2(humidity_pct) / adhesion_j_m2(ROOM_PCT)


def vertical_stiffness_n_m(stiffness_n_m: float, thickness_um: float, beam_um: float) -> float:
    r"""Stiffness out of the plane, N/m, :math:`k_z=k_x(t/w)^2`."""
    return stiffness_n_m * (thickness_um / beam_um) ** 2


def critical_adhesion_j_m2(vertical_n_m: float, film_um: float, contact_um2: float) -> float:
    r"""Adhesion energy above which a plate pressed to the ground stays there, J/m^2, :math:`W_c=\tfrac12k_zd^2/A`.

    Parameters
    ----------
    vertical_n_m, film_um : float
        Stiffness out of the plane and the gap it has to bridge.
    contact_um2 : float
        Area that touches: the whole plate, or the dimples under it.
    """
    return 0.5 * vertical_n_m * film_um * film_um / contact_um2


@kernel
def ageing_ratio(weeks: float) -> float:
    r"""Displacement of an aged device over the displacement of a new device.

    .. math:: r(t)=1-0.428\,\frac{1-e^{-t/\tau}}{1-e^{-t_4/\tau}},\quad t_4=4\ \text{weeks},\ \tau=2\ \text{weeks}

    The text gives the 42.8 % after four weeks (3.1.3.2); the exponential and its time constant are assumed. As the
    static displacement is F/k, ageing is modelled as a stiffness k/r.
    """
    return 1.0 - AGED_SHARE * (1.0 - exp(-weeks / AGEING_WEEKS)) / (1.0 - exp(-AGED_WEEKS / AGEING_WEEKS))
