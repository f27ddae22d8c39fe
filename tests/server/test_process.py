"""The service as a process: its output, its end, the remains after a kill."""

from __future__ import annotations

import asyncio
import contextlib
import gc
import io
import json
import os
import signal
import socket
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import uvicorn
from typer.testing import CliRunner
from websockets.exceptions import ConnectionClosed

from server.app import create_app
from server.cli import logs
from server.cli import main as cli
from server.cli.serve import make_server, unusable
from server.settings import Settings
from server.stream.wire import SUBPROTOCOL
from tests.server.forks import Forks

ROOT = Path(__file__).resolve().parents[2]
TOKEN = "a-canary-token-for-the-logs"


@contextmanager
def process(folder: Path, *arguments: str, **more: str) -> Iterator[Any]:
    """Run ``combbench serve`` and wait until it says where it is."""
    environment = {
        **os.environ,
        "COMBBENCH_TOKEN": TOKEN,
        "COMBBENCH_DATA": str(folder / "data"),
        "COMBBENCH_LOG_LEVEL": "DEBUG",
        "COMBBENCH_FIGURES": "false",
        **more,
    }
    command = [sys.executable, "-m", "server.cli.main", "serve", "--port", "0", *arguments]
    errors = (folder / "stderr").open("wb")
    running = subprocess.Popen(command, cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=errors, text=True)
    try:
        assert running.stdout is not None
        running.address = running.stdout.readline().strip()  # type: ignore[attr-defined]
        yield running
    finally:
        if running.poll() is None:
            running.kill()
        running.communicate()
        errors.close()


def client(address: str) -> httpx.Client:
    base = address.removeprefix("CombBench is at ").partition("/?")[0]
    return httpx.Client(base_url=base, headers={"Authorization": f"Bearer {TOKEN}"}, timeout=120, trust_env=False)


COLLECTS = pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
"""A server that starts collects all garbage; what tests before this one have left is not of this one."""


@COLLECTS
def test_what_is_loaded_is_not_looked_through_for_garbage_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    async def begin(self: uvicorn.Server, sockets: Any = None) -> None:
        self.started = True

    monkeypatch.setattr(uvicorn.Server, "startup", begin)
    settings = Settings(data=tmp_path)
    gc.unfreeze()  # what servers of earlier tests have frozen would not count
    before = gc.get_freeze_count()
    try:
        asyncio.run(make_server(settings, create_app(settings), "somewhere").startup())
        assert gc.get_freeze_count() > before + 100_000
    finally:
        gc.unfreeze()
    assert capsys.readouterr().out == "CombBench is at somewhere\n"


@COLLECTS
def test_a_full_disk_behind_the_printed_address_is_no_reason_not_to_serve(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    async def begin(self: uvicorn.Server, sockets: Any = None) -> None:
        self.started = True

    monkeypatch.setattr(uvicorn.Server, "startup", begin)
    settings = Settings(data=tmp_path)
    with contextlib.suppress(OSError), Path("/dev/full").open("w") as full, monkeypatch.context() as patched:
        server = make_server(settings, create_app(settings), "somewhere")
        patched.setattr(sys, "stdout", full)
        try:
            asyncio.run(server.startup())
        except OSError as error:
            pytest.fail(f"it did not start: {error}")
        finally:
            gc.unfreeze()
    assert "cannot be printed: No space left on device" in caplog.text


def test_the_printed_link_lets_in_whatever_the_token(loaded: Forks, tmp_path: Path) -> None:
    token = "aaaaaaaaaaaaaaaa&b+c#d%41 e"
    with loaded.serve(tmp_path / "data", token=token, log=str(tmp_path / "log"), log_level="DEBUG") as served:
        with httpx.Client(trust_env=False, timeout=120) as page:
            assert page.get(served.link).status_code == 303
            assert page.get(f"{served.address}/api/v1/benches").status_code == 200
    assert token not in (tmp_path / "log").read_text()


def test_a_damaged_token_file_does_not_keep_it_from_starting(loaded: Forks, tmp_path: Path) -> None:
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "token").write_bytes(b"\xff\xfe")
    with loaded.serve(tmp_path / "data", token=None, log=str(tmp_path / "log")) as served:
        kept = (tmp_path / "data" / "token").read_text().strip()
        assert served.link.endswith(f"/?token={kept}") and len(kept) >= 43
    assert "Traceback" not in (tmp_path / "log").read_text()


def test_what_it_keeps_is_for_its_own_user_alone(loaded: Forks, tmp_path: Path) -> None:
    data = tmp_path / "data"
    with loaded.serve(data, figures=False) as served:
        bench = served.http.post("/api/v1/benches", json={"scenario": "first-look"}).json()["id"]
        served.http.post(f"/api/v1/benches/{bench}/recordings")
        run = served.http.post("/api/v1/runs", json={"scenario": "first-look", "set": {"samples": 300}}).json()["id"]
        while served.http.get(f"/api/v1/runs/{run}").json()["state"] != "done":
            os.sched_yield()
        kept = {str(path.relative_to(data)): path.stat().st_mode & 0o777 for path in [data, *data.rglob("*")]}
    assert {"combbench.sqlite3", "combbench.sqlite3-wal", "combbench.sqlite3-shm", "recordings", "runs"} <= set(kept)
    assert any(name.endswith(".arrows") for name in kept) and f"runs/{run}/run.parquet" in kept
    assert {name: mode for name, mode in kept.items() if mode not in (0o700, 0o600)} == {}


def test_it_says_where_it_is_and_says_goodbye(tmp_path: Path) -> None:
    from websockets.sync.client import connect

    with process(tmp_path, COMBBENCH_MAX_RUN_MB="4000") as running:
        assert running.address.startswith("CombBench is at http://127.0.0.1:")
        assert running.address.endswith(f"/?token={TOKEN}")
        with client(running.address) as http:
            assert http.get("/health/ready").status_code == 200
            bench = http.post("/api/v1/benches", json={"scenario": "ch5-seven-step", "time_scale": 0.02}).json()
            recording = http.post(f"/api/v1/benches/{bench['id']}/recordings").json()
            run = {"scenario": "ch5-seven-step", "set": {"samples": 9_000_000}}
            assert http.post("/api/v1/runs", json=run).status_code == 202
            with http.stream("GET", f"/?token={TOKEN}"):
                pass
            url = str(http.base_url).replace("http", "ws").rstrip("/")
            headers = {"Authorization": f"Bearer {TOKEN}"}
            stream = connect(
                f"{url}/api/v1/benches/{bench['id']}/stream",
                additional_headers=headers,
                subprotocols=[SUBPROTOCOL],  # type: ignore[list-item]
                proxy=None,
            )
            while json.loads(stream.recv(timeout=60)).get("tick", 0) < 1500:
                pass
            running.send_signal(signal.SIGTERM)
            last: list[str] = []
            with pytest.raises(ConnectionClosed) as caught:
                while True:
                    message = stream.recv(timeout=60)
                    last.append(message if isinstance(message, str) else "")
            assert caught.value.rcvd is not None and caught.value.rcvd.code == 1001
            assert any('"code":"shutdown"' in message for message in last[-3:])
            assert running.wait(90) == 0
    with contextlib.closing(sqlite3.connect(tmp_path / "data" / "combbench.sqlite3")) as database:
        [(state,)] = database.execute("SELECT state FROM requests").fetchall()
    assert state != "done", "the long run was waited for"
    table = pq.read_table(tmp_path / "data" / "recordings" / f"{recording['id']}.parquet")
    assert table.num_rows > 100
    assert table["tick"].to_pylist() == list(range(table["tick"][0].as_py(), table["tick"][-1].as_py() + 1))
    said = (tmp_path / "stderr").read_text()
    assert TOKEN not in said
    assert "Traceback" not in said


def whole_rows(path: Path) -> int:
    """Count the rows of the batches that are whole in a file that grows."""
    rows = 0
    with contextlib.suppress(pa.ArrowInvalid, OSError), pa.ipc.open_stream(path.read_bytes()) as batches:
        for batch in batches:
            rows += batch.num_rows
    return rows


def test_a_kill_loses_nothing_that_was_written(loaded: Forks, tmp_path: Path) -> None:
    """Every half second is written, so a kill costs no more than that on a machine that keeps up."""
    with loaded.serve(tmp_path, figures=False, run_workers=0) as served:
        bench = served.http.post("/api/v1/benches", json={"scenario": "first-look", "time_scale": 0.02}).json()
        recording = served.http.post(f"/api/v1/benches/{bench['id']}/recordings").json()
        growing = tmp_path / "recordings" / f"{recording['id']}.arrows"
        while whole_rows(growing) <= 500:
            served.http.get("/health/live")
        served.kill()
    with loaded.serve(tmp_path, figures=False, run_workers=0) as served:
        found = served.http.get(f"/api/v1/recordings/{recording['id']}").json()
        assert found["state"] == "aborted"
        trace = served.http.get(f"/api/v1/recordings/{recording['id']}/trace")
    ticks = pq.read_table(io.BytesIO(trace.content))["tick"].to_pylist()
    assert len(ticks) == found["ticks"] > 500
    assert ticks == list(range(found["start_tick"], found["start_tick"] + found["ticks"]))


def test_it_does_not_start_with_wrong_settings(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Each is reported in one line. In `test_a_port_that_is_taken_is_told_in_one_line` a process prints it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(logs, "configure", lambda _: None)
    (tmp_path / "file").touch()
    wrong: list[tuple[list[str], dict[str, str], list[str]]] = [
        (["--host", "0.0.0.0"], {"TOKEN": ""}, ["0.0.0.0", "token"]),
        (["--host", "0.0.0.0"], {"TOKEN": "short"}, ["16 characters"]),
        ([], {"TOKEN": "caf\u00e9-caf\u00e9-caf\u00e9-caf\u00e9"}, ["token", "header"]),
        ([], {"MAX_BENCHES": "none"}, ["max_benches", "COMBBENCH_MAX_BENCHES"]),
        ([], {"DATA": "/proc/nowhere"}, ["data: ", "/proc/nowhere", "another --data"]),
        (["--data", "file/data"], {}, [str(tmp_path / "file/data"), "Not a directory"]),
        (["--host", "192.0.2.1"], {}, ["host: ", "192.0.2.1", "no such address"]),
    ]
    for arguments, environment, words in wrong:
        told = {"COMBBENCH_TOKEN": TOKEN, **{f"COMBBENCH_{name}": value for name, value in environment.items()}}
        done = CliRunner().invoke(cli.app, ["serve", "--port", "0", *arguments], env=told)
        assert done.exit_code == 2 and done.stdout == "", done.output
        assert all(word in done.stderr for word in words) and len(done.stderr.strip().splitlines()) == 1, done.stderr


def test_a_file_elsewhere_that_cannot_be_used_is_not_blamed_on_the_data_folder(tmp_path: Path) -> None:
    inside, outside = tmp_path / "data" / "token", tmp_path / "shm" / "part"
    for file, told in ((inside, f"data: the data folder {tmp_path / 'data'} cannot"), (outside, f"{outside} cannot")):
        assert str(unusable(tmp_path / "data", PermissionError(13, "Permission denied", str(file)))).startswith(told)
    assert str(unusable(tmp_path / "data", OSError(28, "No space left on device"))).startswith("data: ")


def test_a_port_that_is_taken_is_told_in_one_line(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        with process(tmp_path, "--port", port) as running:
            assert running.wait(60) == 2
    said = (tmp_path / "stderr").read_text()
    assert f"127.0.0.1:{port}" in said and "another --port" in said and len(said.strip().splitlines()) == 1


def test_a_data_folder_serves_one_server_until_that_has_ended(loaded: Forks, tmp_path: Path) -> None:
    """The second server touches nothing: the recording of the first continues. A killed one leaves the folder free."""
    data = tmp_path / "data"
    with loaded.serve(data, figures=False, run_workers=0) as served:
        bench = served.http.post("/api/v1/benches", json={"scenario": "first-look"}).json()
        recording = served.http.post(f"/api/v1/benches/{bench['id']}/recordings").json()
        with process(tmp_path, "--data", str(data)) as other:
            assert other.wait(60) == 2
        said = (tmp_path / "stderr").read_text()
        assert f"{data} is in use by process {served.pid} on {socket.gethostname()}" in said
        assert len(said.strip().splitlines()) == 1
        assert served.http.get(f"/api/v1/recordings/{recording['id']}").json()["state"] == "recording"
        served.kill()
    with loaded.serve(data, figures=False, run_workers=0) as served:
        assert served.link


@pytest.mark.long
def test_it_serves_with_its_standard_output_closed(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    command = f"exec {sys.executable} -m server.cli.main serve --port {port} --data {tmp_path / 'data'} >&-"
    environment = {**os.environ, "COMBBENCH_TOKEN": TOKEN}
    root = Path(__file__).resolve().parents[2]
    with (tmp_path / "stderr").open("wb") as errors:
        running = subprocess.Popen(["sh", "-c", command], cwd=root, env=environment, stderr=errors)
    try:
        with httpx.Client(base_url=f"http://127.0.0.1:{port}", trust_env=False) as page:
            while True:
                assert running.poll() is None, (tmp_path / "stderr").read_text()
                with contextlib.suppress(httpx.TransportError):
                    assert page.get("/health/live").status_code == 200
                    break
                os.sched_yield()
        running.terminate()
        assert running.wait(60) == 0
    finally:
        if running.poll() is None:
            running.kill()
        running.wait()
    assert "Traceback" not in (tmp_path / "stderr").read_text()
