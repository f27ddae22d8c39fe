"""The order of the blocks of an instrument: which are lost, late or doubled, and how many samples are missing."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import Any

from core.errors import InputError
from core.format import format_short
from scenarios.records.line import BlockHead

LONGEST_GAP_S = 10.0
"""Longest time between two blocks whose samples are counted as lost one by one; more is a break."""
NS_PER_MS = 1e6
REMEMBERED = 1000
"""Gaps in the numbers that are remembered, to know a late block from a doubled one."""
COUNTED = ("blocks", "lost_blocks", "late_blocks", "doubled_blocks", "lost_samples", "breaks")


@dataclass
class BlockOrder:
    r"""Places blocks one behind the other, by their numbers and by the clock of their source.

    Between the end of a block and the time of the next are :math:`n=(t_{k+1}-t_k)f_s-N_k` samples; from
    :math:`|n|>1` on they are missing. The clock begins again with each block, so that its error does not add up.

    Parameters
    ----------
    rate_khz : float
        Samples for each ms.
    shots : bool
        Whether each gap is a break: the device is not observed between two shots of an oscilloscope.
    """

    rate_khz: float
    shots: bool = False
    blocks: int = 0
    lost_blocks: int = 0
    late_blocks: int = 0
    doubled_blocks: int = 0
    lost_samples: int = 0
    breaks: int = 0
    _session: str = ""
    _next: int | None = None
    _end_ns: int = 0
    _skipped: deque[tuple[int, int]] = field(default_factory=lambda: deque(maxlen=REMEMBERED))

    def counts(self) -> dict[str, Any]:
        """Return the numbers of blocks, lost samples and breaks so far."""
        return {name: getattr(self, name) for name in COUNTED}

    def begin(self, session: str) -> None:
        """Begin a connection: numbers and clock of the same session continue, others begin again."""
        if not session or session != self._session:
            self._next = None
            self._skipped.clear()
        self._session = session

    def place(self, head: BlockHead) -> int | None:
        """Return how many samples are lost before a block; nothing where the block comes too late or twice.

        A break, whose length is not known or too long, is marked by one lost sample.

        Raises
        ------
        InputError
            When the clock of the source runs back.
        """
        if self._next is not None and head.number < self._next:
            self._drop(head.number)
            return None
        lost = self._gap(head)
        if self._next is not None and head.number > self._next:
            self.lost_blocks += head.number - self._next
            self._skipped.append((self._next, head.number))
        self._next = head.number + 1
        self._end_ns = head.time_ns + round(head.samples * NS_PER_MS / self.rate_khz)
        self.blocks += 1
        self.lost_samples += lost
        return lost

    def _gap(self, head: BlockHead) -> int:
        if self._next is None:
            self.breaks += self.blocks > 0
            return int(self.blocks > 0)
        gap = (head.time_ns - self._end_ns) * self.rate_khz / NS_PER_MS
        if gap < -1.5:
            back = format_short((self._end_ns - head.time_ns) * 1e-9, "s")
            text = f"begins {back} before the end of the block before it"
            hint = "its time is of its first sample, by the clock of the samples"
            raise InputError(text, f"block {head.number}", hint)
        if gap > (1.5 if self.shots else LONGEST_GAP_S * 1e3 * self.rate_khz):
            self.breaks += 1
            return 1
        missing = round(gap) if gap > 1.5 else 0
        return max(missing, 1) if head.number > self._next else missing

    def _drop(self, number: int) -> None:
        for i, (first, end) in enumerate(self._skipped):
            if first <= number < end:
                self.late_blocks += 1
                del self._skipped[i]
                self._skipped.extend(part for part in ((first, number), (number + 1, end)) if part[0] < part[1])
                return
        self.doubled_blocks += 1
