"""Commands to a board in their earlier notation, by a kind."""

from __future__ import annotations

from typing import Any

import pytest

from core.errors import InputError
from server.bench.commands import parse
from server.store.earlier import in_this_notation

COMMANDS: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"kind": "inject", "fault": "damping", "severity": 0.2}, {"fault": "damping", "severity": 0.2}),
    (
        {"kind": "inject", "fault": "shock", "severity": 9.0, "parameters": {"axis": "y"}, "at_ms": 2.0},
        {"fault": "shock", "severity": 9.0, "parameters": {"axis": "y"}, "at_ms": 2.0},
    ),
    ({"kind": "heal"}, {"heal": "all"}),
    ({"kind": "heal", "faults": ["damping"], "at_sample": 9}, {"heal": ["damping"], "at_sample": 9}),
    ({"kind": "set", "values": {"sensor.noise_um": 0.1}}, {"set": {"sensor.noise_um": 0.1}}),
    ({"kind": "switch", "controller": "pid"}, {"switch": "pid"}),
    ({"kind": "switch", "controller": "pid", "cold": True}, {"switch": "pid", "cold": True}),
    ({"kind": "reset_trip", "when": "plant.velocity > 5"}, {"reset_trip": True, "when": "plant.velocity > 5"}),
]


def test_it_says_the_same_in_both_notations() -> None:
    for earlier, today in COMMANDS:
        assert parse(earlier).document() == parse(today).document() == today
        assert parse(earlier).kind == parse(today).kind == earlier["kind"]


REFUSED: list[tuple[Any, str, str]] = [
    ({"kind": "inject", "fault": "added_mass"}, "severity", "required"),
    ({"kind": "inject", "fault": "damping", "severity": 1, "profile": {"kind": "saw"}}, "profile.kind", "one of"),
    ({"kind": "heal", "faults": 5}, "faults", "must be a list or one of 'all'"),
    ({"kind": "heal", "faults": [5]}, "faults.0", "must be a text"),
    ({"kind": "heal", "heal": "all"}, "heal", "unknown field; allowed: at_sample, at_ms, when, faults"),
    ({"kind": "set"}, "values", "required"),
    ({"kind": "set", "values": {}}, "values", "at least 1"),
    ({"kind": "switch"}, "controller", "required"),
    ({"kind": "switch", "controller": "pid", "fast": True}, "fast", "unknown field"),
    ({"kind": "reset_trip", "reset_trip": True}, "reset_trip", "unknown field"),
]


def test_a_refusal_names_the_field_as_it_was_written() -> None:
    for document, field, says in REFUSED:
        with pytest.raises(InputError) as caught:
            parse(document)
        assert caught.value.field == field and says in str(caught.value), document


def test_refusals_of_a_board_name_the_field_as_it_was_written(live: Any) -> None:
    key = live.bench(paused=True)["id"]
    for earlier, today in (
        ({"kind": "heal", "faults": ["damping"]}, {"heal": ["damping"]}),
        ({"kind": "switch", "controller": "nobody"}, {"switch": "nobody"}),
        ({"kind": "reset_trip"}, {"reset_trip": True}),
        ({"kind": "set", "values": {"sensor.noise_um": -1}}, {"set": {"sensor.noise_um": -1}}),
        ({"kind": "inject", "fault": "damping", "severity": -3}, {"fault": "damping", "severity": -3}),
    ):
        written = [name for name in earlier if name != "kind"] or ["kind"]
        fields = [live.command(key, **command).json()["error"]["field"] for command in (earlier, today)]
        if "set" in today:
            assert fields == ["sensor.noise_um"] * 2
        elif "fault" in today:
            assert fields == ["severity"] * 2
        else:
            assert fields == [written[0], next(iter(today))]
    assert live.command(key, "inject", fault="damping", severity=0.5).json()["entry"]["command"] == {
        "fault": "damping",
        "severity": 0.5,
    }


def test_stored_events_are_read_in_the_notation_of_today() -> None:
    step = {"kind": "inject", "fault": "damping", "severity": 0.5, "profile": {"kind": "step"}, "parameters": {}}
    stored = [
        {"tick": 1, "command": None},
        {"tick": 2, "command": {"kind": "step", "ticks": 3}},
        {"tick": 3, "command": step},
        {"tick": 4, "command": {"fault": "damping", "severity": 0.4}},
    ]
    read = in_this_notation(stored)
    assert read is not None
    assert [event["command"] for event in read] == [
        None,
        {"kind": "step", "ticks": 3},
        {"fault": "damping", "severity": 0.5},
        {"fault": "damping", "severity": 0.4},
    ]
    assert in_this_notation(None) is None and stored[2]["command"] == step
