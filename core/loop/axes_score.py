"""Score of a diagnoser of a plant with two axes."""

from __future__ import annotations

from typing import Any, cast

from core.block import Block, Context
from core.device.two_axis import TwoAxis
from core.diagnose.axes_hypothesis import AxesModels
from core.kernel import kernel
from core.loop.score import TOLERANCE, Factors, Score, ScoreTiming, count, holds, nothing_counted, take_turns
from core.ports import reads
from core.record import Records, tail


class AxesFactors(Factors):
    """A hypothesis, as factors on the nominal device, a stiffness between the axes, and how near that has to be."""

    second_stiffness: float
    cross_stiffness: float
    cross_tolerance: float


class AxesScore(Block):
    """Scores a bank whose hypotheses also have the stiffness of the second axis, and the stiffness between the axes.

    The rules are the rules of any score. A stiffness between the axes is right within a thousandth, and where a
    hypothesis has none, within the stiffness that reads as 1 deg/s.
    """

    title = "Score of two axes"
    axes = ("x", "y")
    lengths = ("hypotheses",)
    Params = AxesModels
    State = Score.State

    class Packed(ScoreTiming):
        """In addition the hypotheses."""

        hypotheses: Records[AxesFactors] = tail()

    class Ports(Score.Ports):
        """Inputs of any score, and the effects between the axes and of the second axis alone."""

        second_stiffness_scale: float = reads(
            "effects.second_stiffness_scale", "1", "true stiffness of the second axis over the stiffness of all"
        )
        cross_stiffness: float = reads("effects.cross_stiffness", "uN/um", "true stiffness added between the axes")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the ticks between two verdicts and the hypotheses."""
        device = cast(TwoAxis, context.device)
        p = cls.Packed.blank(len(params.hypotheses))
        take_turns(p, len(params.hypotheses), context)
        for factors, item in zip(p.hypotheses, params.hypotheses, strict=True):
            factors.mass, factors.stiffness, factors.damping = item.mass, item.stiffness, item.damping
            factors.gain, factors.second_stiffness = item.drive_gain, item.second_stiffness
            factors.cross_stiffness = item.cross_stiffness(device)
            least = item.model_copy(update={"quadrature_dps": 1.0}).cross_stiffness(device)
            factors.cross_tolerance = max(TOLERANCE * abs(factors.cross_stiffness), least)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> Score.State:
        """Nothing counted."""
        return nothing_counted(len(params.hypotheses))

    @staticmethod
    def step(p: Packed, s: Score.State, x: Ports) -> None:
        """Name the winner and the truth, and count."""
        n = int(p.count)
        truth = -1
        for i in range(n):
            if truth < 0 and holds_along_both(p.hypotheses[i], x):
                truth = i
        count(p, s, x, n, truth)


@kernel
def holds_along_both(h: AxesFactors, x: AxesScore.Ports) -> bool:
    """Return whether a hypothesis is true at this moment."""
    return (
        holds(h, x)
        and abs(x.second_stiffness_scale - h.second_stiffness) <= TOLERANCE * h.second_stiffness
        and abs(x.cross_stiffness - h.cross_stiffness) <= h.cross_tolerance
    )
