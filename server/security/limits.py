"""Rate limits of callers: token buckets."""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Callable
from threading import Lock


class Bucket:
    """A token bucket: ``rate`` per second on average, ``burst`` at once.

    Parameters
    ----------
    rate : float
        Tokens gained per second.
    burst : float
        Most tokens held.
    clock : callable
        Seconds.
    """

    def __init__(self, rate: float, burst: float, clock: Callable[[], float] = time.perf_counter) -> None:
        self._rate, self._burst, self._clock = rate, burst, clock
        self._tokens, self._at = burst, clock()

    def take(self, cost: float = 1.0) -> bool:
        """Take a token if there is one; something that costs more is paid for by a longer wait."""
        now = self._clock()
        self._tokens = min(self._burst, self._tokens + (now - self._at) * self._rate)
        self._at = now
        if self._tokens < 1.0:
            return False
        self._tokens -= cost
        return True


class Buckets:
    """One bucket per caller, the longest unused forgotten first.

    Parameters
    ----------
    rate, burst : float
        Of every bucket.
    most : int
        Callers remembered.
    clock : callable
        Seconds.
    """

    def __init__(
        self, rate: float, burst: float, most: int = 1024, clock: Callable[[], float] = time.perf_counter
    ) -> None:
        self._rate, self._burst, self._most, self._clock = rate, burst, most, clock
        self._buckets: OrderedDict[str, Bucket] = OrderedDict()
        self._lock = Lock()

    def take(self, caller: str, cost: float = 1.0) -> bool:
        """Take a token of ``caller``, or several; from any thread."""
        with self._lock:
            bucket = self._buckets.pop(caller, None) or Bucket(self._rate, self._burst, self._clock)
            self._buckets[caller] = bucket
            if len(self._buckets) > self._most:
                self._buckets.popitem(last=False)
            return bucket.take(cost)
