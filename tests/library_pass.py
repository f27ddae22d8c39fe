"""One pass over the library: each scenario is run once, and every test about the library reads the results.

``python -m tests.library_pass`` runs before the tests, on all processors. The results of the same code and text are
kept, so a second pass computes nothing; a test that is run alone computes the scenarios it asks for.
"""

from __future__ import annotations

import hashlib
import json
import multiprocessing
import os
import shutil
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / ".library_pass"
BENCHES = "benches"
"""Name of the result that holds the digests of the benches of `tests.scenarios.digests`."""

SAME_EVERYWHERE = {
    "OPENBLAS_CORETYPE": "HASWELL",
    "NPY_DISABLE_CPU_FEATURES": "AVX512F AVX512CD AVX512_SKX AVX512_CLX AVX512_CNL AVX512_ICL AVX512_SPR",
}
"""numpy and scipy choose their routines by the processor; with this, every processor since 2013 gives the same bits."""


@cache
def result(name: str) -> dict[str, Any]:
    """Return the result of a scenario: digest, last tick, trip, gallery row, and the figures of its counterparts."""
    path = _place(name)
    if not path.exists():
        _told(name)
    found: dict[str, Any] = json.loads(path.read_text())
    return found


def results() -> dict[str, dict[str, Any]]:
    """Return the result of every scenario, by its id; missing results are computed on all processors."""
    from scenarios.library import ids

    missing = [name for name in ids() if not _place(name).exists()]
    if missing:
        _told(*missing)
    return {name: result(name) for name in ids()}


def names() -> list[str]:
    """Name all results, the longest runs first, so that no processor has a long one left in the end."""
    from scenarios.library import library

    ordered = sorted(library(), key=lambda scenario: (scenario.study is None, -(scenario.samples or 0)))
    return [BENCHES, *(scenario.id for scenario in ordered)]


def _place(name: str) -> Path:
    """Return the file of a result: its folder has the version of the code, its name the hash of its text."""
    from scenarios.key import code_version

    text = ROOT / ("tests/scenarios/digests.json" if name == BENCHES else f"scenarios/library/{name}.toml")
    return FOLDER / code_version() / f"{name}-{hashlib.sha256(text.read_bytes()).hexdigest()[:12]}.json"


def _compute(name: str) -> str:
    """Run a scenario with its counterparts, or the benches, and keep the result."""
    path = _place(name)
    if not path.exists():
        text = json.dumps(_benches() if name == BENCHES else _scenario(name))
        part = path.with_suffix(f".{os.getpid()}")
        part.write_text(text)
        part.replace(path)
    return name


def _scenario(name: str) -> dict[str, Any]:
    from scenarios.campaign.outcome import outcome_of
    from scenarios.campaign.single import compared, summary
    from scenarios.library import get
    from scenarios.run import run

    scenario = get(name)
    found, others = run(scenario), compared(scenario, [scenario.spec.seed])
    return {
        "digest": found.digest,
        "tick": found.board.tick,
        "trip": found.trip.reason if found.trip else None,
        "gallery": summary(scenario, [outcome_of(found)], others),
        "counterparts": {kind: outcomes[0].metrics for kind, outcomes in others.items()},
    }


def _benches() -> dict[str, Any]:
    from scenarios.run import run
    from scenarios.schema import Scenario
    from tests.scenarios import digests

    return {"digests": [run(Scenario.load(one["scenario"])).digest for one in digests.kept()["benches"]]}


def _told(*arguments: str) -> None:
    """Make the pass in a process whose libraries assume a fixed machine."""
    command = [sys.executable, "-W", "ignore", "-m", "tests.library_pass", *arguments]
    ended = subprocess.run(command, cwd=ROOT, env=os.environ | SAME_EVERYWHERE, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr


def main() -> None:
    """Compute the results that are missing, all or those named; forget results of other code."""
    if not SAME_EVERYWHERE.items() <= os.environ.items():
        os.execve(
            sys.executable, [sys.executable, "-m", "tests.library_pass", *sys.argv[1:]], os.environ | SAME_EVERYWHERE
        )
    import scenarios  # noqa: F401  (first: it gives compiled kernels their cache)

    folder = _place(BENCHES).parent
    for other in set(FOLDER.glob("*")) - {folder}:
        shutil.rmtree(other, ignore_errors=True)
    folder.mkdir(parents=True, exist_ok=True)
    wanted = sys.argv[1:] or names()
    if len(wanted) == 1:
        _compute(wanted[0])
        return
    with ProcessPoolExecutor(mp_context=multiprocessing.get_context("forkserver")) as pool:
        for done in pool.map(_compute, wanted):
            print(done, flush=True)


if __name__ == "__main__":
    main()
