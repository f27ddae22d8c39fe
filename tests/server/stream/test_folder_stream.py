"""The worker of a bench in a folder speaks as the server does: one transcript, played to both."""

from __future__ import annotations

import base64
import json
import subprocess
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from scenarios.edit import with_values
from scenarios.in_a_file.bench_file import BenchFile, bench_file
from scenarios.in_a_file.pack import packed, text_of
from scenarios.library import get
from scenarios.schema import Scenario
from server.cli.folder import answers
from server.stream.codec import TRIGGERED, PanelFrame, decode
from tests.scenarios.in_a_file.players import node


@dataclass(frozen=True)
class Transcript:
    """A scenario with values of its own, the signals of a panel, and the commands of a page in their order."""

    scenario: str
    signals: tuple[str, ...]
    commands: tuple[dict[str, Any], ...]
    values: dict[str, Any] = field(default_factory=dict)

    @property
    def of(self) -> Scenario:
        """The scenario."""
        return with_values(get(self.scenario), self.values)

    @property
    def lines(self) -> list[dict[str, Any]]:
        """The messages of the page: panels come, change and go between the commands."""
        commands = [_command(number, **one) for number, one in enumerate(self.commands, 1)]
        return [
            _command(0, kind="pause"),
            self._subscribe(1, mode="roll", window_ms=4.0),
            *commands[:3],
            self._subscribe(2, mode="frozen", start_tick=100, end_tick=1900),
            self._subscribe(1, mode="roll", window_ms=20.0),
            {"type": "unsubscribe", "panel": 2},
            self._triggered(4, sweep="normal"),
            self._triggered(5, sweep="single", edge="either", hysteresis=1e-3, position=0.0),
            self._triggered(6, sweep="auto", edge="leaves", level=-1e6, upper=1e6),
            self._triggered(7, sweep="normal", edge="falling", level=-1e6),
            *commands[3:5],
            {"type": "rearm", "panel": 5},
            {"type": "rearm", "panel": 9},
            *commands[5:],
            self._triggered(8, signal="no.such"),
            self._subscribe(3, mode="roll", window_ms=1.0, signals=["no.such"]),
        ]

    def _triggered(self, panel: int, **trigger: Any) -> dict[str, Any]:
        full = {"signal": self.signals[0], "edge": "rising", "level": 0.0, "upper": None, "hysteresis": 0.0}
        full |= {"position": 0.3, "sweep": "auto", **trigger}
        return self._subscribe(panel, mode="triggered", window_ms=2.0, trigger=full)

    def _subscribe(self, panel: int, **fields: Any) -> dict[str, Any]:
        return {"type": "subscribe", "panel": panel, "signals": [*self.signals], "width": 50, **fields}


def _command(number: int, **command: Any) -> dict[str, Any]:
    return {"type": "command", "id": f"c{number}", "command": command}


def _transcript(
    scenario: str, signals: tuple[str, ...], fault: str, controller: str, values: dict[str, Any] | None = None
) -> Transcript:
    """Return the commands that every bench of a folder has, with a fault and a controller of a scenario."""
    commands: tuple[dict[str, Any], ...] = (
        {"kind": "step", "ticks": 700},
        {"fault": fault, "severity": 0.1, "profile": {"kind": "step"}},
        {"kind": "step", "ticks": 1300},
        {"switch": controller},
        {"kind": "step", "ticks": 333},
        {"kind": "undo"},
        {"fault": "no_such_fault", "severity": 0.1},
        {"heal": "all"},
        {"heal": "all"},
        {"kind": "step_period"},
        {"kind": "time_scale", "value": 0.01},
        {"kind": "reset"},
        {"kind": "step", "ticks": 40},
    )
    return Transcript(scenario, signals, commands, values or {})


FIRST = _transcript("gyro-first-look", ("plant.x", "plant.y", "drive.x.force"), "quadrature", "force_to_rebalance")
TWINS = ("plant.displacement", "lqg:plant.displacement", "resonant:drive.voltage")
SLOW = {"sensor.every": 5, "diagnosers.kalman.every": 3}
"""The Kalman bank then runs at every fifteenth tick, when there is a new sample."""
TRANSCRIPTS = [
    FIRST,
    *(
        pytest.param(one, marks=pytest.mark.long, id=one.scenario)
        for one in (
            _transcript("ch3-baselines", TWINS, "damping", "pid"),
            _transcript("first-look", ("plant.displacement", "sensor.displacement"), "added_mass", "mrac", SLOW),
            _transcript("gyro-whole-angle", ("plant.x", "plant.y"), "quadrature", "open_loop_rate"),
        )
    ),
]
LINES = FIRST.lines
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
    """Return the bench of the first transcript."""
    return bench_file(FIRST.of)


def _of_worker(
    made: BenchFile, lines: list[dict[str, Any]], scenario: Scenario | None = None
) -> list[list[dict[str, Any]]]:
    """Return what the worker says to each line."""
    given = {
        "code": text_of(made.code),
        "pack": text_of(packed({**made.document, "version": "1"})),
        "answers": answers(scenario or FIRST.of, made),
        "lines": lines,
    }
    script = str(Path(__file__).with_name("rehearse.mjs"))
    ended = subprocess.run(
        [node(), script], input=json.dumps(given), capture_output=True, text=True, check=False, timeout=300
    )
    assert ended.returncode == 0, ended.stderr
    found: list[list[dict[str, Any]]] = json.loads(ended.stdout)
    return found


def _of_server(live: Any, played: Transcript) -> list[list[dict[str, Any]]]:
    """Return what the server says to each line."""
    said = []
    bench = live.bench(played.scenario, set=played.values, paused=True, quiet_lead=True)
    with live.stream(bench["id"]) as stream:
        stream.settle()
        for line in played.lines:
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


@pytest.mark.parametrize("played", TRANSCRIPTS, ids=lambda one: one.scenario)
def test_one_transcript_gives_the_same_messages_and_pictures(live: Any, made: BenchFile, played: Transcript) -> None:
    file = made if played is FIRST else bench_file(played.of)
    by_worker, by_server = _of_worker(file, played.lines, played.of), _of_server(live, played)
    pictures = triggered = 0
    for line, own, other in zip(played.lines, by_worker, by_server, strict=True):
        shown, expected = _pictures(own), _pictures(other)
        assert shown.keys() == expected.keys(), line
        for panel, picture in expected.items():
            pictures += 1
            triggered += picture.flags & TRIGGERED > 0
            found = shown[panel]
            assert (found.start, found.end, found.flags, found.revision) == (
                picture.start,
                picture.end,
                picture.flags,
                picture.revision,
            ), line
            np.testing.assert_array_equal(found.trigger, picture.trigger)
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
    assert pictures > 8 and triggered > 1


def test_the_past_is_computed_again_with_the_same_bits_and_another_future_begins_there(made: BenchFile) -> None:
    bench = f"/benches/{FIRST.scenario}"
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
    assert forked["body"]["origin"] == {"bench": FIRST.scenario, "tick": 900, "window_ticks": 500, "is_past": True}
    assert [one["name"] for one in forked["body"]["faults"]] == ["quadrature"]
    assert sought["body"]["tick"] == 650 and back["body"]["tick"] == 2000
    assert again["body"]["scores"] == first["body"]["scores"] and again["body"]["faults"] == first["body"]["faults"]
    assert healed["status"] == 200 and branch["body"]["faults"] == [] and not branch["body"]["origin"]["is_past"]
    assert (late["status"], gone["status"], missing["status"]) == (409, 204, 404)
