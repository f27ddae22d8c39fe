"""Properties of a device on the drawing board: its figures, its response, its spread from the process."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import BaseModel, ValidationError

from core.block import FloatArray
from core.board.parse import parse
from core.board.spec import Spec
from core.device.frequency import Band, response, tolerance_band
from core.device.geometry import Geometry
from core.device.spread import DeviceSpread, Tolerances, draw, evaluate, sensitivity
from core.errors import InputError
from scenarios.measure.lateral import device_pull_in
from scenarios.measure.metrics import device_metrics
from scenarios.studies.process_spread import STEPS

DRAWS = 400
"""Devices drawn for the band."""
SHARES = (1.0, 99.0)
"""Percentiles at the limits of the band."""
TOLERANCE = 0.05
"""Share by which mass, damping and stiffness vary where there is no drawing (assumed)."""


def designed(device: dict[str, Any], environment: dict[str, Any]) -> Spec:
    """Return the bench of a device in its environment, checked.

    Raises
    ------
    InputError
        For the first value that is not allowed, with its dotted path.
    """
    return parse({"device": device, "environment": environment})


def device_figures(spec: Spec) -> dict[str, float]:
    """Return the figures of the device in its environment, by the names of its metrics without ``device.``."""
    figures = {name.removeprefix("device."): value for name, value in device_metrics(spec).items()}
    volts = device_pull_in(spec.device, figures["environment.stiffness_scale"])
    return figures if volts is None else {**figures, "pull_in_v": volts}


def parameters(spec: Spec) -> dict[str, float]:
    """Return mass, damping and stiffness of the device in its environment.

    Raises
    ------
    InputError
        For a transfer function, which has none.
    """
    figures = device_figures(spec)
    return {name: figures[name] for name in spec.device.resolved}


def sensitivities(geometry: Geometry) -> dict[str, dict[str, float]]:
    """Return the change of each parameter, percent, by one step of each number of the drawing that allows one."""
    changes = {}
    for name, step in STEPS.items():
        try:
            Geometry.model_validate({**geometry.model_dump(), name: getattr(geometry, name) + step})
        except ValidationError:
            continue
        changes[name] = sensitivity(geometry, name, step)
    return changes


def bode_band(spec: Spec, frequency_hz: FloatArray, seed: int) -> Band:
    """Return displacement per volt over the static gain of the nominal device, dB and degrees, and its tolerance band.

    With a drawing the band holds the 1st to the 99th percentile of devices drawn from the process; without one it is
    the exact envelope of 5 % more or less of mass, damping and stiffness.

    Parameters
    ----------
    spec : Spec
        From `designed`.
    frequency_hz : ndarray
        Where.
    seed : int
        Of the draw.

    Raises
    ------
    InputError
        For a device without mass, or a device that is driven by forces.
    """
    if spec.device.two_axes is not None:
        raise InputError("is driven by forces along two axes, so nothing is a displacement per volt", "device.id")
    nominal = parameters(spec)
    if spec.device.geometry is None:
        limits = {name: ((1 - TOLERANCE) * value, value, (1 + TOLERANCE) * value) for name, value in nominal.items()}
        return tolerance_band(**limits, frequency_hz=frequency_hz)
    shares = _shares(spec.device.geometry, DRAWS, seed).found
    at_rest = nominal["stiffness_n_m"]
    columns = [(nominal[name] * shares[name]).tolist() for name in ("mass_kg", "damping_ns_m", "stiffness_n_m")]
    drawn = zip(*columns, shares["force"].tolist(), strict=True)
    all_of_them = np.array([response(m, b, k, frequency_hz) * force * at_rest for m, b, k, force in drawn])
    decibels, degrees = 20.0 * np.log10(np.abs(all_of_them)), np.degrees(np.angle(all_of_them))
    low_db, high_db = np.percentile(decibels, SHARES, axis=0)
    low_deg, high_deg = np.percentile(degrees, SHARES, axis=0)
    curve = response(**nominal, frequency_hz=frequency_hz) * at_rest
    middle_db, middle_deg = 20.0 * np.log10(np.abs(curve)), np.degrees(np.angle(curve))
    return Band(frequency_hz, low_db, middle_db, high_db, low_deg, middle_deg, high_deg)


def process(spec: Spec, draws: int, seed: int) -> DeviceSpread:
    """Draw devices from the process: mass, damping, stiffness and force per volt in their environment.

    A value that the device states in addition to its drawing varies by the same share as the value from the drawing.
    Stators that pull alike leave no force to vary.

    Raises
    ------
    InputError
        Without a drawing, or if a beam or a gap vanishes in the process.
    """
    if spec.device.drawn_resonator is None:
        raise InputError("has no drawing of a resonator to vary", "device.id", "choose lcr-350")
    spread = _shares(spec.device.drawn_resonator, draws, seed)
    nominal, force = parameters(spec), abs(spec.device.signed_force_n_per_v)
    if force > 0.0:
        nominal["force"] = force
    drawn = {name: value * spread.found[name] for name, value in nominal.items()}
    omega = np.sqrt(drawn["stiffness_n_m"] / drawn["mass_kg"])
    drawn["f0_hz"] = omega / (2.0 * np.pi)
    drawn["quality_factor"] = omega * drawn["mass_kg"] / drawn["damping_ns_m"]
    return DeviceSpread(spread.drawn, drawn)


def _shares(geometry: Geometry, draws: int, seed: int) -> DeviceSpread:
    """Draw devices from the process, each parameter over its value in the drawing."""
    spread = draw(geometry, Tolerances(), draws, seed)
    return DeviceSpread(spread.drawn, {name: spread.found[name] / value for name, value in evaluate(geometry).items()})


class SpreadStatistics(BaseModel):
    """The spread of one parameter."""

    variation_pct: float
    p01: float
    p50: float
    p99: float

    @classmethod
    def of(cls, spread: DeviceSpread, name: str) -> SpreadStatistics:
        """Return the statistics of one parameter."""
        low, middle, high = (spread.percentile(name, share) for share in (1.0, 50.0, 99.0))
        return cls(variation_pct=spread.variation_pct(name), p01=low, p50=middle, p99=high)
