"""Figures of a run without its trace and its report, for statistics over many seeds.

The same compiled loop runs with the same bits. Left out are controllers that never drive, which no bit of a digest
depends on, columns of the trace that no figure is made of, and runs of a study that another seed has made already.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest

from core.board.commands import Switch
from core.board.ensemble import Ensemble
from core.board.spec import Spec
from core.board.wiring import Wiring
from scenarios.measure.rate_noise import rate_noise_metrics
from scenarios.run import DEFAULT_SAMPLES, _figures, build, figure_signals
from scenarios.schema import Scenario
from scenarios.studies import detectors, monte_carlo, sensing

READ_OUT = ("rate.arw_", "rate.bias_", "rate.noise_", "rate.random_walk_")
"""Beginnings of figures that a read-out gathers while it runs: they need no trace."""


@contextmanager
def fast(scenario: Scenario) -> Iterator[None]:
    """Leave out what no figure of a scenario depends on."""
    commands = (command for event in scenario.events for command in event)
    switched = {command.switch for command in commands if isinstance(command, Switch)}
    with pytest.MonkeyPatch.context() as patch:
        rest = Wiring.rest

        def without_shadows(self: Wiring, spec: Spec) -> list[int]:
            shadows = spec.controllers.keys() - set(spec.driving.values()) - switched
            return [row for row in rest(self, spec) if self.instances[row].prefix not in shadows]

        patch.setattr(Wiring, "rest", without_shadows)
        for module, name in ((monte_carlo, "_run"), (sensing, "_run"), (detectors, "_record")):
            patch.setattr(module, name, _once(getattr(module, name)))
        yield


def _once(function: Any) -> Any:
    """Keep what was made for a seed: the runs of a study are those of seeds in a row."""
    kept: dict[Any, Any] = {}

    def once(board: Any, seed: int, *rest: Any, **options: Any) -> Any:
        key = (seed, str(rest), str(options))
        if key not in kept:
            kept[key] = function(board, seed, *rest, **options)
        return kept[key]

    return once


def figures(scenario: Scenario, seed: int) -> dict[str, float]:
    """Return the figures of a run that its expectations are about, and some more."""
    board = build(scenario, seed)
    if scenario.study is not None:
        study, params = scenario.study
        return study.figures(board, params)
    samples = scenario.samples or DEFAULT_SAMPLES
    if all(entry.metric.startswith(READ_OUT) for entry in scenario.head.expect):
        while board.tick < samples and board.advance(samples - board.tick).count:
            pass
        (name, section), *_ = board.spec.readouts.items()
        taus = section.block.taus_s(section.params, board.spec.context(section.every))  # type: ignore[attr-defined]
        return rate_noise_metrics(taus, board.wiring.state(name))
    twins = board.twins if isinstance(board, Ensemble) else {}
    names = figure_signals(board, board.signals)
    for twin, own in twins.items():
        names += [f"{twin}:{name}" for name in figure_signals(own, board.signals, f"{twin}:")]
    columns = [board.signals.index(name) for name in names]
    outputs = np.empty((samples, board.signals.outputs), order="F")  # columns that are not written take no memory
    while board.tick < samples and (rows := board.advance(samples - board.tick)).count:
        outputs[rows.first_tick : board.tick, columns] = rows.outputs[:, columns]
    found = _figures(board, outputs[: board.tick], scenario)
    for twin, own in twins.items():
        theirs = _figures(own, outputs[: board.tick], scenario, board.signals, f"{twin}:")
        found |= {f"twins.{twin}.{metric}": value for metric, value in theirs.items()}
    return found
