"""Compile all that is compiled at first use into its caches, so that the first bench starts at once."""

from __future__ import annotations

import importlib
import sys
import time

sys.dont_write_bytecode = False  # packages come without bytecode, and some environments never write it


def main() -> None:
    """Load the service, build every scenario's board and run one tick of it, compile what rested meanwhile."""
    start = time.monotonic()
    print("Compiling kernels", end="", flush=True)
    importlib.import_module("server.app")
    from core import registry
    from core.board import program
    from scenarios.library import get, library
    from scenarios.run import build

    for entry in library():
        build(get(entry.id)).advance(1)
        print(".", end="", flush=True)
    for family in registry.FAMILIES:
        for block in registry.blocks(family).values():
            program.address(block)
        print(".", end="", flush=True)
    print(f" {time.monotonic() - start:.1f} s")


if __name__ == "__main__":
    main()
