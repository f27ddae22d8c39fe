r"""Calibration: the device behind a healthy stretch of a record, and whether a mass, a damper and a spring explain it.

Fitted on one half, tested on the other; the numbers are then fitted to both. Only ratios to the force follow from
voltage and displacement: a gain of the sensor and the force of the comb are one number, so the force stays nominal.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from core.block import Oscillator
from core.errors import InputError
from core.measured_record import MeasuredRecord
from scenarios.records.columns import Numbers
from scenarios.records.effects import effects
from scenarios.records.fit import SKIPPED, Fit, fit
from scenarios.records.misfits import CHECKS, Check, Halves
from scenarios.records.remainder import remainder

LEAST = 400
"""Least samples of a healthy stretch."""
MOST = 40_000
"""Most samples of a healthy stretch that are read."""
UNCERTAIN = {"mass": 0.014, "stiffness": 0.014, "damping": 0.07}
"""Largest standard errors over the values; hypotheses are 5 and 30 % apart."""
PULLED = {"mass": 0.01, "stiffness": 0.01, "damping": 0.05}
"""Largest changes of the values by an effect that is not of chance, unless they are within ``FEW`` standard errors."""
FEW = 3.5
CHANCE = 5e-5
"""Probability below which an effect is not of chance."""
RATIOS = {"mass": (0, 0, 0, -1, 0), "damping": (0, 1, 0, -1, 0), "stiffness": (1, 0, 0, -1, 0)}
"""Logarithms of these numbers by the numbers of a fit, at the nominal force."""


@dataclass(frozen=True)
class FittedNumber:
    """A number with its standard error."""

    value: float
    error: float

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % interval."""
        return self.value - 1.96 * self.error, self.value + 1.96 * self.error


@dataclass(frozen=True)
class Calibration:
    """A device behind a record.

    Parameters
    ----------
    mass, damping, stiffness : FittedNumber
        Over nominal, at the nominal force.
    offset_um, delay_samples : FittedNumber
        Of the measured displacement; of the displacement behind the voltage.
    noise_um, quantum_um : float
        Standard deviation of a sample with its rounding; step of the converter, 0 where none is seen.
    first, samples : int
        The stretch: its first sample, and how many.
    checks : list of Check
        Each possible reason against the model.
    refusal : str
        A sentence why the record does not fit the model; empty where it does.
    """

    mass: FittedNumber
    damping: FittedNumber
    stiffness: FittedNumber
    offset_um: FittedNumber
    delay_samples: FittedNumber
    noise_um: float
    quantum_um: float
    first: int
    samples: int
    checks: list[Check] = field(default_factory=list)
    refusal: str = ""


def calibrate(record: MeasuredRecord, nominal: Oscillator, first: int = 0, end: int | None = None) -> Calibration:
    """Return the calibration by a healthy stretch, from sample ``first`` to before ``end``.

    Raises
    ------
    InputError
        For a stretch that is too short, or a voltage or displacement that does not move.
    """
    end = record.samples if end is None else end
    if not 0 <= first < end <= record.samples:
        raise InputError(f"must lie within 0 and {record.samples}, got {first} to {end}", "healthy")
    end = min(end, first + MOST)
    if end - first < LEAST:
        raise InputError(f"has {end - first} samples; {LEAST} are the least", "healthy")
    drive, displacement = record.drive[first:end], record.displacement[first:end]
    if np.ptp(drive) == 0.0:
        raise InputError("the voltage does not move in this stretch", "healthy", "choose another, or excite the device")
    dt_ms, half = 1.0 / record.rate_khz, (end - first) // 2
    if len(np.unique(displacement[SKIPPED:half][np.isfinite(displacement[SKIPPED:half])])) < 2:
        text = "the displacement does not move in the first half of this stretch"
        raise InputError(text, "healthy", "choose another")
    shape = nominal.stiffness / nominal.mass, nominal.damping / nominal.mass
    found = fit(drive[:half], displacement[:half], dt_ms, *shape)
    later = remainder(found, drive[half - SKIPPED :], displacement[half - SKIPPED :], dt_ms)
    halves = Halves(found, later, drive, displacement, dt_ms)
    checks = [check(halves) for check in CHECKS]
    refusal = next((one.sentence for one in checks if not one.ok), "")
    if not refusal:
        found = fit(drive, displacement, dt_ms, *shape, near=found)
        checks.append(_pulled(found, drive, dt_ms))
        refusal = checks[-1].sentence
    estimates = _estimates(found, nominal)
    return Calibration(
        **estimates,
        noise_um=found.noise,
        quantum_um=halves.quantum,
        first=first,
        samples=end - first,
        checks=checks,
        refusal=refusal or _uncertain(estimates),
    )


def _estimates(found: Fit, nominal: Oscillator) -> dict[str, FittedNumber]:
    r"""Return the numbers of the fit as ratios to nominal, with standard errors to first order.

    At the nominal force the mass is :math:`m=F/g`, the damping :math:`a_1m` and the stiffness :math:`a_0m`.
    """
    mass = abs(nominal.force / found.gain) / nominal.mass
    damping = found.damping * mass * nominal.mass / nominal.damping
    stiffness = found.stiffness * mass * nominal.mass / nominal.stiffness
    values = {"mass": mass, "damping": damping, "stiffness": stiffness}
    ratios = {name: FittedNumber(values[name], values[name] * _error(row, found)) for name, row in RATIOS.items()}
    sizes = np.sqrt(np.diag(found.covariance))
    return {
        **ratios,
        "delay_samples": FittedNumber(found.delay, float(sizes[2])),
        "offset_um": FittedNumber(found.offset, float(sizes[4])),
    }


def _error(row: Sequence[int], found: Fit) -> float:
    """Return the standard error of a logarithm."""
    return math.sqrt(float(np.array(row) @ found.covariance @ np.array(row)))


def _pulled(found: Fit, drive: Numbers, dt_ms: float) -> Check:
    """Look for an effect that explains little of the motion, but would make other numbers of the device."""
    worst, sentence = 0.0, ""
    limits = {name: max(most, FEW * _error(RATIOS[name], found)) for name, most in PULLED.items()}
    for effect in effects(found, drive, dt_ms):
        for name, most in limits.items() if effect.chance < CHANCE else ():
            change = float(np.array(RATIOS[name]) @ effect.pull[:5])
            if abs(change) / most > worst:
                worst = abs(change) / most
                size = f"{100.0 * change:+.0f} %" if abs(change) < 1.0 else "more than 100 %"
                sentence = f"the motion shows {effect.name}, which would change the {name} by {size}"
    ok = worst <= 1.0
    return Check("pulled", worst, 1.0, ok, "" if ok else sentence)


def _uncertain(estimates: dict[str, FittedNumber]) -> str:
    """Return the sentence for an input that cannot tell mass from stiffness."""
    for name, most in UNCERTAIN.items():
        one = estimates[name]
        if not one.error <= most * one.value:
            return (
                f"the {name} is uncertain by {100.0 * one.error / one.value:.0f} %: this voltage cannot tell mass, "
                "damping and stiffness apart; excite the device with two tones, a chirp or steps"
            )
    return ""
