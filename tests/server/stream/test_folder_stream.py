"""The worker of a bench in a folder speaks as the server does: one transcript, played to both."""

from __future__ import annotations

import base64
import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from scenarios.in_a_file.bench_file import BenchFile, bench_file
from scenarios.in_a_file.pack import packed, text_of
from scenarios.library import get
from server.cli.folder import answers
from server.stream.codec import PanelFrame, decode
from tests.scenarios.in_a_file.players import node

SCENARIO = "gyro-first-look"
SIGNALS = ["plant.x", "plant.y", "drive.x.force"]


def _command(number: int, **command: Any) -> dict[str, Any]:
    return {"type": "command", "id": f"c{number}", "command": command}


def _subscribe(panel: int, **fields: Any) -> dict[str, Any]:
    return {"type": "subscribe", "panel": panel, "signals": SIGNALS, "width": 50, **fields}


COMMANDS: list[dict[str, Any]] = [
    {"kind": "step", "ticks": 700},
    {"fault": "quadrature", "severity": 0.1, "profile": {"kind": "step"}},
    {"kind": "step", "ticks": 1300},
    {"switch": "force_to_rebalance"},
    {"kind": "step", "ticks": 333},
    {"kind": "undo"},
    {"fault": "no_such_fault", "severity": 0.1},
    {"heal": "all"},
    {"heal": "all"},
    {"kind": "step_period"},
    {"kind": "time_scale", "value": 0.01},
    {"kind": "reset"},
    {"kind": "step", "ticks": 40},
]
LINES: list[dict[str, Any]] = [
    _command(0, kind="pause"),
    _subscribe(1, mode="roll", window_ms=4.0),
    *(_command(number, **one) for number, one in enumerate(COMMANDS[:3], 1)),
    _subscribe(2, mode="frozen", start_tick=100, end_tick=1900),
    _subscribe(1, mode="roll", window_ms=20.0),
    {"type": "unsubscribe", "panel": 2},
    *(_command(number, **one) for number, one in enumerate(COMMANDS[3:], 4)),
    _subscribe(3, mode="roll", window_ms=1.0, signals=["no.such"]),
]
SAME = (
    "state",
    "tick",
    "time_scale",
    "controller",
    "slots",
    "faults",
    "trip",
    "scores",
    "recording",
    "origin",
)


@pytest.fixture(scope="module")
def made() -> BenchFile:
    """Return the bench that both play."""
    return bench_file(get(SCENARIO))


def _of_worker(made: BenchFile, lines: list[dict[str, Any]]) -> list[list[dict[str, Any]]]:
    """Return what the worker says to each line."""
    given = {
        "code": text_of(made.code),
        "pack": text_of(packed({**made.document, "version": "1"})),
        "answers": answers(get(SCENARIO), made),
        "lines": lines,
    }
    script = str(Path(__file__).with_name("rehearse.mjs"))
    ended = subprocess.run(
        [node(), script], input=json.dumps(given), capture_output=True, text=True, check=False, timeout=300
    )
    assert ended.returncode == 0, ended.stderr
    found: list[list[dict[str, Any]]] = json.loads(ended.stdout)
    return found


def _of_server(live: Any) -> list[list[dict[str, Any]]]:
    """Return what the server says to each line."""
    said = []
    with live.stream(live.bench(SCENARIO, paused=True, quiet_lead=True)["id"]) as stream:
        stream.settle()
        for line in LINES:
            messages, frames = len(stream.messages), len(stream.frames)
            stream.send(**line)
            if line["type"] == "command":
                stream.until_type("reply")
            stream.settle()
            said.append([*stream.messages[messages:], *({"frame": one} for one in stream.frames[frames:])])
    return said


def _pictures(said: list[dict[str, Any]]) -> dict[int, PanelFrame]:
    """Return the last picture of each panel, whoever has encoded it."""
    frames = [one["frame"] for one in said if "frame" in one]
    read = [decode(base64.b64decode(one)) if isinstance(one, str) else one for one in frames]
    return {panel.panel: panel for frame in read for panel in frame.panels}


def _of_type(said: list[dict[str, Any]], kind: str) -> list[dict[str, Any]]:
    return [one for one in said if one.get("type") == kind]


def _events(said: list[dict[str, Any]]) -> list[tuple[Any, ...]]:
    events = [event for one in _of_type(said, "events") for event in one["events"]]
    told = [one for one in events if one["kind"] != "scheduled"]  # in a file the events of the scenario wait already
    return [(one["tick"], one["kind"]) for one in told]


def _waiting(status: dict[str, Any]) -> list[tuple[Any, ...]]:
    """Return the commands that wait; their words write numbers in two languages."""
    return [(one["tick"], one["when"], one["actor"]) for one in status["pending"]]


def test_one_transcript_gives_the_same_messages_and_pictures(live: Any, made: BenchFile) -> None:
    by_worker, by_server = _of_worker(made, LINES), _of_server(live)
    pictures = 0
    for line, own, other in zip(LINES, by_worker, by_server, strict=True):
        shown, expected = _pictures(own), _pictures(other)
        assert shown.keys() == expected.keys(), line
        for panel, picture in expected.items():
            pictures += 1
            found = shown[panel]
            assert (found.start, found.end, found.flags, found.revision) == (
                picture.start,
                picture.end,
                picture.flags,
                picture.revision,
            ), line
            np.testing.assert_array_equal(found.columns, picture.columns)
            np.testing.assert_array_equal(found.latest, picture.latest)
        replies = [[(one["ok"], one.get("tick")) for one in _of_type(said, "reply")] for said in (own, other)]
        assert replies[0] == replies[1], line
        assert len(_of_type(own, "error")) == len(_of_type(other, "error")), line
        kinds = [sorted(_events(said)) for said in (own, other)]
        assert kinds[0] == kinds[1], line
        if line["type"] == "command" and (ended := _of_type(other, "status")):
            mine = _of_type(own, "status")[-1]
            assert {name: mine[name] for name in SAME} == {name: ended[-1][name] for name in SAME}, line
            assert _waiting(mine) == _waiting(ended[-1]), line
    assert pictures > 8


def test_the_past_is_computed_again_with_the_same_bits_and_another_future_begins_there(made: BenchFile) -> None:
    bench = f"/benches/{SCENARIO}"
    fork = {"tick": 900, "paused": True, "window_ticks": 500}
    lines: list[dict[str, Any]] = [
        *LINES[:6],
        {"method": "GET", "path": f"{bench}/events"},
        {"method": "POST", "path": f"{bench}/fork", "body": fork},
        {"method": "POST", "path": f"{bench}-2/commands", "body": {"kind": "seek", "tick": 650}},
        {"method": "POST", "path": f"{bench}-2/commands", "body": {"kind": "seek", "tick": 2000}},
        {"method": "GET", "path": f"{bench}-2"},
        {"method": "GET", "path": bench},
        {"method": "POST", "path": f"{bench}-2/commands", "body": {"heal": "all"}},
        {"method": "GET", "path": f"{bench}-2"},
        {"method": "POST", "path": f"{bench}-2/commands", "body": {"kind": "seek", "tick": 100}},
        {"method": "DELETE", "path": f"{bench}-2"},
        {"method": "GET", "path": f"{bench}-2"},
    ]
    answered = [one for said in _of_worker(made, lines) for one in said if "status" in one and "body" in one]
    _, forked, sought, back, again, first, healed, branch, late, gone, missing = answered
    assert (forked["status"], forked["body"]["tick"], forked["body"]["state"]) == (201, 900, "paused")
    assert forked["body"]["origin"] == {"bench": SCENARIO, "tick": 900, "window_ticks": 500, "is_past": True}
    assert [one["name"] for one in forked["body"]["faults"]] == ["quadrature"]
    assert sought["body"]["tick"] == 650 and back["body"]["tick"] == 2000
    assert again["body"]["scores"] == first["body"]["scores"] and again["body"]["faults"] == first["body"]["faults"]
    assert healed["status"] == 200 and branch["body"]["faults"] == [] and not branch["body"]["origin"]["is_past"]
    assert (late["status"], gone["status"], missing["status"]) == (409, 204, 404)
