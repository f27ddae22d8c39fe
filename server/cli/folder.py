"""A live bench in a folder: the page as it is, its bench, and the answers of a server that such a page asks for."""

from __future__ import annotations

import gzip
import html
import json
import re
import shutil
import time
from pathlib import Path
from typing import Any

from core.board.live import section_at
from core.cards import BlockCard, card
from core.errors import InputError
from scenarios.claims import marks
from scenarios.designer import evaluation
from scenarios.in_a_file.bench_file import STAND_IN, BenchFile
from scenarios.in_a_file.pack import packed
from scenarios.run import build
from scenarios.schema import Scenario
from server.api.devices import get_devices
from server.api.scenarios import card as scenario_card
from server.bench.bench import LiveBench
from server.bench.description import bench_of
from server.bench.pacing import usual_scale
from server.metrics import Metrics

INDEX, BENCH = "index.html", "bench"
LEFT = ("in-a-file",)
"""Folders of the build that such a page does not need."""
NOT_NEEDED = (".gz", ".woff", ".ttf")
"""Endings of files that it does not need: the host compresses, and all browsers that run it know WOFF2."""
POLICY = (
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'; "
    "style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self' data:; base-uri 'none'; "
    "form-action 'none'"
)
"""It asks no other host for anything, and the browser holds it to that."""


def write_folder(scenario: Scenario, bench: BenchFile, built: Path, folder: Path, version: str) -> int:
    """Write the page and a bench into a folder, which any static host serves below any path; return its bytes.

    Raises
    ------
    InputError
        When the page has not been built, and when the folder has something in it.
    """
    index = built / INDEX
    if not index.is_file():
        raise InputError("the page has not been built", "--static", "build it: make setup in a checkout")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(f"{folder} is there and is not an empty folder", "--static", "name a new folder")
    parts = {
        "code.bin": bench.code,
        "pack.bin": packed({**bench.document, "version": version}),
        "answers.bin": json.dumps(answers(scenario, bench), separators=(",", ":")).encode(),
    }
    shutil.copytree(built, folder, ignore=_ignored(built), dirs_exist_ok=True)
    (folder / INDEX).write_text(_page(index.read_text("utf-8"), bench.document["title"]), "utf-8")
    (folder / BENCH).mkdir()
    for name, content in parts.items():
        (folder / BENCH / name).write_bytes(gzip.compress(content, 9, mtime=0))
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())


def answers(scenario: Scenario, file: BenchFile) -> dict[str, Any]:
    """Return the answers of a server to such a page, as far as they are always the same.

    The catalogue has the blocks of the bench alone, and only the values that a command of the bench sets are live, so
    that the page offers nothing it cannot do.
    """
    board = build(scenario, compiled=False)
    bench = LiveBench(scenario, board, usual_scale(board), 1, Metrics(), time.monotonic)
    bench.id = scenario.id
    described = bench_of(bench, {}, None).model_dump(mode="json", exclude={"created"})
    own = described["parameters"].get("device", {})
    return {
        "bench": {**described, "controllers": _controllers(file), "source": scenario.head.source},
        "catalog": _catalogue(file, board),
        "scenario": scenario_card(scenario).model_dump(mode="json"),
        "devices": [one.model_dump(mode="json") for one in get_devices().devices if one.id == own.get("id")],
        "printed": [one.model_dump(mode="json") for one in marks(scenario, board.signals)],
        "drawing": None if board.spec.axes else _drawing(own, described["parameters"].get("environment", {})),
        "stand_in": None if board.spec.axes else _drawing({"id": STAND_IN}, {}),
    }


def _controllers(file: BenchFile) -> list[str]:
    """Return the controllers that drive in some choice of the file, in the order of their slots."""
    choices = {name for choice in file.document["wirings"]["writes"]["w"]["numbers"] for name in choice.split("+")}
    return [name for name in file.document["controllers"] if name in choices]


def _catalogue(file: BenchFile, board: Any) -> list[dict[str, Any]]:
    """Return the cards of the blocks of a bench; only the values that a command of the file sets can be set."""
    live: dict[type, set[str]] = {}
    for path in file.document["values"]:
        head, _, name = path.rpartition(".")
        section = section_at(board.spec, head)
        assert section is not None
        live.setdefault(section.block, set()).add(name)
    blocks = dict.fromkeys(one.block for one in board.wiring.instances)
    faults, found = file.document["faults"], []
    for block in blocks:
        own: BlockCard = card(block)
        if own.family == "faults" and own.name not in faults:
            continue
        document = own.model_dump(mode="json")
        for parameter in document["parameters"]:
            parameter["live"] = parameter["name"] in live.get(block, ())
        if own.family == "faults":
            severity = next(one for one in document["parameters"] if one["name"] == "severity")
            document["parameters"] = [severity | {"live": True, "grid": _grid(faults[own.name])}]
        found.append(document)
    return found


def _grid(fault: dict[str, Any]) -> list[float] | None:
    """Return the severities that a fault has, where it has not all of them."""
    grid: list[float] | None = fault["variants"][0]["dependence"].get("grid")
    return grid


def _drawing(device: dict[str, Any], environment: dict[str, Any]) -> dict[str, Any]:
    found = evaluation(device=device, environment=environment)
    return {"title": device.get("id", ""), "geometry": found.geometry}


def _ignored(built: Path) -> Any:
    """Return for the copying of a folder which of its files and folders stay behind."""

    def ignore(folder: str, names: list[str]) -> list[str]:
        own = (*LEFT, INDEX) if Path(folder) == built else ()
        return [name for name in names if name in own or name.endswith(NOT_NEEDED)]

    return ignore


def _page(text: str, title: str) -> str:
    """Return the page without the base of a server, with the policy and the way to its bench."""
    head = (
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}" />\n'
        f'    <meta name="bench" content="./{BENCH}/" />'
    )
    text = re.sub(r"(<!--[^>]*-->\s*)?<base\b[^>]*>", head, text, count=1)
    return re.sub(r"<title>.*?</title>", f"<title>{html.escape(title)}</title>", text, count=1)
