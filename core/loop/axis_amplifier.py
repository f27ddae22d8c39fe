"""Amplifier of an axis: computation delay and bandwidth between the converter of the drive and the device."""

from __future__ import annotations

from typing import Any

from core.block import Block, Context, Equation
from core.loop.amplifier import AmplifierState, DelayParams, PackedAmplifier, packed_amplifier, pass_on
from core.ports import BlockPorts, output, reads


class AxisAmplifier(Block):
    """Delay and bandwidth: the force that the board asks for arrives at one axis of the device late.

    The slew of an amplifier is a voltage over a time, and the drive of an axis a force; so there is none here.
    """

    title = "Delay and amplifier of an axis"
    per_axis = True
    equations = (
        Equation("delay", r"u(t)=u_c(t-(d+f)\,h)"),
        Equation("amplifier", r"\dot F=\omega_a\,(u-F)"),
    )

    class Params(DelayParams):
        """The stages behind the converter of the drive, the same for every axis."""

    class Packed(PackedAmplifier):
        """Delay and bandwidth."""

    class State(AmplifierState):
        """The output and the last commands."""

    class Ports(BlockPorts):
        """The command, and the force that arrives, as a parabola over the tick."""

        command: float = reads("drive.{axis}.force", "uN", "force of the converter")
        command_middle: float = reads("drive.{axis}.middle", "uN", "the same half a sample later")
        command_end: float = reads("drive.{axis}.end", "uN", "the same one sample later")
        force: float = output("uN", "force that arrives", hidden=True)
        middle: float = output("uN", "the same half a sample later", hidden=True)
        end: float = output("uN", "the same one sample later", hidden=True)

    @classmethod
    def rests(cls, params: Any) -> bool:
        """Say whether the command arrives as it is."""
        return not (params.delay_samples or params.delay_fraction or params.amplifier_khz)

    @classmethod
    def pack(cls, params: Any, context: Context) -> PackedAmplifier:
        """Pack the stages."""
        found: PackedAmplifier = packed_amplifier(cls.Packed.blank(), params, context, 0.0)
        return found

    @staticmethod
    def step(p: PackedAmplifier, s: AmplifierState, x: Ports) -> None:
        """Let the command arrive."""
        x.force, x.middle, x.end = pass_on(p, s, x.tick, x.command, x.command_middle, x.command_end)
