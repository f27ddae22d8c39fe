"""A threshold from the command line."""

from __future__ import annotations

import os

from core.errors import InputError
from scenarios.campaign.executor import Processes
from scenarios.campaign.halving import Threshold, Wanted
from scenarios.campaign.threshold import Memory, Search
from scenarios.schema import Scenario


def parse_range(text: str) -> dict[str, str | float]:
    """Read ``PATH=LOW:HIGH``, or ``PATH=LOW:HIGH:log``.

    Raises
    ------
    InputError
        When it is not written so.
    """
    path, _, ends = text.partition("=")
    low, _, rest = ends.partition(":")
    high, _, scale = rest.partition(":")
    try:
        return {"path": path.strip(), "low": float(low), "high": float(high), "scale": scale or "linear"}
    except ValueError:
        raise InputError(f"must be PATH=LOW:HIGH or PATH=LOW:HIGH:log, got {text!r}", "--over") from None


def find(scenario: Scenario, metric: str, over: str) -> Threshold:
    """Find where a claim holds over the range of a number.

    Raises
    ------
    InputError
        When the scenario has no such claim or number.
    """
    wanted = Wanted.checked({"metric": metric, **parse_range(over)}, "--over")
    processes = Processes(os.cpu_count() or 1)
    try:
        search = Search(scenario, wanted, Memory(), processes=processes)
        search.run()
    finally:
        processes.shutdown()
    return Threshold.model_validate(search.kept)


def threshold_text(found: Threshold) -> str:
    """Write the result as lines: the figure at each value, then the range where the claim holds."""
    rows = [
        f"{'ok  ' if one.holds else 'MISS'} {found.path} = {one.value:<12.6g} {found.metric} = "
        + ("not measured" if one.measured is None else f"{one.measured:.6g}")
        for one in found.tried
    ]
    return "\n".join([*rows, found.words])
