"""Score of a diagnoser on a record: the truth is in the labels of the record, if it has any."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, Context
from core.diagnose.hypothesis import BankParams, names_of
from core.loop.score import Score, ScoredPorts, ScoreTiming, count, nothing_counted, take_turns
from core.ports import reads
from core.record import Vector, tail


class LabelledModels(BankParams):
    """The hypotheses of a bank, and the names of the labels of a record."""

    labels: tuple[str, ...] = ()


class RecordScore(Block):
    """Scores a bank by the rules of any score, at the samples of a record that have a label.

    A label that no hypothesis has is a truth that is never found. Without any label there are only verdicts: share,
    switches and delay are no numbers.
    """

    title = "Score on a record"
    apart = True
    lengths = ("hypotheses",)
    Params = LabelledModels
    State = Score.State

    class Packed(ScoreTiming):
        """In addition the hypothesis of every label, -1 for none."""

        hypothesis: Vector = tail()

    class Ports(ScoredPorts):
        """In addition the label."""

        label: float = reads("plant.label", "1", "index of the label, -1 for none")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the ticks between two verdicts and the hypothesis of every label."""
        names = names_of(params)
        p = cls.Packed.blank(len(params.labels))
        take_turns(p, len(names), context)
        p.hypothesis[:] = [names.index(label) if label in names else -1 for label in params.labels]
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> Score.State:
        """Nothing counted."""
        return nothing_counted(len(params.hypotheses))

    @staticmethod
    def step(p: Packed, s: Score.State, x: Ports) -> None:
        """Name the winner, and count where there is a label."""
        label = int(x.label)
        truth = int(p.hypothesis[label]) if label >= 0 else -1
        total = s.total
        count(p, s, x, int(p.count), truth)
        if label < 0:
            s.total = total
        if s.total > 0.0:
            x.correct_fraction = s.right / s.total
        else:
            x.correct_fraction = math.nan
            x.false_switches = math.nan
            x.delay = math.nan
