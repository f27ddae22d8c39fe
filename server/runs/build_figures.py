"""Make the figures of the whole library, for an image or a wheel: ``python -m server.runs.build_figures``."""

from __future__ import annotations

import multiprocessing
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from scenarios.campaign.single import compared
from scenarios.library import get, ids, library
from server.runs.figures import BUILT, Figure, cost, keep
from server.runs.jobs import identify
from server.runs.worker import draw


def build(name: str, folder: Path = BUILT) -> None:
    """Make the figure of one scenario, unless the folder has it."""
    scenario = get(name)
    seed = scenario.spec.seed
    document, key = identify(scenario, [seed])
    if (folder / f"{key[:32]}.json").exists():
        return
    others = [[outcome.model_dump_json() for outcome in outcomes] for outcomes in compared(scenario, [seed]).values()]
    keep(folder, Figure(key[:32], **draw(document, seed, [[], *others])[1]))


def main() -> None:
    """Make all figures on all processors, and delete the figures of other versions."""
    keys = {f"{identify(scenario, [scenario.spec.seed])[1][:32]}.json" for scenario in library()}
    for path in BUILT.glob("*.json"):
        if path.name not in keys:
            path.unlink()
    ordered = sorted(ids(), key=lambda name: -cost(get(name)))
    with ProcessPoolExecutor(mp_context=multiprocessing.get_context("forkserver")) as pool:
        print(f"figures made: {len(list(pool.map(build, ordered)))}")


if __name__ == "__main__":
    main()
