"""Points that differ by numbers alone are read from one another as they are read by themselves."""

from __future__ import annotations

from typing import Any

import pytest

from core.errors import InputError
from scenarios.campaign.campaign import compute
from scenarios.campaign.outcome import RunOutcome
from scenarios.campaign.points import Point
from scenarios.key import code_version
from scenarios.library import get
from scenarios.schema import Scenario

FIELDS: list[tuple[str, dict[str, list[Any]]]] = [
    ("ch5-seven-step", {"device.mass_kg": [2.0e-10, 2.4e-10], "device.damping_ns_m": [7.0e-7, 6.5e-7]}),
    ("ch5-seven-step", {"sensor.noise_um": [0.05, 0.1], "sample_rate_khz": [100.0, 50.0]}),
    ("ch5-seven-step", {"reference.amplitude_um": [1.0, 2.0], "diagnosers.kalman.probability_floor": [1e-3, 1e-2]}),
    ("ch3-stvsc-mass", {"controller.layer_um": [0.01, 0.02], "plant.drive_noise_v": [0.0, 0.01]}),
    ("ch3-stvsc-mass", {"duration_ms": [5.0, 6.0], "device.bias_v": [19.0, 20.0]}),
    ("ch5-light-two-devices", {"device.mass_kg": [2.0e-10, 2.4e-10], "twins.heavier.plant.drive_noise_v": [0.0, 0.1]}),
    ("gyro-small-rates", {"environment.temperature_k": [300.0, 310.0], "sensor.noise_pm_rthz": [0.05, 0.06]}),
    ("ch5-seven-step", {"controller.kind": ["stvsc", "open_loop"], "device.bias_v": [5.0, 6.0]}),
    ("ch5-seven-step", {"metrics.since_ms": [1.0, 2.0]}),
]


def points(name: str, fields: dict[str, list[Any]]) -> list[Point]:
    base = dict(get(name).document)
    return [Point({}, dict(zip(fields, values, strict=True)), base) for values in zip(*fields.values(), strict=True)]


@pytest.mark.parametrize(("name", "fields"), FIELDS)
def test_a_point_read_from_another_is_the_point_read_by_itself(name: str, fields: dict[str, list[Any]]) -> None:
    one, other = points(name, fields)
    by_itself = Scenario.load(other.document)
    for given in (one, other):  # the point before, and the point itself
        read = other.read((given, given.read()))
        assert (read.document, read.bench) == (by_itself.document, by_itself.bench)
        assert repr(read.spec) == repr(by_itself.spec) and read.spec == by_itself.spec
        assert (read.head, read.events, read.samples) == (by_itself.head, by_itself.events, by_itself.samples)
        assert read.twins == by_itself.twins


@pytest.mark.parametrize(
    ("field", "value", "why"),
    [("sensor.noise_um", -1.0, "sensor.noise_um: "), ("sample_rate_khz", 1e5, "samples")],
)
def test_a_point_is_refused_by_the_field_as_it_is_written(field: str, value: float, why: str) -> None:
    good, bad = points("ch5-seven-step", {"device.bias_v": [5.0, 6.0], field: [2.0, value]})
    bad.base.update(samples=None, duration_ms=9000.0)
    with pytest.raises(InputError, match=why) as refused:
        bad.read((good, good.read()))
    with pytest.raises(InputError) as by_itself:
        Scenario.load(bad.document)
    assert str(refused.value) == str(by_itself.value)


def test_points_after_a_refused_one_are_computed() -> None:
    masses = {"device.mass_kg": [2.0e-10, -1.0, 2.2e-10], "duration_ms": [5.0] * 3}
    runs = [(f"{number}", point, 1) for number, point in enumerate(points("ch5-seven-step", masses))]
    found = {key: RunOutcome.model_validate_json(text) for key, text in compute(runs, code_version())[0]}
    assert [bool(found[key].error) for key in "012"] == [False, True, False]
    assert "device.mass_kg" in found["1"].error and found["0"].digest != found["2"].digest
