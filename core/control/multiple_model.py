r"""Multiple-model adaptive control: a law for each hypothesis of a bank, blended by its weights."""

from __future__ import annotations

from typing import Any, Literal

from core.block import Block, Context, Equation, Oscillator, Stage, parameter
from core.control.controller import unsuited_second_order
from core.control.lqg import LqgLaw, LqgParams, fill_law, regulated
from core.control.nominal import FollowingPorts
from core.ports import reads, tap
from core.record import Choice, Record, Records, Vector, several
from core.voltage import Motion

MOST = 16
"""Laws: as many as a bank has hypotheses at most."""


class MultipleModel(Block):
    r"""An LQG for each hypothesis of a diagnoser, :math:`u=\sum_ip_iu_i`, or the law of the winner (Athans 1977).

    Each law has its own filter, which takes the voltage applied. The weights are the weights of this sample. On a bench
    without the diagnoser it is the LQG of the nominal device.
    """

    title = "Multiple models (MMAC)"
    place = 24
    equations = (
        Equation("laws", r"u_i=u_{m,i}-K_i(\hat x_i-x_m)"),
        Equation("blend", r"u=\sum_ip_iu_i\quad\text{or}\quad u=u_k,\;k=\arg\max_ip_i", "Athans et al. 1977"),
    )
    structure = (
        Stage("Law of each hypothesis", "reference model model_velocity applied measured", "estimates", ("laws",)),
        Stage("Blend", "estimates probability", "voltage law", ("blend",)),
    )
    weaknesses = (
        "It has no integral action: a device between the hypotheses leaves an error.",
        "It has no hold time, so the voltage follows each wrong weight of the bank.",
    )

    class Params(LqgParams):
        """Design of each law, the diagnoser, and how the laws are combined."""

        diagnoser: str = parameter("kalman", "diagnoser whose weights count, by its id", live=False)
        combine: Literal["blend", "switch"] = parameter("blend", "all laws by their weights, or the law of the winner")

    class Packed(Record):
        """Number of laws, whether only the winner counts, and the laws."""

        count: Choice
        switches: Choice
        laws: Records[LqgLaw] = several(MOST)

    class State(Record):
        """Estimate of each law."""

        estimates: Records[Motion] = several(MOST)

    class Ports(FollowingPorts):
        """Ports of a controller, the velocity of the model, and the weights."""

        probability: Vector = reads("{diagnoser}.probability?", "1", "weights of the hypotheses")
        law: float = tap("1", "hypothesis with the largest weight")
        largest: float = tap("1", "its weight")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse devices without mass, and models that do not come to rest."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the law of each hypothesis."""
        p = cls.Packed.zeros()
        devices = [*context.banks.get(params.diagnoser, {}).values()] or [context.device]
        p.count, p.switches = len(devices), params.combine == "switch"
        for i, device in enumerate(devices):
            fill_law(p.laws[i], device, params, context)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Compute each law, and combine them."""
        n = int(p.count)
        law = 0
        largest = 1.0
        if p.count > 1.0:
            for i in range(1, n):
                if x.probability[i] > x.probability[law]:
                    law = i
            largest = x.probability[law]
        voltage = 0.0
        for i in range(n):
            own = regulated(p.laws[i], s.estimates[i], x)
            weight = 1.0 if i == law else 0.0
            if p.switches == 0.0 and p.count > 1.0:
                weight = x.probability[i]
            voltage += weight * own
        x.voltage = voltage
        x.law = law
        x.largest = largest
