"""Unlike resonators under one reference: against phasors in closed form."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from scenarios.studies.coherence import Coherence

OPEN = [{"name": "open_loop", "controller": {"kind": "open_loop"}}]
DEVICES = {"heavy_stiff": (1.05, 1.3, 1.0), "light_soft": (0.9, 0.8, 1.5)}


def phasor(mass: float, stiffness: float, damping: float, hz: float, volts: float, force: float) -> complex:
    """Return the displacement of the device of chapter 3 with these factors, um."""
    w = 2.0 * np.pi * hz
    return 1e6 * force * volts / (0.0538 * stiffness - 2.209e-10 * mass * w * w + 7.09e-7 * damping * 1j * w)


def test_without_control_resonators_are_as_far_apart_as_their_phasors():
    scenario = with_values(get("ch3-two-unlike"), {"study.laws": OPEN})
    result = run(scenario)
    hz, force = scenario.spec.tone_hz, scenario.spec.nominal.force * 1e-6
    first, second = (phasor(*factors, hz, 10.0, force) for factors in DEVICES.values())
    assert result.metrics["coherence.open_loop.difference_um"] == pytest.approx(
        abs(first - second) / np.sqrt(2), rel=2e-3
    )
    design = phasor(1.0, 1.0, 1.0, hz, 10.0, force)
    worst = max(abs(first - design), abs(second - design)) / np.sqrt(2)
    assert result.metrics["coherence.open_loop.error_um"] == pytest.approx(worst, rel=2e-3)
    assert result.metrics["coherence.open_loop.settling_ms"] == pytest.approx(100.0, abs=1.2)


def test_like_resonators_are_not_apart():
    """Without noise two boards of one device give the same bits; of three, the pair farthest apart counts."""
    same = [{"name": "first", "faults": {"stiffness": 0.3}}, {"name": "second", "faults": {"stiffness": 0.3}}]
    figures = run(with_values(get("ch3-two-unlike"), {"study.laws": OPEN, "study.resonators": same})).metrics
    assert figures["coherence.open_loop.difference_um"] == 0.0 and figures["coherence.open_loop.settling_ms"] == 0.0
    assert figures["coherence.open_loop.error_um"] > 0.1
    three = [*same, {"name": "third", "faults": {"stiffness": 0.1}}]
    found = {}
    for pair in ([0, 1, 2], [0, 2]):
        devices = [three[i] for i in pair]
        values = {"study.laws": OPEN, "study.resonators": devices, "study.samples": 2000}
        found[len(pair)] = run(with_values(get("ch3-two-unlike"), values)).metrics["coherence.open_loop.difference_um"]
    assert found[3] == found[2] > 0.1


def test_without_adaptation_resonators_do_not_swing_alike():
    """The rows of the adaptive laws do not hold without their adaptation."""
    laws = [
        {"name": "mrac", "controller": {"kind": "mrac", "adaptation_gain": 1e-9}},
        {"name": "stvsc", "controller": {"kind": "vsc"}},
    ]
    rows = run(with_values(get("ch3-two-unlike"), {"study.laws": laws})).expectations()
    found = {row["metric"]: row["ok"] for row in rows}
    for name in ("mrac.difference_um", "mrac.settling_ms", "stvsc.difference_um"):
        assert not found[f"coherence.{name}"]


def test_a_law_under_which_a_guard_trips_has_no_figures():
    laws = [
        *OPEN,
        {"name": "wild", "controller": {"kind": "self_sliding", "form": "relative_degree_one", "adaptation_gain": 1.0}},
    ]
    scenario = with_values(get("ch3-two-unlike"), {"study.laws": laws, "guard.travel_um": 8.0, "study.samples": 4000})
    figures = run(scenario).metrics
    assert {name.split(".")[1] for name in figures if name.startswith("coherence.")} == {"open_loop"}


def test_the_picture_is_the_difference_of_the_first_two():
    scenario = with_values(get("ch3-two-unlike"), {"study.laws": OPEN, "study.samples": 3000})
    (_, params), board = scenario.study, run(scenario).board
    picture = Coherence.picture(board, params)
    ((name, times, values),) = picture.curves
    assert name == "open_loop" and len(times) == len(values) == 3000
    late = np.array(values)[1500:]
    figure = Coherence.figures(board, params)["coherence.open_loop.difference_um"]
    assert np.sqrt(np.mean(late * late)) == pytest.approx(figure, rel=1e-12)
    assert all(later > earlier for earlier, later in itertools.pairwise(times))
