"""The numbers of a board among others: packed anew where the facts behind them differ from the facts of another."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.board.facts import is_alike, numbers, unlike
from core.board.instances import Instance
from core.board.pattern import Pattern, Uneven
from core.board.spec import Spec
from core.board.wiring import Wiring
from core.noise import key


def fill(
    wiring: Wiring,
    spec: Spec,
    before: Sequence[Instance],
    before_spec: Spec,
    pattern: Pattern,
    read: dict[int, set[str]],
) -> None:
    """Write the parameters and the first states of a bench where they differ from another bench.

    Parameters
    ----------
    wiring : Wiring
        Of the bench; its arrays hold the numbers of the other bench at its first tick.
    spec : Spec
        The bench.
    before, before_spec : sequence of Instance, Spec
        The other bench.
    pattern : Pattern
        The parts that both share; it notes the facts in which they differ.
    read : dict
        For each row the facts of a bench that its numbers are made of.

    Raises
    ------
    Uneven
        When a block reads more or fewer numbers than before.
    """
    others = {
        place: unlike(spec.context(*place), before_spec.context(*place), pattern.facts) for place in pattern.places
    }
    pattern.varied.update(*others.values())
    for row, facts in read.items():
        instance = wiring.instances[row]
        is_other = not is_alike(instance.params, before[row].params)
        if is_other or not others[instance.every, instance.axis].isdisjoint(facts):
            read[row] = _pack(wiring, row, spec)
            pattern.follow(read[row])
    if spec.seed != before_spec.seed:
        for at, stream in pattern.streams:
            wiring.p[at] = key(spec.seed, stream)


def _pack(wiring: Wiring, row: int, spec: Spec) -> set[str]:
    """Make the numbers of a row anew; return the facts they are made of."""
    instance = wiring.instances[row]
    parameters, state, read = numbers(instance, spec)
    packed, first = wiring.packed(row), wiring.state_of(instance.key)
    if len(parameters) != len(packed) or len(state) != len(first):
        raise Uneven("other lengths")
    if not np.array_equal(np.isfinite(state), np.isfinite(first)):
        raise Uneven("other numbers without an end")
    packed[:], first[:] = parameters, state
    return read
