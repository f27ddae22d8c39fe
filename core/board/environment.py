"""Environment: what air, age and friction make of the device."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import Block, BlockParams, Context, Equation, FloatArray, Port, parameter
from core.device.environment import (
    ATMOSPHERE_PA,
    ROOM_K,
    adhesion_j_m2,
    ageing_ratio,
    damping_scale,
    friction_scale,
    squeezed_share,
    stiffness_scale,
    structural_share,
)
from core.device.geometry import drawn

PRESSURE_AT, TEMPERATURE_AT, HUMID, STICKY, RUBBING, WEEKS, AGED, SET_DAMPING, FILM = range(9)
"""Packed parameters; from ``FILM`` on areas and gaps, angular frequency and structural share."""
LAST_PRESSURE, LAST_TEMPERATURE, LAST_STIFFNESS, LAST_DAMPING, LAST_SQUEEZE = range(5)
VACUUM, STIFFNESS, DAMPING, SQUEEZE, FRICTION, FRICTION_SCALE, AGE, DAMPING_SET, PRESSURE, ADHESION = range(10)


def environment_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Say what pressure and temperature make of the device; a leak of the tick before counts."""
    pressure = p[PRESSURE_AT]
    if w[io[VACUUM]] != 1.0:
        pressure = ATMOSPHERE_PA - w[io[VACUUM]] * (ATMOSPHERE_PA - pressure)
    temperature = p[TEMPERATURE_AT]
    if pressure != s[LAST_PRESSURE] or temperature != s[LAST_TEMPERATURE]:
        s[LAST_PRESSURE] = pressure
        s[LAST_TEMPERATURE] = temperature
        s[LAST_STIFFNESS] = stiffness_scale(temperature)
        s[LAST_DAMPING] = damping_scale(
            pressure,
            temperature,
            p[FILM],
            p[FILM + 1],
            p[FILM + 2],
            p[FILM + 3],
            p[FILM + 4],
            p[FILM + 5],
        )
        s[LAST_SQUEEZE] = squeezed_share(pressure, temperature, p[FILM + 3]) / s[LAST_DAMPING]
    w[io[STIFFNESS]] = s[LAST_STIFFNESS] * p[AGED]
    w[io[DAMPING]] = s[LAST_DAMPING]
    w[io[SQUEEZE]] = s[LAST_SQUEEZE]
    w[io[FRICTION]] = p[RUBBING] * p[STICKY]
    w[io[FRICTION_SCALE]] = p[STICKY]
    w[io[AGE]] = p[WEEKS]
    w[io[DAMPING_SET]] = p[SET_DAMPING]
    w[io[PRESSURE]] = pressure
    w[io[ADHESION]] = p[HUMID]


class Environment(Block):
    r"""Temperature, pressure and humidity around the device, its age, and what rubs on it.

    They change the true device, never the nominal one the controllers believe in, whose figures hold for a new one at
    300 K and 1 atm; there every factor is exactly 1. A device without a drawing is given the film of the drawn
    LCR-350. Temperature and age change the modulus of all beams, and with it every stiffness of the suspension.
    Temperature is also that of the thermomechanical noise. Humidity sets the adhesion energy, and with it the friction
    of what touches; its effect on viscosity is below 1 %.
    """

    title = "Environment"
    inputs = (Port("vacuum", "1", "share of the vacuum that is left", source="effects.vacuum"),)
    outputs = (
        Port("stiffness_scale", "1", "stiffness over nominal", hidden=True),
        Port("damping_scale", "1", "damping over nominal", hidden=True),
        Port("squeeze", "1", "squeeze film over that of a continuous gas at 300 K, over the damping", hidden=True),
        Port("friction", "uN", "Coulomb friction without any fault", hidden=True),
        Port("friction_scale", "1", "friction at this humidity over that at 40 %", hidden=True),
        Port("age", "week", "age without any fault", hidden=True),
        Port("damping_set", "1", "damping over nominal without any leak", hidden=True),
    )
    taps = (
        Port("pressure", "Pa", "pressure at the device"),
        Port("adhesion", "mJ/m^2", "adhesion energy of surfaces that touch"),
    )
    equations = (
        Equation(
            "damping",
            r"\frac{\beta}{\beta_0}=(1-\sigma)\frac{b(p,T)}{b(p_0,T_0)}+\sigma,\quad "
            r"b=\mu\left[A\left(\tfrac1{d+2\lambda}+\tfrac1{\delta+2\lambda}\right)+\tfrac{A_c}{g+2\lambda}\right]",
            "1.3.7 with slip",
            printed=r"\beta_x=\mu\left[A\left(\tfrac1t+\tfrac1\delta\right)+\tfrac{A_c}{g}\right]",
            why="no rarefaction in the text, so damping would hardly depend on pressure; its t is the film, not the "
            "structural thickness; the flow along x is shear, not squeeze film",
        ),
        Equation(
            "stiffness",
            r"\frac{E}{E_0}=\frac{k}{k_0}=\frac{k_y}{k_{y0}}=\frac{k_\theta}{k_{\theta0}}=1-63\cdot10^{-6}\,(T-300)",
            "recalled value",
        ),
        Equation("pressure", r"p=p_1-v\,(p_1-p_0),\quad p_1=1\ \text{atm}", "v: share of the vacuum left"),
        Equation("adhesion", r"W=W_d(W_w/W_d)^{1/(1+e^{-(H-60)/8})}", "ends recalled, shape assumed; 1.4.4"),
        Equation(
            "friction", r"F_s(H)=F_s\,\frac{W(H)}{W(40)},\quad|x-x_0|\le F_s(H)/k\ \text{at rest}", "assumed; 1.5"
        ),
        Equation(
            "squeeze film", r"c_s\to c_s\,\frac{\mu}{\mu_0}\frac1{1+9.638\,(\lambda/g)^{1.159}}", "Veijola, recalled"
        ),
        Equation("age", r"E\to E/r(t),\quad r=1-0.428\,\frac{1-e^{-t/2}}{1-e^{-2}}", "3.1.3.2; the law is assumed"),
    )

    class Params(BlockParams):
        """State of the air and of the device in it."""

        temperature_k: float = parameter(300.0, "temperature of device and air", "K", ge=150, le=600)
        pressure_pa: float = parameter(101325.0, "pressure of the air", "Pa", ge=0.01, le=1e6, equation="1.3.7")
        humidity_pct: float = parameter(40.0, "relative humidity", "%", ge=0, le=100, equation="1.4.4")
        friction_nn: float = parameter(
            0.0, "Coulomb friction at 40 % of humidity: the shuttle sticks within F/k", "nN", ge=0, le=1e5
        )
        age_weeks: float = parameter(0.0, "age of the device", "week", ge=0, le=52, equation="3.1.3.2")

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the state of the air and the film of the device; nN to uN."""
        device = context.device
        film = [
            *drawn(context).film,
            1e3 * device.natural_frequency,
            # what is no resonator has no air around it either
            structural_share(0.5 / device.damping_ratio) if device.time_unit_ms == 0.0 else 1.0,
        ]
        return np.array(
            [
                params.pressure_pa,
                params.temperature_k,
                1e3 * adhesion_j_m2(params.humidity_pct),
                friction_scale(params.humidity_pct),
                1e-3 * params.friction_nn,
                params.age_weeks,
                1.0 / ageing_ratio(params.age_weeks),
                damping_scale(params.pressure_pa, params.temperature_k, *film),
                *film,
            ]
        )

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Pressure and temperature of the factors kept, and the factors."""
        return np.array([ATMOSPHERE_PA, ROOM_K, 1.0, 1.0, squeezed_share(ATMOSPHERE_PA, ROOM_K, drawn(context).gap_um)])

    @classmethod
    def scales(cls, params: Any, context: Context) -> tuple[float, float]:
        """Return the factors of stiffness and damping before any fault."""
        packed = cls.pack(params, context)
        return float(stiffness_scale(params.temperature_k) * packed[AGED]), float(packed[SET_DAMPING])

    step = environment_step
