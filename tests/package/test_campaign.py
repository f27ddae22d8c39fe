"""Campaigns from Python: the figures of single runs, in a folder that can be continued."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import combbench as cb

CAMPAIGN: dict[str, Any] = {
    "schema": 1,
    "id": "noise",
    "title": "Error over noise",
    "scenario": "first-look",
    "seeds": {"first": 3, "count": 2},
    "set": {"samples": 200},
    "grid": {"sensor.noise_um": [0.0, 0.002]},
}


def test_a_campaign_has_the_runs_of_each_point_and_seed(tmp_path: Path) -> None:
    result = cb.sweep(CAMPAIGN, folder=tmp_path / "kept", workers=1)
    table = result.to_pandas()
    assert len(table) == 4 and len(result.points) == 2 and result.failed == 0
    for row in table.to_dict("records"):
        single = cb.run(
            "first-look", seed=int(row["seed"]), set={"samples": 200, "sensor.noise_um": row["sensor.noise_um"]}
        )
        assert row["digest"] == single.digest
    assert {"report.html", "runs.csv", "runs.parquet"} <= {path.name for path in result.folder.iterdir()}


def test_a_folder_that_holds_a_campaign_is_not_overwritten(tmp_path: Path) -> None:
    folder = tmp_path / "kept"
    first = cb.sweep(CAMPAIGN, folder=folder, workers=1)
    with pytest.raises(cb.InputError, match="holds a campaign already"):
        cb.sweep(CAMPAIGN, folder=folder, workers=1)
    again = cb.sweep(CAMPAIGN, folder=folder, resume=True, workers=1)
    assert again.to_pandas().equals(first.to_pandas())


def test_a_campaign_that_is_not_valid_leaves_no_folder(tmp_path: Path) -> None:
    with pytest.raises(cb.InputError, match=r"sensor\.nothing"):
        cb.sweep({**CAMPAIGN, "grid": {"sensor.nothing": [1]}}, folder=tmp_path / "kept")
    assert not (tmp_path / "kept").exists()
