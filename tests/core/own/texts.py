"""Texts of units, for the tests."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]

PI = '''"""Proportional and integral control."""

from __future__ import annotations

from typing import Any

from core.block import Block, BlockParams, Context, Equation, parameter
from core.control.controller import ControllerPorts
from core.ports import tap
from core.record import Record


class Pi(Block):
    """Proportional and integral control."""

    title = "PI"
    equations = (Equation("law", r"u=K_pe+K_i\\\\int e\\\\,dt"),)

    class Params(BlockParams):
        """Gains."""

        proportional_v_um: float = parameter(-2.0, "proportional gain", "V/um", ge=-1e3, le=1e3)
        integral_v_um_ms: float = parameter(-5.0, "integral gain", "V/(um ms)", ge=-1e4, le=1e4)

    class Packed(Record):
        """Gains and the sample interval."""

        proportional_v_um: float
        integral_v_um_ms: float
        dt_ms: float

    class State(Record):
        """The integral."""

        integral: float

    class Ports(ControllerPorts):
        """Ports, and the error."""

        error: float = tap("um", "model minus measured displacement")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the interval."""
        p = cls.Packed.blank()
        p.dt_ms = context.dt_ms
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Compute one sample."""
        e = x.model - x.measured
        proportional = p.proportional_v_um * e
        if x.engaged == 0.0:
            s.integral = x.applied - proportional
        else:
            s.integral += p.integral_v_um_ms * e * p.dt_ms
        x.voltage = proportional + s.integral
        x.error = e
'''.replace("\\\\\\\\", "\\")

SHELL = """from core.block import Block, BlockParams, Context, Equation, parameter
from core.control.controller import ControllerPorts, Lag, advance_lag, lag, normalised
from core.elementary import exp, floor, sin
from core.kernel import flush_tiny, kernel
from core.ports import output, reads, tap
from core.record import Choice, Record, Records, Vector, several, vector
import math
{top}

class Odd(Block):
    title = "Odd"
{attributes}

    class Params(BlockParams):
        gain: float = parameter(1.0, "gain", "V/um", ge=-10, le=10)
{params}

    class Packed(Record):
        gain: float
        dt_ms: float
        taps: Vector = vector(4)
        lag: Lag
{packed}

    class State(Record):
        a: float
        line: Vector = vector(5)
        grid: Vector = vector(12)
{state}

    class Ports(ControllerPorts):
        seen: float = tap("um", "what is seen")
        three: Vector = tap("um", "three numbers", labels=("a", "b", "c"))
{ports}

    @classmethod
    def pack(cls, params, context):
        p = cls.Packed.blank()
        p.dt_ms = context.dt_ms
        p.lag = lag(1.0, 0.1, False)
{pack}
        return p

    @staticmethod
    def step(p, s, x):
        e = x.model - x.measured
{step}
        x.voltage = p.gain * e
"""
PLACES = {"top": 0, "attributes": 4, "params": 8, "packed": 8, "state": 8, "ports": 8, "pack": 8, "step": 8}


def odd(place: str = "step", text: str = "", **more: str) -> str:
    """Return a controller with something at a place: at the top, among its fields, in pack or in its step."""
    put = {place: text, **more}
    return SHELL.format(
        **{
            name: "\n".join(" " * indent + line for line in put.get(name, "").split("\n")) if put.get(name) else ""
            for name, indent in PLACES.items()
        }
    )


FIT = '''from core.block import BlockParams, parameter
from core.identify.estimator import Estimator
from core.record import Record


class Fit(Estimator):
    """An estimate that is known beforehand."""

    title = "Fit"

    class Params(BlockParams):
        """Nothing that matters."""

        forgetting: float = parameter(0.999, "share of the past kept", ge=0.5, le=1)

    class Packed(Record):
        """Forgetting."""

        forgetting: float

    class State(Record):
        """Samples so far."""

        count: float

    @classmethod
    def pack(cls, params, context):
        """Pack the forgetting."""
        return cls.Packed.blank()

    @staticmethod
    def step(p, s, x):
        """Let the mass grow by a thousandth in each sample, up to five percent."""
        s.count += 1.0
        x.estimate[0] = 1.0 + min(0.05, 0.001 * s.count)
        x.estimate[1] = 1.0
        x.estimate[2] = 1.0
'''
