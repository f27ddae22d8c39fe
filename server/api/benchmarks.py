"""Benchmarks of diagnosers: their tracks, and the table that comes with this version."""

from __future__ import annotations

from functools import cache

from pydantic import BaseModel, Field

from scenarios.benchmark import results
from scenarios.benchmark.results import Cost, LeftOut, Row
from scenarios.benchmark.seeds import BENCHMARK, COMMITMENT, LISTS
from scenarios.benchmark.track import tracks
from server.api.bodies import AnswerBody
from server.api.router import Router
from server.errors import not_found

router = Router(prefix="/benchmarks", tags=["benchmarks"])
TITLE = "How soon and how honestly a fault is noticed and named"


class BenchmarkCard(AnswerBody):
    """A benchmark among others."""

    id: str
    title: str
    tracks: list[str]
    command: str = Field(description="Command that computes the table again")


class BenchmarkList(BaseModel):
    """The benchmarks."""

    benchmarks: list[BenchmarkCard]


class TrackResults(AnswerBody):
    """A track, and the diagnosers it scores, best first; diagnosers without probabilities are last."""

    id: str
    title: str
    question: str
    note: str
    classes: list[str]
    rows: list[Row]


class BenchmarkDetail(BenchmarkCard):
    """A benchmark with the table of the diagnosers of the library."""

    version: str = Field(description="Version of the code that computed the table")
    seeds: str
    cases: int = Field(description="Number of cases of each track")
    commitment: str = Field(description="SHA-256 of the hidden seeds")
    false_alarm_samples: int = Field(description="Mean samples between false alarms, to which thresholds are set")
    within_samples: list[int] = Field(description="Delays, in samples, that the entries of `found_within` belong to")
    results: list[TrackResults]
    left_out: list[LeftOut]
    costs: dict[str, Cost] = Field(description="Cost of each diagnoser, on the machine that computed the table")


@router.get("")
def list_benchmarks() -> BenchmarkList:
    """List the benchmarks."""
    return BenchmarkList(benchmarks=[_card()])


@router.get("/{benchmark_id}")
def get_benchmark(benchmark_id: str) -> BenchmarkDetail:
    """Return a benchmark: tracks, and the table of the diagnosers of the library on the public seeds."""
    if benchmark_id != BENCHMARK:
        raise not_found("benchmark", benchmark_id, f"there is: {BENCHMARK}")
    return _detail()


def _card() -> BenchmarkCard:
    return BenchmarkCard(id=BENCHMARK, title=TITLE, tracks=[*tracks()], command="combbench benchmark")


@cache
def _detail() -> BenchmarkDetail:
    kept = results.kept()
    cases, _ = LISTS[kept.seeds]
    return BenchmarkDetail.of(
        _card(),
        kept,
        cases=cases,
        commitment=COMMITMENT,
        within_samples=[*results.WITHIN_SAMPLES],
        results=[
            TrackResults.of(track, id=name, classes=[*track.classes], rows=kept.ranked(name))
            for name, track in tracks().items()
        ],
    )
