r"""Tuning voltage: a constant voltage on the tuning electrode."""

from __future__ import annotations

from typing import Any

from core.block import Block, BlockParams, Context, Equation, Stage, parameter
from core.control.two_axis import TuningPorts, two_axis
from core.device.two_axis import TuningPlates, TwoAxis
from core.errors import InputError
from core.record import Record


class TuningVoltage(Block):
    r"""A voltage on the plates that face y, :math:`k_e=2\varepsilon_0AV^2/g^3` softer.

    Read-outs of the open loop count with the softening of the nominal electrode.
    """

    title = "Tuning voltage"
    place = 21
    axes = ("x", "y")
    plants = ("tuned_gyroscope",)
    slot = "tuning"
    equations = (Equation("softening", r"k_e=\frac{2\varepsilon_0AV^2}{g^3}", "not in the text"),)
    structure = (Stage("Voltage", "engaged", "tuning softening", ("softening",)),)
    weaknesses = (
        "Nothing measures the split: 1 % of stiffness along y moves it by 20 Hz on gyro-c, five times the half "
        "bandwidth of y.",
    )

    class Params(BlockParams):
        """The voltage."""

        voltage_v: float = parameter(0.0, "voltage on the tuning electrode", "V", ge=0, le=1e4)

    class Packed(Record):
        """The voltage, and the softening by it."""

        voltage_v: float
        taken: float

    class Ports(TuningPorts):
        """Ports of the tuning slot."""

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the voltage.

        Raises
        ------
        InputError
            For a voltage that pulls the nominal mass in.
        """
        p = cls.Packed.blank()
        device, plates = two_axis(context), plates_of(two_axis(context))
        limit = plates.pull_in_v(device.free_stiffness_y)
        if params.voltage_v >= limit:
            text = f"{params.voltage_v:g} V pulls the mass into the tuning electrode; its pull-in is at {limit:.4g} V"
            raise InputError(text, "voltage_v", "choose less")
        p.taken = plates.per_v2 * params.voltage_v * params.voltage_v
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Put the voltage on."""
        x.tuning = p.voltage_v
        x.softening = p.taken
        x.pilot = 0.0


def plates_of(device: TwoAxis) -> TuningPlates:
    """Return the tuning electrode, which the device has wherever a controller of the tuning slot is allowed.

    Raises
    ------
    InputError
        Where it has none after all.
    """
    if device.tuning is None:
        raise InputError("this device has no tuning electrode", "kind", "give it device.electrodes.tuning")
    return device.tuning
