"""The signals of a board that a run keeps: of all running blocks, or only the signals of figures."""

from __future__ import annotations

from core.board.board import Board
from core.board.ensemble import Ensemble
from core.board.idle import looking_on
from core.signals import Signal
from scenarios.measure import rate
from scenarios.measure.verdicts import TRACED_VERDICTS

TRACED_FIGURES = (
    "plant.displacement",
    "sensor.displacement",
    "model.displacement",
    "drive.voltage",
    "reference.voltage",
)
PICTURED = ("plant.shift", "plant.rotation")
"""Taps that reports show."""


def traced(board: Board, *, taps: bool = True, figures_only: bool = False, everything: bool = False) -> list[Signal]:
    """Return the signals of a board at its first tick whose traces a run keeps.

    Parameters
    ----------
    board : Board
        The board, its events waiting.
    taps, figures_only : bool
        As for `run`.
    everything : bool
        Also signals of blocks in shadow.
    """
    wanted = {*watched(board)} if figures_only else {signal.name for signal in board.signals}
    aside = set() if everything else looking_on(board)
    return [
        signal
        for signal in board.signals
        if (taps or signal.kind == "output") and signal.name in wanted
        # the signals of a twin are its purpose
        if signal.block not in aside or ":" in signal.name
    ]


def watched(board: Board) -> list[str]:
    """Return the outputs that the figures of a run need, outputs of twins with their prefix."""
    wanted = {*figure_signals(board), *evidence_signals(board)}
    wanted |= {f"{name}.{port}" for name in board.spec.controllers for port in rate.READ if board.spec.axes}
    if isinstance(board, Ensemble):
        for name, twin in board.twins.items():
            wanted |= {f"{name}:{signal}" for signal in figure_signals(twin)}
    return [signal.name for signal in board.signals if signal.kind == "output" and signal.name in wanted]


def evidence_signals(board: Board) -> list[str]:
    """Return the probabilities of all diagnosers that choose between hypotheses."""
    return [f"{name}.probability.{hypothesis}" for name, s in board.scores().items() for hypothesis in s.names]


def figure_signals(board: Board) -> list[str]:
    """Return the signals that the figures of a board need."""
    moved = rate.traced(board) if board.spec.axes else TRACED_FIGURES
    names = [*moved, *(f"{name}.{port}" for name in board.spec.diagnosers for port in TRACED_VERDICTS)]
    names += [f"{name}.error_pct" for name in board.spec.identifiers]
    found = [name for name in names if name in board.signals]
    unused = {f"{name}.winner" for name in board.spec.diagnosers if f"{name}.verdict" not in found}
    return [name for name in found if name not in unused]
