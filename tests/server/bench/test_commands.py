"""Parsing commands: every refusal is one line that names the field."""

from __future__ import annotations

from typing import Any

import pytest

from core.errors import InputError
from server.bench.commands import parse

REFUSED: list[tuple[Any, str, str]] = [
    ({"kind": "jump"}, "kind", "allowed: start, pause"),
    ({"kind": 3}, "kind", "unknown command"),
    ({}, "kind", "needs a kind, or one of reset_trip, heal, fault, set, switch"),
    ({"ticks": 3}, "kind", "needs a kind"),
    ({"falt": "added_mass", "severity": 0.1}, "falt", "did you mean fault?"),
    ({"heal": "all", "switch": "pid"}, "switch", "does one thing"),
    ("start", "command", "must be an object"),
    ({"kind": "start", "now": True}, "now", "unknown field"),
    ({"kind": "step", "ticks": 0}, "ticks", ">= 1"),
    ({"kind": "step", "ticks": 2.5}, "ticks", "whole number"),
    ({"kind": "step", "ticks": "3"}, "ticks", "whole number"),
    ({"kind": "step", "ticks": True}, "ticks", "whole number"),
    ({"kind": "time_scale"}, "value", "required"),
    ({"kind": "time_scale", "value": 2.0}, "value", "<= 1"),
    ({"kind": "time_scale", "value": float("nan")}, "value", ""),
    ({"fault": "added_mass"}, "severity", "required"),
]


def test_a_wrong_command_is_refused_in_one_line() -> None:
    for document, field, says in REFUSED:
        with pytest.raises(InputError) as caught:
            parse(document)
        assert caught.value.field == field, document
        assert says in f"{caught.value} {caught.value.hint}", document
        assert "\n" not in str(caught.value), document


def test_right_commands_are_taken() -> None:
    assert parse({"kind": "step"}).ticks == 1
    assert parse({"kind": "time_scale", "value": None}).value is None
    assert parse({"kind": "reset", "values": {"sensor.noise_um": 0.1}}).values == {"sensor.noise_um": 0.1}
    assert parse({"heal": "all"}).heal == "all"
