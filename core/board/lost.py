"""Blocks whose state is lost: a number of it is no longer finite.

A number that begins as infinite or NaN may be so at any time: its block means it. Controllers in shadow do not count;
after a runaway they start anew when they take over.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.board.program import S_OFFSET
from core.board.spec import Spec
from core.board.wiring import Wiring

EVERY = 512
"""Ticks between two looks at all states. They are whole multiples of it, so no trip depends on slices."""


class Lost(NamedTuple):
    """A block that has lost its state, and the first tick edge at which it had."""

    block: str
    tick: int


def next_look(tick: int) -> int:
    """Return the next tick at which all states are examined."""
    return tick - tick % EVERY + EVERY


def lost(wiring: Wiring, spec: Spec) -> str:
    """Return the first block of a tick that has lost its state; nothing when none has."""
    finite = np.isfinite(wiring.s)
    if finite.all():
        return ""
    places = np.flatnonzero(~(finite | wiring.endless))
    rows = sorted({*(wiring.table[:, S_OFFSET].searchsorted(places, "right") - 1).tolist()})
    aside = {*spec.controllers} - {*spec.driving.values()}
    found = (wiring.instances[row] for row in rows)
    return next((one.prefix for one in found if one.key not in aside), "")
