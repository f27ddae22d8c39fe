"""A released shuttle decays by beta/2m; transfer functions combined as in A.11."""

from __future__ import annotations

import math

import pytest

from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from scenarios.schema import Scenario
from scenarios.studies import studies


@pytest.mark.parametrize("damping", [2.0e-7, 2.1e-6])
def test_the_decay_of_another_damping(damping):
    r"""Peaks fall as :math:`e^{-\beta t/2m}`, and :math:`1/\sqrt{1-\zeta^2}` times the start bounds the swing."""
    mass, stiffness = 2.2090e-10, 0.0538
    figures = run(with_values(get("appA-exponential"), {"device.damping_ns_m": damping})).metrics
    ratio = damping / (2.0 * math.sqrt(mass * stiffness))
    assert figures["decay.rate_per_s"] == pytest.approx(damping / (2.0 * mass), rel=2e-4)
    assert figures["decay.bound"] == pytest.approx(1.0 / math.sqrt(1.0 - ratio**2), rel=2e-4)
    assert figures["decay.damping_ns_m"] == pytest.approx(damping, rel=2e-4)
    natural = math.sqrt(stiffness / mass * (1.0 - ratio**2))
    assert figures["decay.period_us"] == pytest.approx(2e6 * math.pi / natural, rel=2e-4)


def test_a_start_to_either_side_gives_the_same():
    there = run(get("appA-exponential")).metrics
    other = run(with_values(get("appA-exponential"), {"plant.initial_displacement_um": -4.0})).metrics
    assert all(other[name] == pytest.approx(there[name]) for name in there if name.startswith("decay."))


def test_the_picture_shows_the_decay_under_its_peaks():
    scenario = get("appA-exponential")
    study, params = scenario.study
    picture = study.picture(run(scenario).board, params)
    (_, time_ms, x), (_, at_ms, size) = picture.curves
    assert x[0] == 4.0 and len(time_ms) == len(x) <= 700
    assert size == sorted(size, reverse=True) and at_ms == sorted(at_ms)


@pytest.mark.parametrize("values", [{"plant.initial_displacement_um": 0.0}, {"device.damping_ns_m": 2e-5}])
def test_what_does_not_swing_is_refused(values):
    with pytest.raises(InputError) as refused:
        run(with_values(get("appA-exponential"), values))
    assert refused.value.field == "study.duration_ms"


def test_a_loop_closed_by_what_is_not_positive_real_is_not():
    """1/(s+1) closed by 10/(s+1)^2 is (s+1)^2/((s+1)^3+10), whose real part turns negative."""
    cases = [
        {"name": "first", "numerator": [1.0], "denominator": [1.0, 1.0]},
        {"name": "second", "numerator": [10.0], "denominator": [1.0, 2.0, 1.0]},
    ]
    figures = run(with_values(get("appA-feedback"), {"study.cases": cases})).metrics
    assert (figures["spr.first"], figures["spr.second"], figures["spr.feedback"]) == (2.0, 0.0, 0.0)
    assert figures["spr.inverse"] == 2.0


def test_one_case_cannot_be_combined():
    study = {"kind": "positive_real", "combine": True, "cases": []}
    with pytest.raises(InputError) as refused:
        Scenario.load({"schema": 1, "device": {"id": "ch3"}, "study": study})
    assert refused.value.field.startswith("study") and "two cases" in refused.value.message
    assert "free_decay" in studies()
