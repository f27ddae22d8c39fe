"""Persistency of excitation of common inputs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from pydantic import Field

from core.block import BlockParams, parameter
from core.control.controller import normalised
from core.errors import InputError
from core.theory.persistency import excitation, gram_of_tones
from scenarios.studies.study import Study

if TYPE_CHECKING:
    from core.board.board import Board

HARMONICS = 400


class Persistency(Study):
    """Measures how well inputs separate kp, a1 and a2 of the device, in the steady state and in closed form.

    ``persistency.<input>.smallest`` is the smallest eigenvalue of the mean of phi phi' in um, V and 1/w0, ``.relative``
    the smallest eigenvalue of the matrix scaled to a unit diagonal. Inputs: a step, each of the tones alone, the tones
    in pairs and together, a square wave.
    """

    title = "Persistency of excitation"

    class Params(BlockParams):
        """The tones."""

        frequencies_krad_s: list[float] = Field(
            [1.0, 2.9, 8.0, 16.0], min_length=2, max_length=20, description="angular frequencies, krad/s"
        )
        amplitude_v: float = parameter(10.0, "amplitude of the whole, shared by the tones", "V", gt=0, le=1e4)
        filter_pole: float = parameter(1.0, "double pole of the filters over w0", gt=0.05, le=10)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return the figures of every input."""
        device = board.spec.context().device
        if device.time_unit_ms > 0.0:
            raise InputError("is a transfer function, without mass or stiffness; choose a resonator", "device.id")
        w0 = device.natural_frequency
        a1, a2, gain = normalised(device, w0)
        tones = [w / w0 for w in params.frequencies_krad_s]
        whole = params.amplitude_v

        def shared(chosen: list[float]) -> list[tuple[float, float]]:
            return [(whole / len(chosen), w) for w in chosen]

        inputs = {
            "step": [(whole, 0.0)],
            "one_tone": shared(tones[:1]),
            "resonance": [(whole, 1.0)],
            "two_tones": shared(tones[:2]),
            "all_tones": shared(tones),
            "square": [(4.0 * whole / math.pi / k, k * tones[0]) for k in range(1, 2 * HARMONICS, 2)],
        }
        results = {}
        for name, lines in inputs.items():
            verdict = excitation(gram_of_tones(lines, (gain, a1, a2), params.filter_pole))
            results[f"persistency.{name}.smallest"] = verdict.smallest
            results[f"persistency.{name}.relative"] = verdict.relative
            if math.isfinite(verdict.condition):
                results[f"persistency.{name}.condition"] = verdict.condition
        return results
