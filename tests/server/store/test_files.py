"""Trace files: every format holds the same numbers, and files that a crash has cut off are recovered."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.csv
import pyarrow.parquet as pq
import pytest
from scipy.io import loadmat

from core.errors import InputError
from scenarios.report.traces import schema_of
from server.bench.recorder import Recorder
from server.store.recording import RecordingFile, convert, rescue
from server.store.traces import MEDIA_TYPES, table_of, write

DT = 0.01
UNITS = {"plant.displacement": "um", "drive.voltage": "V"}
SCHEMA = schema_of(UNITS, {"scenario": "mine"}, "float32")
SAMPLES = np.array([[1.5, -2.25, 3e-7], [10.0, 0.0, -1e9]], np.float32)


def read(path: Path, kind: str) -> dict[str, Any]:
    if kind == "parquet":
        return {name: column.to_numpy() for name, column in zip(*_columns(pq.read_table(path)), strict=True)}
    if kind == "csv":
        return {name: column.to_numpy() for name, column in zip(*_columns(pyarrow.csv.read_csv(path)), strict=True)}
    if kind == "npz":
        return dict(np.load(path))
    if kind == "mcap":
        return of_mcap(path)
    found = {k: v for k, v in loadmat(path).items() if not k.startswith("__")}
    names = found.pop("names")
    return {str(names[variable][0, 0][0]): values[:, 0] for variable, values in found.items()}


def of_mcap(path: Path) -> dict[str, Any]:
    """Return the signals of an MCAP file, each message checked against its schema, which is checked too."""
    import jsonschema_rs
    from mcap.reader import make_reader

    found: dict[str, Any] = {}
    with path.open("rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            assert schema is not None and (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
            said, rule = json.loads(message.data), json.loads(schema.data)
            jsonschema_rs.meta.validate(rule)
            jsonschema_rs.Draft202012Validator(rule).validate(said)
            assert message.log_time == round(said["time_ms"] * 1e6)
            for name, value in said.items():
                if name in ("tick", "time_ms") and channel.topic != "/plant":
                    continue
                full = name if name in ("tick", "time_ms") else f"{channel.topic[1:]}.{name}"
                found.setdefault(full, []).append(np.nan if value is None else value)
                if full not in ("tick", "time_ms"):
                    assert rule["properties"][name]["unit"] == UNITS[full]
    return {name: np.array(values) for name, values in found.items()}


def _columns(table: Any) -> tuple[list[str], list[Any]]:
    return table.column_names, table.columns


@pytest.mark.parametrize("kind", list(MEDIA_TYPES))
def test_every_format_holds_the_same_numbers(tmp_path: Path, kind: Any) -> None:
    path = tmp_path / f"trace.{kind}"
    with path.open("wb") as file:
        write(table_of(SCHEMA, 100, DT, SAMPLES), file, kind)
    found = read(path, kind)
    assert list(found) == ["tick", "time_ms", "plant.displacement", "drive.voltage"]
    assert found["tick"].tolist() == [100, 101, 102]
    np.testing.assert_allclose(found["time_ms"], [1.0, 1.01, 1.02])
    np.testing.assert_array_equal(np.float32(found["plant.displacement"]), SAMPLES[0])
    np.testing.assert_array_equal(np.float32(found["drive.voltage"]), SAMPLES[1])


def test_a_number_that_is_not_finite_is_null_in_mcap(tmp_path: Path) -> None:
    path = tmp_path / "trace.mcap"
    with path.open("wb") as file:
        write(table_of(SCHEMA, 0, DT, np.array([[1.0, np.nan], [np.inf, 2.0]], np.float32)), file, "mcap")
    found = of_mcap(path)
    assert np.isnan(found["plant.displacement"][1]) and np.isnan(found["drive.voltage"][0])


def test_mcap_without_its_package_is_one_clear_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("scenarios.extras.find_spec", lambda _: None)
    with (tmp_path / "trace.mcap").open("wb") as file, pytest.raises(InputError, match="package mcap") as refused:
        write(table_of(SCHEMA, 0, DT, SAMPLES), file, "mcap")
    assert refused.value.field == "format" and "[files]" in refused.value.hint


def test_units_and_origin_are_kept_in_the_file(tmp_path: Path) -> None:
    path = tmp_path / "trace.parquet"
    with path.open("wb") as file:
        write(table_of(SCHEMA, 0, DT, SAMPLES), file, "parquet")
    schema = pq.read_schema(path)
    assert schema.field("plant.displacement").metadata == {b"unit": b"um"}
    assert json.loads(schema.metadata[b"combbench"]) == {"scenario": "mine"}


def test_a_recording_grows_and_becomes_parquet(tmp_path: Path) -> None:
    path = tmp_path / "r.parquet"
    file = RecordingFile(path, SCHEMA)
    for start in (0, 3, 6):
        file.append(table_of(SCHEMA, start, DT, SAMPLES))
    assert not path.exists()
    assert file.finish() == 9
    assert pq.read_table(path)["tick"].to_pylist() == list(range(9))
    assert list(tmp_path.iterdir()) == [path]


def test_what_a_crash_cuts_off_anywhere_is_recovered(tmp_path: Path) -> None:
    path, sizes = tmp_path / "r.parquet", []
    file, part = RecordingFile(path, SCHEMA), path.with_suffix(".arrows")
    for start in range(0, 30, 3):
        file.append(table_of(SCHEMA, start, DT, SAMPLES))
        sizes.append(part.stat().st_size)
    file._sink.close()
    data = part.read_bytes()
    for share in (0.0, 0.2, 0.4, 0.6, 0.8, 0.95, 1.0):
        cut = int(share * len(data))
        whole = sum(size <= cut for size in sizes)
        part.write_bytes(data[:cut])
        if cut < sizes[0] // 2:
            with pytest.raises((OSError, ValueError)):
                convert(path)
            continue
        assert convert(path) == 3 * whole, share
        assert pq.read_table(path)["tick"].to_pylist() == list(range(3 * whole)), share


def test_a_stream_that_says_nothing_is_not_kept_for_ever(tmp_path: Path) -> None:
    path = tmp_path / "r.parquet"
    for left in (b"", b"\xff\xff\xff\xff"):
        path.with_suffix(".arrows").write_bytes(left)
        assert rescue(path) == 0 and list(tmp_path.iterdir()) == []


class Ends:
    """Remembers how a recording ended."""

    def __init__(self) -> None:
        self.told: list[tuple[int, str]] = []

    def __call__(self, first: int, ticks: int, reason: str) -> None:
        self.first = first
        self.told.append((ticks, reason))


def recorder(path: Path, ends: Ends, most: int = 10**9) -> Recorder:
    return Recorder("r" * 8, RecordingFile(path, SCHEMA), SCHEMA, DT, most, ends)


def test_the_recorder_writes_every_tick_once_and_in_order(tmp_path: Path) -> None:
    path, ends = tmp_path / "r.parquet", Ends()
    one = recorder(path, ends)
    rng = np.random.default_rng(1)
    tick, written = 50, []
    for _ in range(200):
        samples = rng.normal(size=(2, int(rng.integers(1, 513)))).astype(np.float32)
        one.append(tick, samples)
        written.append(samples)
        tick += samples.shape[1]
    one.stop()
    one.join()
    everything = np.hstack(written)
    table = pq.read_table(path)
    assert table["tick"].to_pylist() == list(range(50, tick))
    np.testing.assert_array_equal(table["plant.displacement"].to_numpy(), everything[0])
    np.testing.assert_array_equal(table["drive.voltage"].to_numpy(), everything[1])
    assert ends.told == [(tick - 50, "stopped")]


def test_the_recorder_ends_at_its_size_limit(tmp_path: Path) -> None:
    path, ends = tmp_path / "r.parquet", Ends()
    one = recorder(path, ends, most=1000)
    for start in range(0, 2000, 100):
        one.append(start, np.zeros((2, 100), np.float32))
    one.join()
    assert not one.is_open
    assert ends.told == [(1000, "it reached its size limit")]


def test_a_disk_that_is_too_slow_ends_the_recording_and_not_the_bench(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("server.bench.recorder.QUEUE_BYTES", 100_000)
    path, ends = tmp_path / "r.parquet", Ends()
    one = recorder(path, ends)
    while one.is_open:
        one.append(0, np.zeros((2, 20_000), np.float32))
    one.join()
    assert ends.told[0][1] == "the disk could not keep up"
    assert pq.read_metadata(path).num_rows == ends.told[0][0]


def test_a_disk_that_fails_ends_the_recording_and_not_the_bench(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, ends = tmp_path / "r.parquet", Ends()
    one = recorder(path, ends)

    def full(_table: Any) -> None:
        raise OSError(28, "No space left on device")

    one._file.append(table_of(SCHEMA, 0, DT, SAMPLES))
    monkeypatch.setattr(one._file, "append", full)
    one.append(3, np.zeros((2, 10_000), np.float32))
    one.join()
    assert not one.is_open
    assert ends.told == [(3, "the disk failed: No space left on device")]
    assert pq.read_metadata(path).num_rows == 3
    one.append(0, np.zeros((2, 10), np.float32))  # without a reader it has no effect


def test_a_table_of_text_has_a_header() -> None:
    file = io.BytesIO()
    write(table_of(SCHEMA, 0, DT, SAMPLES), file, "csv")
    assert file.getvalue().decode().splitlines()[0] == '"tick","time_ms","plant.displacement","drive.voltage"'
