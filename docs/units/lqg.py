r"""LQG: a Kalman filter and a quadratic regulator about the reference model."""

from typing import Any

from core.block import Block, BlockParams, Context, Equation, Oscillator, parameter
from core.control.controller import ControllerPorts, unsuited_second_order
from core.device.oscillator import held
from core.ports import reads, tap
from core.record import Record

DOUBLINGS = 30


class Lqg(Block):
    r"""Linear-quadratic-Gaussian tracking of the reference model (Kalman 1960; Åström 1970, chapter 8).

    Both Riccati equations are solved in ``pack`` by doubling: each pass looks over twice as many samples
    (Anderson 1978).
    """

    title = "LQG"
    equations = (
        Equation("law", r"u=u_m-K(\hat x-x_m),\quad u_m=(m\ddot y_m+\beta\dot y_m+ky_m)/F"),
        Equation("filter", r"\hat x=\bar x+L(y-C\bar x),\quad \bar x=A\hat x+Bu"),
        Equation("cost", r"J=\mathsf E\,\bigl[(y-y_m)^2+\rho\,(u-u_m)^2\bigr]"),
        Equation("regulator", r"P=A^TPA-A^TPB(\rho+B^TPB)^{-1}B^TPA+C^TC"),
    )
    weaknesses = (
        "it takes the voltage for held over a sample",
        "it has no integral action: a device that differs from the nominal one leaves an error",
    )

    class Params(BlockParams):
        """The cost of voltage, and the noise that is assumed."""

        voltage_cost_um_v: float = parameter(0.03, "root of the cost of a volt", "um/V", gt=1e-6, le=1e3)
        process_noise_v: float = parameter(1.0, "assumed noise on the voltage, rms per sample", "V", gt=1e-6, le=100)
        measurement_noise_um: float = parameter(0.05, "assumed noise of the sensor", "um", gt=1e-6, le=100)

    class Packed(Record):
        """The device over a sample, the voltage that moves it as the model moves, and both gains."""

        a11: float
        a12: float
        a21: float
        a22: float
        b1: float
        b2: float
        of_reference: float
        of_velocity: float
        of_displacement: float
        k1: float
        k2: float
        l1: float
        l2: float

    class State(Record):
        """Estimated displacement and velocity."""

        displacement: float
        velocity: float

    class Ports(ControllerPorts):
        """The ports of every controller, the model's velocity, and the estimate."""

        model_velocity: float = reads("model.velocity", "um/ms", "velocity of the model")
        estimate: float = tap("um", "estimated displacement")
        velocity: float = tap("um/ms", "estimated velocity")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse devices without mass, and models that do not come to rest."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the device, and the gains of both Riccati equations."""
        p = cls.Packed.blank()
        device, model = context.device, context.model
        force, share = device.force, device.mass / model.mass
        a11, a12, a21, a22, push1, push2 = held(device.mass, device.damping, device.stiffness, context.dt_ms)
        b1, b2 = force * push1, force * push2
        p.a11, p.a12, p.a21, p.a22, p.b1, p.b2 = a11, a12, a21, a22, b1, b2
        p.of_reference = share * model.force / force
        p.of_velocity = (device.damping - share * model.damping) / force
        p.of_displacement = (device.stiffness - share * model.stiffness) / force

        cost, noise = params.voltage_cost_um_v**2, params.measurement_noise_um**2
        drift = params.process_noise_v**2
        regulator = (a11, a12, a21, a22, b1 * b1 / cost, b1 * b2 / cost, b2 * b2 / cost, 1.0, 0.0, 0.0)
        observer = (a11, a21, a12, a22, 1.0 / noise, 0.0, 0.0, drift * b1 * b1, drift * b1 * b2, drift * b2 * b2)
        for is_regulator, start in ((True, regulator), (False, observer)):
            f11, f12, f21, f22, g11, g12, g22, p11, p12, p22 = start
            for _ in range(DOUBLINGS):
                m11, m12 = 1.0 + g11 * p11 + g12 * p12, g11 * p12 + g12 * p22  # I + GP, its inverse is W
                m21, m22 = g12 * p11 + g22 * p12, 1.0 + g12 * p12 + g22 * p22
                d = m11 * m22 - m12 * m21
                w11, w12 = (m22 * f11 - m12 * f21) / d, (m22 * f12 - m12 * f22) / d  # WF
                w21, w22 = (m11 * f21 - m21 * f11) / d, (m11 * f22 - m21 * f12) / d
                s11, s12, s22 = (m22 * g11 - m12 * g12) / d, (m22 * g12 - m12 * g22) / d, (m11 * g22 - m21 * g12) / d
                t11, t12, t22 = (m22 * p11 - m21 * p12) / d, (m11 * p12 - m12 * p11) / d, (m11 * p22 - m12 * p12) / d
                g11, g12, g22 = (
                    g11 + f11 * (f11 * s11 + f12 * s12) + f12 * (f11 * s12 + f12 * s22),
                    g12 + f21 * (f11 * s11 + f12 * s12) + f22 * (f11 * s12 + f12 * s22),
                    g22 + f21 * (f21 * s11 + f22 * s12) + f22 * (f21 * s12 + f22 * s22),
                )
                p11, p12, p22 = (
                    p11 + f11 * (f11 * t11 + f21 * t12) + f21 * (f11 * t12 + f21 * t22),
                    p12 + f12 * (f11 * t11 + f21 * t12) + f22 * (f11 * t12 + f21 * t22),
                    p22 + f12 * (f12 * t11 + f22 * t12) + f22 * (f12 * t12 + f22 * t22),
                )
                f11, f12, f21, f22 = (
                    f11 * w11 + f12 * w21,
                    f11 * w12 + f12 * w22,
                    f21 * w11 + f22 * w21,
                    f21 * w12 + f22 * w22,
                )
            if is_regulator:
                of1, of2 = b1 * p11 + b2 * p12, b1 * p12 + b2 * p22
                whole = cost + b1 * of1 + b2 * of2
                p.k1, p.k2 = (of1 * a11 + of2 * a21) / whole, (of1 * a12 + of2 * a22) / whole
            else:
                p.l1, p.l2 = p11 / (p11 + noise), p12 / (p11 + noise)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Predict by the voltage applied, correct by the measurement, regulate about the model."""
        displacement = p.a11 * s.displacement + p.a12 * s.velocity + p.b1 * x.applied
        velocity = p.a21 * s.displacement + p.a22 * s.velocity + p.b2 * x.applied
        missed = x.measured - displacement
        s.displacement = displacement + p.l1 * missed
        s.velocity = velocity + p.l2 * missed
        wanted = p.of_reference * x.reference + p.of_velocity * x.model_velocity + p.of_displacement * x.model
        x.voltage = wanted - p.k1 * (s.displacement - x.model) - p.k2 * (s.velocity - x.model_velocity)
        x.estimate = s.displacement
        x.velocity = s.velocity
