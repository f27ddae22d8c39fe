"""Permitted imports of a user unit: names of the library, each by name.

A unit never imports a module. A line ``from core.elementary import exp`` names one of the names below. Kernels among
them take numbers, or records whose class they name; none reads an index from its data.
"""

from __future__ import annotations

import importlib
import math
from functools import cache
from typing import Any

CONTROL = (
    *("ControllerPorts", "FeedForwardPorts", "ReferencePorts", "EngagedPorts"),
    *("Coefficients", "NormalisedPacked", "Lag", "FIRST_ORDER"),
    *("normalised", "coefficients", "first_order", "fill_normalised", "model_filter", "lag"),
    *("unsuited_order", "unsuited_second_order", "advance_lag", "matching", "saturated"),
)
DIAGNOSE = ("Hypothesis", "BankParams", "SEVEN_STEP", "assumed_noise", "lacking")

OFFERED: dict[str, tuple[str, ...]] = {
    "__future__": ("annotations",),
    "typing": ("Any", "Literal"),
    "core.block": ("Block", "BlockParams", "Context", "Equation", "Oscillator", "Stage", "parameter"),
    "core.record": ("Choice", "Record", "Records", "Vector", "several", "stream", "vector"),
    "core.ports": ("BlockPorts", "output", "reads", "tap"),
    "core.kernel": ("flush_tiny", "inlined", "kernel"),
    "core.converter": ("step_of",),
    "core.elementary": ("atan2", "cos", "exp", "expm1", "floor", "log", "sin", "sin_of_turns", "tanh"),
    "core.noise": ("key", "normal", "uniform"),
    "core.voltage": ("AppliedPorts", "MeasuredPorts", "ObservedPorts", "Tick"),
    "core.control.controller": CONTROL,
    "core.control.two_axis": (
        *("DrivePorts", "RatePorts", "PartnerPorts", "Sense"),
        *("two_axis", "fill_sense", "components", "share_kept"),
    ),
    "core.reference.waveform": ("ReferenceParams", "Waveform", "line"),
    "core.faults.fault": (
        *("Fault", "FaultParams", "PackedFault", "ScaleFault"),
        *("INTERMITTENT", "RAMP", "STEP", "effect", "severity", "severity_now"),
    ),
    "core.sense.sensor": (
        *("Sensor", "SensorParams", "ERROR_PORT", "LAST_PORT", "RECOVERED_PORT", "TRUE_PORT"),
        "begin_at",
    ),
    "core.diagnose.hypothesis": DIAGNOSE,
    "core.diagnose.judge": ("Judge",),
    "core.diagnose.lanes": ("LANE",),
    "core.supervise.supervisor": ("ActParams", "Supervisor", "SupervisorPorts"),
    "core.identify.estimator": ("Estimator",),
    "core.identify.identifier": ("PHYSICAL",),
    "core.device.oscillator": ("held", "transition"),
    "core.device.ranges": ("Sized",),
    "core.units": ("PM_PER_UM", "hz_of_rad_ms", "rate_deg_s"),
}

MATHEMATICS = {"sqrt": math.sqrt, "copysign": math.copysign, "isfinite": math.isfinite, "pi": math.pi, "inf": math.inf}
"""Names of ``math``: operations that a processor computes exactly, and two numbers."""

PYTHON: dict[Any, tuple[int, int]] = {
    **dict.fromkeys((abs, bool, float, int, len, round, str, list, tuple), (1, 1)),
    **{enumerate: (1, 2), max: (1, 100), min: (1, 100), range: (1, 3), sum: (1, 2), zip: (1, 100)},
}
"""Functions of Python itself, and how many arguments each may be given where a unit is declared and packed."""

BUILTINS: dict[str, Any] = {function.__name__: function for function in PYTHON}


@cache
def offered(module: str, name: str) -> Any:
    """Return a name that is offered; the caller has looked it up in the table."""
    return getattr(importlib.import_module(module), name)
