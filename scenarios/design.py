"""What a device on the drawing board would be: its figures, its response, what the process makes of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic import ValidationError

from core.block import FloatArray
from core.board.environment import Environment
from core.board.spec import Spec, parse
from core.device.frequency import Band, response, tolerance_band
from core.device.geometry import Geometry
from core.device.spread import Spread, Tolerances, draw, sensitivity
from core.errors import InputError
from scenarios.lateral_metrics import device_pull_in
from scenarios.metrics import device_metrics
from scenarios.studies.process_spread import STEPS

DRAWS = 400
"""Devices drawn for the band."""
SHARES = (1.0, 99.0)
"""Percentiles the band lies between."""
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
    found = {name.removeprefix("device."): value for name, value in device_metrics(spec).items()}
    return {**found, "pull_in_v": device_pull_in(spec.device)}


def sensitivities(geometry: Geometry) -> dict[str, dict[str, float]]:
    """Return what one step of a number of the drawing does to each parameter, percent; steps that leave nothing out."""
    found = {}
    for name, step in STEPS.items():
        try:
            Geometry.model_validate({**geometry.model_dump(), name: getattr(geometry, name) + step})
        except ValidationError:
            continue
        found[name] = sensitivity(geometry, name, step)
    return found


def bode_band(spec: Spec, frequency_hz: FloatArray, seed: int) -> Band:
    """Return displacement per volt over that of the nominal device at rest, dB and degrees, and its tolerance band.

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
    """
    nominal = device_figures(spec)
    si = {name: nominal[name] for name in ("mass_kg", "damping_ns_m", "stiffness_n_m")}
    if spec.device.geometry is None:
        m, b, k = (((1 - TOLERANCE) * value, value, (1 + TOLERANCE) * value) for value in si.values())
        return tolerance_band(m, b, k, frequency_hz)
    spread = process(spec, DRAWS, seed)
    drawn = spread.found
    at_rest = nominal["stiffness_n_m"] / nominal["force_n_per_v"]
    columns = zip(*(drawn[name].tolist() for name in (*si, "force")), strict=True)
    all_of_them = np.array([response(m, b, k, frequency_hz) * force * at_rest for m, b, k, force in columns])
    decibels, degrees = 20.0 * np.log10(np.abs(all_of_them)), np.degrees(np.angle(all_of_them))
    low_db, high_db = np.percentile(decibels, SHARES, axis=0)
    low_deg, high_deg = np.percentile(degrees, SHARES, axis=0)
    own = response(**si, frequency_hz=frequency_hz) * nominal["stiffness_n_m"]
    own_db, own_deg = 20.0 * np.log10(np.abs(own)), np.degrees(np.angle(own))
    return Band(frequency_hz, low_db, own_db, high_db, low_deg, own_deg, high_deg)


def process(spec: Spec, draws: int, seed: int) -> Spread:
    """Draw devices from the process: mass, damping, stiffness and force per volt in their environment.

    What the device states beside its drawing varies by the same share as what the drawing gives.

    Raises
    ------
    InputError
        Without a drawing, or when the process leaves nothing of a beam or a gap.
    """
    geometry = spec.device.geometry
    if geometry is None:
        raise InputError("has no drawing to vary", "device.id", "choose lcr-350")
    spread = draw(geometry, Tolerances(), draws, seed)
    stiffness, damping = Environment.scales(spec.environment.params, spec.context())
    stated = {**spec.device.resolved, "force": abs(spec.device.signed_force_n_per_v)}
    drawing = {
        "mass_kg": geometry.mass_kg(),
        "stiffness_n_m": geometry.stiffness_n_m() / stiffness,
        "damping_ns_m": geometry.damping_ns_m() / damping,
        "force": geometry.capacitance_gradient(),
    }
    found = {name: stated[name] / drawing[name] * spread.found[name] for name in drawing}
    omega = np.sqrt(found["stiffness_n_m"] / found["mass_kg"])
    found["f0_hz"] = omega / (2.0 * np.pi)
    found["quality_factor"] = omega * found["mass_kg"] / found["damping_ns_m"]
    return Spread(spread.drawn, found)


@dataclass(frozen=True)
class Statistics:
    """How far one parameter of drawn devices lies apart."""

    variation_pct: float
    p01: float
    p50: float
    p99: float

    @classmethod
    def of(cls, spread: Spread, name: str) -> Statistics:
        """Return those of one parameter."""
        low, middle, high = (spread.percentile(name, share) for share in (1.0, 50.0, 99.0))
        return cls(spread.variation_pct(name), low, middle, high)
