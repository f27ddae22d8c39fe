"""Wirings of the benches that were wired last: another bench of the same sections takes over all it has in common."""

from __future__ import annotations

import copy
import threading
from collections import deque
from dataclasses import dataclass

import numpy as np

from core.board.facts import has_same_blocks, numbers, streams, unlike
from core.board.program import P_OFFSET
from core.board.spec import Spec
from core.board.wiring import Wiring, wire
from core.noise import key

MOST = 8
"""Benches whose wiring is kept, 0.1 MB each."""


@dataclass(frozen=True, eq=False)
class WiredBench:
    """A bench, its wiring at the first tick, and for each row the facts that its numbers are made of, if known."""

    spec: Spec
    wiring: Wiring
    read: list[set[str]] | None


_last: deque[WiredBench] = deque(maxlen=MOST)
_lock = threading.Lock()


def wired(spec: Spec) -> Wiring:
    """Return a new wiring of a bench, as `wire` does.

    Raises
    ------
    InputError
        As ``Block.pack``.
    """
    with _lock:
        like = next((one for one in _last if _is_like(one.spec, spec)), None)
    wiring = None if like is None else _again(like, spec)
    if wiring is None:
        read: list[set[str]] | None = None if like is None else []  # a bench that comes once needs none
        wiring = wire(spec, read=read)
        with _lock:
            if like is not None and like in _last:
                _last.remove(like)
            _last.append(WiredBench(spec, copy.deepcopy(wiring), read))
    return wiring


def _is_like(one: Spec, other: Spec) -> bool:
    """Say whether two benches have the very same sections of the same library, and no faults."""
    return not one.faults and not other.faults and one.library is other.library and has_same_blocks(one, other)


def _again(like: WiredBench, spec: Spec) -> Wiring | None:
    """Return the wiring of a bench from the one of another; nothing where that does not tell enough."""
    wiring = copy.deepcopy(like.wiring)
    places = {(instance.every, instance.axis) for instance in wiring.instances}
    differs = {place: unlike(spec.context(*place), like.spec.context(*place)) for place in places}
    if not any(differs.values()):
        return wiring
    if like.read is None:
        return None
    for row, instance in enumerate(wiring.instances):
        if differs[instance.every, instance.axis].isdisjoint(like.read[row]):
            continue
        p, s, _ = numbers(instance, spec)
        packed, state = wiring.packed(row), wiring.state_of(instance.key)
        if (len(p), len(s)) != (len(packed), len(state)):
            return None
        packed[:], state[:] = p, s
    for row, instance in enumerate(wiring.instances):
        for place, stream in streams(instance, int(wiring.table[row, P_OFFSET])):
            wiring.p[place] = key(spec.seed, stream)
    wiring.endless = ~np.isfinite(wiring.s)
    return wiring
