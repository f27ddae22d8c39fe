"""Results of the benchmark, also of a submission: a row for each diagnoser and track, with data to recompute it."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path

from pydantic import Field, ValidationError

from core.board.document import Document
from core.errors import InputError, from_validation
from core.table import Table
from scenarios.benchmark.figures import BINS, Estimate

WITHIN_SAMPLES = (5, 10, 20, 30, 50, 75, 100, 150, 200, 300, 500)
"""Delays of the curve of the share of faults found."""


class Bin(Table):
    """A bin of a reliability curve: samples, the mean probability said, and the share that was right."""

    samples: int
    said: float
    right: float


class CaseDigest(Table):
    """A case and the answer of the diagnoser: seed, hash of the scenario, hash of the bits of the outputs."""

    seed: str
    scenario: str
    digest: str


class Row(Table):
    """One diagnoser on one track; a diagnoser without probabilities has no figures of them.

    Attributes
    ----------
    threshold : float
        Evidence above which the alarm is on.
    calibration_alarms, calibration_samples : int
        False alarms of the healthy runs by which it was set, and their length.
    false_alarms, healthy_samples : int
        False alarms of the cases, and their samples before the fault.
    found_within : list of float
        Share of the cases that have a delay in which it is at most each of `WITHIN_SAMPLES`.
    scenario, digest : str
        SHA-256 over the digests of the cases, in order.
    """

    unit: str
    track: str
    threshold: float
    calibration_alarms: int
    calibration_samples: int
    false_alarms: int
    healthy_samples: int
    log_score: Estimate | None
    brier: Estimate | None
    delay_samples: Estimate | None
    missed: Estimate | None
    detection: Estimate | None
    false_alarm: Estimate | None
    isolation: Estimate | None
    truth_probability: Estimate | None
    false_switches: Estimate | None
    reliability: list[Bin]
    found_within: list[float]
    scenario: str
    digest: str
    cases: list[CaseDigest] = Field([])


class LeftOut(Table):
    """A diagnoser that a track cannot score, and why."""

    unit: str
    track: str
    reason: str


class Cost(Table):
    """The cost of a sample of a diagnoser, on the machine that measured it: not recomputed to the bit."""

    ns_per_sample: float
    over_mmae: float


class BenchmarkResults(Table):
    """Rows, and the version and seeds of the computation.

    Attributes
    ----------
    version : str
        Hash of the code of core and scenarios.
    seeds : str
        Name of the list of seeds.
    false_alarm_samples : int
        Mean number of samples between false alarms that thresholds are set for.
    sources : dict
        SHA-256 of the source of each diagnoser.
    own : dict
        The text of each unit that is not of the library, so that the results can be recomputed from their file.
    costs : dict
        Of each diagnoser, measured together with the Kalman bank ``mmae`` in the same run.
    """

    benchmark: str
    version: str
    seeds: str
    false_alarm_samples: int
    sources: dict[str, str]
    rows: list[Row]
    left_out: list[LeftOut]
    own: dict[str, str] = Field({})
    costs: dict[str, Cost] = Field({})

    @property
    def units(self) -> Document:
        """The units that are not of the library, as a scenario carries them."""
        return {name: {"source": text} for name, text in self.own.items()}

    def ranked(self, track: str) -> list[Row]:
        """Return the rows of a track, best first: by log score, then by Brier's; those without probabilities last."""
        rows = [row for row in self.rows if row.track == track]
        return sorted(rows, key=_place)

    def without_cases(self) -> BenchmarkResults:
        """Return the results without the digests of the cases."""
        return self.model_copy(update={"rows": [row.model_copy(update={"cases": []}) for row in self.rows]})

    def differences(self, other: BenchmarkResults) -> list[str]:
        """Return where the rows of other results differ from these, each in a line."""
        found = []
        theirs = {(row.unit, row.track): row for row in other.rows}
        for row in self.rows:
            beside = theirs.get((row.unit, row.track))
            found += [f"{row.unit}, {row.track}: {text}" for text in _unlike(row, beside)]
        return found


def _place(row: Row) -> tuple[float, float, str]:
    if row.log_score is None or row.brier is None:
        return float("inf"), 0.0, row.unit
    return row.log_score.mean, row.brier.mean, row.unit


def _unlike(row: Row, beside: Row | None) -> list[str]:
    """Return the differences of a row; differences of single cases only where both have them."""
    if beside is None:
        return ["is missing"]
    found = [name for name in Row.model_fields if name != "cases" and getattr(row, name) != getattr(beside, name)]
    pairs = zip(row.cases, beside.cases, strict=False)
    found += [f"case {one.seed}" for one, other in pairs if one != other]
    return [", ".join(found)] if found else []


def hash_of(texts: Sequence[str]) -> str:
    """Return the SHA-256 over texts, in order."""
    return hashlib.sha256("".join(texts).encode()).hexdigest()


def bins(counts: Sequence[Sequence[float]]) -> list[Bin]:
    """Return the bins of a reliability curve from how many samples, the sum said and how many right, empty ones too."""
    many, said, right = counts
    return [
        Bin(samples=int(many[i]), said=said[i] / many[i], right=right[i] / many[i])
        if many[i]
        else Bin(samples=0, said=0.0, right=0.0)
        for i in range(BINS)
    ]


def read(text: str, field: str) -> BenchmarkResults:
    """Read results.

    Raises
    ------
    InputError
        When they are malformed.
    """
    try:
        return BenchmarkResults.model_validate_json(text)
    except ValidationError as error:
        if error.errors()[0]["type"] == "json_invalid":
            raise InputError("is not JSON", field, code="malformed") from None
        raise from_validation(error, {"": [*BenchmarkResults.model_fields]}).under(field) from None


KEPT = Path("results.json")
"""The table of the library's diagnosers on the public seeds."""


@cache
def kept() -> BenchmarkResults:
    """Return the table that comes with this version."""
    return read((files(__package__) / KEPT.name).read_text("utf-8"), KEPT.name)


def write(results: BenchmarkResults) -> str:
    """Return results as a file."""
    return results.model_dump_json(indent=1) + "\n"
