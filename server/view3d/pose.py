"""The pose of a device: one moment of a bench as its scene shows it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

from core.faults.fault import Fault, FaultParams

F = TypeVar("F", bound=FaultParams)


@dataclass(frozen=True)
class Active:
    """A fault that acts at the moment shown."""

    block: type[Fault]
    params: FaultParams
    severity: float

    @property
    def share(self) -> float:
        """Severity over the injected severity."""
        return self.severity / self.params.severity if self.params.severity else 1.0

    def given(self, kind: type[F]) -> F:
        """Return the parameters it was injected with, of the class its block has."""
        assert isinstance(self.params, kind)
        return self.params


@dataclass(frozen=True, kw_only=True)
class Pose:
    """One moment of any device.

    Parameters
    ----------
    faults : tuple of Active
        The faults that act.
    contact : int
        Whether fingers touch.
    caption : str
        The differences from the true motion, in words.
    when : str
        The moment in words, if it is not the present.
    """

    faults: tuple[Active, ...] = ()
    contact: int = 0
    caption: str = ""
    when: str = ""
