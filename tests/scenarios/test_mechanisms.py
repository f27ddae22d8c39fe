"""Claims of the sections: an expectation fails once the mechanism of the claim is taken out of its scenario."""

from __future__ import annotations

from typing import Any

import pytest

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run

WITHOUT: list[tuple[str, dict[str, Any], str]] = [
    ("ch1-temperature", {"environment.temperature_k": 300.0}, "decay.damping_ns_m"),
    ("ch1-temperature", {"environment.temperature_k": 300.0}, "decay.period_us"),
    ("ch2-beams", {"sensor.kind": "peak_valley"}, "sensing.rms_error_nm"),
    ("ch2-beams", {"sensor.kind": "peak_valley"}, "sensing.direction_lost_fraction"),
    ("ch2-beams", {"twins.filtered.sensor.kind": "peak_valley"}, "twins.filtered.sensing.rms_error_nm"),
    ("ch3-normaliser", {"controller.normaliser": 0.0}, "control.peak_error_um"),
    ("ch3-normaliser", {"twins.more.controller.normaliser": 10.0}, "twins.more.control.peak_error_um"),
    ("ch4-augmentation", {"controller.form": "relative_degree_one"}, "control.tail_rms_error_um"),
    ("ch4-augmentation", {"events": []}, "twins.unfiltered.control.tail_rms_error_um"),
    ("ch4-bandwidth", {"controller.form": "relative_degree_one"}, "control.tail_rms_error_um"),
    ("ch4-constant-reference", {"controller.kind": "open_loop"}, "control.tail_rms_error_um"),
    ("ch4-constant-reference", {"events": []}, "twins.vsc.control.tail_rms_error_um"),
    ("ch5-short-circuit", {"events": []}, "control.tail_rms_error_um"),
    ("ch5-short-circuit", {"events": []}, "twins.mrac.control.tail_rms_error_um"),
    ("ch5-short-circuit", {"events": []}, "diagnosis.consistency.unknown"),
]


@pytest.mark.parametrize(
    ("scenario", "values", "metric"), WITHOUT, ids=lambda value: value if isinstance(value, str) else ""
)
def test_without_its_mechanism_the_expectation_fails(scenario, values, metric):
    found = {row["metric"]: row for row in run(with_values(get(scenario), values)).expectations()}
    assert not found[metric]["ok"]
