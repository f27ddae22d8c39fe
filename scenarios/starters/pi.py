"""Proportional and integral control."""

from __future__ import annotations

from typing import Any

from core.block import Block, BlockParams, Context, Equation, Stage, parameter
from core.control.controller import ControllerPorts
from core.ports import tap
from core.record import Record


class Pi(Block):
    r"""Proportional and integral control, :math:`u=K_pe+K_i\int e\,dt`, :math:`e=y_m-y`."""

    title = "PI"
    equations = (Equation("law", r"u=K_pe+K_i\int e\,dt,\quad e=y_m-y"),)
    structure = (Stage("Error", "model measured", "error"), Stage("Law", "error", "voltage integral", ("law",)))

    class Params(BlockParams):
        """Gains, as people set them."""

        proportional_v_um: float = parameter(-2.0, "proportional gain", "V/um", ge=-1e3, le=1e3)
        integral_v_um_ms: float = parameter(-5.0, "integral gain", "V/(um ms)", ge=-1e4, le=1e4)

    class Packed(Record):
        """Numbers the step reads."""

        proportional_v_um: float
        integral_v_um_ms: float
        dt_ms: float

    class State(Record):
        """The integral, V."""

        integral: float

    class Ports(ControllerPorts):
        """The ports of every controller, and the error to look at."""

        error: float = tap("um", "model minus measured displacement")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the sample interval; the gains go to the fields of their names."""
        p = cls.Packed.blank()
        p.dt_ms = context.dt_ms
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Compute one sample; a law that does not drive keeps its integral ready to take over."""
        e = x.model - x.measured
        proportional = p.proportional_v_um * e
        if x.engaged == 0.0:
            s.integral = x.applied - proportional
        else:
            s.integral += p.integral_v_um_ms * e * p.dt_ms
        x.voltage = proportional + s.integral
        x.error = e
