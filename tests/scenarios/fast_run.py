"""Figures of a run without its trace and its report, for statistics over many seeds.

The same compiled loop runs with the same bits. Left out is what no figure depends on: blocks that nothing reads, such
as controllers that never drive, columns of the trace that no figure is made of, the log, and what another seed has
found already, be it runs of a study or the pull-in of a device.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest

from core.board import board as boards
from core.board import ensemble, fold, program
from core.board.commands import Switch
from core.board.observer import Observer
from core.board.spec import Spec
from core.board.wiring import Wiring
from scenarios.measure import lateral
from scenarios.measure.metrics import device_metrics, measure
from scenarios.measure.rate_noise import rate_noise_metrics
from scenarios.run import DEFAULT_SAMPLES, build, figure_signals
from scenarios.schema import Scenario
from scenarios.studies import detectors, monte_carlo, sensing

READ_OUT = ("rate.arw_", "rate.bias_", "rate.noise_", "rate.random_walk_")
"""Beginnings of figures that a read-out gathers while it runs: they need no trace."""
LONG = 2048
"""Ticks of one call of the loop: every call costs as much as some fifty of them."""
UNREAD = ("waveform",)
"""Blocks that are on every bench of their kind, for a controller that seldom drives."""


@contextmanager
def fast(scenario: Scenario) -> Iterator[None]:
    """Leave out what no figure of a scenario depends on."""
    commands = (command for event in scenario.events for command in event)
    switched = {command.switch for command in commands if isinstance(command, Switch)}
    with pytest.MonkeyPatch.context() as patch:
        rest = Wiring.rest

        def without_shadows(self: Wiring, spec: Spec) -> list[int]:
            driving = {*spec.driving.values(), *switched}
            aside = {name for name in spec.controllers if name not in driving}
            aside |= {name for name in UNREAD if f"{name}_drive" not in driving}
            return [row for row in rest(self, spec) if self.instances[row].prefix not in aside]

        patch.setattr(Wiring, "rest", without_shadows)
        patch.setattr(lateral, "_planar", _planar_once())
        for module, name in ((monte_carlo, "_run"), (sensing, "_run"), (detectors, "_record")):
            patch.setattr(module, name, _once(getattr(module, name)))
        if scenario.study is None:
            _without_taps(patch)
        yield


def _without_taps(patch: pytest.MonkeyPatch) -> None:
    """Keep no taps and write no log; of twins keep the outputs that figures are made of."""
    allocate = boards.Board._allocate

    def allocate_outputs(self: boards.Board) -> None:
        allocate(self)
        self._taps = np.zeros((LONG, 0))

    def shown(twin: boards.Board) -> list[int]:
        columns = (twin.signals.index(name) for name in figure_signals(twin, twin.signals))
        return [column for column in columns if column < twin.signals.outputs]

    patch.setattr(boards, "CHUNK", LONG)
    patch.setattr(boards.Board, "_allocate", allocate_outputs)
    patch.setattr(Observer, "look", lambda *_: [])
    patch.setattr(ensemble, "_shown", shown)


def _once(function: Any) -> Any:
    """Keep what was made for a seed: the runs of a study are those of seeds in a row."""
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


def figures(scenario: Scenario, seed: int) -> dict[str, float]:
    """Return the figures of a run that its expectations are about, and some more."""
    board = build(scenario, seed)
    if scenario.study is not None:
        study, params = scenario.study
        return device_metrics(board.spec) | study.figures(board, params)
    samples = scenario.samples or DEFAULT_SAMPLES
    if not scenario.events and all(entry.metric.startswith(READ_OUT) for entry in scenario.head.expect):
        return _read_out(board, samples)
    twins = board.twins if isinstance(board, ensemble.Ensemble) else {}
    parts = {"": board, **{f"{name}:": twin for name, twin in twins.items()}}
    columns = {
        prefix: [(name, board.signals.index(prefix + name)) for name in figure_signals(one, board.signals, prefix)]
        for prefix, one in parts.items()
    }
    traces = {prefix: {name: np.empty(samples) for name, _ in own} for prefix, own in columns.items()}
    while board.tick < samples and (rows := board.advance(samples - board.tick)).count:
        for prefix, own in columns.items():
            for name, column in own:
                traces[prefix][name][rows.first_tick : board.tick] = rows.outputs[:, column]
    found: dict[str, float] = {}
    for prefix, one in parts.items():
        trace = {name: values[: one.tick] for name, values in traces[prefix].items()}
        own_figures = measure(one, trace, scenario.head.metrics)
        found |= {f"twins.{prefix[:-1]}.{name}" if prefix else name: value for name, value in own_figures.items()}
    return found


def _read_out(board: boards.Board, samples: int) -> dict[str, float]:
    """Run the bare loop, which keeps nothing, and return what the read-out has gathered."""
    wiring, nothing = board.wiring, np.zeros((samples, 0))
    arrays = (board._table, wiring.p, wiring.s, wiring.w, wiring.io)
    program.run(samples, 0, board.dt_ms, *arrays, nothing, nothing, fold.begin(0), wiring.trip, np.zeros((0, 3)))
    (name, section), *_ = board.spec.readouts.items()
    taus = section.block.taus_s(section.params, board.spec.context(section.every))  # type: ignore[attr-defined]
    return rate_noise_metrics(taus, wiring.state(name))
