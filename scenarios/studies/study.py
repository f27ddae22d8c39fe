"""Base of the studies: parameters, and figures from the bench of a scenario."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from core.block import BlockParams

if TYPE_CHECKING:
    from core.board.board import Board


class Study:
    """Base of every study."""

    title: ClassVar[str]
    Params: ClassVar[type[BlockParams]]

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return the figures by dotted names.

        Parameters
        ----------
        board : Board
            The bench of the scenario at its first tick; it may be run.
        params : Params
            The parameters.
        """
        raise NotImplementedError
