"""An experiment: a scenario and the commands to its bench up to a tick, which give the same bits again."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from scenarios.key import code_version
from server.version import VERSION

THIS_VERSION = f"{VERSION} {code_version()}"


class Experiment(BaseModel):
    """The scenario of a bench, the commands to it, and its state."""

    scenario: dict[str, Any]
    events: list[dict[str, Any]]
    tick: int
    digest: str
    version: str
    running: bool
    time_scale: float | None
