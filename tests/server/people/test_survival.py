"""The server is killed in mid-class: students come back to their benches, which go on bit for bit."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest

from scenarios.run import build
from scenarios.schema import Scenario
from tests.server.conftest import TOKEN
from tests.server.people.group import Somebody, join, open_class

BEARER = {"Authorization": f"Bearer {TOKEN}"}


class Process:
    """A server in a process of its own, which can be killed."""

    def __init__(self, folder: Path) -> None:
        environment = {**os.environ, "COMBBENCH_TOKEN": TOKEN, "COMBBENCH_FIGURES": "false"}
        command = [sys.executable, "-m", "server.cli", "serve", "--port", "0", "--data", str(folder)]
        self._process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True)
        assert self._process.stdout is not None
        found = re.search(r"http://127\.0\.0\.1:\d+", self._process.stdout.readline())
        assert found is not None
        self.address = found[0]

    def ask(self, method: str, path: str, secret: str = TOKEN, **options: Any) -> Any:
        headers = {"Authorization": f"Bearer {secret}"}
        answer = httpx.request(method, self.address + path, headers=headers, timeout=60, trust_env=False, **options)
        assert answer.status_code < 300, answer.text
        return answer.json() if answer.content else None

    def text(self, path: str) -> str:
        return httpx.get(self.address + path, headers=BEARER, timeout=60, trust_env=False).text

    def end(self, how: int) -> None:
        self._process.send_signal(how)
        self._process.wait(30)
        assert self._process.stdout is not None
        self._process.stdout.close()


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM])
def test_students_come_back_to_their_benches(tmp_path: Path, how: int) -> None:
    server = Process(tmp_path)
    group = server.ask("POST", "/api/v1/classes", json={"name": "Tuesday"})
    path = f"/api/v1/classes/{group['id']}"
    students = [
        server.ask("POST", f"{path}/join", json={"code": group["code"], "name": name}) for name in ("Ada", "Ben", "Cy")
    ]
    ada = f"/api/v1/benches/{students[0]['bench']}"
    for command in (
        {"fault": "added_mass", "severity": 0.05},
        {"switch": "mrac"},
        {"set": {"reference.amplitude_v": 9}},
        {"fault": "shock", "severity": 0.1, "at_ms": 1e5},
    ):
        server.ask("POST", f"{ada}/commands", students[0]["session"], json=command)
        time.sleep(0.3)
    own = server.ask("POST", "/api/v1/benches", json={"scenario": "first-look"})["id"]
    server.ask("PUT", f"{path}/shown", json={"bench": own})
    server.ask("PUT", f"{path}/layout", json={"name": "mine", "layout": {"dock": {}, "large": True, "axes": False}})
    server.ask("POST", f"/api/v1/benches/{own}/driving", json={"do": "hand_over", "to": students[2]["id"]})
    seen = [server.ask("GET", "/api/v1/me", one["session"]) for one in students]
    given = server.ask("GET", "/api/v1/me/layout", students[0]["session"])
    time.sleep(1.5)  # checkpoints are at most a second old
    shown = server.ask("GET", f"/api/v1/benches/{own}")
    before = [server.ask("GET", f"/api/v1/benches/{one['bench']}") for one in students]
    events = server.ask("GET", f"{ada}/events")["events"]
    server.end(how)

    server = Process(tmp_path)
    try:
        server.ask("POST", f"/api/v1/benches/{own}/commands", students[2]["session"], json={"switch": "mrac"})
        assert [server.ask("GET", "/api/v1/me", one["session"]) for one in students] == seen
        assert [me["shown"] for me in seen] == [own] * 3 and [me["lent"] for me in seen] == [None, None, own]
        assert server.ask("GET", "/api/v1/me/layout", students[0]["session"]) == given
        now = server.ask("GET", f"/api/v1/benches/{own}", students[0]["session"])
        assert now["state"] == "running" and now["created"] == shown["created"] and now["controller"] == "mrac"
        assert now["tick"] >= shown["tick"] - 200 and server.ask("GET", path)["shown"] == own
        deadline = time.monotonic() + 60
        for one, was in zip(students, before, strict=True):
            me = server.ask("GET", "/api/v1/me", one["session"])
            assert me["bench"] == one["bench"]
            now = server.ask("GET", f"/api/v1/benches/{one['bench']}", one["session"])
            assert now["state"] == "running" and now["seed"] == was["seed"] and now["created"] == was["created"]
            assert now["tick"] >= was["tick"] - 100_000 * 0.002 * 1.0  # a second of device time at this scale
            assert time.monotonic() < deadline
        now = server.ask("GET", ada)
        assert [fault["name"] for fault in now["faults"]] == ["added_mass"] and now["controller"] == "mrac"
        assert len(now["pending"]) == 1 and now["parameters"]["reference"]["amplitude_v"] == 9
        again = server.ask("GET", f"{ada}/events")["events"]
        assert again[: len(events)] == events  # the log is complete and goes on
        server.ask("POST", f"{ada}/commands", json={"kind": "pause"})
        saved, digest = server.text(f"{ada}/scenario"), server.ask("GET", f"{ada}/digest")
    finally:
        server.end(signal.SIGTERM)

    # what it is now is what a straight run from tick 0 gives, bit for bit
    board = build(Scenario.load(saved))
    while board.tick < digest["tick"]:
        board.advance(digest["tick"] - board.tick)
    board.apply_due()
    assert board.digest() == digest["digest"] and digest["tick"] > before[0]["tick"] - 200


def test_a_torn_line_of_the_log_and_a_torn_board_do_no_harm(serve: Any, tmp_path: Path) -> None:
    folder = tmp_path / "torn"
    with serve(folder=folder) as live:
        group = open_class(live)
        ada, ben = join(live, group, "Ada"), join(live, group, "Ben")
        ada.ask("POST", f"/api/v1/benches/{ada.bench}/commands", json={"kind": "pause"})
        last = live.get(ada.bench)["last_event"]
    with (folder / "benches" / f"{ada.bench}.events").open("a") as file:
        file.write('{"seq": 99, "tick": 5, "ac')
    board = folder / "benches" / f"{ben.bench}.npz"
    board.write_bytes(board.read_bytes()[:1000])
    with serve(folder=folder) as live:
        live.until(ada.bench, lambda bench: bench.get("state") == "paused")
        assert live.get(ada.bench)["last_event"] == last + 1  # opened again
        other = Somebody(live, ben.secret).ask("GET", "/api/v1/me").json()["bench"]
        assert other != ben.bench and live.get(other)["state"] == "running"


def test_a_bench_that_is_gone_is_shown_and_lent_no_longer(serve: Any, tmp_path: Path) -> None:
    folder = tmp_path / "gone"
    with serve(folder=folder) as live:
        group = open_class(live)
        ada = join(live, group, "Ada")
        own = live.bench("first-look")["id"]
        live.http.put(f"/api/v1/classes/{group['id']}/shown", json={"bench": own})
        live.http.post(f"/api/v1/benches/{own}/driving", json={"do": "hand_over", "to": ada.id})
        me = ada.ask("GET", "/api/v1/me").json()
        assert me["shown"] == me["lent"] == own
    (folder / "benches" / f"{own}.npz").unlink()
    for _ in range(2):  # neither at once nor with the start behind it
        with serve(folder=folder) as live:
            back = Somebody(live, ada.secret)
            me = back.ask("GET", "/api/v1/me").json()
            assert me["shown"] is me["lent"] is None and me["bench"] == ada.bench
            assert live.http.get(f"/api/v1/classes/{group['id']}").json()["shown"] is None
            assert back.ask("GET", f"/api/v1/benches/{own}").status_code == 403
            assert {path.stem for path in (folder / "benches").iterdir()} == {ada.bench}


def test_what_is_kept_goes_with_the_bench(serve: Any, tmp_path: Path) -> None:
    folder = tmp_path / "kept"
    with serve(folder=folder) as live:
        group = open_class(live)
        ada, ben = join(live, group, "Ada"), join(live, group, "Ben")
        deadline = time.monotonic() + 20
        while len(list((folder / "benches").glob("*.npz"))) < 2:
            assert time.monotonic() < deadline
            time.sleep(0.05)
        live.http.delete(f"/api/v1/classes/{group['id']}/members/{ada.id}")
        assert {path.stem for path in (folder / "benches").iterdir()} == {ben.bench}
        live.http.delete(f"/api/v1/classes/{group['id']}")
        assert list((folder / "benches").iterdir()) == []


def test_a_bench_of_another_version_is_not_gone_on_with(serve: Any, tmp_path: Path, caplog: Any) -> None:
    folder = tmp_path / "old"
    with serve(folder=folder) as live:
        ada = join(live, open_class(live), "Ada")
    path = folder / "benches" / f"{ada.bench}.npz"
    with np.load(path) as file:
        arrays = dict(file)
    document = json.loads(arrays["document"].tobytes())
    arrays["document"] = np.frombuffer(json.dumps({**document, "version": "older"}).encode(), np.uint8)
    np.savez(path, **arrays)
    with serve(folder=folder) as live:
        assert Somebody(live, ada.secret).ask("GET", "/api/v1/me").json()["bench"] != ada.bench
    assert "was kept by version older" in caplog.text


def test_a_blind_bench_comes_back_blind_and_answers_stay(tmp_path: Path) -> None:
    server = Process(tmp_path)
    group = server.ask("POST", "/api/v1/classes", json={"name": "Tuesday"})
    path = f"/api/v1/classes/{group['id']}"
    ada, ben = [
        server.ask("POST", f"{path}/join", json={"code": group["code"], "name": name})["session"]
        for name in ("Ada", "Ben")
    ]
    assert server.ask("POST", f"{path}/blind", json={})["done"] == 2
    benches = [f"/api/v1/benches/{server.ask('GET', '/api/v1/me', one)['bench']}" for one in (ada, ben)]
    asked = server.ask("GET", benches[0], ada)["blind"]
    events = server.ask("GET", f"{benches[0]}/events", ada)["events"]
    said = server.ask("POST", f"{benches[1]}/blind/answer", ben, json={"said": "m+5", "confidence": 0.7})
    kept = server.ask("GET", f"{path}/blind")
    server.end(signal.SIGKILL)

    server = Process(tmp_path)
    try:
        assert f"/api/v1/benches/{server.ask('GET', '/api/v1/me', ada)['bench']}" == benches[0]
        bench = server.ask("GET", benches[0], ada)
        assert bench["blind"] == asked and bench["faults"] == bench["pending"] == []
        assert server.ask("GET", f"{benches[0]}/events", ada)["events"][: len(events)] == events
        closed = httpx.get(
            server.address + f"{benches[0]}/digest", headers={"Authorization": f"Bearer {ada}"}, trust_env=False
        )
        assert closed.status_code == 403 and closed.json()["error"]["code"] == "blind"
        assert server.ask("GET", f"{path}/blind") == kept and kept["hidden"] == 1 and said in kept["answers"]
        truth = next(one["truth"] for one in kept["answers"] if one["name"] == "Ada")
        right = server.ask("POST", f"{benches[0]}/blind/answer", ada, json={"said": truth, "confidence": 1.0})
        assert right["points"] == 100.0 and len(server.ask("GET", f"{benches[0]}/digest", ada)["digest"]) == 64
    finally:
        server.end(signal.SIGTERM)
