"""Process spread: which manufacturing step moves which parameter, and how far."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from core.block import FloatArray
from core.device.geometry import Geometry
from core.errors import InputError

STEPS = (
    "lithography",
    "material growth",
    "etching",
    "mechanical properties",
    "surface roughness",
    "stress",
    "stiction",
    "ageing",
)
PRINTED: dict[str, tuple[str, ...]] = {
    "mass": ("material growth", "mechanical properties"),
    "stiffness": ("lithography", "material growth", "etching", "mechanical properties", "stress", "ageing"),
    "damping": ("lithography", "etching", "surface roughness"),
    "force": ("etching", "surface roughness", "stiction"),
}
"""Table 2.1 as printed (in chapter 1): the steps that each parameter depends on."""
MISSING: dict[str, dict[str, str]] = {
    "mass": {
        "lithography": "line widths set the area of the shuttle",
        "etching": "so does the etch bias of each edge",
    },
    "damping": {"material growth": "the sacrificial layer is the gas film, and thickness the facing area of the combs"},
    "force": {
        "lithography": "F is proportional to t/g, and the gap is a line width (1.3.2)",
        "material growth": "F is proportional to t/g, and t is grown (1.3.2)",
    },
}
"""Dots that the text's own formulas 1.3.2 to 1.3.7 demand and that the table lacks, with the reason."""
CARRIERS: dict[str, tuple[str, ...]] = {
    "lithography": ("beam_bias_um", "comb_bias_um"),
    "material growth": ("thickness_um", "film_gap_um"),
    "etching": ("beam_bias_um", "comb_bias_um"),
    "mechanical properties": ("youngs_modulus_gpa",),
}
"""The numbers of a drawing that each step moves; the other steps have none in 1.3.2 to 1.3.7."""


@dataclass(frozen=True)
class Tolerances:
    """Standard deviations of a process; all are assumptions, the text gives none."""

    beam_bias_um: float = 0.05
    comb_bias_um: float = 0.03
    thickness_um: float = 0.05
    film_gap_um: float = 0.08
    youngs_modulus_gpa: float = 5.0


QUANTITIES: dict[str, Callable[[Geometry], float]] = {
    "mass_kg": Geometry.mass_kg,
    "stiffness_n_m": Geometry.stiffness_n_m,
    "damping_ns_m": Geometry.damping_ns_m,
    "force": Geometry.capacitance_gradient,
}


@dataclass(frozen=True)
class DeviceSpread:
    """Devices of one drawing from one process: arrays of the drawn numbers and of the resulting parameters."""

    drawn: dict[str, FloatArray]
    found: dict[str, FloatArray]

    def variation_pct(self, name: str) -> float:
        """Return the coefficient of variation."""
        values = self.found[name]
        return float(100.0 * np.std(values, ddof=1) / abs(np.mean(values)))

    def percentile(self, name: str, share_pct: float) -> float:
        """Return the value that a share of the devices stays below."""
        return float(np.percentile(self.found[name], share_pct))

    def correlation(self, first: str, second: str) -> float:
        """Return the correlation of two parameters."""
        return float(np.corrcoef(self.found[first], self.found[second])[0, 1])


def draw(geometry: Geometry, tolerances: Tolerances, draws: int, seed: int, cut: float = 3.0) -> DeviceSpread:
    """Draw devices: independent normal deviations, cut (drawn again) beyond some standard deviations.

    Parameters
    ----------
    geometry : Geometry
        The drawing.
    tolerances : Tolerances
        Standard deviations.
    draws, seed : int
        Number of devices and seed of the draw; the same seed gives the same devices.
    cut : float
        Largest deviation, in standard deviations.

    Raises
    ------
    InputError
        When a beam or a gap would vanish.
    """
    generator = np.random.default_rng(seed)
    drawn: dict[str, FloatArray] = {}
    for entry in fields(tolerances):
        deviation = generator.standard_normal(draws)
        while (outside := np.abs(deviation) > cut).any():
            deviation[outside] = generator.standard_normal(int(outside.sum()))
        drawn[entry.name] = getattr(geometry, entry.name) + getattr(tolerances, entry.name) * deviation
    for name, width in (
        ("beam_width_um", geometry.beam_width_um - 2.0 * drawn["beam_bias_um"]),
        ("truss_width_um", geometry.truss_width_um - 2.0 * drawn["beam_bias_um"]),
        ("finger_width_um", geometry.finger_width_um - 2.0 * drawn["comb_bias_um"]),
        ("finger_gap_um", geometry.finger_gap_um + 2.0 * drawn["comb_bias_um"]),
        ("thickness_um", drawn["thickness_um"]),
        ("film_gap_um", drawn["film_gap_um"]),
        ("youngs_modulus_gpa", drawn["youngs_modulus_gpa"]),
    ):
        if np.min(width) <= 0.0:
            raise InputError("vanishes in some of the devices; the tolerances are too wide", f"device.geometry.{name}")
    values: dict[str, Any] = {**geometry.model_dump(), **drawn}
    return DeviceSpread(drawn, evaluate(Geometry.model_construct(**values)))


def sensitivity(geometry: Geometry, name: str, change: float) -> dict[str, float]:
    """Return the relative change of each parameter when one number of the drawing changes, in percent."""
    moved = geometry.model_copy(update={name: getattr(geometry, name) + change})
    before, after = evaluate(geometry), evaluate(moved)
    return {key: float(100.0 * (after[key] / before[key] - 1.0)) for key in before}


def evaluate(geometry: Geometry) -> dict[str, FloatArray]:
    """Return the parameters of a drawing, or of many at once when its numbers are arrays."""
    parameters: dict[str, FloatArray] = {name: np.asarray(quantity(geometry)) for name, quantity in QUANTITIES.items()}
    omega = np.sqrt(parameters["stiffness_n_m"] / parameters["mass_kg"])
    parameters["f0_hz"] = omega / (2.0 * np.pi)
    parameters["quality_factor"] = omega * parameters["mass_kg"] / parameters["damping_ns_m"]
    return parameters
