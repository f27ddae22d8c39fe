"""Coefficients that identifiers of the sampled plant find, against the coefficients of the device."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from core.block import BlockParams, FloatArray, parameter
from core.errors import InputError
from core.identify.discrete import COEFFICIENTS, Discrete
from scenarios.studies.monte_carlo import again
from scenarios.studies.study import Study, StudyPicture

if TYPE_CHECKING:
    from core.board.board import Board

SHOWN = 400
"""Samples shown of the last ones."""


class EstimatesStudy(Study):
    """Runs every identifier of the sampled plant and takes its coefficients b0, b1, a1, a2 over the second half.

    ``estimates.<id>.<coefficient>`` is the median, ``.<coefficient>_spread`` the range that holds the middle half of
    the samples, and ``.<coefficient>_true`` the true coefficient of the device at this sample interval.
    """

    title = "Estimated coefficients"

    class Params(BlockParams):
        """How long to look."""

        samples: int = parameter(6000, "samples of the run", ge=10, le=10_000_000)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return median, spread and truth of every coefficient."""
        results: dict[str, float] = {}
        for name, (found, true) in _run(board, params.samples).items():
            half = found[len(found) // 2 :]
            for i, coefficient in enumerate(COEFFICIENTS):
                low, middle, high = np.quantile(half[:, i], [0.25, 0.5, 0.75])
                results |= {
                    f"estimates.{name}.{coefficient}": float(middle),
                    f"estimates.{name}.{coefficient}_spread": float(high - low),
                    f"estimates.{name}.{coefficient}_true": float(true[i]),
                }
        return results

    @classmethod
    def picture(cls, board: Board, params: Any) -> StudyPicture:
        """Return a2 over the last samples, which the damping of the device decides."""
        curves = []
        for name, (found, true) in _run(board, params.samples).items():
            last = found[-SHOWN:, -1]
            at = (board.dt_ms * np.arange(params.samples - len(last), params.samples)).tolist()
            curves += [(name.replace("_", " "), at, last.tolist()), ("device", at, [float(true[-1])] * len(at))]
        return StudyPicture(("time", "ms"), ("a₂", ""), curves[:1] + curves[2::2] + curves[1:2])


def _run(board: Board, samples: int) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Return, for each identifier, its coefficients at every sample and the coefficients of the device."""
    fresh = again(board, board.spec.seed)
    names = [name for name, one in fresh.spec.identifiers.items() if issubclass(one.block, Discrete)]
    if not names:
        raise InputError("needs an identifier of the sampled plant", "identifiers")
    first = fresh.signals.outputs
    columns = {
        name: [fresh.signals.index(f"{name}.coefficient.{one}") - first for one in COEFFICIENTS] for name in names
    }
    kept: dict[str, list[FloatArray]] = {name: [] for name in names}
    while fresh.tick < samples and (rows := fresh.advance(samples - fresh.tick)).count:
        for name in names:
            kept[name].append(np.array(rows.taps[:, columns[name]]))
    return {
        name: (
            np.concatenate(kept[name]),
            np.array([fresh.value(f"{name}.coefficient_true.{one}") for one in COEFFICIENTS]),
        )
        for name in names
    }
