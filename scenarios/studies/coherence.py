"""Unlike resonators under one reference: how far they swing apart under each law."""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import Field

from core.block import BlockParams, FloatArray, parameter
from core.board.commands import Inject
from core.board.document import Document
from scenarios.measure.blocks import last_where
from scenarios.measure.errors import rms
from scenarios.measure.metrics import SETTLED
from scenarios.studies.laws import FaultyDevice, Law
from scenarios.studies.study import Study, StudyPicture

if TYPE_CHECKING:
    from core.board.board import Board


class Coherence(Study):
    """Runs each law on several resonators under one reference; they differ from the design, which is all the law knows.

    ``coherence.<law>.difference_um`` is the rms of the difference between two displacements in the last half of the
    run, of the two resonators that are farthest apart, and ``.settling_ms`` the last moment at which any two differed
    by more than 2 % of the model's amplitude. ``.error_um`` is the largest rms of shuttle minus model in the last half:
    resonators may also swing alike and wrong.
    """

    title = "Unlike resonators that swing alike"

    class Params(BlockParams):
        """The resonators, the laws, and the length of a run."""

        resonators: list[FaultyDevice] = Field([], max_length=8, description="two resonators or more, by their faults")
        laws: list[Law] = Field([], max_length=20, description="the controllers")
        samples: int = parameter(5000, "length of a run", ge=10, le=1_000_000)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return differences, settling times and errors of each law; none of a law under which a guard trips."""
        found: dict[str, float] = {}
        late = slice(params.samples // 2, None)
        for law in params.laws:
            motions, model = swings(board, law.controller, params)
            if not np.all(np.isfinite(motions)):
                continue
            name = f"coherence.{law.name}"
            apart = [first - second for first, second in itertools.combinations(motions, 2)]
            band = SETTLED * float(np.max(np.abs(model[late])))
            found[f"{name}.difference_um"] = max(rms(one[late]) for one in apart)
            found[f"{name}.error_um"] = max(rms((one - model)[late]) for one in motions)
            found[f"{name}.settling_ms"] = max(last_apart(one, band) for one in apart) * board.dt_ms
        return found

    @classmethod
    def picture(cls, board: Board, params: Any) -> StudyPicture:
        """Return the difference between the first two displacements over time, under each law."""
        times = [float(value) for value in np.arange(params.samples) * board.dt_ms]
        curves = []
        for law in params.laws:
            motions, _ = swings(board, law.controller, params)
            curves.append((law.name, times, [float(value) for value in motions[0] - motions[1]]))
        return StudyPicture(("time", "ms"), ("difference between the displacements", "um"), curves)


def last_apart(difference: FloatArray, band: float) -> int:
    """Return the samples to the last one at which a difference was outside a band."""
    return int(last_where(lambda values: np.abs(values) > band, difference))


def swings(board: Board, controller: Document, params: Any) -> tuple[FloatArray, FloatArray]:
    """Return the displacement of each resonator under a law, and of the model; no numbers from a trip on."""
    motions = np.full((len(params.resonators), params.samples), math.nan)
    model = np.full(params.samples, math.nan)
    for motion, resonator in zip(motions, params.resonators, strict=True):
        one = type(board)({**board.base, "controller": controller})
        for fault, severity in resonator.faults.items():
            one.apply(Inject(fault=fault, severity=severity, at_sample=0), "study")
        moved, wanted = (one.signals.index(name) for name in ("plant.displacement", "model.displacement"))
        while one.tick < params.samples and (rows := one.advance(params.samples - one.tick)).count:
            at = slice(one.tick - rows.count, one.tick)
            motion[at], model[at] = rows.outputs[:, moved], rows.outputs[:, wanted]
        if one.trip is not None:
            motion[:] = math.nan
    return motions, model
