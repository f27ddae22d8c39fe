r"""Base of identifiers that estimate the device in a way of their own.

Its inputs are the measurement and the applied voltage, and its outputs mass, stiffness and damping over their nominal
values. The board adds the truth and the error.
"""

from __future__ import annotations

from core.block import Block, Oscillator
from core.identify.identifier import PHYSICAL, Identifier
from core.ports import output
from core.record import Vector
from core.voltage import ObservedPorts


class Estimator(Block):
    """An identifier; its step runs once for each measurement."""

    class Ports(ObservedPorts):
        """The measurement and the applied voltage; the estimate."""

        estimate: Vector = output("1", "estimated mass, stiffness and damping over nominal", labels=PHYSICAL)

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants without mass, damping or spring."""
        return Identifier.unsuited(device, model)
