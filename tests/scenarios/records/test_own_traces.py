"""Traces of the bench itself, through files and back: the banks give the same bits, in blocks of any size."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import get_args

import pytest

from core.board.board import Board
from core.errors import InputError
from core.measured_record import MeasuredRecord
from scenarios.library import get, library
from scenarios.records.bench import on_record
from scenarios.records.reading import read_record
from scenarios.records.shelf import RecordFolder
from scenarios.report.traces import TraceFile
from scenarios.run import RunResult, run
from scenarios.schema import Scenario
from server.store.traces import Cut, Format, read_cut, write

BLOCKS = (1, 777, 16_384)
"""Samples that are computed at a time."""
READ_BACK = tuple(kind for kind in get_args(Format) if kind in ("csv", "parquet", "mat"))
CHEAP = ("ch5-seven-step", "ch5-difference-equations", "ch5-self-tuning-two-devices")
OTHER_SENSOR = "ch5-two-outputs"
"""Reads a sensor that no record has."""


def banks(scenario: Scenario) -> list[str]:
    """Return the diagnosers that give probabilities."""
    of = scenario.spec.diagnosers.items()
    return [name for name, section in of if any(port.name == "probability" for port in section.block.outputs)]


def able() -> list[str]:
    """Return the scenarios whose banks need voltage and displacement alone."""
    usual = [one for one in library() if one.study is None and not one.spec.axes and not one.twins]
    return [one.id for one in usual if banks(one) and one.id != OTHER_SENSOR]


def probabilities(result: RunResult, names: list[str]) -> dict[str, bytes]:
    kept = [one.name for one in result.kept if any(one.name.startswith(f"{name}.probability.") for name in names)]
    return {name: result.signal(name).tobytes() for name in kept}


def digests(scenario: Scenario, samples: int) -> set[str]:
    found = set()
    for block in BLOCKS:
        board = Board(scenario.spec)
        while board.tick < samples:
            board.advance(min(block, samples - board.tick))
        found.add(board.digest())
    return found


def check(name: str, folder: RecordFolder, tmp_path: Path, samples: int | None = None) -> None:
    scenario = get(name)
    with TraceFile(tmp_path / "trace.parquet", scenario.document) as trace:
        run(scenario, trace=trace)
    own = run(scenario)
    table = read_cut(tmp_path / "trace.parquet", Cut(), 1 << 20)
    records = dict[str, MeasuredRecord]()
    for kind in READ_BACK:
        content = BytesIO()
        write(table, content, kind)
        read = read_record(content.getvalue(), f"trace.{kind}")
        records[read.record.key] = read.record
        assert read.record.rate_khz == scenario.spec.document["sample_rate_khz"] and not read.notes
    (record,) = records.values()
    folder.keep(record)
    again = Scenario.load(on_record(scenario, record))
    expected = probabilities(own, banks(scenario))
    assert expected and probabilities(run(again), banks(scenario)) == expected
    assert len(digests(again, samples or record.samples)) == 1


@pytest.mark.parametrize("name", CHEAP)
def test_a_trace_through_files_gives_the_bits_of_the_bench(name: str, folder: RecordFolder, tmp_path: Path) -> None:
    check(name, folder, tmp_path, 1600)


@pytest.mark.long
@pytest.mark.parametrize("name", able())
def test_every_trace_through_files_gives_the_bits_of_the_bench(name: str, folder: RecordFolder, tmp_path: Path) -> None:
    check(name, folder, tmp_path)


def test_twenty_scenarios_are_able() -> None:
    assert len(able()) >= 20 and set(CHEAP) <= set(able())


def test_a_bank_that_needs_another_sensor_is_refused(own: MeasuredRecord, folder: RecordFolder) -> None:
    folder.keep(own)
    with pytest.raises(InputError, match="reads velocimeter, and a record has only recorded") as refused:
        Scenario.load(on_record(get(OTHER_SENSOR), own))
    assert refused.value.field == "diagnosers.both.kind"


def test_times_tell_the_rate_of_every_scenario() -> None:
    for rate in {one.spec.document["sample_rate_khz"] for one in library() if one.study is None}:
        rows = "\n".join(f"{i / rate!r},{i % 7},{i % 5}" for i in range(3000))
        assert read_record(f"time_ms,u,y\n{rows}".encode(), "a.csv").record.rate_khz == rate
