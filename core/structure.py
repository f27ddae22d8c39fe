"""What a block tells of its inside: its equations, and the stages a sample passes."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Equation:
    """An equation shown beside the block, with the erratum if the printed one is wrong."""

    label: str
    latex: str
    source: str = ""
    printed: str = ""
    why: str = ""


@dataclass(frozen=True)
class Stage:
    """A part of what a step computes; where one stage takes what another gives, the drawing has a line.

    Parameters
    ----------
    title : str
        What it is called.
    takes, gives : str
        Names with spaces between: ports of the block, or fields of its state.
    equations : tuple of str
        Labels of the equations it carries, the block's own or those of its bases.
    """

    title: str
    takes: str
    gives: str
    equations: tuple[str, ...] = ()
