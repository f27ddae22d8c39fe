"""Base of the studies: parameters, figures from the bench of a scenario, and a picture where it helps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from core.block import BlockParams

if TYPE_CHECKING:
    from core.board.board import Board


@dataclass(frozen=True)
class StudyPicture:
    """Curves over two axes, each axis with its title and the unit its values come in."""

    x: tuple[str, str]
    y: tuple[str, str]
    curves: Sequence[tuple[str, Sequence[float], Sequence[float]]]
    is_log_x: bool = False
    is_stepped: bool = False


class Study:
    """Base of the studies: a study computes figures of a bench, and may draw curves."""

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

    @classmethod
    def picture(cls, board: Board, params: Any) -> StudyPicture | None:  # noqa: ARG003
        """Return the curves behind the figures, or None where the figures are enough; it is made from a fresh bench."""
        return None
