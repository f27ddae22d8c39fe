"""The remains of a killed server in its recordings are put in order at the next start."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator
from pathlib import Path

import pyarrow as pa
import pytest

from server.store.database import Database
from server.store.recording import EVENTS, PART
from server.store.recordings import About, Recordings

ABOUT = About(bench_id="b", name="mine", title="Mine", dt_ms=0.01, scenario={}, seed=1)
SCHEMA = pa.schema([("tick", pa.int64()), ("time", pa.float64()), ("x", pa.float32())])
EVENT = {"tick": 7, "kind": "note"}


@pytest.fixture
def database(tmp_path: Path) -> Iterator[Database]:
    database = Database(tmp_path / "test.sqlite3")
    database.migrate()
    yield database
    database.close()


def test_a_kill_just_after_a_row_was_closed_leaves_no_events_behind(database: Database, tmp_path: Path) -> None:
    async def closed_then_killed() -> None:
        recordings = Recordings(database, tmp_path / "recordings", 0)
        opened, file = await recordings.open(ABOUT, SCHEMA)
        file.append(pa.table([[5, 6], [0.05, 0.06], [1.0, 2.0]], schema=SCHEMA))
        file.note(json.dumps(EVENT))
        await asyncio.to_thread(recordings.closer(opened.id), 5, file.finish(), "stopped", False)
        events = recordings.path(opened.id).with_suffix(EVENTS)
        events.write_text(json.dumps(EVENT) + "\n")  # as if the kill had come before its deletion
        again = Recordings(database, tmp_path / "recordings", 0)
        await again.recover()
        assert not events.exists()
        found = await again.get(opened.id)
        assert (found.state, found.ticks, found.events) == ("done", 2, [EVENT])

    asyncio.run(closed_then_killed())


def test_a_stream_left_of_a_closed_recording_does_not_cost_its_events(database: Database, tmp_path: Path) -> None:
    async def left_by_a_full_disk() -> None:
        recordings = Recordings(database, tmp_path / "recordings", 0)
        opened, file = await recordings.open(ABOUT, SCHEMA)
        file.append(pa.table([[5, 6], [0.05, 0.06], [1.0, 2.0]], schema=SCHEMA))
        file.note(json.dumps(EVENT))
        part = recordings.path(opened.id).with_suffix(PART)
        stream = part.read_bytes()
        part.unlink()  # what salvage finds when the disk is full: nothing it can turn into Parquet
        await asyncio.to_thread(recordings.closer(opened.id), 5, file.salvage(), "the disk is full", True)
        part.write_bytes(stream)
        again = Recordings(database, tmp_path / "recordings", 0)
        await again.recover()
        found = await again.get(opened.id)
        assert (found.ticks, found.start_tick, found.events) == (2, 5, [EVENT])
        assert {path.suffix for path in (tmp_path / "recordings").iterdir()} == {".parquet"}

    asyncio.run(left_by_a_full_disk())
