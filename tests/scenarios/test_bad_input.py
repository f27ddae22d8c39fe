"""Bad input is refused in one line that names its field."""

from __future__ import annotations

import copy
import math
from typing import Any

import pytest

from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from scenarios.schema import Scenario
from tests.lab import document

BAD: list[tuple[dict[str, Any], str]] = [
    ({"sensor.noise_nm": 5}, "sensor.noise_nm"),
    ({"sensor.noise": 5}, "sensor.noise"),
    ({"sensor.noise_um": "loud"}, "sensor.noise_um"),
    ({"sensor.noise_um": "0.6 um"}, "sensor.noise_um"),
    ({"sensor.noise_um": -0.1}, "sensor.noise_um"),
    ({"sensor.noise_um": math.nan}, "sensor.noise_um"),
    ({"sensor.noise_um": math.inf}, "sensor.noise_um"),
    ({"sensor.noise_um": [1]}, "sensor.noise_um"),
    ({"sensor.kind": "perfect"}, "sensor.kind"),
    ({"sensor.kind": 3}, "sensor.kind"),
    ({"sensor": 3}, "sensor"),
    ({"reference.kind": "sinus"}, "reference.kind"),
    ({"reference": {"kind": "sine"}}, "reference"),
    ({"reference.amplitude_um": 1.0}, "reference"),
    ({"reference.frequency_hz": -5}, "reference.frequency_hz"),
    ({"reference.frequency_khz": 2}, "reference.frequency_khz"),
    ({"controller.kind": "pdi"}, "controller.kind"),
    ({"controller": {"kind": "pid", "gain": 1}}, "controller.gain"),
    ({"controllers.pid.pole": 99}, "controllers.pid.pole"),
    ({"controllers.nobody.gain": 1}, "controllers"),
    ({"plant.model": "quadratic"}, "plant.model"),
    ({"plant.drive": "wireless"}, "plant.drive"),
    ({"drive.kind": "wireless"}, "drive.kind"),
    ({"plant.mass": 1}, "plant.mass"),
    ({"device.id": "ch7"}, "device.id"),
    ({"device.id": [1]}, "device.id"),
    ({"device.mass_g": 1}, "device.mass_g"),
    ({"device.mass_kg": 1e-300}, "device.mass_kg"),
    ({"device.mass_kg": 1e300}, "device.mass_kg"),
    ({"device.mass_kg": True}, "device.mass_kg"),
    ({"device.stiffness_n_m": 1e300}, "device.stiffness_n_m"),
    ({"device.bias_v": 1e-300}, "device.bias_v"),
    ({"device": {"transfer_function": {"denominator": [1e-9, -1e9]}}, "plant": {}}, "device.transfer_function"),
    ({"device": {"id": "lcr-350", "geometry": {"beam_length_um": 1e5, "beam_width_um": 0.5}}}, "device"),
    ({"device": {"transfer_function": {"denominator": [1.0, 1e-300]}}}, "device.transfer_function.denominator.1"),
    ({"device.mass_kg": 0}, "device.mass_kg"),
    ({"device.geometry.fingers": 3.5}, "device.geometry.fingers"),
    ({"sample_rate_khz": 0}, "sample_rate_khz"),
    ({"sample_rate_hz": 5}, "sample_rate_hz"),
    ({"seed": -1}, "seed"),
    ({"seed": 1.5}, "seed"),
    ({"seed": True}, "seed"),
    ({"samples": 0}, "samples"),
    ({"samples": True}, "samples"),
    ({"duration_ms": 1e308}, "duration_ms"),
    ({"duration_ms": 1e11}, "duration_ms"),
    ({"sensor.noise_um": True}, "sensor.noise_um"),
    ({"metrics": {"tail_share": math.nan}}, "metrics.tail_share"),
    ({"metrics": {"tail_share": 0}}, "metrics.tail_share"),
    ({"metrics": {"tail_share": -1}}, "metrics.tail_share"),
    ({"metrics": {"tail_share": 2}}, "metrics.tail_share"),
    ({"metrics": {"since_ms": -5}}, "metrics.since_ms"),
    ({"metrics": {"since_ms": math.inf}}, "metrics.since_ms"),
    ({"metrics": {"since": 5}}, "metrics.since"),
    ({"samples": 100, "duration_ms": 3.0}, "duration_ms"),
    ({"schema": 2}, "schema"),
    ({"id": "No Spaces"}, "id"),
    ({"verdict": 1}, "verdict"),
    ({"nonsense": 1}, "nonsense"),
    ({"diagnosers.kalman.kind": "oracle"}, "diagnosers.kalman.kind"),
    ({"diagnosers.Kal man.kind": "mmae"}, "diagnosers.Kal man"),
    ({"diagnosers.kalman": {"kind": "mmae", "probability_floor": 0.2}}, "diagnosers.kalman.probability_floor"),
    ({"diagnosers.kalman": {"kind": "mmae", "hypotheses": []}}, "diagnosers.kalman.hypotheses"),
    (
        {"diagnosers.kalman": {"kind": "mmae", "hypotheses": [{"name": "a"}, {"name": "a"}]}},
        "diagnosers.kalman",
    ),
    (
        {"diagnosers.kalman": {"kind": "mmae", "hypotheses": [{"name": "a"}, {"name": "b", "mass": -1}]}},
        "diagnosers.kalman.hypotheses.1.mass",
    ),
    ({"diagnosers.kalman": {"kind": "mmae", "every": 0}}, "diagnosers.kalman.every"),
    ({"events": [{"at_sample": 1}]}, "events.0"),
    ({"events": [{"fault": "damping", "severity": 1.0}]}, "events.0"),
    ({"events": [{"at_sample": 1, "fault": "damping"}]}, "events.0.severity"),
    ({"events": [{"at_sample": 1, "heal": "all"}, {"at_ms": 1, "fault": "dampling", "severity": 1}]}, "events.1.fault"),
    ({"events": [{"at_sample": 1, "fault": "damping", "severity": 1e9}]}, "events.0.severity"),
    ({"events": [{"at_sample": 1, "fault": "damping", "severity": math.nan}]}, "events.0.severity"),
    ({"events": [{"at_ms": 1, "fault": "damping", "severity": 1, "profile": {"kind": "x"}}]}, "events.0.profile.kind"),
    ({"events": [{"at_sample": 1, "at_ms": 2.0, "heal": "all"}]}, "events.0"),
    ({"events": [{"when": "nothing > 1", "heal": "all"}]}, "events.0.when"),
    ({"events": [{"when": "@nothing > -1", "heal": "all"}]}, "events.0.when"),
    ({"events": [{"when": "drive.middle > -1", "heal": "all"}]}, "events.0.when"),
    ({"events": [{"at_ms": 1e308, "heal": "all"}]}, "events.0.at_ms"),
    ({"events": [{"at_sample": 1, "set": {"sensor.noise_nm": 1}}]}, "events.0.sensor.noise_nm"),
    ({"events": [{"at_sample": 1, "switch": "nobody"}]}, "events.0.switch"),
    ({"events": [{"at_sample": 1, "explode": True}]}, "events.0.explode"),
    ({"expect": [{"metric": "x"}]}, "expect.0"),
    ({"expect": [{"metric": "x", "value": 1.0}]}, "expect.0"),
    ({"expect": [{"min": 1.0}]}, "expect.0.metric"),
    ({"expect": [{"metric": "x", "min": math.nan}]}, "expect.0.min"),
    ({"expect": [{"metric": "x", "min": 2.0, "max": 1.0}]}, "expect.0"),
]  # fmt: skip


def refusal(values: dict[str, Any]) -> InputError | None:
    """Return the error with which a bench with these values is refused."""
    whole = copy.deepcopy(document())
    for path, value in values.items():
        table = whole
        *parents, leaf = path.split(".")
        for part in parents:
            table = table.setdefault(part, {})
        table[leaf] = value
    try:
        build(Scenario.load(whole))
    except InputError as error:
        return error
    return None


def test_bad_input_is_refused_with_its_field():
    wrong = []
    for values, field in BAD:
        error = refusal(values)
        text = str(error)
        one_line = "\n" not in text and text.startswith(f"{field}: ") and len(text) > len(field) + 8
        wrong += [] if error is not None and error.field == field and one_line else [(str(values)[:200], text)]
    assert wrong == []


def test_malformed_toml():
    for text in ("a = ", "schema = 1\n[device", "schema = 1\nschema = 1", "\x00", "x = 1e", "[[events]\n"):
        with pytest.raises(InputError, match="malformed TOML") as error:
            Scenario.load(text)
        assert error.value.code == "malformed" and "\n" not in str(error.value), text
        assert "line" in str(error.value) or "end of document" in str(error.value), text


def test_a_scenario_must_be_a_table():
    for thing in (None, 3, [], [1]):
        with pytest.raises(InputError):
            Scenario(thing)


def test_the_hint_names_the_field_that_was_meant():
    for path, word in (
        ("sensor.noise_nm", "noise_um"),
        ("sensor.nois_um", "noise_um"),
        ("device.mass_g", "mass_kg"),
        ("reference.amplitud_v", "amplitude_v"),
    ):
        with pytest.raises(InputError) as error:
            with_values(Scenario.load(document()), {path: 1.0})
        assert word in f"{error.value} {error.value.hint}", path


def test_paths_that_lead_nowhere_are_refused():
    for path in (
        *("", "a..b", "seed.deep", "events.5.severity", "events.x.severity", "events.².severity"),
        *(f"events.{'9' * 5000}.severity", "sensor.noise_um.x"),
    ):
        with pytest.raises(InputError):
            with_values(get("ch5-seven-step"), {path: 1})


def test_a_condition_is_offered_no_signal_that_cannot_be_seen():
    with pytest.raises(InputError) as error:
        build(Scenario.load(document({"events": [{"when": "displacement@2 > 1", "heal": "all"}]})))
    assert (
        "plant.displacement" in error.value.hint and "@" not in error.value.message.partition(";")[2] + error.value.hint
    )


def test_no_diagnoser_or_identifier_has_the_name_of_another_part():
    """The names of parts come before the first dot of the signals of a bench without diagnosers."""
    board = build(Scenario.load(document()))
    names = {name.split(".")[0] for name in board.signals.names} | {"tick", "time_ms"}
    for key, kind in (("diagnosers", "mmae"), ("identifiers", "excitation")):
        for name in names:
            with pytest.raises(InputError) as error:
                Scenario.load(document({f"{key}.{name}": {"kind": kind}}))
            assert error.value.field == f"{key}.{name}" and "plant" in error.value.message


def test_a_controller_this_device_has_no_use_for_keeps_its_name():
    plain = {"device": {"id": "first-order-gain"}, "plant": {}, "diagnosers": {"mrac": {"kind": "cusum"}}}
    with pytest.raises(InputError) as error:
        Scenario.load({**document(), **plain})
    assert error.value.field == "diagnosers.mrac"


def test_amplitude_in_micrometres_needs_a_device_that_moves():
    still = {"device": {"id": "lcr-350", "opposite_bias_v": 10.0}, "reference": {"kind": "sine", "amplitude_um": 1.0}}
    with pytest.raises(InputError):
        build(Scenario.load(document(still)))
