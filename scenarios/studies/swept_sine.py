"""Identification of the device by a stepped sine."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from core.block import BlockParams, parameter
from scenarios.measure.sweep_sine import sweep_sine
from scenarios.studies.study import Study

if TYPE_CHECKING:
    from core.board.board import Board


class SweptSineStudy(Study):
    """Plays sines on the bench, events of its first sample included, and fits mass, damping and stiffness.

    ``sweep.*`` are the figures of the fit with standard errors (``*_error_*``); ``sweep.read_*`` are read off the
    curve without a model. The force per volt is taken as known: it sets the scale of all three.
    """

    title = "Swept sine"

    class Params(BlockParams):
        """How the sweep is made."""

        amplitude_v: float = parameter(2.0, "amplitude", "V", ge=1e-6, le=1000)
        points: int = parameter(31, "tones of each of the two passes", ge=4, le=1000)
        cycles: float = parameter(40.0, "cycles measured at each tone", ge=2, le=10_000)
        settle: float = parameter(12.0, "time constants waited before", ge=0, le=100)
        start_hz: float | None = parameter(
            None, "lowest tone; a quarter of the resonance unless given", "Hz", gt=0, le=1e9
        )
        stop_hz: float | None = parameter(None, "highest tone; twice the resonance unless given", "Hz", gt=0, le=1e9)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return the figures of the sweep."""
        board.advance(1)  # events of the first sample take effect
        identified = asdict(sweep_sine(board, **params.model_dump()).found)
        return {f"sweep.{name}": float(value) for name, value in identified.items() if value is not None}
