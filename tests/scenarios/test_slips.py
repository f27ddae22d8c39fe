"""Slips of people in documents: each is refused when the document is read, in one line that helps."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import Field

from core.errors import InputError, did_you_mean, unknown
from core.registry import FAMILIES, blocks
from core.table import Table
from scenarios.campaign.sweep import Sweep
from scenarios.edit import parse_assignment, with_values
from scenarios.lecture import Lecture
from scenarios.library import get, ids
from scenarios.schema import Scenario
from scenarios.sheets.read import read_sheet
from server.api.examples import SHEET

BENCH: dict[str, Any] = {
    "id": "slips",
    "sample_rate_khz": 100,
    "samples": 100,
    "device": {"id": "ch3"},
    "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 2000.0},
    "diagnosers": {"kalman": {"kind": "mmae", "hypotheses": [{"name": "a"}, {"name": "b", "mass": 1.05}]}},
    "expect": [{"metric": "control.rms_error_um", "max": 1.0}],
    "events": [{"at_sample": 10, "fault": "added_mass", "severity": 0.05}],
}


def refused(values: dict[str, Any]) -> InputError:
    with pytest.raises(InputError) as caught:
        with_values(Scenario.load(BENCH), values)
    assert "\n" not in str(caught.value)
    return caught.value


@pytest.mark.parametrize(
    ("event", "field", "hint"),
    [
        ({"fault": "added_mas", "severity": 0.05}, "fault", "added_mass"),
        ({"heal": ["added_mas"]}, "heal", "added_mass"),
        ({"switch": "mrak"}, "switch", "mrac"),
        ({"set": {"reference.amplitud_v": 5.0}}, "reference.amplitud_v", "amplitude_v"),
        ({"set": {"sensr.noise_um": 0.1}}, "sensr", "sensor"),
        ({"fault": "shock", "severity": 1.0, "parameters": {"pulse": 1.0}}, "parameters.pulse", "pulse_ms"),
    ],
)
def test_an_event_with_a_slip_is_refused_when_the_scenario_is_read(event: Any, field: str, hint: str) -> None:
    error = refused({"events": [{"at_sample": 10, **event}]})
    assert error.field == f"events.0.{field}" and error.hint.startswith(f"did you mean {hint}"), error.as_dict()


def test_a_condition_on_no_signal_and_a_severity_out_of_range_are_refused_too() -> None:
    fault = {"fault": "added_mass", "severity": 0.05}
    error = refused({"events": [{"when": "plant.displacment > 1", **fault}]})
    assert (error.field, error.hint) == ("events.0.when", "did you mean plant.displacement?")
    assert refused({"events": [{"at_sample": 1, **fault, "severity": 500.0}]}).field == "events.0.severity"


TEXTS = {
    "sample_rate_khz": "100",
    "samples": "100",
    "seed": "1",
    "reference.amplitude_v": "10",
    "device.mass_kg": "2e-10",
    "environment.temperature_k": " 300",
    "model.numerator": ["1.0"],
    "plant.thermal_noise": "true",
    "events.0.severity": "0.05",
    "expect.0.max": "1",
    "diagnosers.kalman.hypotheses.1.mass": "1.05",
}


@pytest.mark.parametrize("path", TEXTS)
def test_a_number_in_quotes_is_refused(path: str) -> None:
    head, _, rest = path.partition(".")
    if head in ("events", "expect"):
        place, _, leaf = rest.partition(".")
        error = refused({head: [{**BENCH[head][int(place)], leaf: TEXTS[path]}]})
    elif "hypotheses" in path:
        error = refused({"diagnosers.kalman.hypotheses": [{"name": "a"}, {"name": "b", "mass": TEXTS[path]}]})
    else:
        error = refused({path: TEXTS[path]})
    assert error.field == path and error.message.startswith("must be ") and "got" in error.message, error.as_dict()


def test_each_parameter_of_each_block_that_is_a_number_refuses_its_default_in_quotes() -> None:
    for family in FAMILIES:
        for block in blocks(family).values():
            for name, info in block.Params.model_fields.items():
                if isinstance(info.default, int | float):
                    with pytest.raises(ValueError, match=name):
                        block.Params.model_validate({name: str(info.default)})


def test_campaigns_lectures_and_sheets_refuse_numbers_in_quotes() -> None:
    campaign = {"scenario": "first-look", "latin_hypercube": {"points": "4", "ranges": {"sensor.noise_um": {}}}}
    with pytest.raises(InputError, match=r"latin_hypercube.points: must be a whole number"):
        Sweep(campaign)
    lecture = 'title = "Mine"\nchapter = "1"\nsummary = "A"\n[[cue]]\ntitle = "A"\nsay = "A"\n'
    with pytest.raises(InputError, match="chapter: must be a whole number"):
        Lecture.load("mine", lecture)
    with pytest.raises(InputError, match="minutes: must be a"):
        read_sheet(SHEET.replace("minutes = 5", 'minutes = "5"'), "mine")


def test_the_ends_of_open_ranges_may_be_texts() -> None:
    row = {"metric": "control.rms_error_um", "max": 1.0, "published": "small", "published_range": ["-inf", 1.0]}
    assert with_values(Scenario.load(BENCH), {"expect": [row]}).head.expect[0].published_range == (-float("inf"), 1.0)


def test_a_bare_number_of_the_command_line_is_one_in_any_notation() -> None:
    for text, value in ((".5", 0.5), ("5.", 5.0), ("+.5e-3", 5e-4), ("10", 10), ("pid", "pid"), ("1.2.3", "1.2.3")):
        assert parse_assignment(f"a={text}") == ("a", value)


@pytest.mark.parametrize("scenario", [BENCH, {**BENCH, "samples": None, "duration_ms": 1.0}])
def test_a_length_takes_the_place_of_the_other(scenario: dict[str, Any]) -> None:
    scenario = {name: value for name, value in scenario.items() if value is not None}
    read = Scenario.load(scenario)
    assert with_values(read, {"samples": 50}).samples == 50
    assert with_values(read, {"duration_ms": 0.2}).samples == 20
    with pytest.raises(InputError, match="not both"):
        with_values(read, {"samples": 50, "duration_ms": 0.2})


def test_each_length_of_the_library_can_be_given_in_samples() -> None:
    timed = [name for name in ids() if get(name).head.duration_ms is not None]
    assert timed and all(with_values(get(name), {"samples": 50}).samples == 50 for name in timed)


def test_of_many_names_the_nearest_is_said() -> None:
    signals = [f"{block}.{port}" for block in ("plant", "model", "sensor") for port in ("speed", *"abcdefghijklmn")]
    near = unknown("signal", "plant.sped", signals)
    assert (near.message, near.hint) == (
        "unknown signal 'plant.sped'; allowed: 45 names",
        "did you mean plant.speed?",
    )
    assert did_you_mean("my_own_favourite_thing.speed", signals) == (
        "did you mean plant.speed or model.speed or sensor.speed?"
    )
    assert unknown("signal", "zzz", signals).message.endswith("45 names, which begin with plant, model, sensor")
    assert unknown("track", "zzz", ["known", "drift"]).message.endswith("allowed: known, drift")


class Mixed(Table):
    """A table whose fields take numbers beside other things."""

    either: float | str = 1.0
    named: dict[str, float] = Field(default_factory=dict)


def test_a_text_stays_one_where_texts_are_allowed() -> None:
    assert Mixed(either="10").either == "10" and Mixed(named={"1": 2.0}).named == {"1": 2.0}
