"""The comparator of a scenario: the PID that its claims for a controller are compared with."""

from __future__ import annotations

from typing import Self

from pydantic import Field, model_validator

from core.board.document import Document
from core.table import Table

POLES = (0.8, 1.0, 1.3, 1.6, 2.0, 2.5)
FEEDFORWARD = (0.0, 1.0)
SIZE = len(POLES) * len(FEEDFORWARD)
NONE = "no PID was tuned for this bench"


class Comparator(Table):
    """The best PID of a small family, chosen once for a scenario, on its device without faults.

    With the reference fed forward a healthy device follows a copied model whatever the feedback. So the pole comes
    first, by the error its feedback alone leaves in the tail of the run, and then the feed-forward, by the error with
    this pole; the least is the best. A member that trips is not chosen.
    """

    pole: float = Field(description=f"pole of the PID over w0, one of {POLES}")
    feedforward: float = Field(description=f"share of the reference that is fed forward, one of {FEEDFORWARD}")

    @model_validator(mode="after")
    def _is_of_the_family(self) -> Self:
        for name, allowed in (("pole", POLES), ("feedforward", FEEDFORWARD)):
            if getattr(self, name) not in allowed:
                raise ValueError(f"{name} must be one of {', '.join(f'{one:g}' for one in allowed)}")
        return self

    @property
    def name(self) -> str:
        """How a row names it."""
        return f"best PID of {SIZE}: pole {self.pole:g}, feed-forward {self.feedforward:g}"

    @property
    def controller(self) -> Document:
        """The controller as a scenario has it."""
        return {"kind": "pid", "pole": self.pole, "feedforward": self.feedforward}
