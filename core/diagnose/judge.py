r"""Base of diagnosers that weigh hypotheses in a way of their own.

It knows the hypotheses and puts out a probability for each; everything between is the diagnoser's.
"""

from __future__ import annotations

from typing import ClassVar

from core.block import Block, BlockParams, Oscillator
from core.diagnose.hypothesis import BankParams, lacking
from core.ports import output, tap
from core.record import Choice, Record, Vector
from core.voltage import ObservedPorts


class Judge(Block):
    """A diagnoser that chooses between hypotheses; its step runs once for each measurement.

    It may leave `residual` and `nis` at 0.
    """

    Params: ClassVar[type[BlockParams]] = BankParams

    class Packed(Record):
        """How many hypotheses there are."""

        count: Choice

    class Ports(ObservedPorts):
        """The measured displacement and the applied voltage; the probability of every hypothesis."""

        probability: Vector = output("1", "probability of the hypothesis", each="hypotheses")
        residual: Vector = tap("um", "residual of the hypothesis", each="hypotheses")
        nis: Vector = tap("1", "square of the residual over its expected value", each="hypotheses")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants without mass or spring."""
        return lacking(device)
