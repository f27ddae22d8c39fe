"""Pages around the bench and its exercises, as a service answers: parts of `record_answers`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from record_answers import Recorder

POINTS = 24
ROWS = 4


def record_design(recorder: Recorder, folder: Path) -> None:
    """Record the answers for the designer: a device with its response, its process, and a gyroscope."""
    device = {"device": {"id": "lcr-350"}, "environment": {}}
    found = {
        "evaluation": recorder.post("/devices/evaluate", **device),
        "bode": recorder.post("/devices/bode", **device, start_hz=250, stop_hz=25_000, points=POINTS, seed=1),
        "spread": recorder.post("/devices/spread", **device, seed=1),
        "gyroscope": recorder.post("/devices/evaluate", device={"id": "gyro-lcr-350"}, environment={}),
    }
    recorder.write(folder, "design", found)


def record_theory(recorder: Recorder, folder: Path) -> None:
    """Record the judgements of the page of theory."""
    tone = {"amplitude": 10, "frequency": 0.4}
    resonator = {"gain": 1, "a1": 0.2, "a2": 1, "filter_pole": 1}
    found = {
        "positiveReal": recorder.post("/theory/positive-real", numerator=[1, 1], denominator=[1, 5, 6]),
        "persistency": recorder.post("/theory/persistency", tones=[tone], **resonator),
        "map": recorder.post("/theory/instability-map", frequencies=6, gains=5),
    }
    recorder.write(folder, "theory", found)


def record_campaign(recorder: Recorder, folder: Path, run: str, sweep: str) -> None:
    """Record the answers about a campaign, and two runs side by side."""
    second = recorder.post("/runs", scenario="first-look", set={"samples": 500}, seed=2)
    recorder.name(second["id"], "run-2")
    recorder.until(f"/runs/{second['id']}", lambda now: now["state"] == "done")
    ids = [run, second["id"]]
    found = {
        "points": recorder.get(f"/sweeps/{sweep}/points", limit=50),
        "picture": recorder.get(f"/sweeps/{sweep}/picture"),
        "density": recorder.get(f"/sweeps/{sweep}/distribution", x="sensor.noise_um", y="control.rms_error_um"),
        "histogram": recorder.get(f"/sweeps/{sweep}/distribution", x="sensor.noise_um"),
        "comparison": recorder.get("/runs/compare", ids=ids),
        "trace": recorder.get("/runs/compare/trace", ids=ids, signal="plant.displacement"),
    }
    recorder.write(folder, "campaign", found)


def record_exercises(recorder: Recorder, folder: Path) -> None:
    """Record a hidden fault with its answer, two games, the sheets, a vote and a lecture."""
    bench = recorder.name(recorder.post("/benches", scenario="ch5-seven-step", paused=True)["id"], "bench-of-blind")
    recorder.post(f"/benches/{bench}/blind", seed=1, shows=False)
    question = recorder.get(f"/benches/{bench}")
    rule = recorder.get(f"/benches/{bench}/blind")
    recorder.post(f"/benches/{bench}/blind/answer", said=question["blind"]["answers"][0], confidence=0.7)
    blind = {"bench": question, "asked": rule, "answered": recorder.get(f"/benches/{bench}/blind")}
    recorder.write(folder, "blind", blind)
    cards = recorder.get("/games")["games"]
    plays = {card["id"]: _play(recorder, card["id"]) for card in cards}
    recorder.write(folder, "games", {"games": cards, "plays": plays})
    recorder.write(folder, "sheets", recorder.get("/sheets"))
    vote = recorder.post("/votes", text="Which is it?", answers=["heavier", "stiffer"], right="heavier")
    recorder.http.put(f"/votes/{vote['id']}/hands", json={"counts": [3, 1]}).raise_for_status()
    revealed = recorder.post(f"/votes/{recorder.name(vote['id'], 'vote-1')}/reveal")
    recorder.write(folder, "votes", {"open": vote, "revealed": revealed})
    lectures = recorder.get("/lectures")["lectures"]
    lecture = recorder.get(f"/lectures/{lectures[0]['id']}")
    recorder.write(folder, "lectures", {"lectures": lectures, "lecture": lecture})


def _play(recorder: Recorder, game: str) -> dict[str, Any]:
    """Play a game once at a seed: return it before and after the answer."""
    before = recorder.get(f"/games/{game}", seed=1)
    begun = recorder.post(f"/games/{game}/begin", seed=1, hand_in={})
    recorder.name(begun["bench"], f"bench-of-{game}")
    hand_in = {"fault": begun["kinds"][0]["name"]} if begun["kinds"] else {}
    return {"before": before, "after": recorder.post(f"/games/{game}/attempts", seed=1, hand_in=hand_in)}


def record_kept(recorder: Recorder, folder: Path, bench: str) -> None:
    """Record two recordings of a bench and their comparison, the texts of units, and a text that is checked."""
    for name in ("first", "second"):
        made = recorder.post(f"/benches/{bench}/recordings", name=name, past_ticks=100)
        recorder.name(made["id"], f"recording-{name}")
        recorder.step(bench, 50)
        recorder.post(f"/benches/{bench}/recordings/{made['id']}/stop")
    recordings = recorder.until("/recordings", lambda now: all(one["finished"] for one in now["recordings"]))
    ids = {one["name"]: one["id"] for one in recordings["recordings"]}
    path = f"/recordings/{ids['first']}/compare"
    compared = recorder.post(path, other=ids["second"], relative=0.01, align="start")
    kept = [{**one, "version": "", "bytes": 0} for one in recordings["recordings"]]
    recorder.write(folder, "recordings", {"recordings": kept, "compared": compared})
    units = recorder.get("/units")
    source = recorder.get("/units/pid")["source"]
    found = {
        "units": {**units, "units": units["units"][:3]},
        "source": source,
        "checked": recorder.post("/units", name="my_pid", source=source),
        "mistake": recorder.post("/units", name="my_pid", source=f"{source}\nx = (\n"),
    }
    recorder.write(folder, "units", found)
    scores = recorder.get("/benchmarks/mems-diag-1")
    results = [{**track, "rows": track["rows"][:ROWS]} for track in scores["results"]]
    recorder.write(folder, "benchmark", {**scores, "results": results})
