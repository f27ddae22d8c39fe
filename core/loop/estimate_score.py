"""Compares the estimate of a user's identifier with the true device."""

from __future__ import annotations

from core.block import Block, BlockParams
from core.identify.identifier import PHYSICAL, worst
from core.ports import BlockPorts, output, reads, tap
from core.record import Record, Vector


class EstimateScore(Block):
    r"""The largest relative error of mass, stiffness and damping, :math:`\max_i|\hat\theta_i/\theta_i-1|`."""

    title = "Score of an estimate"

    class Params(BlockParams):
        """Nothing to choose."""

    class Ports(BlockPorts):
        """Estimate and truth; the error."""

        estimate: Vector = reads("", "1", "estimated mass, stiffness and damping over nominal")
        mass_scale: float = reads("effects.mass_scale", "1", "true mass over nominal")
        stiffness_scale: float = reads("effects.stiffness_scale", "1", "true stiffness over nominal")
        damping_scale: float = reads("effects.damping_scale", "1", "true damping over nominal")
        error_pct: float = output("%", "largest relative error of the estimate")
        truth: Vector = tap("1", "true mass, stiffness and damping over nominal", labels=PHYSICAL)

    @staticmethod
    def step(p: Record, s: Record, x: Ports) -> None:
        """Show the truth, and compare."""
        x.truth[0] = x.mass_scale
        x.truth[1] = x.stiffness_scale
        x.truth[2] = x.damping_scale
        x.error_pct = worst(x.estimate, x.truth, 3)
