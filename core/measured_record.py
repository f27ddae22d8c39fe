"""A record of a real device: drive voltage and displacement at regular samples, and the verdicts that are known."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from core.errors import InputError, short

MOST_SAMPLES = 20_000_000
"""Longest record: 200 s at 100 kHz, 320 MB."""
UNLABELLED = -1
"""Label of a sample whose verdict is not known."""
Stretch = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64] | None]
"""Drive, displacement and labels of some samples."""


class PlayedRecord(Protocol):
    """A record as a board plays it."""

    @property
    def rate_khz(self) -> float:
        """Samples for each ms."""

    @property
    def hypotheses(self) -> Sequence[str]:
        """The names of the labels."""

    @property
    def has_labels(self) -> bool:
        """Whether a label says the truth at some samples."""

    @property
    def key(self) -> str:
        """The name by which the shelf finds it."""

    @property
    def samples(self) -> int:
        """Number of samples so far."""

    @property
    def is_growing(self) -> bool:
        """Whether more samples may come, for which the board then waits."""

    def stretch(self, first: int, end: int) -> Stretch:
        """Return samples before the end."""


@dataclass(frozen=True, eq=False)
class MeasuredRecord:
    r"""Samples of a device: the voltage :math:`u_i` acts from sample i on, the displacement :math:`y_i` is of sample i.

    Parameters
    ----------
    rate_khz : float
        Samples for each ms.
    drive, displacement : array, shape (samples,)
        V and um; a displacement that is no number is a lost sample.
    label : array of int, shape (samples,), optional
        Index of the hypothesis that is true at a sample, -1 where it is not known.
    hypotheses : sequence of str
        The names of the labels.

    Raises
    ------
    InputError
        For columns of different lengths, a drive that is not finite, a record that is empty or too long.
    """

    rate_khz: float
    drive: NDArray[np.float64] = field(repr=False)
    displacement: NDArray[np.float64] = field(repr=False)
    label: NDArray[np.int64] | None = field(default=None, repr=False)
    hypotheses: Sequence[str] = ()

    def __post_init__(self) -> None:
        """Check the columns, and keep them from changes."""
        columns: dict[str, NDArray[Any]] = {"drive": self.drive, "displacement": self.displacement}
        if self.label is not None:
            columns["label"] = self.label
        for name, column in columns.items():
            if column.shape != (len(self.drive),):
                raise InputError(f"has {len(column)} samples, the drive has {len(self.drive)}", name)
            column.flags.writeable = False
        if not 2 <= len(self.drive) <= MOST_SAMPLES:
            raise InputError(f"has {len(self.drive)} samples; allowed: 2 to {MOST_SAMPLES}", "record")
        if not np.isfinite(self.rate_khz) or self.rate_khz <= 0.0:
            raise InputError(f"must be above 0, got {self.rate_khz!r}", "rate_khz")
        wrong = np.flatnonzero(~np.isfinite(self.drive))
        if len(wrong):
            raise InputError(f"is not a finite number at sample {wrong[0]}", "drive")
        if not np.isfinite(self.displacement).any():
            raise InputError("has no finite number at all", "displacement")

    is_growing: ClassVar[bool] = False

    @property
    def samples(self) -> int:
        """Number of samples."""
        return len(self.drive)

    @property
    def has_labels(self) -> bool:
        """Whether a label says the truth at some samples."""
        return self.label is not None

    def stretch(self, first: int, end: int) -> Stretch:
        """Return some samples."""
        label = self.label
        return self.drive[first:end], self.displacement[first:end], None if label is None else label[first:end]

    @cached_property
    def key(self) -> str:
        """SHA-256 of rate, columns and labels: the same for the same numbers, from whatever file."""
        whole = hashlib.sha256(b"combbench record 1")
        whole.update(np.float64(self.rate_khz).tobytes())
        missing = np.isnan(self.displacement)
        whole.update(self.drive.astype("<f8").tobytes())
        whole.update(np.where(missing, np.nan, self.displacement).astype("<f8").tobytes())
        if self.label is not None:
            whole.update("\0".join(self.hypotheses).encode() + self.label.astype("<i8").tobytes())
        return whole.hexdigest()


class RecordShelf(Protocol):
    """A place for records that outlasts the process."""

    def get(self, key: str) -> PlayedRecord | None:
        """Return a record, or nothing."""


_shelf: RecordShelf | None = None


def find_on(shelf: RecordShelf) -> None:
    """Name the place where benches look for their records."""
    global _shelf
    _shelf = shelf


def record_of(key: str, path: str) -> PlayedRecord:
    """Return the record with this key.

    Raises
    ------
    InputError
        When the shelf has none.
    """
    found = _shelf.get(key) if _shelf is not None else None
    if found is None:
        hint = "bring it in with combbench replay"
        raise InputError(f"no record {short(key)} is kept here", path, hint)
    return found
