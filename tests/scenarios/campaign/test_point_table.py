"""Points from a design of experiments: rows in their order and of their kind, from a document, CSV and Parquet."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from core.errors import InputError
from scenarios.campaign.check import check
from scenarios.campaign.sweep import Sweep
from server.cli.sweep import checked, read_sweep, with_table

NOISE, KIND = "sensor.noise_um", "controller.kind"
SEVEN: dict[str, Any] = {"schema": 1, "scenario": "ch5-seven-step", "set": {"samples": 500}}
ROWS = [[0.2, "mrac", 40], [0.1, "pid", 50], [0.2, "mrac", 40], [0.3, "open_loop", 60]]
PATHS = [NOISE, KIND, "samples"]
TEXT = f"{NOISE},{KIND},samples\n" + "".join(f"{a},{b},{c}\n" for a, b, c in ROWS)


def sweep_of(points: dict[str, Any]) -> Sweep:
    return checked({"schema": 1, "scenario": "ch5-seven-step", "points": points})


def test_each_row_is_a_point_with_its_values_and_labels() -> None:
    sweep = sweep_of({"paths": PATHS, "rows": ROWS})
    assert [[*point.values.values()] for point in sweep.points] == ROWS
    assert [point.labels for point in sweep.points] == [dict(zip(PATHS, row, strict=True)) for row in ROWS]
    assert type(sweep.points[0].values["samples"]) is int
    assert sweep.points[1].read().samples == 50 and sweep.points[1].document["controller"]["kind"] == "pid"
    assert sweep.key(0) == sweep.key(2) != sweep.key(1)  # a repeated row is not computed twice
    assert sweep.points.axes() == {NOISE: False, KIND: True, "samples": False}


def test_rows_are_combined_with_variants_grids_and_seeds() -> None:
    points = {"paths": [NOISE], "rows": [[0.1], [0.2]]}
    sweep = Sweep({**SEVEN, "points": points, "grid": {KIND: ["pid", "mrac"]}, "seeds": "3:5"})
    assert len(sweep.points) == 4 and len(sweep) == 12
    assert [(p.labels[KIND], p.labels[NOISE]) for p in sweep.points] == [
        ("pid", 0.1), ("pid", 0.2), ("mrac", 0.1), ("mrac", 0.2),
    ]  # fmt: skip


def test_csv_parquet_and_rows_are_the_same_campaign(tmp_path: Path) -> None:
    keys = [sweep_of({"paths": PATHS, "rows": ROWS}).key(number) for number in range(4)]
    (tmp_path / "design.csv").write_text(TEXT)
    columns = {path: [row[at] for row in ROWS] for at, path in enumerate(PATHS)}
    pq.write_table(pa.table(columns), tmp_path / "design.parquet")
    for name in ("design.csv", "design.parquet"):
        file = tmp_path / f"{name}.toml"
        file.write_text(f'schema = 1\nscenario = "ch5-seven-step"\n[points]\ntable = "{name}"\n')
        assert [read_sweep(file).key(number) for number in range(4)] == keys
    assert [sweep_of({"csv": TEXT}).key(number) for number in range(4)] == keys


@pytest.mark.parametrize(
    ("points", "words"),
    [
        ({}, ["points", "at least one row"]),
        ({"paths": [NOISE], "rows": []}, ["points", "at least one row"]),
        ({"paths": [NOISE, NOISE], "rows": [[1, 2]]}, ["twice", NOISE]),
        ({"paths": [NOISE], "rows": [[0.1], [0.1, 0.2]]}, ["row 2", "2 values for 1"]),
        ({"paths": [NOISE], "rows": [[0.1], ["low"]]}, [f"points.{NOISE}", "row 2", "'low'", "finite number"]),
        ({"paths": [NOISE], "rows": [[0.1], [None]]}, ["row 2", "finite number"]),
        ({"paths": [NOISE], "rows": [[0.1], [float("nan")]]}, ["row 2", "nan", "finite number"]),
        ({"paths": [KIND], "rows": [["pid"], [3]]}, ["row 2", "3", "text"]),
        ({"paths": [KIND], "rows": [[["pid"]]]}, ["row 1", "pid"]),
        ({"paths": ["sensor.nose_um"], "rows": [[0.1]]}, ["nose_um"]),
        ({"paths": [NOISE], "rows": [[0.1], [0.2], [-1.0]]}, ["noise_um", "-1"]),
        ({"paths": [KIND], "rows": [["pid"], ["mrac"], ["mrak"]]}, ["mrak"]),
        ({"paths": ["seed"], "rows": [[1]]}, ["points.paths.seed", "[seeds]"]),
        ({"table": "design.csv"}, ["points", "design.csv", "paths and rows"]),
        ({"csv": "a,b\n1\n"}, ["csv", "cannot be read"]),
        ({"csv": f"{NOISE}\n0.1\n", "paths": [NOISE], "rows": [[0.1]]}, ["not both"]),
    ],
)
def test_a_wrong_table_is_refused_in_one_line(points: dict[str, Any], words: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        check(Sweep({**SEVEN, "points": points}))
    assert all(word in str(caught.value) for word in words) and "\n" not in str(caught.value), str(caught.value)


def test_a_path_has_values_from_one_source() -> None:
    with pytest.raises(InputError, match="points"):
        Sweep({**SEVEN, "points": {"paths": [NOISE], "rows": [[0.1]]}, "grid": {NOISE: [0.2]}})


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("missing.csv", None, ["missing.csv"]),
        ("empty.csv", b"", ["empty.csv", "cannot be read"]),
        ("short.csv", b"a,b\n1,2\n3\n", ["short.csv", "cannot be read"]),
        ("latin.csv", b"sensor.noise_um\n\xff\xfe\x00\n", ["row 1"]),
        ("damaged.parquet", b"PAR1 and no more", ["damaged.parquet", "cannot be read"]),
        ("long.csv", b"a\n" + b"1\n" * 100_001, ["100001 rows", "100000"]),
        ("wide.csv", (",".join(f"c{n}" for n in range(51)) + "\n" + "1," * 50 + "1\n").encode(), ["51 columns", "50"]),
    ],
)
def test_a_wrong_file_is_refused_in_one_line(
    tmp_path: Path, name: str, content: bytes | None, words: list[str]
) -> None:
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError) as caught:
        checked(with_table({**SEVEN, "points": {"table": name}}, tmp_path))
    assert all(word in str(caught.value) for word in words) and "\n" not in str(caught.value), str(caught.value)
