"""Floating-point operations of the diagnosers, and the number of models that a board can compute."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from core.block import BlockParams, parameter
from core.board.flops import budget
from scenarios.studies.study import Study

if TYPE_CHECKING:
    from core.board.board import Board

TOTALS = {
    1: (1, 2_471_485, 2000, 11_141_412),
    2: (2001, 11_145_755, 3000, 15_478_414),
    3: (3001, 15_482_749, 4000, 19_815_418),
}
"""Table 5.5.1 by its number of models: first iteration and its total, last and its total.

The last is printed as 14985418, less than the total before it: a slip of digits, as the next, 19819751, shows.
"""


class Flops(Study):
    """Counts the operations of every diagnoser by running it on numbers that count, and holds them against a board.

    ``flops.<id>.per_model`` is the number of additions, multiplications and divisions for each model and sample;
    ``.functions`` of exponentials, logarithms and the like for all models; ``.share`` the diagnoser's share of the
    board's operations. ``.overrun`` is 1 if the diagnosers before it leave too few operations, and ``.models_that_fit``
    is the number of its models that would still be in time. ``flops.table.iteration_<n>`` is the number of operations
    by which the totals of table 5.5.1 grow in an iteration with n models.
    """

    title = "Operations"

    class Params(BlockParams):
        """The board."""

        board_mflops: float = parameter(50.0, "operations of the board per second, in millions", gt=0, le=1e9)
        function_flops: float = parameter(20.0, "operations an exponential or a logarithm is worth", ge=0, le=1e4)
        warm: int = parameter(600, "samples run before counting", ge=2, le=100_000)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return the figures."""
        while board.tick < params.warm and board.advance(params.warm - board.tick).count:
            pass
        budgeted = budget(board, params.board_mflops * 1e6, params.function_flops)
        figures = {"flops.share": budgeted.share}
        for models, (first, before, last, after) in TOTALS.items():
            figures[f"flops.table.iteration_{models}"] = (after - before) / (last - first)
        for load in budgeted.loads:
            figures |= {
                f"flops.{load.name}.per_sample": load.operations,
                f"flops.{load.name}.per_model": load.per_model,
                f"flops.{load.name}.functions": load.functions,
                f"flops.{load.name}.share": load.share,
                f"flops.{load.name}.overrun": float(load.overrun),
                f"flops.{load.name}.models_that_fit": float(load.models_that_fit),
            }
        return figures
