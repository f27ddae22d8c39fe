"""The summary of a run as the API shows it: kept as JSON, so it is a dictionary here too."""

from __future__ import annotations

from typing import Annotated, NotRequired

from pydantic import Field
from typing_extensions import TypedDict

from core.board.commands import Trip


class RunExpectation(TypedDict):
    """An expectation of the scenario, and the measured value."""

    metric: str
    published: str
    expected: str
    measured: float | None
    ok: bool
    note: str
    expected_words: NotRequired[Annotated[str, Field(description="The expected value in words, with its unit")]]
    published_value: NotRequired[float | None]
    verdict: NotRequired[str | None]
    open_loop: NotRequired[
        Annotated[float | None, Field(description="Figure with the open loop in place of the controller")]
    ]
    pid: NotRequired[Annotated[float | None, Field(description="Figure with a PID in its place")]]
    comparator: NotRequired[Annotated[str, Field(description="Name of this PID")]]
    pid_too: NotRequired[Annotated[bool, Field(description="Whether this PID meets the claim too")]]


class RunSummary(TypedDict):
    """Figures of a run and verdicts on them; with several seeds, figures are means."""

    scenario: str
    title: str
    source: str
    claim: str
    verdict: str | None
    seed: Annotated[int, Field(description="The first seed")]
    ticks: int
    dt_s: float
    elapsed_s: float
    digest: str
    trip: Trip | None
    warnings: list[str]
    metrics: Annotated[dict[str, float], Field(description="Figures by name")]
    expectations: list[RunExpectation]
    ok: Annotated[bool, Field(description="Whether all expectations hold")]
    seeds: NotRequired[Annotated[list[int], Field(description="The first and the last of several seeds")]]
    digests: NotRequired[Annotated[list[str], Field(description="The digest of each seed")]]
    tripped_runs: NotRequired[int]
    metrics_std: NotRequired[Annotated[dict[str, float], Field(description="Standard deviations by name of figure")]]
