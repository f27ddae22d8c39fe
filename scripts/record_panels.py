"""What panels ask of a bench, as a service answers: part of `record_answers`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from record_answers import Recorder


def record_questions(recorder: Recorder, folder: Path, bench: str, tick: int) -> None:
    """Record what panels ask of a bench: aliases, a turn of the verdict, a sweep, the unstable region, sets."""
    path = f"/benches/{bench}"
    recorder.write(folder, "aliases", recorder.post(f"{path}/diagnosers/kalman/aliases"))
    recorder.write(folder, "turn", recorder.get(f"{path}/diagnosers/kalman/turn", tick=tick))
    recorder.write(folder, "identification", recorder.post(f"{path}/identification", points=4, cycles=4, settle=4))
    planar = recorder.post(f"{path}/variant", set={"plant.model": "planar"})["id"]
    recorder.step(planar, 10)
    recorder.write(folder, "unstable-region", recorder.get(f"/benches/{planar}/unstable-region", drive_v=0))
    kept = recorder.post(f"{path}/parameter-sets", name="soft")
    recorder.name(kept["id"], "set-1")
    recorder.post(f"{path}/commands", set={"sensor.noise_um": 0.2})
    difference = recorder.get(f"/parameter-sets/{kept['id']}/difference", bench=bench)
    recorder.write(folder, "parameter-sets", {**recorder.get("/parameter-sets"), "difference": difference})
