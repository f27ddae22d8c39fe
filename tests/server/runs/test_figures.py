"""Figures of the gallery: made once, kept, and reported in one line where they cannot be made."""

from __future__ import annotations

import asyncio
import errno
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from server.runs.figures import ScenarioFigures, build

FEW = ("first-look", "ch1-beam-width", "ch3-ffrls-b30")


@pytest.fixture(autouse=True)
def none_built(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Forget the figures that a wheel or an image would bring."""
    monkeypatch.setattr("server.runs.figures.BUILT", tmp_path / "built")


def few(monkeypatch: pytest.MonkeyPatch, *more: Any) -> None:
    chosen = (*(get(name) for name in FEW), *more)
    for module in ("server.runs.figures", "server.api.gallery"):
        monkeypatch.setattr(f"{module}.library", lambda: chosen)


def settled(live: Any, first: Sequence[str] = ()) -> dict[str, Any]:
    """Open the gallery, with some cards in sight; return it once no figure is being made."""

    async def made() -> None:
        await asyncio.wait([live.service.figures._task])

    opened = live.http.get("/api/v1/gallery", params={"first": list(first)}).json()
    if not opened["figures"]["is_making"]:
        return opened
    asyncio.run_coroutine_threadsafe(made(), live.service._loop).result(120)
    found: dict[str, Any] = live.http.get("/api/v1/gallery").json()
    assert not found["figures"]["is_making"]
    return found


def test_figures_are_made_once_and_survive_a_restart(
    serve: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    few(monkeypatch)
    with serve(folder=tmp_path, figures=True) as live:
        found = settled(live)
        assert found["figures"] == {"made": 3, "total": 3, "is_making": False, "problem": ""}
        for card in found["cards"]:
            expected = run(get(card["id"]))
            assert card["digest"] == expected.digest and card["state"] == "new" and card["run"] is None
            assert [one["measured"] for one in card["expectations"]] == [
                one["measured"] for one in expected.expectations()
            ]
            picture = live.http.get(f"/api/v1/gallery/{card['id']}/figure")
            assert picture.headers["content-type"].startswith("image/svg+xml")
            assert ElementTree.fromstring(picture.text).attrib["aria-label"] == card["title"]
        assert live.http.get("/api/v1/runs").json()["runs"] == []  # figures are no requested runs
        assert live.http.get("/api/v1/gallery/none/figure").status_code == 404
        assert live.http.get("/api/v1/gallery/appA-spr/figure").json()["error"]["code"] == "not_found"
    kept = {path: path.stat().st_mtime_ns for path in (tmp_path / "figures").iterdir()}
    assert len(kept) == 3
    (broken := next(iter(kept))).write_text("{")
    (tmp_path / "figures" / "of-another-version.json").write_text("{}")
    with serve(folder=tmp_path, figures=True) as live:
        assert settled(live)["figures"]["made"] == 3
        assert live.service.queue.processes._pool is not None  # the broken one is made again, the others are not
    after = {path: path.stat().st_mtime_ns for path in (tmp_path / "figures").iterdir()}
    assert set(after) == set(kept)
    assert [path for path in kept if after[path] != kept[path]] == [broken]


def test_a_scenario_that_fails_is_told_in_one_line_and_stops_nothing(
    serve: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    few(monkeypatch, with_values(get("ch1-process-spread"), {"device.id": "ch3"}))
    with serve(figures=True) as live:
        found = settled(live)
        assert found["figures"]["made"] == 3 and found["figures"]["total"] == 4
        assert "ch1-process-spread" in found["figures"]["problem"] and "\n" not in found["figures"]["problem"]
        failed = next(card for card in found["cards"] if card["id"] == "ch1-process-spread")
        assert "has no drawing" in failed["problem"] and failed["figure"] is None


def test_on_a_full_disk_figures_are_there_and_the_reason_they_are_not_kept(
    serve: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    few(monkeypatch)

    def full(*_: Any) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("server.runs.figures.write_json", full)
    with serve(folder=tmp_path, figures=True) as live:
        found = settled(live)
        assert found["figures"]["made"] == 3 and "No space left" in found["figures"]["problem"]
        assert live.http.get("/api/v1/gallery/first-look/figure").status_code == 200


def test_cards_say_what_they_are_about(live: Any) -> None:
    cards = {card["id"]: card for card in live.http.get("/api/v1/gallery").json()["cards"]}
    assert cards["first-look"]["demo"] and not cards["ch5-seven-step"]["demo"]
    assert {"ch3", "Kalman bank (MMAE)", "Added mass"} <= set(cards["ch5-seven-step"]["topics"])
    assert any("PID" in topic for topic in cards["ch5-closed-loop"]["topics"])
    assert all(card["topics"] for card in cards.values() if card["study"] is None)


def test_figures_are_made_when_the_gallery_is_opened_the_cards_in_sight_first(
    serve: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    few(monkeypatch)
    drawn: list[str] = []
    draw = ScenarioFigures._draw

    async def noted(self: ScenarioFigures, scenario: Any) -> dict[str, Any]:
        drawn.append(scenario.id)
        return await draw(self, scenario)

    monkeypatch.setattr(ScenarioFigures, "_draw", noted)
    with serve(figures=True) as live:
        live.bench("first-look", paused=True)
        assert live.http.get("/api/v1/gallery/first-look/figure").status_code == 404
        assert live.service.figures._task is None and not drawn
        settled(live, first=["ch3-ffrls-b30"])
        assert drawn[0] == "ch3-ffrls-b30" and sorted(drawn) == sorted(FEW)
        assert live.http.get("/api/v1/gallery", params={"first": ["x"] * 65}).status_code == 422


def test_figures_that_an_image_brings_are_not_made_again(
    serve: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    few(monkeypatch)
    built = tmp_path / "built"
    for name in FEW:
        build(name, built)
    with serve(folder=tmp_path / "data", figures=True) as live:
        assert settled(live)["figures"]["made"] == 3
        assert live.service.queue.processes._pool is None
        assert not (tmp_path / "data" / "figures").exists()
        assert live.http.get("/api/v1/gallery/first-look/figure").text.startswith("<svg")
