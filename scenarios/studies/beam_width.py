"""Stiffness against the width of the beams."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from core.block import BlockParams, parameter
from core.device.geometry import Geometry
from core.errors import InputError
from scenarios.studies.study import Study

if TYPE_CHECKING:
    from core.board.board import Board


class BeamWidth(Study):
    r"""How much softer a suspension is when lithography narrows beams and trusses alike.

    By 1.3.4, which with :math:`\alpha` kept is the cube: :math:`1-(1-\Delta w/w)^3`.
    """

    title = "Beam width"

    class Params(BlockParams):
        """Which beams, and how much narrower."""

        widths_um: list[float] = parameter([5.0, 1.0], "widths of the beams", "um")
        reduction_um: float = parameter(0.2, "total loss of the width", "um", gt=0, le=10)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return the loss of stiffness in percent, by 1.3.4 and to first order."""
        base = board.spec.device.geometry or Geometry()
        losses = {}
        for width in params.widths_um:
            if width <= params.reduction_um:
                raise InputError(f"nothing is left of {width:g} um", "study.widths_um")
            drawn = {"beam_width_um": width, "truss_width_um": width}
            whole = base.model_copy(update={**drawn, "beam_bias_um": 0.0})
            narrow = base.model_copy(update={**drawn, "beam_bias_um": 0.5 * params.reduction_um})
            name = f"{width:g}".replace(".", "_")
            softer = 1.0 - narrow.stiffness_n_m() / whole.stiffness_n_m()
            losses[f"beam_width.softer_{name}_um_pct"] = 100.0 * softer
            losses[f"beam_width.linear_{name}_um_pct"] = 300.0 * params.reduction_um / width
        return losses
