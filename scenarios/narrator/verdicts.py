"""When the belief of a diagnoser turns to another hypothesis for good."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from core.board.spec import Section
from core.diagnose.hypothesis import ModelList
from core.format import format_count, format_percent
from core.loop.score import HELD
from scenarios.narrator.samples import LastSamples, rms
from scenarios.narrator.sentence import Sentence
from scenarios.narrator.words import figure, hypothesis_words, length, moment

TURNS = int(HELD)
"""Verdicts in a row for one hypothesis after which it counts, by the rule of the score."""


class Verdicts:
    r"""Tells each verdict of a diagnoser: another hypothesis has won 20 times in a row.

    A verdict holds until another hypothesis wins 20 times in a row; that of the healthy device holds at tick 0. Where
    the narrator begins later, or no hypothesis is the healthy device, the first verdict is not told. A model misses by
    the root mean square of its residuals over the 20, :math:`\sqrt{\tfrac1{20}\sum r_k^2}`; where there are no
    residuals, of the normalised ones. The delay counts from the change of the truth to the first of the 20, as that of
    the score does. Without the signal of the truth a sentence says nothing of it.

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
        self._whose = "belief turns to the lane" if alone else f"the belief of {name} turns to the lane"
        self._nominal = next((at for at, one in enumerate(models) if one.is_nominal), None)
        self._held: int | None = None
        self._winner, self._since = -1, 0
        self._truth: int | None = None
        self._changed: int | None = None

    @property
    def signals(self) -> list[str]:
        """The signals it looks at, where there are such."""
        ports = ("probability", "residual", "nis")
        each = [f"{self._name}.{port}.{model}" for port in ports for model in self._models]
        return [f"{self._name}.winner", f"{self._name}.truth", *each]

    def look(self, samples: LastSamples, first: int) -> Iterator[Sentence]:
        """Tell the verdicts from a tick on."""
        if first == 0:
            self._held = self._nominal
        truths = self._truths(samples, first)
        winners = samples.values(f"{self._name}.winner", first, samples.end).astype(np.int64)
        turns = np.flatnonzero(np.diff(winners, prepend=self._winner)).tolist()
        need = (TURNS - 1) * self._every
        for at, stop in zip([-1, *turns], [*turns, len(winners)], strict=True):
            if at >= 0:
                self._winner, self._since = int(winners[at]), first + at
            tick = self._since + need
            if self._winner in (-1, self._held) or not first <= tick < first + stop:
                continue
            old, self._held = self._held, self._winner
            if old is not None:
                truth = next((one for one in reversed(truths) if one[0] <= tick), None)
                yield self._sentence(samples, tick, old, truth)

    def _truths(self, samples: LastSamples, first: int) -> list[tuple[int, int, int | None]]:
        """Return tick and value of the truth at the beginning and where it changes, and when it had changed last."""
        name = f"{self._name}.truth"
        if name not in samples:
            return []
        values = samples.values(name, first, samples.end).astype(np.int64)
        before = int(values[0]) if self._truth is None else self._truth
        found = [(first - 1, before, self._changed)]
        for at in np.flatnonzero(np.diff(values, prepend=before)).tolist():
            self._changed = first + at
            found.append((first + at, int(values[at]), self._changed))
        self._truth = int(values[-1])
        return found

    def _sentence(
        self, samples: LastSamples, tick: int, old: int, truth: tuple[int, int, int | None] | None
    ) -> Sentence:
        """Say a verdict."""
        new, numbers = self._winner, {"time_ms": tick * self._dt_ms}
        probability = samples.at(f"{self._name}.probability.{self._models[new]}", tick)
        numbers["probability"] = probability
        signals = [f"{self._name}.probability.{self._models[at]}" for at in (new, old)]
        missed = self._missed(samples, tick, new, old, numbers, signals)
        turned = f"{self._whose} {self._words[new]} ({format_percent(probability)})"
        text = f"At {moment(tick * self._dt_ms)} {missed}{turned}."
        is_false, start = truth is not None and truth[1] != new, self._since
        if truth is not None:
            text, start = f"{text} {self._judged(new, truth, numbers)}", min(start, truth[2] or start)
        return Sentence(
            tick=tick,
            kind="false_verdict" if is_false else "verdict",
            text=text,
            signals=signals,
            span=(start, tick),
            numbers=numbers,
        )

    def _missed(
        self, samples: LastSamples, tick: int, new: int, old: int, numbers: dict[str, float], signals: list[str]
    ) -> str:
        """Say by how much the model misses that wins, and the one that won before."""
        port = next((port for port in ("residual", "nis") if f"{self._name}.{port}.{self._models[new]}" in samples), "")
        if not port:
            return ""
        first, said = tick - (TURNS - 1) * self._every, []
        for which, at in (("new", new), ("old", old)):
            name = f"{self._name}.{port}.{self._models[at]}"
            values = samples.values(name, first, tick + 1, self._every)
            signals.append(name)
            if port == "residual":
                size = numbers[f"{which}_um"] = rms(values)
                said.append(figure(size, "um"))
            else:
                size = numbers[f"{which}_normalised"] = float(np.sqrt(np.mean(values)))
                said.append(f"{figure(size, '')} times what noise explains")
        return f"the {self._words[new]} model misses by {said[0]}, the {self._words[old]} one by {said[1]}: "

    def _judged(self, new: int, truth: tuple[int, int, int | None], numbers: dict[str, float]) -> str:
        """Say whether a verdict is right, and how long after the change."""
        _, true, changed = truth
        numbers["truth"] = float(true)
        if true != new:
            return f"That is wrong: {f'the truth is {self._words[true]}' if true >= 0 else 'no lane has the truth'}."
        if changed is None:
            return "That is right."
        numbers["delay_samples"] = float(max(0, self._since - changed))
        after = length(numbers["delay_samples"] * self._dt_ms)
        return f"That is right, {format_count(numbers['delay_samples'], 'sample')} ({after}) after the change."
