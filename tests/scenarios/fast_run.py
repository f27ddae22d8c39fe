"""Figures of a scenario at many seeds, without traces and reports: abreast as in a campaign.

Also left out are results that another seed has found already, be it runs of a study or the pull-in of a device, and the
trace of runs whose figures a read-out has gathered.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import pytest

from core.board.abreast import Abreast
from core.board.lane_traces import LaneTraces
from core.board.pattern import Pattern
from core.board.pending import PendingQueue
from core.compile.machine import WIDTH
from scenarios.campaign.batch import outcomes
from scenarios.measure import lateral
from scenarios.measure.metrics import device_metrics
from scenarios.measure.rate_noise import rate_noise_metrics
from scenarios.run import build
from scenarios.schema import Scenario
from scenarios.studies import detectors, monte_carlo, sensing

READ_OUT = ("rate.arw_", "rate.bias_", "rate.noise_", "rate.random_walk_")
"""Beginnings of figures that a read-out gathers while it runs: they need no trace."""


@contextmanager
def fast() -> Iterator[None]:
    """Keep what another seed has found already."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(lateral, "_planar", _planar_once())
        for module, name in ((monte_carlo, "_run"), (sensing, "_run"), (detectors, "_record")):
            patch.setattr(module, name, _once(getattr(module, name)))
        yield


def _once(function: Any) -> Any:
    """Keep the results of a seed: the runs of a study have consecutive seeds."""
    kept: dict[Any, Any] = {}

    def once(board: Any, seed: int, *rest: Any, **options: Any) -> Any:
        key = (seed, str(rest), str(options))
        if key not in kept:
            kept[key] = function(board, seed, *rest, **options)
        return kept[key]

    return once


def _planar_once() -> Callable[..., dict[str, float]]:
    """Keep the folds of a device with its faults; when it touched is of each run."""
    found = lateral._planar
    kept: dict[Any, dict[str, float]] = {}

    def once(p: Any, state: Any, far_um: float) -> dict[str, float]:
        key = (far_um, *lateral.stators_of(p), state.suspension.array.tobytes())
        if key not in kept:
            kept[key] = found(p, state, far_um)
        still = {name: value for name, value in kept[key].items() if name != "lateral.contact_ms"}
        return still | lateral._touched(float(state.touched_ms))

    return once


def figures(scenario: Scenario, seeds: Sequence[int]) -> Iterator[dict[str, float]]:
    """Yield the figures of a scenario at each seed."""
    if scenario.study is not None:
        study, params = scenario.study
        for board in (build(scenario, seed) for seed in seeds):
            yield device_metrics(board.spec) | study.figures(board, params)
        return
    gathered = not scenario.events and all(entry.metric.startswith(READ_OUT) for entry in scenario.head.expect)
    for start in range(0, len(seeds), WIDTH):
        chosen = seeds[start : start + WIDTH]
        if gathered:
            yield from _read_out(scenario, chosen)
        else:
            yield from (found.metrics for found in outcomes([(scenario, seed) for seed in chosen]))


def _read_out(scenario: Scenario, seeds: Sequence[int]) -> Iterator[dict[str, float]]:
    """Run boards abreast without a trace, and return what their read-outs have gathered."""
    pattern, specs = Pattern(build(scenario)), [scenario.spec.with_seed(seed) for seed in seeds]
    assert scenario.samples is not None
    traces = LaneTraces(pattern.board.wiring, [], scenario.samples)
    abreast = Abreast(pattern, specs, [PendingQueue() for _ in seeds], traces)
    assert all(abreast.run(scenario.samples))
    for board in abreast.boards:
        (name, section), *_ = board.spec.readouts.items()
        block: Any = section.block
        taus = block.taus_s(section.params, board.spec.context(section.every))
        yield rate_noise_metrics(taus, board.wiring.state(name))
