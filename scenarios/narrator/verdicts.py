"""When a diagnoser favours another hypothesis for good."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from core.block import FloatArray
from core.board.spec import Section
from core.diagnose.hypothesis import ModelList
from core.format import format_count, format_percent
from core.loop.score import HELD
from scenarios.narrator.samples import NarratorSignals, rms
from scenarios.narrator.sentence import Sentence
from scenarios.narrator.words import figure, hypothesis_words, length, moment

TURNS = int(HELD)
"""Verdicts in a row for one hypothesis after which it counts, by the rule of the score."""


class WinnerTurns(NamedTuple):
    """Changes of a signal of whole numbers: their ticks, and the numbers from there on."""

    ticks: list[int]
    values: list[int]


NEVER = WinnerTurns([], [])


class Verdicts:
    r"""Tells each verdict of a diagnoser: another hypothesis has won 20 times in a row.

    A verdict holds until another hypothesis wins 20 times in a row; the healthy verdict holds at tick 0. Where the
    narrator begins later, or no hypothesis is the healthy device, the first verdict gives no sentence. A model misses
    by the root mean square of its residuals over the 20, :math:`\sqrt{\tfrac1{20}\sum r_k^2}`; where there are no
    residuals, of the normalised ones. The delay counts from the change of the truth to the first of the 20, as the
    delay of the score does. Without the signal of the truth a sentence does not mention it.

    Parameters
    ----------
    name : str
        Id of the diagnoser.
    section : Section
        Its block and parameters.
    every : int
        Ticks between two of its verdicts.
    dt_ms : float
        Device time of a tick.
    alone : bool
        Whether it is the only diagnoser of the bench.
    """

    def __init__(self, name: str, section: Section, every: int, dt_ms: float, alone: bool) -> None:
        assert isinstance(section.params, ModelList)
        models = section.params.hypotheses
        self._models, self._words = [one.name for one in models], [hypothesis_words(one) for one in models]
        self._name, self._every, self._dt_ms = name, every, dt_ms
        self._whose = "the bank now favours" if alone else f'bank "{name}" now favours'
        self._nominal = next((at for at, one in enumerate(models) if one.is_nominal), None)
        self._held: int | None = None
        self._winner, self._since = -1, 0
        self._truth: int | None = None
        self._changed: int | None = None
        self._missed: list[list[FloatArray]] = []

    def look(self, samples: NarratorSignals, changes: Mapping[str, WinnerTurns]) -> Iterator[Sentence]:
        """Tell the verdicts in the rows of now, by the changes of winner and truth."""
        if samples.first == 0:
            self._held = self._nominal
        ticks, winners = changes.get(f"{self._name}.winner", NEVER)
        truths = [(-1, self._truth, self._changed), *self._truths(samples, changes.get(f"{self._name}.truth", NEVER))]
        need = (TURNS - 1) * self._every
        # only who wins often enough in a row counts, and who wins at the end
        edges = np.array([self._since, *ticks, samples.end + need + 1])
        for at in (np.flatnonzero(edges[1:] - edges[:-1] > need) - 1).tolist():
            if at >= 0:
                self._since, self._winner = ticks[at], winners[at]
                self._missed = []
            if self._winner in (-1, self._held):
                continue
            last = self._since + need
            stop = min(samples.end, last + 1)
            self._gather(samples, stop)
            if not samples.first <= last < stop:
                continue
            old, self._held = self._held, self._winner
            if old is not None:
                yield self._sentence(samples, last, old, next(one for one in reversed(truths) if one[0] <= last))

    def _truths(self, samples: NarratorSignals, changes: WinnerTurns) -> Iterator[tuple[int, int, int | None]]:
        """Return tick and value of each change of the truth, and when it changed last; the beginning is no change."""
        for tick, value in zip(*changes, strict=True):
            self._changed = tick if tick != samples.began else None
            self._truth = value
            yield tick, value, self._changed

    def _gather(self, samples: NarratorSignals, stop: int) -> None:
        """Gather the residual of the model that wins now, and of the model whose verdict holds."""
        first = samples.first + (self._since - samples.first) % self._every
        first = max(first, self._since)
        port = self._port(samples)
        if port and self._held is not None:
            names = [f"{self._name}.{port}.{self._models[model]}" for model in (self._winner, self._held)]
            self._missed = [*self._missed, [samples.values(name, first, stop, self._every) for name in names]]

    def _port(self, samples: NarratorSignals) -> str:
        """Return the signal by which models miss: residuals, or else normalised ones."""
        ports = ("residual", "nis")
        return next((port for port in ports if f"{self._name}.{port}.{self._models[0]}" in samples), "")

    def _sentence(
        self, samples: NarratorSignals, tick: int, old: int, truth: tuple[int, int | None, int | None]
    ) -> Sentence:
        """Say a verdict."""
        new, numbers = self._winner, {"time_ms": tick * self._dt_ms}
        probability = samples.at(f"{self._name}.probability.{self._models[new]}", tick)
        numbers["probability"] = probability
        signals = [f"{self._name}.probability.{self._models[at]}" for at in (new, old)]
        missed = self._misses(samples, new, old, numbers, signals)
        turned = f"{self._whose} {self._words[new]} ({format_percent(probability)})"
        text = f"At {moment(tick * self._dt_ms)} {turned}."
        _, true, changed = truth
        is_false, start = true is not None and true != new, self._since
        if true is not None:
            text, start = f"{text} {self._judged(new, true, changed, numbers)}", min(start, changed or start)
        text += missed
        return Sentence(
            tick=tick,
            kind="false_verdict" if is_false else "verdict",
            text=text,
            signals=signals,
            span=(start, tick),
            numbers=numbers,
        )

    def _misses(
        self, samples: NarratorSignals, new: int, old: int, numbers: dict[str, float], signals: list[str]
    ) -> str:
        """Return the text with the residual of the model that wins, and of the previous winner."""
        port, said = self._port(samples), []
        if not port:
            return ""
        for which, model, parts in zip(("new", "old"), (new, old), zip(*self._missed, strict=True), strict=True):
            values = np.concatenate(parts)
            signals.append(f"{self._name}.{port}.{self._models[model]}")
            if port == "residual":
                size = numbers[f"{which}_um"] = rms(values)
                said.append(figure(size, "um"))
            else:
                size = numbers[f"{which}_normalised"] = float(np.sqrt(np.mean(values)))
                said.append(f"{figure(size, '')} times what noise explains")
        words = f" The {self._words[new]} model misses the measurement by {said[0]}"
        return f"{words}, the {self._words[old]} one by {said[1]}."

    def _judged(self, new: int, true: int, changed: int | None, numbers: dict[str, float]) -> str:
        """Say whether a verdict is right, and how long after the change."""
        numbers["truth"] = float(true)
        if true != new:
            why = f"the truth is {self._words[true]}" if true >= 0 else "no hypothesis matches the real fault"
            return f"Wrong: {why}."
        if changed is None:
            return "Correct."
        numbers["since_ms"] = self._since * self._dt_ms
        numbers["delay_samples"] = float(max(0, self._since - changed))
        if self._since <= changed:
            return "Correct: chosen before the change."
        after = f"{format_count(numbers['delay_samples'], 'sample')} ({length(numbers['delay_samples'] * self._dt_ms)})"
        return f"Correct; first chosen at {moment(numbers['since_ms'])}, {after} after the change."
