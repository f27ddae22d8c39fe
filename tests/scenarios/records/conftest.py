"""A folder of records for each test, and a record of the seven steps."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from core.measured_record import MeasuredRecord, find_on
from scenarios.library import get
from scenarios.record_folders import FOLDER
from scenarios.records import shelf
from scenarios.records.shelf import RecordFolder
from scenarios.run import RunResult, run


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[RecordFolder]:
    monkeypatch.setenv(FOLDER, str(tmp_path / "records"))
    yield shelf.prepare()
    find_on(RecordFolder())


@pytest.fixture(scope="session")
def seven() -> RunResult:
    return run(get("ch5-seven-step"), taps=True)


@pytest.fixture(scope="session")
def own(seven: RunResult) -> MeasuredRecord:
    """The seven steps as a record, with the truth as labels."""
    names = [one.name for one in seven.board.spec.diagnosers["kalman"].params.hypotheses]
    columns = [np.array(seven.signal(name)) for name in ("drive.voltage", "sensor.displacement", "kalman.truth")]
    return MeasuredRecord(50.0, columns[0], columns[1], columns[2].astype(np.int64), names)
