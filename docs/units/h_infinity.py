r"""An H-infinity controller of ``ch3``; ``design_h_infinity.py`` computes its constants."""

from typing import Any

from core.block import Block, BlockParams, Context, Equation, Oscillator
from core.control.controller import ControllerPorts, unsuited_second_order
from core.device.oscillator import held
from core.ports import tap
from core.record import Record

BOUND = 2.60736
# of the controller, in units of 1/w0 of the device and of k/F volts per um
NUMERATOR = (416.08917, 473.70635)
DENOMINATOR = (24.584761, 153.89096)


class HInfinity(Block):
    r"""Loop shaping by normalised coprime factors (McFarlane and Glover 1992; Skogestad and Postlethwaite 2005, 9.4).

    The loop is stable for every device whose :math:`\nu`-gap from ``ch3``, both weighed by :math:`W=10`, is below
    :math:`1/\gamma` (Vinnicombe 1993), as long as the samples are quick relative to the loop.
    """

    title = "H-infinity loop shaping"
    equations = (
        Equation("law", r"u=r+C(s)\,e,\quad C=\frac{k}{F}\,\frac{c_1s+c_0}{s^2+a_1s+a_0},\quad e=y_m-y"),
        Equation(
            "norm",
            r"\left\|\begin{bmatrix}I\\K\end{bmatrix}(I+G_sK)^{-1}\begin{bmatrix}I&G_s\end{bmatrix}\right\|_\infty"
            r"\le\gamma=2.61,\quad G_s=WG,\quad C=WK",
            "Skogestad and Postlethwaite 9.4.1",
        ),
    )
    weaknesses = (
        "designed in continuous time: at 50 kHz and less the loop of ch3 loses much of its margin",
        "it has no integral action: a device that differs from the nominal one leaves an error",
    )

    class Params(BlockParams):
        """Nothing is left to set."""

    class Packed(Record):
        """The controller over a sample, and the gains from its state to the voltage."""

        phi11: float
        phi12: float
        phi21: float
        phi22: float
        push1: float
        push2: float
        of_state: float
        of_rate: float

    class State(Record):
        """State of the controller and its rate, and the error held over the last sample."""

        state: float
        rate: float
        error: float

    class Ports(ControllerPorts):
        """The ports of every controller, and the error."""

        error: float = tap("um", "model minus measured displacement")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse devices without mass, and models that do not come to rest."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the controller over a sample: its poles are the poles of an oscillator, driven by the error."""
        p = cls.Packed.blank()
        device = context.device
        h = context.dt_ms * device.natural_frequency
        p.phi11, p.phi12, p.phi21, p.phi22, p.push1, p.push2 = held(1.0, DENOMINATOR[0], DENOMINATOR[1], h)
        volts = device.stiffness / device.force
        p.of_state, p.of_rate = volts * NUMERATOR[1], volts * NUMERATOR[0]
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Advance the controller by the error held over the sample that ends now."""
        state, rate = s.state, s.rate
        s.state = p.phi11 * state + p.phi12 * rate + p.push1 * s.error
        s.rate = p.phi21 * state + p.phi22 * rate + p.push2 * s.error
        s.error = x.model - x.measured
        x.error = s.error
        x.voltage = x.reference + p.of_state * s.state + p.of_rate * s.rate
