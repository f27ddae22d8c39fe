"""The inside of a block: its equations, and the stages of a sample."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Equation:
    """An equation shown with the block, with the erratum if the printed equation is wrong."""

    label: str
    latex: str
    source: str = ""
    printed: str = ""
    why: str = ""


@dataclass(frozen=True)
class Stage:
    """A part of a step; where one stage takes the output of another, the drawing has a line.

    Parameters
    ----------
    title : str
        Its name.
    takes, gives : str
        Names with spaces between: ports of the block, or fields of its state.
    equations : tuple of str
        Labels of its equations, from the block or its bases.
    """

    title: str
    takes: str
    gives: str
    equations: tuple[str, ...] = ()
