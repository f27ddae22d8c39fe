"""Whether steps of user units run behind the wall in this process, and the way to each of these steps."""

from __future__ import annotations

import atexit
from collections.abc import MutableMapping
from threading import Lock
from weakref import WeakKeyDictionary

from core.block import Block
from core.wall.code import kept
from core.wall.crossing import Crossing, Sizes
from core.wall.host import instance_of, machine, module_of

INSTANCES = 4
"""Of a step: so many threads can run it at a time; more wait for each other."""

_is_demanded = False
_building = Lock()
_crossings: MutableMapping[type[Block], dict[tuple[Sizes, int], Crossing]] = WeakKeyDictionary()
atexit.register(_crossings.clear)  # before the package that deletes them is unloaded


def demand(wanted: bool = True) -> None:
    """Say whether units run behind the wall in this process from now on.

    Raises
    ------
    InputError
        When it cannot be built here.
    """
    global _is_demanded
    if wanted:
        machine()
    _is_demanded = wanted


def is_demanded() -> bool:
    """Say whether units run behind the wall."""
    return _is_demanded


def address(block: type[Block], sizes: Sizes, width: int = 1) -> int:
    """Return the address of a C function that computes a step behind the wall, for so many boards side by side.

    The function exists as long as the block.

    Raises
    ------
    InputError
        When the step cannot be there.
    """
    with _building:  # a way that another replaced would be gone from under the boards that have its address
        ways = _crossings.setdefault(block, {})
        found = ways.get((sizes, width))
        if found is None:
            module = module_of(kept(block))
            instances = [instance_of(module, sizes.total) for _ in range(INSTANCES)]
            found = ways[sizes, width] = Crossing(instances, sizes, width)
        return found.address
