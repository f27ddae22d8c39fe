"""The numbers of a board among others: packed anew where the facts behind them differ from the facts of another."""

from __future__ import annotations

import numpy as np

from core.board.facts import is_alike, numbers, unlike
from core.board.pattern import Uneven
from core.board.spec import Spec
from core.board.wiring import Wiring


def fill(
    wiring: Wiring, spec: Spec, before: Wiring, before_spec: Spec, read: dict[int, set[str]], packed: set[int]
) -> None:
    """Write the parameters and the first states of a bench where they differ from another bench.

    Parameters
    ----------
    wiring : Wiring
        Of the bench; its arrays hold the numbers of the first bench of all.
    spec : Spec
        The bench.
    before, before_spec : Wiring, Spec
        The other bench, at its first tick as far as its numbers are taken.
    read : dict
        For each row the facts of a bench that its numbers are made of.
    packed : set
        Rows that differ between the other bench and the first of all; rows that differ here join them.

    Raises
    ------
    Uneven
        When a block reads more or fewer numbers than before.
    """
    others: dict[tuple[int, str], set[str]] = {}
    for row, facts in read.items():
        instance, known = wiring.instances[row], before.instances[row]
        place = instance.every, instance.axis
        if place not in others:
            others[place] = unlike(spec.context(*place), before_spec.context(*place))
        if others[place].isdisjoint(facts) and is_alike(instance.params, known.params):
            if row not in packed:
                continue
            parameters, state = before.packed(row), before.state_of(instance.key)
        else:
            parameters, state, read[row] = numbers(instance, spec)
            packed.add(row)
        own, first = wiring.packed(row), wiring.state_of(instance.key)
        if len(parameters) != len(own) or len(state) != len(first):
            raise Uneven("other lengths")
        if not (np.isfinite(state) == np.isfinite(first)).all():
            raise Uneven("other numbers without an end")
        own[:], first[:] = parameters, state
