"""Process spread of a drawn device."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from core.block import BlockParams, parameter
from core.device.geometry import Geometry
from core.device.spread import CARRIERS, MISSING, PRINTED, DeviceSpread, Tolerances, draw, sensitivity
from core.errors import InputError
from scenarios.studies.study import Study, StudyPicture

if TYPE_CHECKING:
    from core.board.board import Board

STEPS = {
    "beam_bias_um": 0.1,
    "thickness_um": 0.1,
    "film_gap_um": 0.1,
    "youngs_modulus_gpa": 1.0,
    "comb_bias_um": 0.1,
}
"""Step of each number for the sensitivities."""
SEEN_PCT = 0.01
"""Smallest change that counts as a dependence."""
NAMES = {"mass": "mass_kg", "stiffness": "stiffness_n_m", "damping": "damping_ns_m", "force": "force"}


class ProcessSpreadStudy(Study):
    """Draws devices from a process and gives the spread of their parameters (Table 2.1 with numbers).

    ``spread.<parameter>.cv_pct`` is the coefficient of variation, ``spread.sensitivity.<number>.<parameter>_pct`` the
    change for one step of a number of the drawing. ``spread.dots_printed`` and ``spread.dots_missing`` count the
    dependences of Table 2.1, and the additional ones that the text's own equations demand.
    """

    title = "Process spread"

    class Params(BlockParams):
        """Standard deviations; all are assumed, the text gives none."""

        draws: int = parameter(20_000, "devices drawn", ge=10, le=2_000_000)
        cut: float = parameter(3.0, "largest deviation, in standard deviations", ge=0.5, le=10)
        beam_bias_um: float = parameter(0.05, "standard deviation of the etch bias of beams, per edge", "um", ge=0)
        comb_bias_um: float = parameter(0.03, "standard deviation of the etch bias of fingers, per edge", "um", ge=0)
        thickness_um: float = parameter(0.05, "standard deviation of the thickness", "um", ge=0)
        film_gap_um: float = parameter(0.08, "standard deviation of the gas film", "um", ge=0)
        youngs_modulus_gpa: float = parameter(5.0, "standard deviation of Young's modulus", "GPa", ge=0)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return spreads, percentiles, correlations and sensitivities."""
        geometry, spread = cls._drawn(board, params)
        results: dict[str, float] = {}
        for name in spread.found:
            results[f"spread.{name}.cv_pct"] = spread.variation_pct(name)
        for share in (1, 50, 99):
            results[f"spread.f0_hz.p{share:02d}"] = spread.percentile("f0_hz", share)
        results["spread.correlation.stiffness_f0"] = spread.correlation("stiffness_n_m", "f0_hz")
        results["spread.correlation.mass_force"] = spread.correlation("mass_kg", "force")
        moved = {name: sensitivity(geometry, name, step) for name, step in STEPS.items()}
        for name, changes in moved.items():
            results |= {f"spread.sensitivity.{name}.{key}_pct": value for key, value in changes.items()}
        demanded = {
            (quantity, step)
            for step, numbers in CARRIERS.items()
            for quantity, key in NAMES.items()
            if any(abs(moved[number][key]) > SEEN_PCT for number in numbers)
        }
        printed = {(quantity, step) for quantity, steps in PRINTED.items() for step in steps}
        results["spread.dots_printed"] = float(len(printed))
        results["spread.dots_missing"] = float(len(demanded - printed))
        results["spread.dots_named"] = float(sum(len(steps) for steps in MISSING.values()))
        return results

    @classmethod
    def picture(cls, board: Board, params: Any) -> StudyPicture:
        """Return how many of the devices drawn have which resonance."""
        counts, edges = np.histogram(cls._drawn(board, params)[1].found["f0_hz"], 60)
        heights = [*counts.astype(float).tolist(), 0.0]
        return StudyPicture(
            ("resonance", "Hz"), ("devices", ""), [("devices", edges.tolist(), heights)], is_stepped=True
        )

    @staticmethod
    def _drawn(board: Board, params: Any) -> tuple[Geometry, DeviceSpread]:
        """Return the drawing, and the devices drawn from the process."""
        geometry = board.spec.device.drawn_resonator
        if geometry is None:
            raise InputError("has no drawing of a resonator to vary; choose lcr-350", "device.id")
        tolerances = Tolerances(**params.model_dump(exclude={"draws", "cut"}))
        return geometry, draw(geometry, tolerances, params.draws, board.spec.seed, params.cut)
