"""Diagnosis of a controlled device: what feedback, adaptation and lack of excitation do to it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from tests.lab import inject, make, play, rms
from tests.physics.bank import BENCH, BETA, FORCE, K, M, of_bank
from tests.physics.seeds import EDGES, chunks, seven_steps

BANKS: dict[str, dict[str, Any]] = {"kalman": {"kind": "mmae", "process_noise_v": 0.3}, "imm": {"kind": "imm"}}


def check_loop(seeds: range, tolerance: float) -> None:
    sine = seven_steps(seeds, BANKS, base="ch5-closed-loop", sensor__noise_um=0.05)
    assert sine["kalman"].correct >= 0.975 and sine["imm"].correct >= 0.985
    assert sine["kalman"].correct == pytest.approx(0.990, abs=tolerance)
    still = seven_steps(seeds, BANKS, base="ch5-closed-loop-constant", sensor__noise_um=0.05)
    assert still["kalman"].correct <= 0.80 and still["kalman"].missed[1] >= 0.9
    # stiffness shows in the static displacement, mass does not
    assert still["kalman"].delays[3] <= 20 and still["kalman"].missed[3] == 0
    dither = seven_steps(seeds, BANKS, base="ch5-closed-loop-dither", sensor__noise_um=0.05)
    assert dither["kalman"].correct >= 0.96 and np.all(dither["kalman"].missed == 0)


def test_feedback_does_no_harm_and_lack_of_excitation_does():
    check_loop(range(1, 4), 0.006)


@pytest.mark.long
def test_feedback_and_excitation_over_many_seeds():
    check_loop(range(101, 126), 0.003)


@pytest.mark.parametrize(("base", "limit"), [("ch5-closed-loop", 8.0), ("ch5-closed-loop-dither", 14.0)])
def test_the_bank_is_fed_the_voltage_that_was_applied(base, limit):
    """With the command of the controller instead, beyond the limit, no filter would be right."""
    scenario = with_values(get(base), {"drive.limit_v": limit, "expect": [], "samples": 2000, "events": []})
    board = build(scenario, 5)
    asked, applied, right = [], [], []
    names = list(board.signals.names)
    for rows in chunks(board, 2000):
        whole = np.hstack([rows.outputs, rows.taps])
        asked.append(whole[:, names.index("pid.voltage")].copy())
        applied.append(whole[:, names.index("drive.voltage")].copy())
        right.append(whole[:, names.index("kalman.winner")].copy())
    limited = np.abs(np.concatenate(asked)) > limit
    assert limited.mean() > 0.05 and np.abs(np.concatenate(applied)).max() <= limit
    assert np.mean(np.concatenate(right)[200:] == 0) > 0.97


def test_a_shuttle_held_still_is_warned_of():
    """The log says that the drive hardly tells the likeliest two apart, and dither takes the warning away."""

    def warned(base: str) -> tuple[float, bool]:
        board = build(with_values(get(base), {"expect": [], "events": []}), 3)
        column = board.signals.index("kalman.unexcited") - board.signals.outputs
        flags = np.concatenate([rows.taps[:, column].copy() for rows in chunks(board, 4000)])
        said = any("hardly tells" in entry.text for entry in board.log if entry.kind == "unexcited")
        return float(flags[1000:].mean()), said

    still, said = warned("ch5-closed-loop-constant")
    assert still > 0.7 and said
    assert warned("ch5-closed-loop-dither")[0] < 0.05


def adapted(kind: str, seed: int) -> tuple[float, float]:
    """Play the seven steps at 20 V under a controller; return the rms off the model at k+10 and the share right."""
    values = {
        "reference.amplitude_v": 20.0,
        "controller": {"kind": kind, **({"adaptation_gain": 1.0} if kind == "mrac" else {})},
        "drive": {"limit_v": 60.0},
        "sensor.noise_um": 0.01,
        "diagnosers": {"kalman": BANKS["kalman"]},
        "expect": [],
    }
    board = build(with_values(get("ch5-seven-step"), values), seed)
    x, model = (board.signals.index(f"{name}.displacement") for name in ("plant", "model"))
    parts = [rows.outputs[:, [x, model]].copy() for rows in chunks(board, 9000)]
    apart = np.diff(np.vstack(parts), axis=1)[:, 0]
    return rms(apart[EDGES[5] - 250 : EDGES[5]]), board.scores()["kalman"].correct_fraction


def test_under_adaptation_the_error_is_no_sign_of_a_fault_and_the_bank_is():
    (without, plain), (adapting, found) = adapted("open_loop", 2), adapted("mrac", 2)
    # without adaptation the shuttle is off by the difference of the phasors
    w = 2 * math.pi * 2000
    phasors = [FORCE * 20e6 / complex(k * K - M * w**2, BETA * w) for k in (1.0, 1.1)]
    assert without == pytest.approx(abs(phasors[0] - phasors[1]) / math.sqrt(2), rel=0.02)
    assert without / adapting >= 10
    assert found >= 0.985 and plain >= 0.985


def test_two_tones_part_what_one_cannot():
    """A mass and its alias at 2 kHz; with a second tone they are two points again (section 5.1.3.3)."""
    alias = 1 - 0.05 * M * (2 * math.pi * 2000) ** 2 / K
    pair = [{"name": "m+5", "mass": 1.05}, {"name": "alias", "stiffness": alias}]

    def share(tones: list[dict[str, float]]) -> float:
        reference = {"kind": "multi_sine", "amplitude_v": 7.0, "tones": tones}
        board = make({**BENCH, "reference": reference, "diagnosers": {"kalman": {"kind": "imm", "hypotheses": pair}}})
        board.advance(1)
        inject(board, stiffness=alias - 1)
        trace = play(board, 6000)
        return float(np.mean(of_bank(trace, "probability", ["alias"])[1000:]))

    one, two = share([{"frequency_hz": 2000.0}]), share([{"frequency_hz": 2000.0}, {"frequency_hz": 1000.0}])
    assert two > 0.99
    assert one < 0.9
