"""Environment: the effects of air, age and friction on the device."""

from __future__ import annotations

from typing import Any

from core.block import Block, BlockParams, Context, Equation, parameter
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
from core.kernel import kernel
from core.ports import BlockPorts, output, reads, tap
from core.record import Record


class Film(Record):
    """The gas film of a device, as ``core.device.environment.damping_scale`` takes it, and the structural share."""

    plan_um2: float
    film_um: float
    comb_um2: float
    gap_um: float
    omega: float
    structural: float


@kernel
def damping_in(film: Film, pressure_pa: float, temperature_k: float) -> float:
    """Return the damping of a device in air over that at 300 K and 1 atm."""
    return float(
        damping_scale(
            pressure_pa,
            temperature_k,
            film.plan_um2,
            film.film_um,
            film.comb_um2,
            film.gap_um,
            film.omega,
            film.structural,
        )
    )


class Environment(Block):
    r"""Temperature, pressure and humidity around the device, its age, and its friction.

    They change the true device, never the nominal device of the controllers, whose figures hold for a new device at 300
    K and 1 atm; there every factor is exactly 1. A device without a drawing is given the film of the drawn LCR-350.
    Temperature and age change the modulus of all beams, and with it every stiffness of the suspension. Temperature is
    also that of the thermomechanical noise. Humidity sets the adhesion energy, and with it the friction of touching
    surfaces; its effect on viscosity is below 1 %.

    A device of two axes is sealed in a package, at whose pressure its quality factors hold. No air outside reaches it:
    its damping depends neither on pressure nor on humidity here, and the fault ``package_leak`` raises the pressure
    inside. Temperature changes its stiffness and its thermomechanical noise. The drag of a sealed gas grows with
    :math:`\sqrt T` besides, 8 % from 300 to 350 K; how much of the damping is gas is not known, so that is left out.
    """

    title = "Environment"
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
        pressure_pa: float = parameter(
            101325.0,
            "pressure of the air; a device in a sealed package does not feel it",
            "Pa",
            ge=0.01,
            le=1e6,
            equation="1.3.7",
        )
        humidity_pct: float = parameter(40.0, "relative humidity", "%", ge=0, le=100, equation="1.4.4")
        friction_nn: float = parameter(
            0.0, "Coulomb friction at 40 % of humidity: the shuttle sticks within F/k", "nN", ge=0, le=1e5
        )
        age_weeks: float = parameter(0.0, "age of the device", "week", ge=0, le=52, equation="3.1.3.2")

    class Packed(Record):
        """Air, adhesion, friction, age and the share of the modulus it leaves, damping without a leak, film."""

        pressure_pa: float
        temperature_k: float
        adhesion: float
        friction_scale: float
        friction_un: float
        age_weeks: float
        aged: float
        damping_set: float
        film: Film

    class State(Record):
        """Pressure and temperature of the factors kept, and the factors."""

        pressure: float
        temperature: float
        stiffness: float
        damping: float
        squeeze: float

    class Ports(BlockPorts):
        """The leak in; factors out."""

        vacuum: float = reads("effects.vacuum", "1", "share of the vacuum that is left")
        stiffness_scale: float = output("1", "stiffness over nominal", hidden=True)
        damping_scale: float = output("1", "damping over nominal", hidden=True)
        squeeze: float = output(
            "1", "squeeze film over its value in a continuous gas at 300 K, over the damping", hidden=True
        )
        friction: float = output("uN", "Coulomb friction without any fault", hidden=True)
        friction_scale: float = output("1", "friction at this humidity over that at 40 %", hidden=True)
        age: float = output("week", "age without any fault", hidden=True)
        damping_set: float = output("1", "damping over nominal without any leak", hidden=True)
        pressure: float = tap("Pa", "pressure of the air around the device or its package")
        adhesion: float = tap("mJ/m^2", "adhesion energy of surfaces that touch")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the state of the air and the film of the device; nN to uN."""
        device = context.device
        p = cls.Packed.blank()
        p.adhesion = 1e3 * adhesion_j_m2(params.humidity_pct)
        p.friction_scale = friction_scale(params.humidity_pct)
        p.friction_un = 1e-3 * params.friction_nn
        p.aged = 1.0 / ageing_ratio(params.age_weeks)
        film = p.film
        film.plan_um2, film.film_um, film.comb_um2, film.gap_um = drawn(context).film
        film.omega = 1e3 * device.natural_frequency
        film.structural = structural_share(0.5 / device.damping_ratio) if device.in_air else 1.0
        p.damping_set = damping_in(film, params.pressure_pa, params.temperature_k)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Factors at room temperature and 1 atm."""
        s = cls.State.zeros()
        s.pressure, s.temperature, s.stiffness, s.damping = ATMOSPHERE_PA, ROOM_K, 1.0, 1.0
        s.squeeze = squeezed_share(ATMOSPHERE_PA, ROOM_K, drawn(context).gap_um)
        return s

    @classmethod
    def scales(cls, params: Any, context: Context) -> tuple[float, float]:
        """Return the factors of stiffness and damping before any fault."""
        packed = cls.pack(params, context)
        return float(stiffness_scale(params.temperature_k) * packed.aged), float(packed.damping_set)

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Compute the effects of pressure and temperature on the device; a leak of the tick before counts."""
        pressure = p.pressure_pa
        if x.vacuum != 1.0:
            pressure = ATMOSPHERE_PA - x.vacuum * (ATMOSPHERE_PA - pressure)
        if pressure != s.pressure or p.temperature_k != s.temperature:
            s.pressure = pressure
            s.temperature = p.temperature_k
            s.stiffness = stiffness_scale(p.temperature_k)
            s.damping = damping_in(p.film, pressure, p.temperature_k)
            s.squeeze = squeezed_share(pressure, p.temperature_k, p.film.gap_um) / s.damping
        x.stiffness_scale = s.stiffness * p.aged
        x.damping_scale = s.damping
        x.squeeze = s.squeeze
        x.friction = p.friction_un * p.friction_scale
        x.friction_scale = p.friction_scale
        x.age = p.age_weeks
        x.damping_set = p.damping_set
        x.pressure = pressure
        x.adhesion = p.adhesion
