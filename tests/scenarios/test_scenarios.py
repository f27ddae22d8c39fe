"""Scenarios: the library holds what it promises, every field can be reached, bad input is named."""

from __future__ import annotations

import json
from typing import Any

import pytest

from core import registry
from core.board.commands import parse_event
from core.device.catalogue import device
from core.device.device import Device
from core.device.drawn_gyroscope import DrawnGyroscope
from core.device.geometry import Geometry
from core.errors import InputError
from core.loop.axis_drive import AxisDrive
from core.loop.axis_guard import AxisGuard
from core.loop.drive import Drive
from core.loop.guard import Guard
from core.loop.model import Model
from scenarios.edit import parse_assignment, with_values
from scenarios.expectation import Expectation
from scenarios.library import get, library
from scenarios.run import run
from scenarios.schema import Head, Scenario
from tests.lab import document

RESONATOR = device({}).oscillator()
LIBRARY = [pytest.param(entry, id=entry.id) for entry in library()]


# -- the library


ADAPTIVE_CHAPTERS = """
    ch3-mrac-mass-x10 ch3-mrac-damping-x5 ch3-mrac-spring-x2 ch3-case1-aged-mass ch3-case2-broken-truss
    ch3-case3-adhesion ch3-ageing-four-weeks ch3-stvsc-mass ch3-stvsc-long-stroke ch3-stvsc-pull-in ch3-pull-in-map
    ch3-ffrls-b10 ch3-ffrls-b30 ch3-indirect-mrac ch4-regulator ch4-tracking ch4-double-integrator ch4-lcr-two-tone
    appA-spr appA-persistency appB-mit appB-lyapunov appB-dressler appB-price appB-monopoli
"""


def test_every_experiment_of_chapters_3_and_4_and_the_appendices_is_there():
    for name in ADAPTIVE_CHAPTERS.split():
        scenario = get(name)
        assert scenario.head.claim and scenario.verdict and scenario.head.expect, name


@pytest.mark.parametrize("scenario", LIBRARY)
def test_library_scenario_keeps_its_expectations(scenario):
    result = run(scenario)
    for entry in result.expectations():
        assert entry["ok"], f"{entry['metric']}: {entry['measured']}, expected {entry['expected']}"
    assert [entry["verdict"] for entry in result.expectations()] == [row.promised() for row in scenario.head.expect]
    assert result.summary()["verdict"] == scenario.verdict
    if any(entry.metric == "lateral.contact_ms" for entry in scenario.head.expect):
        assert result.trip is not None and "touched" in result.trip.reason
        return
    assert result.trip is None
    assert result.board.tick == (0 if scenario.study else scenario.samples or 10_000)


@pytest.mark.parametrize("scenario", LIBRARY)
def test_library_scenario_says_what_it_is(scenario):
    head = scenario.head
    assert head.title and head.source and head.summary
    if head.expect:
        assert head.claim and scenario.verdict
    if scenario.verdict in ("partly", "not reproduced"):
        assert any(entry.note for entry in head.expect), "what is true instead"
    assert Scenario.load(scenario.toml()).document == scenario.document


def shortened(scenario: Scenario) -> Scenario:
    if scenario.study is None:
        return with_values(scenario, {"samples": 700} if "samples" in scenario.document else {"duration_ms": 7.0})
    few = {"runs": 2, "healthy_samples": 20_000, "draws": 50}
    own = type(scenario.study[1]).model_fields
    return with_values(scenario, {f"study.{name}": value for name, value in few.items() if name in own})


@pytest.mark.parametrize("scenario", LIBRARY)
def test_library_scenario_gives_the_same_bits_again(scenario):
    short = shortened(scenario)
    first, again = run(short), run(Scenario.load(short.toml()))
    assert first.digest == again.digest
    quiet = scenario.spec.axes and "thermal_noise = false" in short.toml()
    no_chance = scenario.study or quiet or "noise_um = 0.0" in short.toml()
    assert run(short, seed=99).digest != first.digest or no_chance


def test_expectations_can_miss():
    scenario = with_values(get("ch5-seven-step"), {"diagnosers.kalman.probability_floor": 0})
    result = run(scenario)
    assert not result.summary()["ok"]
    missing = with_values(get("ch3-mrac-spring-x2"), {"expect": [{"metric": "control.nothing", "min": 0}]})
    entry = run(missing).expectations()[0]
    assert entry["measured"] is None and not entry["ok"] and "no such metric" in entry["note"]


@pytest.mark.parametrize(
    ("bounds", "value", "ok"),
    [
        ({"min": 1.0}, 1.0, True),
        ({"min": 1.0}, 0.999, False),
        ({"max": 1.0}, 1.0, True),
        ({"max": 1.0}, 1.001, False),
        ({"min": 1.0, "max": 2.0}, 1.5, True),
        ({"value": 2.0, "tolerance": 0.25}, 2.25, True),
        ({"value": 2.0, "tolerance": 0.25}, 1.74, False),
        ({"value": 2.0, "tolerance": 0.25}, None, False),
    ],
)
def test_expectations(bounds, value, ok):
    assert Expectation(metric="x", **bounds).holds(value) is ok


# -- every field can be set


def other_value(parameter: registry.ParameterCard) -> Any:
    """Return an allowed value that is not the default."""
    if parameter.choices:
        return next(choice for choice in parameter.choices if choice != parameter.default)
    if parameter.type == "boolean":
        return not parameter.default
    low = parameter.minimum if parameter.minimum is not None else -1e6
    high = parameter.maximum if parameter.maximum is not None else 1e6
    start = parameter.default if isinstance(parameter.default, int | float) else max(low, min(1.0, high))
    for candidate in (start + 1, start * 1.25 + 0.01, start * 0.5, (low + high) / 2):
        value = round(candidate) if parameter.type == "integer" else float(candidate)
        if low < value < high and value != parameter.default:
            return value
    raise AssertionError(parameter)


AXES: dict[str, Any] = {"device": {"id": "gyro-a"}, "plant": {"model": "gyroscope_pair"}}
"""What a bench needs for blocks of axes."""


def leaves() -> list[Any]:
    found = []

    def add(table: str, block: Any, base: dict[str, Any]) -> None:
        card = registry.card(block)
        if block.axes or block.per_axis:
            base = {**AXES, **base}
        elif block.unsuited(RESONATOR, RESONATOR):
            base = {**base, "device": {"id": "second-order-gain"}, "plant": {"model": "transfer_function"}}
        for parameter in card.parameters:
            if parameter.type in ("list", "table"):
                continue
            if parameter.name == "amplitude_um" and block.family == "reference":
                base = {"reference": {"kind": block.name, "amplitude_um": 0.5}}
            elif parameter.name == "amplitude_v":
                base = {"reference": {"kind": block.name, "amplitude_v": 1.0}}
            found.append(
                pytest.param(base, table, parameter.name, other_value(parameter), id=f"{table}.{parameter.name}")
            )

    for block in registry.blocks("reference").values():
        add("reference", block, {"reference": {"kind": block.name, "amplitude_v": 1.0}})
    for block in registry.blocks("plant").values():
        add("plant", block, {"plant": {"model": block.name}})
    for block in registry.blocks("sense").values():
        add(f"sensors.{block.name}", block, {})
        if any(port.name == "displacement" for port in block.outputs):
            add("sensor", block, {"sensor": {"kind": block.name}})
    for block in registry.blocks("control").values():
        if block.slot != "drive":
            add("controller", block, {"controller": {"kind": block.name}})
        add(f"controllers.{block.name}", block, {})
    for block in registry.blocks("diagnose").values():
        add("diagnosers.bank", block, {"diagnosers": {"bank": {"kind": block.name}}})
    for block in registry.blocks("identify").values():
        add("identifiers.one", block, {"identifiers": {"one": {"kind": block.name}}})
    for block in registry.blocks("rate").values():
        add("rate", block, {"rate": {"kind": block.name}})
    for block in registry.blocks("readout").values():
        add("readouts.one", block, {"readouts": {"one": {"kind": block.name}}})
    for block in (Drive, Guard, Model, AxisGuard):
        add(block.name.removeprefix("axis_"), block, {})
    add("drive", AxisDrive, {"slots": {"drive": "forced_drive"}, "controller": {"kind": "open_loop_rate"}})
    return found


@pytest.mark.parametrize(("base", "table", "name", "value"), leaves())
def test_set_reaches_every_parameter(base, table, name, value):
    scenario = Scenario.load(base if base.get("device") == AXES["device"] else document({**base}))
    found = with_values(scenario, {f"{table}.{name}": value})
    spec = found.spec
    if table == "controller":
        section = spec.controllers[spec.active]
    elif table.startswith("controllers."):
        section = spec.controllers[table.removeprefix("controllers.")]
    elif table.startswith("sensors."):
        section = spec.sensors[table.removeprefix("sensors.")]
    elif table.startswith("diagnosers."):
        section = spec.diagnosers["bank"]
    elif table.startswith("identifiers."):
        section = spec.identifiers["one"]
    elif table.startswith("readouts."):
        section = spec.readouts["one"]
    elif table == "rate":
        section = spec.generators["rate"]
    elif table == "sensor":
        section = spec.sensors[spec.measuring]
    else:
        section = getattr(spec, table)
    assert getattr(section.params, name) == value
    # by the command line as well
    text = str(value).lower() if isinstance(value, bool) else str(value)
    path, read = parse_assignment(f"{table}.{name}={text}")
    assert path == f"{table}.{name}" and read == value


@pytest.mark.parametrize("name", sorted(set(Geometry.model_fields)))
def test_set_reaches_every_length_of_a_drawing(name):
    base = Scenario.load(document({"device": {"id": "lcr-350"}}))
    old = getattr(base.spec.device.geometry, name)
    found = with_values(base, {f"device.geometry.{name}": old + 1 if isinstance(old, int) else old * 1.01})
    assert getattr(found.spec.device.geometry, name) != old
    before, after = base.spec.device.metrics(), found.spec.device.metrics()
    if name != "truss_length_um":  # the segment between beams is what counts
        assert before != after, "a length that changes nothing"


@pytest.mark.parametrize("name", sorted(set(DrawnGyroscope.model_fields)))
def test_set_reaches_every_number_of_a_drawn_gyroscope(name):
    base = get("gyro-comb-device")
    old = getattr(base.spec.device.drawn_gyroscope, name)
    found = with_values(base, {f"device.drawn_gyroscope.{name}": old - 1 if isinstance(old, int) else old * 1.01})
    assert base.spec.device.metrics() != found.spec.device.metrics(), "a number that changes nothing"


TABLES_OF_A_DEVICE = {"id", "geometry", "transfer_function", "gyroscope", "drawn_gyroscope", "printed"}


@pytest.mark.parametrize("name", sorted(set(Device.model_fields) - TABLES_OF_A_DEVICE))
def test_set_reaches_every_value_of_a_device(name):
    value: Any = {"title": "x", "source": "y", "fingers": 25}.get(name, 2.5)
    found = with_values(Scenario.load(document()), {f"device.{name}": value})
    assert getattr(found.spec.device, name) == value


def test_set_reaches_head_events_and_expectations():
    base = get("ch5-seven-step")
    found = with_values(
        base,
        {
            "samples": 123,
            "seed": 5,
            "sample_rate_khz": 20,
            "title": "other",
            "events.0.severity": 0.07,
            "events.1.at_sample": 77,
            "expect.0.min": 0.5,
            "diagnosers.kalman.hypotheses.1.mass": 1.07,
            "metrics.tail_share": 0.5,
        },
    )
    assert found.samples == 123 and found.spec.seed == 5 and found.spec.dt_ms == 0.05
    assert found.head.title == "other" and found.events[0][0].document()["severity"] == 0.07
    assert found.events[1][0].at_sample == 77 and found.head.expect[0].min == 0.5
    assert found.spec.diagnosers["kalman"].params.hypotheses[1].mass == 1.07
    assert found.head.metrics.tail_share == 0.5
    assert base.samples == 9000 and base.head.events[0]["severity"] == 0.05, "the original is untouched"
    for name in Head.model_fields:
        assert name in ("schema_", "id", "title", "source", "summary", "claim", "verdict", "samples", "duration_ms",
                        "events", "expect", "metrics", "study", "printed")  # fmt: skip


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("a.b=1", 1),
        ("a.b=1.5", 1.5),
        ("a.b=true", True),
        ("a.b=text", "text"),
        ('a.b="text"', "text"),
        ("a.b=[1, 2]", [1, 2]),
        ("a.b={ c = 1 }", {"c": 1}),
        ("a.b=x=y", "x=y"),
        ("a.b=1e-3", 1e-3),
        (" a.b = mrac ", "mrac"),
    ],
)
def test_assignments(text, value):
    assert parse_assignment(text) == ("a.b", value)


@pytest.mark.parametrize("text", ["a.b", "=1", " = 1"])
def test_bad_assignments(text):
    with pytest.raises(InputError):
        parse_assignment(text)


def test_an_event_is_several_commands_in_order():
    event = {"switch": "pid", "heal": ["damping"], "fault": "stiffness", "severity": 0.1, "set": {"seed": 1}}
    commands = parse_event({"at_ms": 1.0, **event})
    assert [command.kind for command in commands] == ["heal", "inject", "set", "switch"]
    assert all(command.at_ms == 1.0 for command in commands)
    assert {key: value for command in commands for key, value in command.document().items()} == {"at_ms": 1.0, **event}
    reset = parse_event({"at_sample": 1, "reset_trip": True, "heal": "all"})
    assert [command.kind for command in reset] == ["reset_trip", "heal"]


@pytest.mark.parametrize(
    ("event", "says"),
    [
        ({"heal": "all"}, "needs one of at_sample, at_ms, when"),
        ({"at_ms": 1.0}, "needs one of reset_trip, heal, fault, set, switch"),
        ({"at_ms": 1.0, "severity": 0.1, "heal": "all"}, "events.0.severity: goes with fault"),
        ({"at_ms": 1.0, "fault": "stiffness"}, "events.0.severity: is required"),
        ({"at_ms": 1.0, "fault": "stiffness", "severity": True}, "events.0.severity: must be a number"),
        ({"at_ms": 1.0, "kind": "heal"}, "events.0.kind: unknown field"),
        ("heal", "events.0: must be a table"),
    ],
)
def test_what_is_wrong_with_an_event_is_said_in_one_line(event, says):
    with pytest.raises(InputError, match=says):
        Scenario.load({**document(), "events": [event]})


def test_length_in_samples_or_time():
    assert Scenario.load({**document(), "duration_ms": 12.34}).samples == 1234
    assert Scenario.load({**document(), "samples": 7}).samples == 7
    assert Scenario.load(document()).samples is None
    assert run(Scenario.load({**document(), "samples": 1})).board.tick == 1


def test_summary_is_json():
    summary = run(get("ch3-mrac-spring-x2")).summary()
    assert json.loads(json.dumps(summary, allow_nan=False)) == summary
