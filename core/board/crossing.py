"""Where a signal crosses a level, or enters or leaves a window, sample by sample."""

from __future__ import annotations

from typing import Any

from core.block import IntArray
from core.kernel import kernel


@kernel
def crossings(samples: Any, ways: Any, outside: int, ready: IntArray, found: IntArray) -> int:
    """Find crossings until there is no sample more or no room for another; return how many there are.

    A way of crossing has a target, from its first number to its second. A crossing is the first sample on the target
    after the signal has been back, beyond the third number or the fourth.

    Parameters
    ----------
    samples : ndarray of float32, shape (ticks,)
        The signal.
    ways : ndarray of float32, shape (ways, 4)
        Targets, and how far back the signal must have been.
    outside : int
        1 if the target is all that is not between its numbers, and back is between the other two.
    ready : ndarray of int64, shape (ways,)
        1 where the signal has been back since the last crossing; kept from call to call.
    found : ndarray of int64
        Takes the places of the crossings among the samples.
    """
    count = 0
    k = 0
    while k < samples.shape[0] and count < found.shape[0]:
        x = samples[k]
        crosses = 0
        for way in range(ways.shape[0]):
            if outside == 1:
                is_on = x <= ways[way, 0] or x >= ways[way, 1]
                is_back = x > ways[way, 2] and x < ways[way, 3]
            else:
                is_on = x >= ways[way, 0] and x <= ways[way, 1]
                is_back = x < ways[way, 2] or x > ways[way, 3]
            if is_on:
                if ready[way] == 1:
                    crosses = 1
                ready[way] = 0
            elif is_back:
                ready[way] = 1
        if crosses == 1:
            found[count] = k
            count += 1
        k += 1
    return count
