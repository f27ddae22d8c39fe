"""The code inside an exported FMU: a device, exact from sample to sample under a held voltage.

The file goes into the FMU unchanged, with its numbers in ``device.json``, and needs only Python there.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from pythonfmu3 import Fmi3Slave
from pythonfmu3.default_experiment import DefaultExperiment
from pythonfmu3.enums import Fmi3Causality, Fmi3Variability
from pythonfmu3.unit import Unit
from pythonfmu3.variables import Float64

NEAR = 1e-6
"""How far a step may be from a whole number of samples, relative."""
TICKS_OF_CLOCK, SHARE = 2.0, 0.1
"""The same for the difference of two large times: in units of their last digit, and at most this share of a sample."""


class CombBenchDevice(Fmi3Slave):  # type: ignore[misc]
    """Voltage in, displacement and velocity out; a step is a whole number of samples."""

    author = "CombBench"

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        given = json.loads((Path(self.resources) / "device.json").read_text("utf-8"))
        self.description = given["description"]
        self.interval_s = given["interval_s"]
        self.default_experiment = DefaultExperiment(0.0, 0.01, self.interval_s)
        (self.phi11, self.phi12), (self.phi21, self.phi22) = given["transition"]
        self.push1, self.push2 = given["push"]
        self.time, self.voltage = 0.0, 0.0
        self.displacement, self.velocity = given["start"]
        volt = Unit("V", kg=1, m=2, s=-3, A=-1)
        self.register_units([volt, Unit("um", factor=1e-6, m=1), Unit("um/s", factor=1e-6, m=1, s=-1), Unit("s", s=1)])
        output = Fmi3Causality.output
        self._add("time", "s", Fmi3Causality.independent, Fmi3Variability.continuous, "device time")
        self._add("voltage", "V", Fmi3Causality.input, Fmi3Variability.discrete, "held over the next step")
        self._add("displacement", "um", output, Fmi3Variability.discrete, "displacement of the shuttle")
        self._add("velocity", "um/s", output, Fmi3Variability.discrete, "velocity of the shuttle")

    def _add(self, name: str, unit: str, causality: Any, variability: Any, description: str) -> None:
        self.register_variable(
            Float64(name, unit=unit, causality=causality, variability=variability, description=description)
        )

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Go on by a whole number of samples; refuse any other step."""
        samples = round(step_size / self.interval_s)
        rounding = min(TICKS_OF_CLOCK * math.ulp(current_time + step_size), SHARE * self.interval_s)
        if samples < 1 or abs(samples * self.interval_s - step_size) > NEAR * step_size + rounding:
            self.log(f"a step must be a whole number of samples of {self.interval_s:g} s, got {step_size:g} s")
            return False
        for _ in range(samples):
            x, v, u = self.displacement, self.velocity, self.voltage
            self.displacement = self.phi11 * x + self.phi12 * v + self.push1 * u
            self.velocity = self.phi21 * x + self.phi22 * v + self.push2 * u
        self.time = current_time + step_size
        return True
