"""Episodes of an environment: each has noise of its own, and values and a fault that chance draws from its seed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from core.board.changes import check
from core.board.commands import Inject
from core.board.parse import changed
from core.board.pending import PendingCommand, PendingQueue
from core.board.spec import MOST_SEED, Spec
from core.errors import InputError, short, unknown

Ranges = Mapping[str, tuple[float, float]]
OPTIONS = ("values", "seed")
"""Options of a reset: values of the bench for this episode alone, and the seed of its noise."""


class Episode(NamedTuple):
    """A bench, its waiting commands, and what chance has drawn."""

    spec: Spec
    pending: PendingQueue
    drawn: dict[str, Any]


class Episodes:
    """Draws the episodes of an environment.

    Parameters
    ----------
    spec : Spec
        The bench.
    pending : PendingQueue
        The events of the scenario.
    samples : int
        Length of an episode.
    draws : mapping
        Fields of the bench by dotted paths, each with the ends of the range from which chance draws it evenly.
    faults : mapping
        Faults, each with the ends of the range of its severity. An episode has one of these faults or none, all equally
        likely, from a sample of the episode on, all samples equally likely.

    Raises
    ------
    InputError
        For a field or a fault that the bench has not, or a range that it does not allow.
    """

    def __init__(self, spec: Spec, pending: PendingQueue, samples: int, draws: Ranges, faults: Ranges) -> None:
        self._spec, self._pending, self._samples = spec, pending, samples
        self._draws = {path: ends_of(ends, f"draws.{path}") for path, ends in draws.items()}
        self._faults = {name: ends_of(ends, f"faults.{name}") for name, ends in faults.items()}
        for end in (0, 1):
            if draws:
                changed(spec, {path: ends[end] for path, ends in self._draws.items()})
            for name, ends in self._faults.items():
                check(spec, Inject(fault=name, severity=ends[end]))

    def next(self, chance: np.random.Generator, options: Mapping[str, Any]) -> Episode:
        """Return the next episode.

        Raises
        ------
        InputError
            For an option that there is not, or values that the bench does not allow.
        """
        for name in options:
            if name not in OPTIONS:
                raise unknown("option", name, OPTIONS, "options")
        seed = int(chance.integers(MOST_SEED))
        values = {path: float(chance.uniform(*ends)) for path, ends in self._draws.items()}
        fault, pending = self._fault(chance), self._pending.copy()
        if fault is not None:
            pending.add(PendingCommand(fault, "scenario", fault.at_sample))
        seed = _seed(options.get("seed", seed))
        values |= options.get("values") or {}
        spec = changed(self._spec, values) if values else self._spec
        name, severity, at = (fault.fault, fault.severity, fault.at_sample) if fault else ("", 0.0, 0)
        drawn = {"seed": seed, "fault": name, "severity": severity, "at_sample": at, "values": values}
        return Episode(spec.with_seed(seed), pending, drawn)

    def _fault(self, chance: np.random.Generator) -> Inject | None:
        if not self._faults:
            return None
        number, share, at = int(chance.integers(len(self._faults) + 1)), chance.random(), chance.random()
        if number == len(self._faults):
            return None
        name, (low, high) = [*self._faults.items()][number]
        severity = low + (high - low) * float(share)
        return Inject(fault=name, severity=severity, at_sample=int(at * self._samples)) if severity else None


def ends_of(ends: object, field: str) -> tuple[float, float]:
    """Return the ends of a range, in order."""
    try:
        low, high = (float(end) for end in ends)  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        low, high = math.nan, math.nan
    if not (math.isfinite(low) and math.isfinite(high) and low <= high):
        raise InputError(f"must be two numbers, the smaller one first, got {short(ends)}", field)
    return low, high


def _seed(given: object) -> int:
    whole = int(given) if isinstance(given, int | np.integer) and not isinstance(given, bool) else -1
    if not 0 <= whole <= MOST_SEED:
        raise InputError(f"must be a whole number from 0 to {MOST_SEED}, got {short(given)}", "options.seed")
    return whole
