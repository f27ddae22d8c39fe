"""Make the figures of the whole library, for an image or a wheel: ``python -m server.runs.build_figures``."""

from __future__ import annotations

import multiprocessing
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from scenarios.campaign.single import compared
from scenarios.library import get, ids, library
from server.runs.figures import BUILT, Figure, cost, keep, key_of
from server.runs.jobs import identify
from server.runs.worker import draw


def build(name: str, folder: Path = BUILT) -> None:
    """Make the figure of one scenario, unless the folder has it."""
    scenario = get(name)
    seed = scenario.spec.seed
    key = key_of(scenario)
    if (folder / f"{key}.json").exists():
        return
    others = [[outcome.model_dump_json() for outcome in outcomes] for outcomes in compared(scenario, [seed]).values()]
    document, _ = identify(scenario, [seed])
    keep(folder, Figure(key, **draw(document, seed, [[], *others])[1]))


def main() -> None:
    """Make all figures on all processors, and delete the figures of other versions."""
    keys = {f"{key_of(scenario)}.json" for scenario in library()}
    for path in BUILT.glob("*.json"):
        if path.name not in keys:
            path.unlink()
    ordered = sorted(ids(), key=lambda name: -cost(get(name)))
    with ProcessPoolExecutor(mp_context=multiprocessing.get_context("forkserver")) as pool:
        print(f"figures made: {len(list(pool.map(build, ordered)))}")


if __name__ == "__main__":
    main()
