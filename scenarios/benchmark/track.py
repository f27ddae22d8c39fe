"""A track of the benchmark: a question to diagnosers, and the cases that are drawn for it."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

from pydantic import Field

from core.board.document import Document
from core.diagnose.hypothesis import Hypothesis
from core.errors import unknown
from core.nesting import read_toml
from core.table import Table
from scenarios.key import content_hash
from scenarios.schema import Scenario

WARM = 500
"""Samples at the start that are not judged: there is no motion yet, and windows are empty."""
ONSET = (1500, 2500)
"""Between these the fault happens."""
WITHIN = 2500
"""Samples from the fault to the end of a case."""
HEALTHY = 10_000
"""Samples of a healthy run that set the thresholds, after the `WARM` samples."""
DIGITS = 6
"""Digits of a number that is drawn, so that it reads the same in any document."""


class FaultDraw(Table):
    """A fault that may happen: its severity, or the ends it is drawn between, and the class that is true then."""

    fault: str
    severity: float | tuple[float, float]
    truth: str


class BenchmarkTrack(Table):
    """A question, and how its cases are drawn: a pair of numbers is the ends of a range, all of it equally likely.

    Attributes
    ----------
    hypotheses : list
        Hypotheses for every diagnoser that chooses between hypotheses.
    classes : dict
        The classes to distinguish, healthy first, and the hypotheses of each class.
    """

    title: str
    place: int
    question: str
    note: str
    hypotheses: list[Hypothesis]
    classes: dict[str, list[str]]
    faults: list[FaultDraw] = Field(min_length=1)
    references: list[dict[str, Any]] = Field(min_length=1)
    scenario: dict[str, Any]

    def case(self, seed: str) -> Case:
        """Draw a case with a fault."""
        document = self._document(seed)
        chosen = self.faults[_choice(seed, "fault", len(self.faults))]
        first, last = ONSET
        onset = first + _choice(seed, "onset", last - first)
        severity = _drawn(chosen.severity, seed, "severity")
        event = {"at_sample": onset, "fault": chosen.fault, "severity": severity}
        document |= {"samples": onset + WITHIN, "events": [*document.get("events", []), event]}
        return Case(seed, document, onset, [*self.classes].index(chosen.truth))

    def healthy(self, seed: str) -> Case:
        """Draw a case without a fault, for the threshold."""
        samples = WARM + HEALTHY
        return Case(seed, self._document(seed) | {"samples": samples}, samples, 0)

    def _document(self, seed: str) -> Document:
        document: Document = _drawn(self.scenario, seed, "scenario")
        number = _choice(seed, "reference", len(self.references))
        reference = _drawn(self.references[number], seed, "reference")
        return document | {"reference": reference, "seed": _choice(seed, "noise", 2**53)}


@dataclass(frozen=True)
class Case:
    """One draw: the scenario without diagnosers, the sample at which the fault happens, and the class true then."""

    seed: str
    document: Document
    onset: int
    truth: int

    @property
    def hash(self) -> str:
        """Hash of the scenario."""
        return content_hash(self.document)

    def scenario(self, diagnosers: Mapping[str, Document], units: Document) -> Scenario:
        """Return the scenario with diagnosers, and the units of their own among them."""
        return Scenario.load({**self.document, "diagnosers": dict(diagnosers), "units": units})


def share(seed: str, name: str) -> float:
    r"""Return a number from 0 up to 1 by seed and name: 53 bits of :math:`\text{SHA-256}(\text{seed name})`."""
    digest = hashlib.sha256(f"{seed} {name}".encode()).digest()
    return (int.from_bytes(digest[:8], "big") >> 11) * 2.0**-53


def _choice(seed: str, name: str, count: int) -> int:
    return int(share(seed, name) * count)


def _drawn(value: Any, seed: str, name: str) -> Any:
    """Return a table with its ranges replaced by draws, each known by its path."""
    if isinstance(value, dict):
        return {key: _drawn(entry, seed, f"{name}.{key}") for key, entry in value.items()}
    if isinstance(value, list | tuple) and len(value) == 2 and all(isinstance(end, float) for end in value):
        low, high = value
        return round(low + (high - low) * share(seed, name), DIGITS)
    if isinstance(value, list):
        return [_drawn(entry, seed, f"{name}.{position}") for position, entry in enumerate(value)]
    return value


@cache
def tracks() -> dict[str, BenchmarkTrack]:
    """Return the tracks by name, in their order."""
    folder = files(__package__) / "tracks"
    found = {
        entry.name.removesuffix(".toml"): BenchmarkTrack.model_validate(read_toml(entry.read_text("utf-8"), entry.name))
        for entry in folder.iterdir()
    }
    return dict(sorted(found.items(), key=lambda item: item[1].place))


def track(name: str) -> BenchmarkTrack:
    """Return one track.

    Raises
    ------
    InputError
        When there is none of that name.
    """
    if name not in tracks():
        raise unknown("track", name, tracks(), "--track")
    return tracks()[name]
