"""Record answers and streams of the service for the tests of the page; files of unchanged answers stay as they are."""

from __future__ import annotations

import base64
import json
import re
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
from record_folder import folder_bench
from record_panels import record_questions
from record_views import record_campaign, record_design, record_exercises, record_kept, record_theory
from same_answer import is_same
from websockets.sync.client import connect
from websockets.sync.connection import Connection

from server.app import create_app
from server.cli.serve import bind, make_server
from server.settings import Settings
from server.stream.codec import Moment, decode, encode
from server.stream.wire import SUBPROTOCOL

FOLDER = Path(__file__).resolve().parents[1] / "web" / "src" / "testing" / "recorded"
TOKEN = "a-token-for-recording-only"
PATIENCE_S = 300.0
PAUSE_S = 0.02
SCOPE = ["plant.displacement", "sensor.displacement"]
WINDOW_MS = 4.0
WIDTH = 200
FIRST_TICKS, NEXT_TICKS = 1800, 200
BENCHES: dict[str, tuple[str, dict[str, Any]]] = {
    "first-look": ("first-look", {"fault": "added_mass", "severity": 0.05}),
    "seven-steps": ("ch5-seven-step", {"fault": "added_mass", "severity": 0.1}),
    "gyroscope": ("gyro-adaptive", {"fault": "quadrature", "severity": 0.1}),
}
GALLERY_ENTRIES = 6
NOW = "2026-01-01T00:00:00Z"
MOMENT = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(?:\.\d+)?(?:Z|[+-]\d\d:\d\d)")
DIGEST = re.compile(r'"(?:[0-9a-f]{64}|[0-9a-f]{16})"')
MEASURED = ("achieved_scale", "loop_lag_ms", "wake_late_ms", "let_go_in_s", "elapsed_s", "overruns", "given_up_ms")


class Recorder:
    """A service to record, and the names that replace ids of this recording.

    Parameters
    ----------
    address : str
        Of the service.
    """

    def __init__(self, address: str) -> None:
        self.address = address
        headers = {"Authorization": f"Bearer {TOKEN}"}
        self.http = httpx.Client(base_url=f"{address}/api/v1", headers=headers, timeout=PATIENCE_S, trust_env=False)
        self._names: dict[str, str] = {address: "http://127.0.0.1:8000"}

    def name(self, found: str, name: str) -> str:
        """Replace an id by a name, and return the id."""
        self._names[found] = name
        return found

    def get(self, path: str, **query: Any) -> Any:
        """Return the answer to a question."""
        return self.http.get(path, params=query).raise_for_status().json()

    def post(self, path: str, **body: Any) -> Any:
        """Return the answer to a request."""
        answer = self.http.post(path, json=body).raise_for_status()
        return answer.json() if answer.content else None

    def until(self, path: str, holds: Callable[[Any], bool]) -> Any:
        """Ask until something holds of the answer."""
        end = time.monotonic() + PATIENCE_S
        while not holds(answer := self.get(path)):
            if time.monotonic() > end:
                raise TimeoutError(f"{path}: {answer}")
            time.sleep(PAUSE_S)
        return answer

    def step(self, bench: str, ticks: int) -> None:
        """Let a bench run some ticks, and pause."""
        head = self.get(f"/benches/{bench}")["tick"] + ticks
        self.post(f"/benches/{bench}/commands", kind="step", ticks=ticks)
        self.until(f"/benches/{bench}", lambda found: found["tick"] == head and found["state"] == "paused")

    @contextmanager
    def stream(self, bench: str) -> Iterator[Connection]:
        """Watch a bench."""
        url = f"{self.address.replace('http', 'ws')}/api/v1/benches/{bench}/stream"
        headers = {"Authorization": f"Bearer {TOKEN}"}
        with connect(url, additional_headers=headers, subprotocols=[SUBPROTOCOL], proxy=None, max_size=None) as line:  # type: ignore[list-item]
            yield line

    def write(self, folder: Path, name: str, content: Any) -> None:
        """Write a recording without times, ids and digests: two recordings have the same bytes."""
        text = json.dumps(_settled(content), ensure_ascii=False, separators=(",", ":"))
        for found in sorted(self._names, key=len, reverse=True):
            text = re.sub(rf"(?<!\w){re.escape(found)}(?!\w)", self._names[found], text)
        lines = re.sub(r"(?<=[\]}]),(?=[\[{])", ",\n", MOMENT.sub(NOW, DIGEST.sub('"digest"', text)))
        file = folder / f"{name}.json"
        if not file.exists() or not is_same(json.loads(file.read_text("utf-8")), json.loads(lines)):
            file.write_text(lines + "\n", encoding="utf-8")


def _settled(content: Any) -> Any:
    """Return the content with 0 for each figure that a clock made."""
    if isinstance(content, dict):
        return {key: 0 if key in MEASURED and found else _settled(found) for key, found in content.items()}
    return [_settled(found) for found in content] if isinstance(content, list) else content


def record_bench(recorder: Recorder, folder: Path, name: str, scenario: str, fault: dict[str, Any]) -> str:
    """Record a bench with an active fault: messages of its stream, and pictures of a scope and of each bank.

    Returns
    -------
    str
        The id of the bench.
    """
    made = recorder.post("/benches", scenario=scenario, paused=True)
    bench = recorder.name(made["id"], name)
    recorder.step(bench, FIRST_TICKS)
    recorder.post(f"/benches/{bench}/commands", **fault)
    recorder.step(bench, NEXT_TICKS)
    heard: dict[str, Any] = {}
    frames: dict[str, Any] = {}
    with recorder.stream(bench) as line:
        plots = _plots(made)
        for panel, signals in enumerate(plots.values()):
            asked = {"mode": "roll", "signals": signals, "window_ms": WINDOW_MS, "width": WIDTH}
            line.send(json.dumps({"type": "subscribe", "panel": panel, **asked}))
        while len(heard) < 2 or len(frames) < len(plots):
            message = line.recv(timeout=PATIENCE_S)
            if isinstance(message, str):
                said = json.loads(message)
                if said["type"] in ("hello", "status"):
                    heard.setdefault(said["type"], said)
                continue
            frame = decode(message)
            line.send(json.dumps({"type": "ack", "frame": frame.frame}))
            moment = Moment(frame.head, frame.dt_ms, 0.0)
            for picture in frame.panels:
                parts = encode(1, frame.running, moment, [(1, 1, picture)])
                plot = list(plots)[picture.panel]
                frames[plot] = {"signals": plots[plot], "bytes": base64.b64encode(b"".join(parts)).decode()}
    recorder.name(heard["hello"]["server"], "server")
    events = {"type": "events", "events": recorder.get(f"/benches/{bench}/events")["events"]}
    frames = {plot: frames[plot] for plot in plots}
    recorder.write(
        folder, name, {"hello": heard["hello"], "status": heard["status"], "events": events, "frames": frames}
    )
    return bench


def _plots(bench: dict[str, Any]) -> dict[str, list[str]]:
    """Return the signals of a scope, and of the lanes of each bank."""
    known = [signal["name"] for signal in bench["signals"]]
    plots = {"scope": [signal for signal in SCOPE if signal in known] or known[:2]}
    for bank, found in bench["diagnosers"].items():
        parts = [f"{bank}.probability.{hypothesis}" for hypothesis in found["names"]]
        lanes = [*parts, *(f"{bank}.{part}" for part in ("winner", "truth", "unexplained"))]
        plots[bank] = [signal for signal in lanes if signal in known]
    return plots


def record_library(recorder: Recorder, folder: Path) -> None:
    """Record the library: its blocks, its scenarios, its devices, entries of its gallery."""
    recorder.write(folder, "catalog", {"blocks": recorder.get("/catalog")["blocks"]})
    recorder.write(folder, "scenarios", recorder.get("/scenarios"))
    recorder.write(folder, "devices", recorder.get("/devices"))
    gallery = recorder.get("/gallery")
    recorder.write(folder, "gallery", {**gallery, "cards": gallery["cards"][:GALLERY_ENTRIES]})


def record_runs(recorder: Recorder, folder: Path) -> None:
    """Record a run that has ended, and a campaign of four."""
    run = recorder.post("/runs", scenario="first-look", set={"samples": 500})
    sweep = {
        "scenario": "first-look",
        "set": {"samples": 100},
        "grid": {"sensor.noise_um": [0.01, 0.02, 0.05, 0.1]},
    }
    campaign = recorder.post("/sweeps", sweep=sweep)
    for kind, found in (("run", run), ("sweep", campaign)):
        path = f"/{kind}s/{recorder.name(found['id'], f'{kind}-1')}"
        recorder.write(folder, kind, recorder.until(path, lambda now: now["state"] not in ("queued", "running")))
    record_campaign(recorder, folder, run["id"], campaign["id"])


def record_class(recorder: Recorder, folder: Path) -> None:
    """Record a class with two students, and the tiles of their benches before they run."""
    group = recorder.post("/classes", name="Sensors", bench={"scenario": "first-look", "paused": True})
    path = f"/classes/{recorder.name(group['id'], 'class-1')}"
    for number, student in enumerate(("Ada", "Ben"), 1):
        joined = recorder.post(f"{path}/join", code=group["code"], name=student)
        recorder.name(joined["id"], f"student-{number}")
        recorder.name(joined["bench"], f"bench-of-student-{number}")
    for written in (group["code"], group["path"].rpartition("=")[2]):
        recorder.name(written, "CODE")
    recorder.write(folder, "class", {"class": recorder.get(path), **recorder.get(f"{path}/members")})


@contextmanager
def serving() -> Iterator[Recorder]:
    """Serve with an empty folder of data, until all is recorded."""
    with tempfile.TemporaryDirectory() as data:
        settings = Settings(port=0, data=Path(data), token=TOKEN, figures=False)
        listener = bind(settings)
        server = make_server(settings, create_app(settings))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        recorder = Recorder(f"http://127.0.0.1:{listener.getsockname()[1]}")
        try:
            while not server.started and thread.is_alive():
                time.sleep(PAUSE_S)
            yield recorder
        finally:
            recorder.http.close()
            server.should_exit = True
            thread.join()


def record(folder: Path = FOLDER) -> None:
    """Record all into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    with serving() as recorder:
        record_library(recorder, folder)
        for name, (scenario, fault) in BENCHES.items():
            bench = record_bench(recorder, folder, name, scenario, fault)
            if name == "first-look":
                tick = FIRST_TICKS + NEXT_TICKS - 1
                explained = recorder.get(f"/benches/{bench}/diagnosers/kalman/explain", tick=tick)
                recorder.write(folder, "explanation", explained)
                sheet = recorder.post("/sheets/first-look/begin")
                recorder.name(sheet["bench"], "bench-of-sheet")
                recorder.write(folder, "sheet", sheet)
                record_questions(recorder, folder, bench, FIRST_TICKS + NEXT_TICKS - 1)
                record_kept(recorder, folder, bench)
            elif name == "seven-steps":
                recorder.write(folder, "claims", recorder.get(f"/benches/{bench}/claims"))
        recorder.write(folder, "folder", folder_bench("first-look"))
        record_design(recorder, folder)
        record_theory(recorder, folder)
        record_exercises(recorder, folder)
        record_class(recorder, folder)
        record_runs(recorder, folder)


if __name__ == "__main__":
    record(*map(Path, sys.argv[1:]))
