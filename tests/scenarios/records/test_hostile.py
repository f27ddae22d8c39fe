"""A hundred hostile files: each is refused in one line, within little memory, and leaves nothing behind."""

from __future__ import annotations

import itertools
import tracemalloc
from pathlib import Path

import pyarrow as pa
import pytest
from typer.testing import CliRunner

from core.errors import InputError
from scenarios.records import binary_table, columns
from scenarios.records.reading import read_record
from scenarios.records.shelf import RecordFolder
from server.cli.main import app
from tests.scenarios.records import hostile

MOST_MEMORY = 24 << 20
"""Memory that the refusal of a small file may take; bombs unpack to more than this, or announce more."""
FILES = [*itertools.chain(hostile.texts(), hostile.units(), hostile.binaries())]


@pytest.fixture(autouse=True)
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Lower the limits, so that bombs may be small too."""
    monkeypatch.setattr(columns, "MOST_SAMPLES", 100_000)
    monkeypatch.setattr(binary_table, "MOST_UNPACKED", 8 << 20)


def refused(name: str, content: bytes, said: str) -> None:
    pool = pa.default_memory_pool()
    before = pool.bytes_allocated()
    tracemalloc.start()
    with pytest.raises(InputError) as found:
        read_record(content, name)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    line = str(found.value)
    assert said in line and line.isprintable() and len(line) < 300, line
    assert most + pool.bytes_allocated() - before < MOST_MEMORY


@pytest.mark.parametrize(("name", "content", "said"), FILES, ids=[name for name, _, _ in FILES])
def test_a_hostile_file_is_refused_in_one_line(name: str, content: bytes, said: str) -> None:
    refused(name, content, said)


def test_hostile_files_of_hdf5_are_refused_in_one_line() -> None:
    pytest.importorskip("h5py")
    for name, content, said in hostile.hdf5():
        refused(name, content, said)


def test_there_are_a_hundred() -> None:
    assert len(FILES) >= 92  # and eight of HDF5


def test_the_command_refuses_them_in_one_line_and_writes_nothing(
    folder: RecordFolder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for number, (name, content, _) in enumerate(FILES[::31]):
        file = tmp_path / f"{number}{Path(name).suffix}"
        file.write_bytes(content)
        found = CliRunner().invoke(app, ["diagnose", file.name, "--html", "a.html"], catch_exceptions=False)
        assert found.exit_code == 2 and found.stderr.count("\n") == 1, name
        file.unlink()
    assert [*tmp_path.iterdir()] == [] and [*folder.keys()] == []
