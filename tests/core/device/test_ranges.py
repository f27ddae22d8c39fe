"""Devices at the ends of the allowed ranges: every figure and every controller has finite numbers."""

from __future__ import annotations

import itertools
import json
from contextlib import suppress
from typing import Any

import pytest

from core.errors import InputError
from core.registry import blocks
from scenarios.run import run
from scenarios.schema import Scenario

ENDS = {"mass_kg": (1e-18, 1e3), "damping_ns_m": (1e-40, 1e3), "stiffness_n_m": (1e-9, 1e9)}
SIZES = (1e-9, -1e-9, 1e9, -1e9)


def judged(device: dict[str, Any], **bench: Any) -> None:
    """Run a few samples; the summary is JSON as the standard has it."""
    document = {"schema": 1, "samples": 20, "device": device, **bench}
    json.dumps(run(Scenario.load(document)).summary(), allow_nan=False)


@pytest.mark.parametrize("values", [*itertools.product(*ENDS.values())], ids=str)
@pytest.mark.parametrize("bias_v", [1e-9, 1e3])
def test_a_resonator_at_the_ends_of_its_ranges(values: tuple[float, ...], bias_v: float) -> None:
    device = dict(zip(ENDS, values, strict=True))
    judged({**device, "bias_v": bias_v}, diagnosers={"bank": {"kind": "mmae"}})


@pytest.mark.parametrize(("first", "last"), [*itertools.product(SIZES, SIZES)])
@pytest.mark.parametrize("unit", [1e-6, 1e6])
def test_a_transfer_function_at_the_ends_of_its_ranges(first: float, last: float, unit: float) -> None:
    """A transfer function that would grow beyond all numbers within a sample is refused."""
    for lead in (1e-9, 1e9):
        with suppress(InputError):
            judged({"transfer_function": {"gain": last, "denominator": [lead, first, last], "time_unit_ms": unit}})


@pytest.mark.parametrize(
    "controller", [name for name, block in blocks("control").items() if name != "gain_adaptation" and not block.axes]
)
def test_a_resonator_whose_motion_dies_within_a_sample(controller: str) -> None:
    """At 0.1 kHz nothing is left of it after 10 ms, so that samples tell of no velocity."""
    judged({"mass_kg": 1e-16, "stiffness_n_m": 1e6}, sample_rate_khz=0.1, controller={"kind": controller})
