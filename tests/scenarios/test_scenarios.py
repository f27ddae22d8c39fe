"""Scenarios: the library keeps its promises, every field can be reached, bad input is named."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import pytest

from core import registry
from core.board.commands import parse_event
from core.device.catalogue import device
from core.device.device import Device
from core.device.drawn_gyroscope import DrawnGyroscope
from core.device.geometry import Geometry
from core.errors import InputError
from core.loop.amplifier import Amplifier
from core.loop.axis_amplifier import AxisAmplifier
from core.loop.axis_drive import AxisDrive
from core.loop.axis_guard import AxisGuard
from core.loop.axis_sampler import AxisSampler
from core.loop.drive import Drive
from core.loop.guard import Guard
from core.loop.model import Model
from core.loop.sampler import Sampler
from scenarios.edit import parse_assignment, with_values
from scenarios.expectation import Expectation
from scenarios.library import get, library
from scenarios.run import run
from scenarios.schema import Scenario, ScenarioHead
from tests.lab import document
from tests.library_pass import results

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


def test_every_scenario_of_the_library_keeps_its_expectations_to_its_end():
    wrong = []
    for name, found in results().items():
        scenario, rows = get(name), found["gallery"]["expectations"]
        wrong += [f"{name}: {row['metric']} {row['measured']}, not {row['expected']}" for row in rows if not row["ok"]]
        promised = [row.promised() for row in scenario.head.expect]
        if [row["verdict"] for row in rows] != promised or found["gallery"]["verdict"] != scenario.verdict:
            wrong.append(f"{name}: another verdict than promised")
        if any(entry.metric == "lateral.contact_ms" for entry in scenario.head.expect):
            wrong += [] if "touched" in str(found["trip"]) else [f"{name} does not touch"]
        elif (found["trip"], found["tick"]) != (None, 0 if scenario.study else scenario.samples or 10_000):
            wrong.append(f"{name} ends at {found['tick']}: {found['trip']}")
    assert wrong == []


def test_every_scenario_of_the_library_says_its_subject_and_reads_back():
    wrong = []
    for scenario in library():
        head = scenario.head
        if not (head.title and head.source and head.summary) or (head.expect and not (head.claim and scenario.verdict)):
            wrong.append(f"{scenario.id} lacks title, source, summary, claim or verdict")
        if scenario.verdict in ("partly", "not reproduced") and not any(entry.note for entry in head.expect):
            wrong.append(f"{scenario.id} does not say the truth instead")
        if Scenario.load(scenario.toml()).document != scenario.document:
            wrong.append(f"{scenario.id} reads back as another")
    assert wrong == []


def shortened(scenario: Scenario) -> Scenario:
    if scenario.study is None:
        return with_values(scenario, {"samples": 700} if "samples" in scenario.document else {"duration_ms": 7.0})
    few = {"runs": 2, "healthy_samples": 20_000, "draws": 50}
    own = type(scenario.study[1]).model_fields
    return with_values(scenario, {f"study.{name}": value for name, value in few.items() if name in own})


def unlike_itself(scenario: Scenario) -> str:
    """Return how a short run differs from itself, or does not depend on its seed."""
    short = shortened(scenario)
    first, again = run(short), run(Scenario.load(short.toml()))
    quiet = scenario.spec.axes and "thermal_noise = false" in short.toml()
    no_chance = scenario.study or quiet or "noise_um = 0.0" in short.toml()
    if first.digest != again.digest:
        return f"{scenario.id} gives other bits when it is run again"
    return "" if no_chance or run(short, seed=99).digest != first.digest else f"{scenario.id} does not heed its seed"


def test_a_run_of_each_plant_and_a_study_give_the_same_bits_again():
    plants = {(one.spec.plant.block.name, bool(one.twins)): one for one in library() if one.study is None}
    studies = [get(name) for name in ("ch1-process-spread", "ch1-bode-tolerances", "ch2-doppler")]
    assert len(plants) > 8 and list(filter(None, map(unlike_itself, [*plants.values(), *studies]))) == []


@pytest.mark.long
@pytest.mark.timeout(900)
def test_every_scenario_of_the_library_gives_the_same_bits_again():
    assert list(filter(None, map(unlike_itself, library()))) == []


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
    if parameter.type == "text":
        return {"diagnoser": "other"}.get(parameter.name, "adrc")
    low = parameter.minimum if parameter.minimum is not None else -1e6
    high = parameter.maximum if parameter.maximum is not None else 1e6
    start = parameter.default if isinstance(parameter.default, int | float) else max(low, min(1.0, high))
    for candidate in (start + 1, start * 1.25 + 0.01, start * 0.5, (low + high) / 2):
        value = round(candidate) if parameter.type == "integer" else float(candidate)
        if low < value < high and value != parameter.default:
            return value
    raise AssertionError(parameter)


AXES: dict[str, Any] = {"device": {"id": "gyro-a"}, "plant": {"model": "gyroscope_pair"}}
"""Settings of a bench for blocks of axes."""

TUNED: dict[str, Any] = {
    "device": {"id": "gyro-c", "electrodes": {"tuning": {}}},
    "plant": {"model": "tuned_gyroscope"},
    "slots": {"drive": "drive_loop"},
    "controller": {"kind": "open_loop_rate"},
}
"""Settings of a bench for blocks of a gyroscope with a tuning electrode."""
COMB = {"fingers": 200, "thickness_um": 60.0, "gap_um": 3.0}
COMBS: dict[str, Any] = {
    "device": {"id": "gyro-a", "electrodes": {"drive": COMB, "sense": COMB}},
    "plant": {"model": "gyroscope"},
}
NEEDS = {"axis_drive.by": COMBS, "axis_drive.converter_limit_v": {**COMBS, "drive": {"by": "volts"}}}
"""Settings of a bench without which a parameter is refused."""
ALONE = (AXES["device"], TUNED["device"], COMBS["device"])
"""Devices of benches that are whole without the tables of a resonator."""

BANK = {"kind": "mmae"}


def tables(family: str) -> Iterator[tuple[str, Any, dict[str, Any]]]:
    """Yield the tables of a document that set the blocks of a family: path, block, and the bench that has them."""
    for block in registry.blocks(family).values():
        kind = {"kind": block.name}
        if family == "reference":
            yield "reference", block, {"reference": {**kind, "amplitude_v": 1.0}}
        elif family == "plant":
            yield "plant", block, TUNED if block.name == "tuned_gyroscope" else {"plant": {"model": block.name}}
        elif family == "sense":
            yield f"sensors.{block.name}", block, {}
            if any(port.name == "displacement" for port in block.outputs):
                yield "sensor", block, {"sensor": kind}
        elif family == "control":
            tuned = {**TUNED, "slots": {"drive": "drive_loop", "tuning": block.name}} if block.slot == "tuning" else {}
            yield f"controllers.{block.name}", block, tuned
            if block.slot not in ("drive", "tuning"):
                yield "controller", block, {"controller": kind}
        elif family == "rate":
            yield "rate", block, {"rate": kind}
        elif family == "supervise":
            yield "supervisor", block, {"supervisor": kind, "diagnosers": {"kalman": BANK, "other": BANK}}
        else:
            several, name = {
                "diagnose": ("diagnosers", "bank"),
                "identify": ("identifiers", "one"),
                "readout": ("readouts", "one"),
            }[family]
            yield f"{several}.{name}", block, {several: {name: kind}}


def own_tables() -> Iterator[tuple[str, Any, dict[str, Any]]]:
    """Yield the tables of blocks that are on every bench."""
    for block in (Drive, Guard, Model, AxisGuard):
        yield block.name.removeprefix("axis_"), block, {}
    for block in (Sampler, Amplifier, AxisSampler, AxisAmplifier):
        yield "board", block, {}
    yield "drive", AxisDrive, {"slots": {"drive": "forced_drive"}, "controller": {"kind": "open_loop_rate"}}


def section_of(spec: Any, table: str) -> Any:
    """Return the section of a bench that a table of its document sets."""
    if table == "controller":
        return spec.controllers[spec.active]
    if table == "sensor":
        return spec.sensors[spec.measuring]
    if table == "rate":
        return spec.generators["rate"]
    if table == "supervisor":
        return spec.supervisors["supervisor"]
    several, _, name = table.partition(".")
    return getattr(spec, several)[name] if name else getattr(spec, table)


def unreached(table: str, block: Any, base: dict[str, Any]) -> list[str]:
    """Return the parameters of a block that neither a value nor the command line sets."""
    resonator, wrong = device({}).oscillator(), []
    if block.axes or block.per_axis:
        base = {**AXES, **base}
    elif block.unsuited(resonator, resonator):
        base = {**base, "device": {"id": "second-order-gain"}, "plant": {"model": "transfer_function"}}
    loaded: dict[str, Scenario] = {}
    for parameter in registry.card(block).parameters:
        if parameter.type in ("list", "table"):
            continue
        name, value = parameter.name, other_value(parameter)
        if name == "amplitude_um" and block.family == "reference":
            base = {"reference": {"kind": block.name, "amplitude_um": 0.5}}
        elif name == "amplitude_v":
            base = {"reference": {"kind": block.name, "amplitude_v": 1.0}}
        whole = {**base, **NEEDS.get(f"{block.name}.{name}", {})}
        if str(whole) not in loaded:
            loaded[str(whole)] = Scenario.load(whole if whole.get("device") in ALONE else document({**whole}))
        spec = with_values(loaded[str(whole)], {f"{table}.{name}": value}).spec
        text = str(value).lower() if isinstance(value, bool) else str(value)
        assigned = parse_assignment(f"{table}.{name}={text}")
        if getattr(section_of(spec, table).params, name) != value or assigned != (f"{table}.{name}", value):
            wrong.append(f"{block.name}: {table}.{name} = {value}")
    return wrong


@pytest.mark.parametrize(
    "family", [*"reference plant sense control diagnose supervise identify rate readout".split(), "own"]
)
def test_set_reaches_every_parameter(family):
    found = [*(own_tables() if family == "own" else tables(family))]
    assert found and [name for one in found for name in unreached(*one)] == []


def test_set_reaches_every_length_of_a_drawing():
    base, idle = Scenario.load(document({"device": {"id": "lcr-350"}})), []
    before = base.spec.device.metrics()
    for name in Geometry.model_fields:
        old = getattr(base.spec.device.geometry, name)
        found = with_values(base, {f"device.geometry.{name}": old + 1 if isinstance(old, int) else old * 1.01})
        assert getattr(found.spec.device.geometry, name) != old, name
        idle += [name] if found.spec.device.metrics() == before else []
    assert not idle, "a length that changes nothing"


def test_set_reaches_every_number_of_a_drawn_gyroscope():
    base = get("gyro-comb-device")
    for name in DrawnGyroscope.model_fields:
        old = getattr(base.spec.device.drawn_gyroscope, name)
        found = with_values(base, {f"device.drawn_gyroscope.{name}": old - 1 if isinstance(old, int) else old * 1.01})
        assert base.spec.device.metrics() != found.spec.device.metrics(), f"{name} changes nothing"


TABLES_OF_A_DEVICE = {"id", "geometry", "transfer_function", "gyroscope", "drawn_gyroscope", "electrodes", "printed"}


def test_set_reaches_every_value_of_a_device():
    base = Scenario.load(document())
    for name in set(Device.model_fields) - TABLES_OF_A_DEVICE:
        value: Any = {"title": "x", "source": "y", "fingers": 25, "fringing": "free"}.get(name, 2.5)
        assert getattr(with_values(base, {f"device.{name}": value}).spec.device, name) == value, name


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
    for name in ScenarioHead.model_fields:
        assert name in ("schema_", "id", "title", "source", "summary", "claim", "verdict", "samples", "duration_ms",
                        "events", "expect", "comparator", "metrics", "study", "printed")  # fmt: skip


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
def test_an_error_in_an_event_is_said_in_one_line(event, says):
    with pytest.raises(InputError, match=says):
        Scenario.load({**document(), "events": [event]})


def test_length_in_samples_or_time():
    assert Scenario.load({**document(), "duration_ms": 12.34}).samples == 1234
    assert Scenario.load({**document(), "samples": 7}).samples == 7
    assert Scenario.load(document()).samples is None
    assert run(Scenario.load({**document(), "samples": 1})).board.tick == 1


def test_a_summary_is_json_and_has_the_figures_of_the_device():
    for name in ("ch3-mrac-spring-x2", "ch1-table-1-1", "ch1-process-spread"):
        summary = run(get(name)).summary()
        assert json.loads(json.dumps(summary, allow_nan=False)) == summary
        assert any(figure.startswith("device.") for figure in summary["metrics"])
