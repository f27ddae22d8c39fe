"""Computes digests with code for a level of processors: ``python -m tests.scenarios.on_level x86-64-v2 8 library``.

The last word says what is run: ``library`` (alone), ``benches`` (alone), ``abreast`` (the benches, each beside two with
other seeds, so many boards side by side as the second word says).
"""

from __future__ import annotations

import json
import subprocess
import sys
from typing import Any

from core.compile import machine
from tests.library_pass import ROOT

LEVELS = {level.processor: level for level in machine.LEVELS} | {"native": machine.native()}
BESIDE = 3
"""Runs of each bench abreast: fewer go one by one."""


def digests_on(level: str, width: int, what: str) -> dict[str, Any]:
    """Return digests by name, from a process whose code is for a level; and how many came from boards abreast."""
    command = [sys.executable, "-W", "ignore", "-m", "tests.scenarios.on_level", level, str(width), what]
    told = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr
    found: dict[str, Any] = json.loads(told.stdout)
    return found


def main() -> None:
    """Print the digests."""
    level, width, what = sys.argv[1:]
    machine.native = lambda: LEVELS[level]  # before any module takes it from there
    machine.WIDTH = int(width)
    import scenarios  # noqa: F401  (first: it gives compiled kernels their cache)
    from scenarios.campaign import batch
    from scenarios.library import library
    from scenarios.run import run
    from scenarios.schema import Scenario
    from tests.scenarios import digests

    assert batch.WIDTH == machine.WIDTH
    benches = {str(n): Scenario.load(one["scenario"]) for n, one in enumerate(digests.kept()["benches"])}
    abreast, together = [], batch._together

    def counted(*arguments: Any) -> Any:
        found = together(*arguments)
        abreast.extend(found)
        return found

    batch._together = counted
    if what == "abreast":
        found = {
            name: batch.outcomes([(one, one.spec.seed + k) for k in range(BESIDE)])[0].digest
            for name, one in benches.items()
        }
    else:
        chosen = benches if what == "benches" else {one.id: one for one in library() if one.study is None}
        found = {name: run(one).digest for name, one in chosen.items()}
    print(json.dumps({"digests": found, "abreast": len(abreast)}))


if __name__ == "__main__":
    main()
