"""Commands that wait for their moment."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from core.block import FloatArray
from core.board import changes
from core.board.commands import Command
from core.board.condition import Condition
from core.board.document import Document


@dataclass
class Pending:
    """A command that waits for its moment: a tick, or a condition watched from a tick on."""

    command: Command
    actor: str
    tick: int | None
    condition: Condition | None = None
    since: int = 0

    @property
    def watched(self) -> Condition | None:
        """The condition, once it is watched."""
        return self.condition if self.tick is None else None

    def event(self) -> Document:
        """Return it as an event of a scenario."""
        document = changes.event(self.command.model_dump(exclude_none=True, mode="json"))
        document.pop("at_ms", None)
        if self.condition is None:
            document.pop("when", None)  # met already, or never asked for
        document["at_sample"] = self.since if self.tick is None else self.tick
        return document


def watches(pending: Iterable[Pending], index: dict[str, int]) -> FloatArray:
    """Return the conditions that are watched as rows for the loop."""
    conditions = [entry.watched for entry in pending if entry.watched is not None]
    rows = [[index[found.signal], found.sign, found.threshold] for found in conditions]
    return np.array(rows, dtype=np.float64).reshape(-1, 3)
