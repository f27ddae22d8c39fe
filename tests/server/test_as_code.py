"""Commands that the page copies from its log, read by their receivers: shell, server, command line, Python."""

from __future__ import annotations

import importlib.util
import json
import shlex
import sys
from pathlib import Path
from typing import Any

import pytest

from scenarios.edit import parse_assignment, with_values
from scenarios.library import get
from scenarios.run import DEFAULT_SAMPLES
from tests.server.conftest import TOKEN, Live

ROOT = Path(__file__).resolve().parents[2]
FOUND = json.loads((ROOT / "web/src/testing/cases/as-code.json").read_text("utf-8"))
SOURCE = FOUND["source"]
CASES = FOUND["cases"]
HEADLESS = [case for case in CASES if "cli" in case]


def logged(live: Live, bench: str) -> dict[str, Any]:
    """Return the command of the newest event that has one and is by the API."""
    events = live.http.get(f"/api/v1/benches/{bench}/events").json()["events"]
    command: dict[str, Any] = next(e["command"] for e in reversed(events) if e["command"] and "api" in e["actor"])
    return command


def curl(live: Live, text: str) -> Any:
    """Send the data that a shell would let curl send."""
    command, *words = shlex.split(text.replace("$COMBBENCH_TOKEN", TOKEN))
    assert command == "curl" and words[0::2][:3] == ["-H", "-H", "-d"] and len(words) == 7
    headers = dict(header.split(": ", 1) for header in (words[1], words[3]))
    with live.anonymous() as client:
        return client.post(words[6], content=words[5], headers=headers)


@pytest.fixture
def bench(live: Live) -> str:
    return str(live.bench("first-look", paused=True)["id"])


def there(live: Live, bench: str, text: str) -> str:
    return text.replace(SOURCE["address"], f"{live.address}/").replace(SOURCE["bench"], bench)


def test_a_server_takes_the_copied_requests_as_they_were_logged(live: Live, bench: str) -> None:
    for case in CASES:
        answer = curl(live, there(live, bench, case["rest"]))
        assert answer.status_code == 200, (case, answer.text)
        assert logged(live, bench) == case["event"]["command"]


def test_python_sends_the_copied_commands_as_they_were_logged(
    live: Live, bench: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    spec = importlib.util.spec_from_file_location("combbench_client", ROOT / "clients/combbench_client.py")
    assert spec is not None and spec.loader is not None
    client = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(client)
    monkeypatch.setitem(sys.modules, "combbench_client", client)
    monkeypatch.setenv("COMBBENCH_TOKEN", TOKEN)
    for case in CASES:
        exec(there(live, bench, case["python"]), {})
        assert logged(live, bench) == case["event"]["command"]


def test_the_command_line_takes_the_copied_runs() -> None:
    for case in HEADLESS:
        command, name, scenario, *options = shlex.split(case["cli"])
        assert (command, name, options[0::2]) == ("combbench", "run", ["--set"] * (len(options) // 2))
        run = with_values(get(scenario), dict(parse_assignment(value) for value in options[1::2]))
        [event] = run.document["events"]
        told = case["event"]["command"]
        assert event == (told if told.keys() & {"at_sample", "when"} else {"at_sample": case["event"]["tick"], **told})
        assert (run.samples or DEFAULT_SAMPLES) > case["event"]["tick"]


def test_only_commands_to_the_board_are_headless_runs() -> None:
    assert [case for case in CASES if ("cli" in case) == ("kind" in case["event"]["command"])] == []
    assert len(HEADLESS) >= 8
