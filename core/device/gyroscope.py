r"""A vibrating gyroscope: masses, stiffness and damping along two axes that differ slightly from the layout's."""

from __future__ import annotations

import math
from typing import Self

from pydantic import model_validator

from core.block import BlockParams, parameter
from core.device.environment import ROOM_K
from core.device.ranges import DampingNsM, LengthUm, MassKg, StiffnessNM
from core.device.two_axis import TwoAxis
from core.elementary import cos, sin
from core.units import (
    PM_PER_UM,
    damping_un_ms_um,
    hz_of_rad_ms,
    mass_mg,
    rate_deg_s,
    rate_rad_ms,
    stiffness_un_um,
    thermal_density_un,
)


class GyroscopeTable(BlockParams):
    r"""Parameters of a gyroscope; the angles turn stiffness and damping against the layout (6.1.3).

    .. math:: K=R(\alpha)\begin{bmatrix}k_x&k_{xy}\\k_{xy}&k_y\end{bmatrix}R(\alpha)^T,\quad
        D=R(\gamma)\begin{bmatrix}d_x&d_{xy}\\d_{xy}&d_y\end{bmatrix}R(\gamma)^T

    Principal values need an angle and no cross term, entries a cross term and no angle.
    """

    mass_x_kg: MassKg = parameter(..., "mass that moves along x, the driven axis", "kg", live=False)
    mass_y_kg: MassKg | None = parameter(None, "mass that moves along y; the mass of x unless given", "kg", live=False)
    coriolis_mass_kg: MassKg | None = parameter(
        None, "mass the rate acts on; the mass of y unless given", "kg", live=False
    )
    stiffness_x_n_m: StiffnessNM = parameter(..., "stiffness k_x", "N/m", equation="6.1.3", live=False)
    stiffness_y_n_m: StiffnessNM = parameter(..., "stiffness k_y", "N/m", equation="6.1.3", live=False)
    stiffness_xy_n_m: float = parameter(0.0, "cross stiffness k_xy: quadrature", "N/m", equation="6.1.3", live=False)
    alpha_deg: float = parameter(
        0.0, "angle of the axes of stiffness", "deg", ge=-90, le=90, equation="6.1.3", live=False
    )
    damping_x_ns_m: DampingNsM = parameter(..., "damping d_x", "N s/m", equation="6.1.3", live=False)
    damping_y_ns_m: DampingNsM = parameter(..., "damping d_y", "N s/m", equation="6.1.3", live=False)
    damping_xy_ns_m: float = parameter(0.0, "cross damping d_xy", "N s/m", equation="6.1.3", live=False)
    gamma_deg: float = parameter(
        0.0, "angle of the axes of damping", "deg", ge=-90, le=90, equation="6.1.3", live=False
    )
    drive_amplitude_um: LengthUm = parameter(1.0, "amplitude x is meant to swing with", "um", live=False)

    @model_validator(mode="after")
    def _rings(self) -> Self:
        for name, x, y, xy in (
            ("stiffness", self.stiffness_x_n_m, self.stiffness_y_n_m, self.stiffness_xy_n_m),
            ("damping", self.damping_x_ns_m, self.damping_y_ns_m, self.damping_xy_ns_m),
        ):
            if abs(xy) >= math.sqrt(x) * math.sqrt(y):
                raise ValueError(f"the {name} along x and y must outweigh the cross term: x times y above its square")
        if len(self.two_axis().modes()) < 2:
            raise ValueError("is damped too much: both modes of a gyroscope ring")
        return self

    @property
    def drive_axis(self) -> dict[str, float]:
        """Mass, damping and stiffness of x with y at zero, in SI units."""
        return {
            "mass_kg": self.mass_x_kg,
            "damping_ns_m": turned(self.damping_x_ns_m, self.damping_xy_ns_m, self.damping_y_ns_m, self.gamma_deg)[0],
            "stiffness_n_m": turned(self.stiffness_x_n_m, self.stiffness_xy_n_m, self.stiffness_y_n_m, self.alpha_deg)[
                0
            ],
        }

    def two_axis(self) -> TwoAxis:
        """Return the device in the units of the loop."""
        mass_y = self.mass_y_kg or self.mass_x_kg
        kx, kxy, ky = turned(self.stiffness_x_n_m, self.stiffness_xy_n_m, self.stiffness_y_n_m, self.alpha_deg)
        dx, dxy, dy = turned(self.damping_x_ns_m, self.damping_xy_ns_m, self.damping_y_ns_m, self.gamma_deg)
        return TwoAxis(
            mass=mass_mg(self.mass_x_kg),
            damping=damping_un_ms_um(dx),
            stiffness=stiffness_un_um(kx),
            force=1.0,
            mass_y=mass_mg(mass_y),
            coriolis_mass=mass_mg(self.coriolis_mass_kg or mass_y),
            damping_xy=damping_un_ms_um(dxy),
            damping_y=damping_un_ms_um(dy),
            stiffness_xy=stiffness_un_um(kxy),
            stiffness_y=stiffness_un_um(ky),
            amplitude=self.drive_amplitude_um,
        )

    def metrics(
        self, stiffness_scale: float = 1.0, damping_scale: float = 1.0, temperature_k: float = ROOM_K
    ) -> dict[str, float]:
        r"""Return the figures of a gyroscope that swings with its drive amplitude A.

        Scale, tilt and zero rate are the values with y free, driven at the mode nearest to x. Quadrature as a rate and
        the thermal floor are the values with y held at zero, where x rings at :math:`\omega_x=\sqrt{k_{xx}/m_x}`:

        .. math:: \Omega_q=\frac{k_{xy}}{2m_c\omega_x},\quad
            \Omega_n=\frac{\sqrt2\sqrt{4k_BTd_{yy}}}{2m_c\omega_xA},\quad N=\frac{\Omega_n}{\sqrt2}

        The floor is the root of a one-sided density, the angle random walk N the root of a two-sided density.

        Parameters
        ----------
        stiffness_scale, damping_scale : float
            Stiffness and damping in the environment, over nominal.
        temperature_k : float
            Temperature of the thermomechanical noise.
        """
        device = self.two_axis().scaled(stiffness_scale, damping_scale)
        amplitude, driven = self.drive_amplitude_um, device.drive_frequency
        modes = device.modes()
        quoted: dict[str, float] = {}
        for n, (omega, quality) in enumerate(modes, 1):
            quoted[f"gyro.mode_hz.{n}"] = hz_of_rad_ms(omega)
            quoted[f"gyro.quality_factor.{n}"] = quality
        if len(modes) == 2:
            quoted["gyro.split_hz"] = hz_of_rad_ms(modes[1][0] - modes[0][0])
        zero_rate = device.zero_rate(driven)
        if zero_rate is not None:
            quoted["gyro.zero_rate_dps"] = rate_deg_s(zero_rate)
        thermal = thermal_density_un(temperature_k) * math.sqrt(device.damping_y)
        floor = 3600.0 * rate_deg_s(device.rate_of_force(math.sqrt(2.0) * thermal / amplitude))
        return quoted | {
            "gyro.axis_deg": math.degrees(device.stiffness_axis),
            "gyro.tilt_deg": math.degrees(device.tilt(driven)),
            "gyro.scale_pm_per_dps": PM_PER_UM * amplitude * device.scale(driven) * rate_rad_ms(1.0),
            "gyro.quadrature_dps": rate_deg_s(device.rate_of_force(device.stiffness_xy)),
            "gyro.damping_rate_dps": rate_deg_s(0.5 * device.damping_xy / device.coriolis_mass),
            "gyro.floor_deg_per_h_rthz": floor,
            "gyro.arw_deg_per_rt_h": floor / math.sqrt(2.0) / 60.0,
        }


def turned(x: float, xy: float, y: float, angle_deg: float) -> tuple[float, float, float]:
    r"""Return the entries of a symmetric matrix turned by an angle, :math:`RAR^T` (6.1.3)."""
    c, s = cos(math.radians(angle_deg)), sin(math.radians(angle_deg))
    cross = (x - y) * s * c + xy * (c * c - s * s)
    return x * c * c + y * s * s - 2.0 * xy * s * c, cross, x * s * s + y * c * c + 2.0 * xy * s * c
