"""Runs over several seeds: means and spreads of every figure."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from core.board.spec import MOST_SEED
from core.errors import InputError, short
from scenarios.run import judge, run
from scenarios.schema import Scenario


def parse_seeds(text: str, field: str = "--seeds") -> range:
    """Read ``A:B``, both included: how seeds are counted everywhere.

    Raises
    ------
    InputError
        If it is not two whole numbers in order.
    """
    whole = re.fullmatch(r"\s*([0-9]{1,16})\s*:\s*([0-9]{1,16})\s*", text)
    first, last = (int(part) for part in whole.groups()) if whole else (1, 0)
    if not first <= last <= MOST_SEED:
        raise InputError(f"must be A:B with whole numbers A <= B <= {MOST_SEED}, got {short(text)}", field)
    return range(first, last + 1)


def run_seeds(scenario: Scenario, seeds: Sequence[int]) -> dict[str, Any]:
    """Run a scenario once for each seed and return one summary with means and standard deviations."""
    return together(scenario, [run(scenario, seed).summary() for seed in seeds])


def together(scenario: Scenario, summaries: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Join the summaries of several seeds: means, standard deviations of a sample, expectations of the means, warnings.

    The digest is the SHA-256 over the digests of the runs. A figure that some runs lack is the mean over the others.
    """
    names = sorted({name for summary in summaries for name in summary["metrics"]})
    values = {name: [s["metrics"][name] for s in summaries if name in s["metrics"]] for name in names}
    means = {name: float(np.mean(over_seeds)) for name, over_seeds in values.items()}
    expectations = judge(scenario, means)
    digests = [summary["digest"] for summary in summaries]
    return {
        **summaries[0],
        "seeds": [summaries[0]["seed"], summaries[-1]["seed"]],
        "elapsed_s": sum(summary["elapsed_s"] for summary in summaries),
        "digest": hashlib.sha256("".join(digests).encode()).hexdigest(),
        "digests": digests,
        "tripped_runs": sum(summary["trip"] is not None for summary in summaries),
        "warnings": list(dict.fromkeys(text for summary in summaries for text in summary["warnings"])),
        "metrics": means,
        "metrics_std": {
            name: float(np.std(over_seeds, ddof=1)) if len(over_seeds) > 1 else 0.0
            for name, over_seeds in values.items()
        },
        "expectations": expectations,
        "ok": all(entry["ok"] for entry in expectations),
    }
