"""Files of results: others read them in place, they are whole, and they follow the table of results."""

from __future__ import annotations

from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import duckdb
import numpy as np
import pyarrow.parquet as pq
import pytest

from core.errors import InputError
from scenarios.campaign import parquet as module
from scenarios.campaign.batch import outcomes
from scenarios.campaign.outcome import RunOutcome
from scenarios.campaign.parquet import ParquetParts
from scenarios.campaign.survey import Survey
from scenarios.campaign.sweep import Sweep
from scenarios.campaign.tally import tally
from scenarios.report.campaign import surveyed_report
from scenarios.report.campaign_picture import campaign_picture, surveyed_picture
from scenarios.schema import Scenario

DOCUMENT: dict[str, Any] = {
    "schema": 1,
    "scenario": "ch5-seven-step",
    "set": {"samples": 2500},
    "seeds": {"count": 6},
    "grid": {"sensor.noise_um": [0.05, 0.1, 0.6], "controller.kind": ["open_loop", "pid"]},
}


class Table:
    """A table of results that can be filled bit by bit."""

    def __init__(self, found: dict[str, RunOutcome]) -> None:
        self.found = dict(found)
        self.visible: set[str] = set()
        self.reads = 0

    def read(self, keys: list[str]) -> list[tuple[str, str]]:
        self.reads += len(keys)
        return [(key, self.found[key].model_dump_json()) for key in keys if key in self.visible]

    def show(self, *keys: str) -> None:
        self.visible |= set(keys or self.found)


@pytest.fixture(scope="module")
def computed() -> tuple[Sweep, dict[str, RunOutcome]]:
    sweep = Sweep(DOCUMENT)
    runs = [(key, Scenario.load(point.document), seed) for key, point, seed in sweep.runs()]
    found = outcomes([(scenario, seed) for _, scenario, seed in runs])
    return sweep, {key: outcome for (key, _, _), outcome in zip(runs, found, strict=True)}


@pytest.fixture
def made(
    computed: tuple[Sweep, dict[str, RunOutcome]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> tuple[Sweep, ParquetParts, Table]:
    """A campaign of 36 runs in files of 10, read 4 at a time."""
    monkeypatch.setattr(module, "PART", 10)
    monkeypatch.setattr("scenarios.campaign.survey.PART", 10)
    monkeypatch.setattr(module, "AT_ONCE", 4)
    return computed[0], ParquetParts(computed[0], tmp_path / "runs"), Table(computed[1])


def test_files_follow_the_table_of_results(made: tuple[Sweep, ParquetParts, Table]) -> None:
    sweep, parts, table = made
    keys = [sweep.key(number) for number in range(len(sweep))]
    assert keys == [key for key, _, _ in sweep.runs()]
    assert parts.keep_up(table.read) == 0 and table.reads == 4, "behind missing runs nothing is looked for"
    table.show(*keys[:13])
    assert parts.keep_up(table.read) == 13 and parts.whole() == 1
    first, before = parts.path(0), parts.path(0).stat().st_mtime_ns
    table.show(*keys[:20], *keys[33:])
    assert parts.keep_up(table.read) == 20 and first.stat().st_mtime_ns == before, "what is whole is not written again"
    assert parts.keep_up(table.read, to_end=True) == 23
    table.show()
    assert parts.keep_up(table.read) == 36 and parts.whole() == len(parts) == 4
    # a lost file and one of another program are made anew from the table
    parts.path(1).unlink()
    parts.path(2).write_bytes(b"PAR1")
    again = ParquetParts(sweep, first.parent)
    assert again.whole() == 2 and again.keep_up(table.read) == 36
    assert [path.name for path in sorted(first.parent.iterdir())] == [f"part-0000{n}.parquet" for n in range(4)]
    rows = pq.read_table(first.parent)
    assert rows["key"].to_pylist() == keys
    assert rows["digest"].to_pylist() == [table.found[key].digest for key in keys]


def test_arrow_and_duckdb_read_the_folder_while_it_grows(made: tuple[Sweep, ParquetParts, Table]) -> None:
    """The second half has a figure that the first lacks; the columns of all files stay the same."""
    sweep, parts, table = made
    keys = [sweep.key(number) for number in range(len(sweep))]
    for key in keys[:20]:
        table.found[key] = table.found[key].model_copy(update={"metrics": {"control.rms_error_um": 1.0}})
    table.show(*keys[:20])
    parts.keep_up(table.read)
    folder = parts.path(0).parent
    assert len(pq.read_table(folder)) == 20
    assert duckdb.sql(f"SELECT count(*) FROM read_parquet('{folder}/*.parquet')").fetchall() == [(20,)]
    table.show()
    parts.keep_up(table.read)
    frame = pq.read_table(folder)
    name = "diagnosis.kalman.correct_fraction"
    assert len(frame) == 36 and frame[name].null_count == 20
    labels = [
        (point.labels["sensor.noise_um"], point.labels["controller.kind"], seed) for _, point, seed in sweep.runs()
    ]
    assert (
        list(zip(*(frame[axis].to_pylist() for axis in ("sensor.noise_um", "controller.kind", "seed")), strict=True))
        == labels
    )
    assert frame["point"].to_pylist() == [number // 6 for number in range(36)]
    query = f"""SELECT "controller.kind", avg("{name}") FROM read_parquet('{folder}/*.parquet') GROUP BY ALL"""
    found = dict(duckdb.sql(query).fetchall())
    means = frame.group_by("controller.kind").aggregate([(name, "mean")]).to_pylist()
    assert found == pytest.approx({row["controller.kind"]: row[f"{name}_mean"] for row in means})


def test_a_campaign_that_was_changed_has_new_files(made: tuple[Sweep, ParquetParts, Table], tmp_path: Path) -> None:
    _, parts, table = made
    table.show()
    parts.keep_up(table.read)
    smaller = Sweep({**DOCUMENT, "seeds": {"count": 2}})
    changed = ParquetParts(smaller, tmp_path / "runs")
    assert changed.keep_up(table.read) == 12 and len(changed.paths()) == 2
    assert pq.read_table(tmp_path / "runs").num_rows == 12


def test_a_survey_of_files_is_the_tally_of_outcomes(made: tuple[Sweep, ParquetParts, Table]) -> None:
    sweep, parts, table = made
    table.show()
    parts.keep_up(table.read)
    survey = Survey(sweep, parts)
    everything = tally(sweep, table.found)
    for mine, other in zip(survey.page(range(6)), everything, strict=True):
        assert same(mine, other)
    assert survey.order().tolist() == list(range(6)) and survey.runs() == 36 and survey.failed() == 0
    name = "diagnosis.kalman.correct_fraction"
    means = [point.metrics[name].mean for point in everything]
    assert survey.order(name).tolist() == np.argsort(means, kind="stable").tolist()
    assert survey.order(name, descending=True).tolist() == np.argsort(means, kind="stable")[::-1].tolist()
    assert survey.order("controller.kind").tolist() == [0, 2, 4, 1, 3, 5]
    assert survey.order("sensor.noise_um", descending=True).tolist() == [4, 5, 2, 3, 0, 1]
    with pytest.raises(InputError, match="sort"):
        survey.order("nonsense")
    assert "36 of 36 runs" in surveyed_report(sweep, survey)


def same(mine: Any, other: Any) -> bool:
    """Whether two tallies say the same; means are added up in another order."""
    for name, spread in mine.metrics.items():
        assert asdict(spread) == pytest.approx(asdict(other.metrics[name]), rel=1e-9, abs=1e-15)
        assert spread.std == 0.0 or spread.min < spread.max, "what is all alike has no deviation"
    return bool(replace(mine, metrics={}) == replace(other, metrics={}))


def test_runs_are_counted_over_one_quantity_and_over_two(
    made: tuple[Sweep, ParquetParts, Table], monkeypatch: pytest.MonkeyPatch
) -> None:
    sweep, parts, table = made
    failed = sweep.key(0)
    table.found = {**table.found, failed: RunOutcome(seed=1, error="severity: too large")}
    table.show()
    parts.keep_up(table.read)
    survey = Survey(sweep, parts)
    assert survey.failed() == 1 and survey.page([0])[0].errors == ["severity: too large (1 runs)"]
    name = "control.rms_error_um"
    values = np.array([table.found[key].metrics[name] for key, _, _ in sweep.runs() if key != failed])
    alone = survey.distribution(name)
    assert alone.runs == 35 and alone.y is None and alone.dots is None
    assert alone.counts[0] == np.histogram(values, alone.x.cells)[0].tolist()
    both = survey.distribution("sensor.noise_um", name)
    assert both.dots is not None and len(both.dots) == 35 == sum(map(sum, both.counts))
    assert both.y is not None and len(both.counts) == both.y.cells and len(both.counts[0]) == both.x.cells
    assert sum(row[0] for row in both.counts) == 11, "runs of the least noise stand in the first column"
    assert (both.y.low, both.y.high) == (values.min(), values.max())
    monkeypatch.setattr("scenarios.campaign.survey.MOST_DOTS", 30)
    assert survey.distribution("sensor.noise_um", name).dots is None
    with pytest.raises(InputError, match="controller"):
        survey.distribution("controller.kind")


def test_the_report_of_many_points_lists_the_first(
    made: tuple[Sweep, ParquetParts, Table], monkeypatch: pytest.MonkeyPatch
) -> None:
    sweep, parts, table = made
    monkeypatch.setattr("scenarios.report.campaign.MOST_POINTS", 3)
    table.show()
    parts.keep_up(table.read)
    text = surveyed_report(sweep, Survey(sweep, parts), "Many")
    assert "36 of 36 runs" in text and "The first 3 points" in text and "<h1>Many</h1>" in text


def test_the_picture_of_files_is_that_of_outcomes(made: tuple[Sweep, ParquetParts, Table]) -> None:
    """It is of all points, and reads no more figures than it needs."""
    sweep, parts, table = made
    table.show()
    parts.keep_up(table.read)
    survey = Survey(sweep, parts)
    everything = dict(enumerate(tally(sweep, table.found)))
    for figure in ("", "control.rms_error_um"):
        mine = surveyed_picture(survey, figure)
        other = campaign_picture(sweep, everything, survey.figures, figure)
        assert mine.figures == other.figures
        assert [part.labels for part in mine.parts] == [part.labels for part in other.parts]
        for part, beside in zip(mine.parts, other.parts, strict=True):
            assert part.x == beside.x and part.mean == pytest.approx(beside.mean, rel=1e-9)
    (bare,) = survey.page([0], ["control.rms_error_um"])
    assert list(bare.metrics) == ["control.rms_error_um"] and not bare.diagnosis and bare.runs == 6


def test_a_file_of_many_runs_of_a_point_holds_what_they_add_up_to(
    made: tuple[Sweep, ParquetParts, Table], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its stored totals equal bit for bit the totals of its runs, and none of the runs is read."""
    sweep, parts, table = made
    table.show()
    parts.keep_up(table.read, to_end=True)
    points = range(len(sweep.points))
    assert parts.sums(0) is None, "two points of six runs are not worth it"
    plain = Survey(sweep, parts).page(points)
    monkeypatch.setattr(module, "MANY", 5)
    written = ParquetParts(sweep, parts.path(0).parent.with_name("written"))
    written.keep_up(table.read, to_end=True)
    read: list[int] = []
    tables = ParquetParts.tables
    monkeypatch.setattr(
        ParquetParts, "tables", lambda self, names, numbers: (read.extend(numbers), tables(self, names, numbers))[1]
    )
    assert Survey(sweep, written).page(points) == plain
    assert read == [number for number in range(len(written)) if written.sums(number) is None] != [*range(len(written))]


def test_the_first_runs_are_written_before_the_rest(
    made: tuple[Sweep, ParquetParts, Table], monkeypatch: pytest.MonkeyPatch
) -> None:
    sweep, parts, table = made
    assert parts.begin(table.read) == 0 and not parts.paths()
    table.show(*[sweep.key(number) for number in range(9)])
    assert parts.begin(table.read) == 4, "so many are read at once"
    assert parts.begin(table.read) == 4, "there are some: the rest is the work of others"
    assert parts.keep_up(table.read) == 9
    monkeypatch.setattr(module, "AT_ONCE", 99)
    table.show()
    other = ParquetParts(sweep, parts.path(0).parent.with_name("other"))
    assert other.begin(table.read) == 10, "no more than the file holds"
