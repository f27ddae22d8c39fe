"""Drive of an axis: limiter and converter between the controllers and one axis of the plant."""

from __future__ import annotations

from typing import Any, Literal

from core.block import Block, BlockParams, Context, Equation, Oscillator, parameter
from core.converter import BITS, Converter, convert, reach, step_of
from core.device.two_axis import PushPull
from core.kernel import kernel
from core.ports import BlockPorts, output, reads, tap
from core.record import Record

AXES, OF_PARTNER = ("x", "y", "partner_x", "partner_y"), "partner_"
"""Axes that a device and its partner may have, and the mark of the latter."""
USUAL_V = 20.0
"""Limit of the voltage on combs unless it is given."""


class PackedDrive(Converter):
    """The converter, whether it passes on how the force moves between samples, and the combs of an axis.

    Without combs, ``per_volt`` is 0 and the converter puts out a force.
    """

    analogue: float
    gradient: float
    bias_v: float
    per_volt: float


@kernel
def pull(p: PackedDrive, volts: float) -> float:
    """Return the force of two combs, at the bias plus the voltage and at the bias minus the voltage."""
    more, less = p.bias_v + volts, p.bias_v - volts
    return 0.5 * p.gradient * (more * more - less * less)


@kernel
def put_out(p: PackedDrive, command: float) -> float:
    """Return the force that the drive puts out for a command: by its converter, or by volts on combs."""
    if p.per_volt == 0.0:
        return convert(p, command)
    return pull(p, convert(p, command / p.per_volt))


class AxisDrive(Block):
    r"""Limiter and digital-to-analogue converter of one axis; holds the force for one sample.

    The force comes from the driving controller in the last slot that has an output named after the axis. By volts, the
    converter puts out the voltage that the nominal combs need for it, and the combs of the axis pull with

    .. math:: F=\tfrac12\frac{dC}{dx}\left[(V_b+v)^2-(V_b-v)^2\right] .
    """

    title = "Drive of an axis"
    per_axis = True
    equations = (
        Equation("volts", r"v=F_c\Big/2\frac{dC}{dx}V_b", "1.3.2"),
        Equation("combs", r"F=\tfrac12\frac{dC}{dx}\left[(V_b+v)^2-(V_b-v)^2\right]", "1.3.2"),
    )

    class Params(BlockParams):
        """The output stage, the same for every axis."""

        limit_un: float = parameter(1000.0, "limit to either side, by force", "uN", gt=0, le=1e6)
        quantum_un: float = parameter(0.0, "step of the converter, 0 for none", "uN", ge=0, le=1e4)
        bits: int = BITS
        by: Literal["force", "volts"] = parameter(
            "force",
            "force as such, or volts on the combs of the device; the converter then has converter_limit_v",
            live=False,
        )
        converter_limit_v: float | None = parameter(
            None, "limit to either side, by volts; 20 V unless given", "V", gt=0, le=1e4
        )
        kind: Literal["held", "analogue"] = parameter(
            "held",
            "held by a converter, or analogue, for controllers that know their force between samples",
            live=False,
        )

    class Packed(PackedDrive):
        """The converter, and the combs of the axis."""

    class Ports(BlockPorts):
        """Requested force, applied force."""

        command: float = reads("@command", "uN", "force asked for by the controller that drives the axis")
        command_middle: float = reads("@command_middle", "uN", "the same half a sample later")
        command_end: float = reads("@command_end", "uN", "the same one sample later")
        force: float = output("uN", "applied force")
        middle: float = output("uN", "applied force half a sample later", hidden=True)
        end: float = output("uN", "applied force one sample later", hidden=True)
        saturated: float = tap("1", "1 while more force is asked for than the drive has")
        voltage: float = tap("V", "voltage on the combs beside their bias; 0 where the drive is a force")

    @classmethod
    def quantum(cls, params: Any) -> float:
        """Return the step of the converter, 0 for none; by volts it is in volts."""
        if params.by == "volts":
            return step_of(0.0, params.bits, params.converter_limit_v or USUAL_V)
        return step_of(params.quantum_un, params.bits, params.limit_un)

    @classmethod
    def reach(cls, params: Any) -> float:
        """Return the largest force that is put out; by volts the largest voltage."""
        return reach(
            (params.converter_limit_v or USUAL_V) if params.by == "volts" else params.limit_un, cls.quantum(params)
        )

    @classmethod
    def reach_un(cls, params: Any, device: Oscillator, partner: Oscillator | None) -> float:
        """Return the largest force that is put out along every axis with combs, uN."""
        if params.by == "force":
            return cls.reach(params)
        found = [comb.per_volt for axis in AXES if (comb := combs(device, partner, axis)) is not None]
        return cls.reach(params) * min(found, default=0.0)

    @classmethod
    def unable(
        cls, params: Any, device: Oscillator, partner: Oscillator | None, axes: tuple[str, ...]
    ) -> tuple[str, str]:
        """Return the field that does not go with this drive or device, and why; nothing where all do."""
        if params.by == "force":
            return (
                ("converter_limit_v", "limits the volts on combs; this drive is by force")
                if params.converter_limit_v
                else ("", "")
            )
        without = [axis for axis in axes if combs(device, partner, axis) is None]
        if without:
            return "by", f"no combs for volts along {', '.join(without)}"
        return (
            ("quantum_un", "is the step of a force; by volts the converter has bits") if params.quantum_un else ("", "")
        )

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the limit, the step and the combs."""
        p = cls.Packed.blank()
        p.limit, p.quantum = cls.reach(params), cls.quantum(params)
        p.analogue = params.kind == "analogue"
        p.gradient, p.bias_v, p.per_volt = 0.0, 0.0, 0.0
        comb = combs(context.device, context.partner, context.axis) if params.by == "volts" else None
        if comb is not None:
            p.gradient, p.bias_v, p.per_volt = comb.gradient, comb.bias_v, comb.per_volt
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Apply the requested force, as far as the drive can."""
        x.force = put_out(p, x.command)
        if p.analogue == 0.0 or (x.command_middle == x.command and x.command_end == x.command):
            x.middle = x.force
            x.end = x.force
        else:
            x.middle = put_out(p, x.command_middle)
            x.end = put_out(p, x.command_end)
        asked = x.command if p.per_volt == 0.0 else x.command / p.per_volt
        x.saturated = 1.0 if abs(asked) > p.limit else 0.0
        x.voltage = 0.0 if p.per_volt == 0.0 else convert(p, asked)


def combs(device: Oscillator, partner: Oscillator | None, axis: str) -> PushPull | None:
    """Return the combs along an axis, of a device or of its partner."""
    own = axis.removeprefix(OF_PARTNER)
    found: PushPull | None = getattr(device if own == axis else partner, f"comb_{own}", None)
    return found
