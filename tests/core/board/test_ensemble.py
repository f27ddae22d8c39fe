"""Twins: the same bits as boards of their own that meet the same events."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.block import FloatArray
from core.board.board import Board
from core.board.commands import SetValues
from core.board.ensemble import Ensemble, make
from core.errors import InputError
from scenarios.run import build, run
from scenarios.schema import Scenario

BENCH: dict[str, Any] = {
    "sample_rate_khz": 100,
    "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 2000.0},
    "plant": {"model": "linear", "drive_noise_v": 0.01},
    "sensor": {"kind": "ideal", "noise_um": 0.02},
    "controller": {"kind": "open_loop"},
    "diagnosers": {"kalman": {"kind": "mmae", "hypotheses": [{"name": "healthy"}, {"name": "k+50", "stiffness": 1.5}]}},
}
TWINS: dict[str, dict[str, Any]] = {
    "adaptive": {"controller": {"kind": "mrac"}},
    "classic": {"controller": {"kind": "pid", "proportional_v_um": 2.0}},
}
EVENTS: list[dict[str, Any]] = [
    {"at_sample": 700, "fault": "stiffness", "severity": 0.5},
    {"at_sample": 900, "set": {"sensor.noise_um": 0.05}},
    {"at_sample": 1200, "switch": "mrac"},
    {"at_sample": 1500, "heal": "all"},
]
SAMPLES = 2000


def scenario(**changed: Any) -> Scenario:
    return Scenario({"schema": 1, "id": "twins", "samples": SAMPLES, "events": EVENTS, **BENCH, **changed})


def played(board: Board, chunk: int = 300) -> FloatArray:
    parts = []
    while board.tick < SAMPLES:
        rows = board.advance(min(chunk, SAMPLES - board.tick))
        if not rows.count:
            break
        parts.append(np.hstack([rows.outputs, rows.taps]))
    return np.vstack(parts)


@pytest.mark.parametrize("chunk", [300, 512])
def test_a_twin_is_bit_for_bit_the_board_it_would_be_alone(chunk: int) -> None:
    together = build(scenario(twins=TWINS))
    trace = played(together, chunk)
    for name, own in TWINS.items():
        # the switch is not for a twin with a controller of its own
        alone = build(scenario(**own, events=[event for event in EVENTS if "switch" not in event]))
        expected = played(alone, 77)
        for signal in ("plant.displacement", "sensor.displacement", "drive.voltage", "kalman.probability.k+50"):
            mine = trace[:, together.signals.index(f"{name}:{signal}")]
            assert np.array_equal(mine, expected[:, alone.signals.index(signal)]), (name, signal)
    first = build(scenario())
    expected = played(first)
    for entry in first.signals:
        assert np.array_equal(trace[:, together.signals.index(entry.name)], expected[:, entry.index]), entry.name


def test_a_twin_without_a_controller_of_its_own_follows_the_switch() -> None:
    together = build(scenario(twins={"noisier": {"diagnosers": {"kalman": {"assumed_noise_scale": 4.0}}}}))
    trace = played(together)
    first = trace[:, together.signals.index("drive.voltage")]
    assert np.array_equal(first, trace[:, together.signals.index("noisier:drive.voltage")])
    assert not np.array_equal(
        trace[:, together.signals.index("kalman.probability.healthy")],
        trace[:, together.signals.index("noisier:kalman.probability.healthy")],
    )
    assert list(together.scores()) == ["kalman", "noisier:kalman"]


def test_what_is_set_for_all_leaves_alone_what_a_twin_has_of_its_own() -> None:
    together = make({**BENCH, "twins": TWINS})
    assert isinstance(together, Ensemble)
    together.advance(100)
    together.apply(SetValues(at_sample=100, set={"controllers.pid.proportional_v_um": 5.0}))
    together.advance(100)
    kept = {name: twin.spec.controllers["pid"].params.proportional_v_um for name, twin in together.twins.items()}  # type: ignore[attr-defined]
    assert kept == {"adaptive": 5.0, "classic": 2.0}


def test_restored_and_saved_twins_give_the_same_bits() -> None:
    whole = build(scenario(twins=TWINS))
    trace = played(whole)
    part = build(scenario(twins=TWINS))
    while part.tick < 1000:
        part.advance(250)
    for copied in (Board.restore(part.checkpoint()), part):
        rest = played(copied)
        assert np.array_equal(rest, trace[1000:])
        assert copied.digest() == whole.digest()
    again = build(Scenario({"schema": 1, "id": "again", **whole.save()}))
    assert np.array_equal(played(again), trace)
    assert again.digest() == whole.digest()


def test_a_twin_that_trips_rests_and_the_board_goes_on() -> None:
    fragile = {"fragile": {"drive": {"limit_v": 5.0}, "guard": {"rail_ms": 0.02}}}
    together = build(scenario(twins=fragile))
    trace = played(together)
    assert together.trip is None
    assert len(trace) == SAMPLES
    column = trace[:, together.signals.index("fragile:plant.displacement")]
    stopped = int(np.flatnonzero(np.isnan(column))[0])
    assert 0 < stopped < 500
    assert np.isnan(column[stopped:]).all()
    tripped = [entry for entry in together.log if entry.kind == "twin_tripped"]
    assert [entry.tick for entry in tripped] == [stopped]
    assert tripped[0].text.startswith("fragile: tripped: ")


def test_every_twin_has_its_own_figures() -> None:
    result = run(scenario(twins=TWINS))
    alone = run(scenario(**TWINS["classic"], events=[event for event in EVENTS if "switch" not in event]))
    for metric in ("control.rms_error_um", "control.effort_ratio", "diagnosis.kalman.correct_fraction"):
        assert result.metrics[f"twins.classic.{metric}"] == alone.metrics[metric]
    assert result.metrics["control.rms_error_um"] != alone.metrics["control.rms_error_um"]


@pytest.mark.parametrize(
    ("twins", "field"),
    [
        ([1], "twins"),
        ({"a": 1}, "twins.a"),
        ({"A b": {}}, "twins.A b"),
        ({"a": {"seed": 2}}, "twins.a.seed"),
        ({"a": {"reference": {"kind": "step"}}}, "twins.a.reference"),
        ({"a": {"controller": {"kind": "magic"}}}, "twins.a.controller.kind"),
        ({name: {} for name in "abcd"}, "twins"),
    ],
)
def test_what_a_twin_cannot_be(twins: Any, field: str) -> None:
    with pytest.raises(InputError) as caught:
        scenario(twins=twins)
    assert caught.value.field == field
