"""Compile the kernels of the library's scenarios into the cache, so that the first bench starts at once."""

from __future__ import annotations

import time

from scenarios.library import get, library
from scenarios.run import build


def main() -> None:
    """Build every scenario's board and run one tick of it."""
    start = time.monotonic()
    print("Compiling kernels", end="", flush=True)
    for entry in library():
        build(get(entry.id)).advance(1)
        print(".", end="", flush=True)
    print(f" {time.monotonic() - start:.1f} s")


if __name__ == "__main__":
    main()
