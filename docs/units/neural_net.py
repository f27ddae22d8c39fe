r"""A small network of fixed weights as a controller; ``train_neural_net.py`` trains it."""

from typing import Any

from core.block import Block, BlockParams, Context, Equation, Oscillator, parameter
from core.control.controller import ControllerPorts, unsuited_second_order
from core.elementary import tanh
from core.ports import tap
from core.record import Record, Vector, vector

UNITS = 3
OF_ERROR = (-0.815175, 1.97319, 0.853589)
OF_RATE = (-2.24869, 2.65565, 2.0537)
OUT = (3.26547, 0.19487, 4.09788)


class NeuralNet(Block):
    r"""A network of three tanh units that has learnt a saturated switching law (Cybenko 1989; Bryson and Ho 1975, 3.9).

    Its teacher is :math:`\mathrm{sat}(z_1+z_2+z_2|z_2|/2)`, the switching curve of the double integrator with a
    boundary layer. The weights are fixed: the network does not learn while it drives.
    """

    title = "Neural network"
    equations = (
        Equation("law", r"u=r+A\,\mathrm{sgn}(F)\sum_{i=1}^{3}c_i\tanh(a_iz_1+b_iz_2)"),
        Equation("inputs", r"z_1=e/E,\quad z_2=\frac{e_n-e_{n-1}}{\omega_0hE},\quad e=y_m-y"),
    )
    weaknesses = (
        "an error that stays is a voltage that stays: it has no integral action",
        "the rate of the error is a difference, so it takes the noise of the sensor for motion",
    )

    class Params(BlockParams):
        """How strong the law is, and the error that is large to it."""

        authority_v: float = parameter(10.0, "voltage of a large error", "V", ge=0, le=1e3)
        scale_um: float = parameter(1.0, "error that saturates the law", "um", gt=1e-6, le=1e3)

    class Packed(Record):
        """Scales of the inputs, and the weights; the weights of the output in volts, in the direction of the force."""

        by_error: float
        by_rate: float
        of_error: Vector = vector(UNITS)
        of_rate: Vector = vector(UNITS)
        out: Vector = vector(UNITS)

    class State(Record):
        """The last error, and whether there was one."""

        error: float
        started: float

    class Ports(ControllerPorts):
        """The ports of every controller, and the output of the network."""

        correction: float = tap("V", "what the network adds to the reference")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse devices without mass, and models that do not come to rest."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the scales of the inputs, and the weights."""
        p = cls.Packed.blank()
        p.by_error = 1.0 / params.scale_um
        p.by_rate = p.by_error / (context.device.natural_frequency * context.dt_ms)
        signed_v = params.authority_v if context.device.force > 0.0 else -params.authority_v
        for i in range(UNITS):
            p.of_error[i], p.of_rate[i], p.out[i] = OF_ERROR[i], OF_RATE[i], signed_v * OUT[i]
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Compute one sample: inputs, hidden units, output."""
        e = x.model - x.measured
        error = p.by_error * e
        rate = p.by_rate * (e - s.error) if s.started != 0.0 else 0.0
        s.error = e
        s.started = 1.0
        total = 0.0
        for i in range(UNITS):
            total += p.out[i] * tanh(p.of_error[i] * error + p.of_rate[i] * rate)
        x.correction = total
        x.voltage = x.reference + total
