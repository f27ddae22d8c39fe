"""The limit of a headless run: its ticks."""

from __future__ import annotations

from scenarios.run import DEFAULT_SAMPLES
from scenarios.schema import Scenario
from server.errors import ApiError
from server.settings import Settings


def check_length(scenario: Scenario, seeds: int, settings: Settings, what: str, field: str) -> None:
    """Refuse a run that is too long for this server.

    Parameters
    ----------
    scenario : Scenario
        The scenario of the run.
    seeds : int
        Number of seeds.
    settings : Settings
        Limits.
    what, field : str
        The name of the run in the error, and the field at fault.

    Raises
    ------
    ApiError
        If it has too many ticks.
    """
    samples = scenario.samples or DEFAULT_SAMPLES
    if samples * seeds > settings.max_run_ticks:
        text = f"{what} has {samples * seeds} ticks, the limit is {settings.max_run_ticks} (max_run_ticks)"
        raise ApiError(422, "too_long", text, field)
