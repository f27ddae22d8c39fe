"""Records of devices over REST: brought in, plotted, calibrated, diagnosed, played on benches; hostile files."""

from __future__ import annotations

import io
import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from core.measured_record import MeasuredRecord
from scenarios import record_folders
from scenarios.campaign.executor import Processes
from scenarios.library import get
from scenarios.record_folders import FOLDER
from scenarios.records.bench import on_record
from scenarios.records.shelf import RecordFolder
from scenarios.run import RunResult, run
from scenarios.schema import Scenario
from server.view3d.viewers import device_of
from tests.scenarios.records.foreign import DT, draw
from tests.server.classroom.group import Somebody, join, open_class
from tests.server.conftest import Live, serving

RECORDS = "/api/v1/records"
DEVICES = "/api/v1/measured-devices"


@pytest.fixture(scope="module")
def live(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Live]:
    with serving(tmp_path_factory.mktemp("records"), max_record_mb=2, student_record_mb=1) as server:
        yield server


@pytest.fixture(scope="module")
def seven() -> RunResult:
    return run(get("ch5-seven-step"), taps=True)


def csv(drive: np.ndarray, displacement: np.ndarray, head: str = "time_ms,drive,displacement") -> bytes:
    rows = zip((np.arange(len(drive)) * DT).tolist(), drive.tolist(), displacement.tolist(), strict=True)
    return "\n".join([head, *(f"{t!r},{u!r},{y!r}" for t, u, y in rows)]).encode()


def bring(http: Any, content: bytes, name: str = "device.csv", **query: Any) -> Any:
    return http.post(RECORDS, content=content, params={"name": name, **query})


def kept(live: Live, content: bytes, **query: Any) -> dict[str, Any]:
    answer = bring(live.http, content, **query)
    assert answer.status_code in (200, 201), answer.text
    found: dict[str, Any] = answer.json()
    return found


@pytest.fixture(scope="module")
def foreign(live: Live) -> dict[str, Any]:
    one = draw(1)
    return kept(live, csv(one.drive[:3000], one.displacement[:3000]))


def test_the_door_and_a_live_bench_give_the_bits_of_the_trace(live: Live, seven: RunResult) -> None:
    signals = {name: seven.signal(name) for name in ("drive.voltage", "sensor.displacement")}
    file = io.BytesIO()
    pq.write_table(pa.table({name: np.array(one) for name, one in signals.items()}), file)
    made = kept(live, file.getvalue(), name="own.parquet", rate_khz=50)
    assert made["samples"] == 9000 and made["rate_khz"] == 50.0 and made["columns"]["drive"] == "drive.voltage"
    bench = live.bench("ch5-seven-step", record=made["id"], paused=True)
    assert live.command(bench["id"], "step", ticks=9000).status_code == 200
    names = [f"kalman.probability.{one}" for one in ("healthy", "m+5", "m+10", "k+5", "k+10", "b+30")]
    answer = live.http.get(
        f"/api/v1/benches/{bench['id']}/trace", params={"signals": ",".join([*signals, *names]), "format": "parquet"}
    )
    table = pq.read_table(io.BytesIO(answer.content))
    for name in (*signals, *names):
        shown = np.array(seven.signal(name)).astype(np.float32)  # a history keeps so many bits
        assert np.array_equal(table[name].to_numpy().view(np.int32), shown.view(np.int32)), name
    drive, displacement = map(np.array, signals.values())
    record = MeasuredRecord(50.0, drive, displacement)
    apart = run(Scenario.load(on_record(get("ch5-seven-step"), record)), taps=True)
    assert live.http.get(f"/api/v1/benches/{bench['id']}/digest").json()["digest"] == apart.digest
    for name in (*signals, *names):
        assert np.array_equal(apart.signal(name).view(np.int64), seven.signal(name).view(np.int64)), name


def test_blocks_of_any_length_and_a_look_back_have_one_digest(live: Live, foreign: dict[str, Any]) -> None:
    rng = np.random.default_rng(1)
    drive = np.repeat(rng.normal(0.0, 5.0, 2150), 8)
    made = kept(live, csv(drive, np.cumsum(rng.normal(0.0, 0.01, len(drive)))))
    digests: dict[int, set[str]] = {}

    def note(bench: str) -> None:
        found = live.http.get(f"/api/v1/benches/{bench}/digest").json()
        digests.setdefault(found["tick"], set()).add(found["digest"])

    for blocks in ((1, 777, 16_384), (10_000, 7162), (1,) * 20 + (777,) * 21 + (825,)):
        bench = live.bench("first-look", record=made["id"], paused=True)["id"]
        for ticks in blocks:
            for part in (ticks - ticks // 2, ticks // 2) if ticks > 10_000 else (ticks,):
                assert live.command(bench, "step", ticks=part).status_code == 200
        note(bench)
    assert [*digests] == [17_162] and len(digests[17_162]) == 1
    early = live.http.post(f"/api/v1/benches/{bench}/fork", json={"tick": 9000, "paused": True}).json()
    assert early["tick"] == 9000 and early["record"] == live.get(bench)["record"]
    assert early["record"] == {"key": made["key"], "samples": 17_200, "labels": []} and early["scores"] == {}
    assert live.command(early["id"], "step", ticks=8162).status_code == 200
    note(early["id"])
    assert len(digests[17_162]) == 1
    live.command(bench, "time_scale", value=None)
    live.command(bench, "start")
    live.until(bench, lambda seen: seen["state"] != "running")
    assert live.get(bench)["tick"] == 17_200 and live.get(bench)["trip"] is None
    live.command(bench, "start")
    live.until(bench, lambda seen: seen["state"] == "tripped")
    assert live.get(bench)["trip"]["reason"] == "the record has ended"
    for injected in ({"fault": "added_mass", "severity": 0.05}, {"set": {"plant.record": foreign["key"]}}):
        refused = live.command(bench, **injected)
        assert refused.status_code == 422 and "\n" not in refused.json()["error"]["message"]


def test_a_plot_has_the_extremes_of_each_stretch_and_lost_samples_are_null(live: Live) -> None:
    drive, y = np.sin(np.arange(1000.0)), np.cos(np.arange(1000.0))
    y[500:530] = np.nan
    made = kept(live, csv(drive, y))
    assert made["lost"] == 30 and made["notes"] == ["30 samples are lost"]
    assert made["drive_v"] == [drive.min(), drive.max()] and made["labels"] == []
    plot = live.http.get(f"{RECORDS}/{made['id']}", params={"start": 500, "end": 700, "points": 20}).json()["plot"]
    assert plot["sample"] == list(range(500, 700, 10))
    assert plot["drive_low"] == drive[500:700].reshape(20, 10).min(axis=1).tolist()
    assert plot["displacement_high"][:3] == [None] * 3
    assert plot["displacement_high"][3:] == y[530:700].reshape(17, 10).max(axis=1).tolist()
    whole = live.http.get(f"{RECORDS}/{made['id']}", params={"points": 4000}).json()["plot"]
    assert whole["drive_low"] == whole["drive_high"] == drive.tolist()
    late = live.http.get(f"{RECORDS}/{made['id']}", params={"start": 1000})
    assert late.status_code == 422 and late.json()["error"]["field"] == "start"


def test_a_calibration_finds_the_device_and_goes_on_any_bench(live: Live, foreign: dict[str, Any]) -> None:
    body = {"first": 0, "end": 2000}
    found = live.http.post(f"{RECORDS}/{foreign['id']}/calibration", json=body).json()
    assert found["refusal"] == "" and all(one["ok"] for one in found["checks"])
    for name, true in draw(1).ratios.items():
        assert abs(found[name]["value"] - true) < 5 * found[name]["error"] + 1e-3, name
        assert found[name]["low"] < found[name]["value"] < found[name]["high"]
    saved = live.http.post(DEVICES, json={**body, "name": "mine", "record": foreign["id"]})
    assert saved.status_code == 201 and saved.json()["values"] == found["values"]
    assert live.http.get(DEVICES).json()["devices"] == [saved.json()]
    again = live.http.post(DEVICES, json={**body, "name": "mine", "record": foreign["id"]})
    assert again.status_code == 409 and again.json()["error"]["field"] == "name"
    device = saved.json()["id"]
    benches = (("first-look", foreign["id"]), ("first-look", ""), ("ch5-seven-step", ""), ("ch1-fringing", ""))
    for scenario, record in benches:
        bench = live.bench(scenario, record=record, device=device, paused=True)
        toml = live.http.get(f"/api/v1/benches/{bench['id']}/scenario").text
        assert f"mass_kg = {found['values']['device.mass_kg']!r}" in toml
        plant = bench["parameters"]["plant"]
        assert plant.get("offset_um") == (found["values"]["plant.offset_um"] if record else None)
    assert live.http.delete(f"{DEVICES}/{device}").status_code == 204
    assert live.http.post("/api/v1/benches", json={"scenario": "first-look", "device": device}).status_code == 404


def test_a_diagnosis_names_the_fault_or_refuses_with_the_reason(live: Live, foreign: dict[str, Any]) -> None:
    names, one = ("healthy", "m+5", "m+10", "k+5", "k+10", "b+30"), draw(1)
    found = live.http.post(f"{RECORDS}/{foreign['id']}/diagnosis", json={"end": 2000}).json()
    (bank,) = found["banks"]
    assert bank["verdicts"][-1]["verdict"] == names[one.truth[2999]] != bank["healthy"] == "healthy"
    assert sum(bank["shares"].values()) == pytest.approx(1.0) and bank["left_out"] == 0 and found["figures"] == {}
    rubbed = draw(3, "friction", 2400)
    made = kept(live, csv(rubbed.drive, rubbed.displacement))
    refused = live.http.post(f"{RECORDS}/{made['id']}/diagnosis", json={"end": 2000}).json()
    assert "friction explains" in refused["refusal"] and refused["banks"] == []
    saved = live.http.post(DEVICES, json={"end": 2000, "name": "rubbed", "record": made["id"]})
    assert saved.status_code == 422 and "friction explains" in saved.json()["error"]["message"]
    assert live.http.get(DEVICES).json()["devices"] == []


def test_the_scene_of_a_record_follows_it_and_has_no_faults(live: Live, foreign: dict[str, Any]) -> None:
    bench = live.bench("first-look", record=foreign["id"], paused=True)
    assert live.command(bench["id"], "step", ticks=200).status_code == 200
    assert live.http.get(bench["view3d"]).status_code == 200
    session = live.service.benches.get(bench["id"])
    device = device_of(session)
    pose = device.pose()
    ghosts = {name for name in device.parts() if name.endswith("/outline")}
    assert pose.reference_um is None and ghosts == {"/estimate/outline"}  # the reference did not drive the record
    assert "/reference" not in device.picture(pose).nodes
    factor = float(re.search(r"motion ×\s*([0-9.]+)", pose.caption)[1])  # type: ignore[index]
    assert pose.displacement_um == pytest.approx(factor * session.board.value("plant.displacement"), rel=1e-6)
    assert (pose.turn, pose.shift_um, pose.faults) == (0.0, 0.0, ())


def test_the_key_of_a_run_holds_the_record(live: Live, foreign: dict[str, Any]) -> None:
    one = draw(1)
    other = kept(live, csv(one.drive[:3000], one.displacement[:3000] + 0.5))
    ids = set()
    for made in (foreign, other):
        bench = live.bench("first-look", record=made["id"], paused=True)["id"]
        toml = live.http.get(f"/api/v1/benches/{bench}/scenario").text
        answer = live.http.post("/api/v1/runs", json={"scenario": toml, "set": {"samples": 500}})
        assert answer.status_code == 202, answer.text
        row = answer.json()["id"]
        live.ended(row)
        found = live.http.get(f"/api/v1/runs/{row}").json()
        assert found["state"] == "done", found["error"]
        ids.add((row, found["summary"]["digest"]))
    assert len(ids) == 2 and len({digest for _, digest in ids}) == 2


@pytest.mark.parametrize(
    ("content", "query", "said"),
    [
        (b"time_ms,drive,displacement\n0,1,2\n0.02,x,2\n", {}, "row 3, column 'drive': 'x' is no number"),
        (b"time_ms,drive,displacement\n0,1,2\n0,1,2\n", {}, "row 3, column 'time_ms' does not rise"),
        (b"a,b\n1,2\n3,4\n", {}, "has no column for the drive; its columns are 'a', 'b'"),
        (b"drive,displacement\n1,2\n3,4\n", {}, "has no column of times"),
        (b"drive,displacement\n1,2\n3,4\n", {"drive": "z", "rate_khz": 1}, "unknown column 'z'"),
        (b"\0\1\2\3" * 50, {}, "is no text"),
        (b"PAR1" + b"\xff" * 500 + b"PAR1", {"name": "x.parquet"}, "cannot be read as Parquet"),
        (b"MATLAB 5.0" + b"\xff" * 500, {"name": "x.mat"}, "announces 4294967295 bytes"),
        (b"x", {"name": "../../etc/passwd"}, "unknown kind of file"),
        (b"", {}, "the file is empty"),
        (b"drive,displacement\n" + b"9" * 70_000 + b",1\n", {"rate_khz": 1}, "is longer than"),
    ],
)
def test_a_hostile_file_is_one_line_and_leaves_nothing(
    live: Live, content: bytes, query: dict[str, Any], said: str
) -> None:
    before, rows = listing(live), live.http.get(RECORDS).json()
    answer = bring(live.http, content, **{"name": "some.csv", **query})
    error = answer.json()["error"]
    assert answer.status_code == 422 and said in error["message"] and "\n" not in error["message"], error
    assert listing(live) == before and live.http.get(RECORDS).json() == rows
    assert live.http.get("/health/ready").status_code == 200


def listing(live: Live) -> list[Path]:
    return sorted(live.service.measured_records.folder.rglob("*"))


def test_a_file_that_unfolds_or_is_too_large_is_refused_and_leaves_nothing(live: Live) -> None:
    before = listing(live)
    zeros = io.BytesIO()
    column = pa.array(np.zeros(30_000_000))
    pq.write_table(pa.table({"drive": column, "displacement": column}), zeros, compression="zstd")
    assert len(zeros.getvalue()) < 1 << 20
    refused = bring(live.http, zeros.getvalue(), name="zeros.parquet", rate_khz=50)
    assert refused.status_code == 422 and "\n" not in refused.json()["error"]["message"], refused.text
    large = bring(live.http, b"drive,displacement\n" + b"1,2\n" * 600_000, rate_khz=50)
    assert large.status_code == 413 and "max_record_mb" in large.json()["error"]["hint"]
    assert listing(live) == before
    assert kept(live, b"drive,displacement\n1,2\n3,4\n", rate_khz=50)["samples"] == 2


def test_columns_are_read_and_nothing_is_kept(live: Live) -> None:
    before = listing(live)
    head = b"zeit;Spannung (mV);y [nm];note\n0;1,5;2;a\n"
    answer = live.http.post(f"{RECORDS}/columns", content=head, params={"name": "x.csv"})
    found = answer.json()
    assert [one["name"] for one in found["columns"]] == ["zeit", "Spannung (mV)", "y [nm]", "note"]
    assert found["columns"][1] == {"name": "Spannung (mV)", "unit": "mv", "is_number": True}
    assert found["columns"][3]["is_number"] is False and found["found"] == {"displacement": "y [nm]"}
    assert listing(live) == before


def test_a_record_that_plays_stays_and_one_that_does_not_goes(live: Live) -> None:
    made = kept(live, b"drive,displacement\n" + b"1,2\n3,4\n" * 30, rate_khz=50)
    assert bring(live.http, b"drive,displacement\n" + b"1,2\n3,4\n" * 30, rate_khz=50).status_code == 200
    bench = live.bench("first-look", record=made["id"], paused=True)["id"]
    refused = live.http.delete(f"{RECORDS}/{made['id']}")
    assert refused.status_code == 409 and bench in refused.json()["error"]["hint"]
    assert live.http.delete(f"/api/v1/benches/{bench}").status_code == 204
    assert live.http.delete(f"{RECORDS}/{made['id']}").status_code == 204
    assert live.http.get(f"{RECORDS}/{made['id']}").status_code == 404
    assert not (live.service.measured_records.folder / f"{made['key']}.npz").exists()


def test_a_student_sees_the_own_records_alone_within_limits(live: Live, foreign: dict[str, Any]) -> None:
    group = open_class(live)
    ada, ben = join(live, group, "Ada"), join(live, group, "Ben")

    def brought(who: Somebody, content: bytes, **query: Any) -> Any:
        return who.ask("POST", RECORDS, content=content, params={"name": "device.csv", **query})

    one = draw(1)
    made = brought(ada, csv(one.drive[:3000], one.displacement[:3000]))
    assert made.status_code == 201 and made.json()["key"] == foreign["key"] and made.json()["id"] != foreign["id"]
    path = f"{RECORDS}/{made.json()['id']}"
    assert [one["id"] for one in ada.ask("GET", RECORDS).json()["records"]] == [made.json()["id"]]
    assert ben.ask("GET", RECORDS).json()["records"] == []
    for method, more in (("GET", ""), ("DELETE", ""), ("POST", "/calibration"), ("POST", "/diagnosis")):
        assert ben.ask(method, path + more, **({"json": {}} if more else {})).status_code == 404
    wanted = {"scenario": "first-look", "record": made.json()["id"]}
    assert ben.ask("POST", "/api/v1/benches", json=wanted).status_code == 404
    assert live.http.get(path).status_code == 200
    bench = ada.ask("POST", "/api/v1/benches", json=wanted)
    assert bench.status_code == 201 and bench.json()["record"]["key"] == foreign["key"], bench.text
    found = ada.ask("POST", f"{path}/calibration", json={"end": 2000})
    assert found.status_code == 200 and found.json()["refusal"] == ""
    assert ada.ask("POST", DEVICES, json={"name": "x", "record": made.json()["id"]}).status_code == 403
    large = brought(ben, b"drive,displacement\n" + b"1,2\n" * 300_000, rate_khz=50)
    assert large.status_code == 413 and "student_record_mb" in large.json()["error"]["hint"]
    for i in range(8):
        assert brought(ben, f"drive,displacement\n1,2\n3,{i}\n".encode(), rate_khz=50).status_code == 201
    full = brought(ben, b"drive,displacement\n1,2\n3,9\n", rate_khz=50)
    assert full.status_code == 409 and "8 records" in full.json()["error"]["message"]
    live.http.delete(f"/api/v1/classes/{group['id']}")


def test_records_outlive_the_server_and_uploads_under_way_do_not(tmp_path: Path) -> None:
    with serving(tmp_path) as first:
        made = kept(first, b"drive,displacement\n" + b"1,2\n3,4\n" * 30, rate_khz=50)
        bench = first.bench("first-look", record=made["id"], paused=True)["id"]
    (tmp_path / "records" / ".uploading-x").mkdir()
    (tmp_path / "records" / f"{'0' * 64}.npz").write_bytes(b"left")
    with serving(tmp_path) as second:
        assert second.http.get(f"{RECORDS}/{made['id']}").json()["plot"]["sample"] == list(range(60))
        assert [path.name for path in listing(second)] == [f"{'0' * 64}.npz", f"{made['key']}.npz"]
        assert second.http.post(f"/api/v1/benches/{bench}/reopen").status_code == 200


def has_record(key: str) -> bool:
    return RecordFolder().get(key) is not None


def test_each_of_two_servers_in_a_process_finds_its_records_whichever_ends_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(record_folders, "_in_use", [])
    monkeypatch.setenv(FOLDER, "before")
    folders = [tmp_path / name for name in ("first", "second")]
    few = [MeasuredRecord(50.0, np.arange(5.0), np.full(5, float(k))) for k in range(2)]
    keys = [RecordFolder(folder).keep(one) for folder, one in zip(folders, few, strict=True)]
    first, second = map(record_folders.found_by_benches, folders)
    first.__enter__()
    second.__enter__()
    assert all(RecordFolder().get(key) for key in keys)
    monkeypatch.setenv(FOLDER, "of another test")
    assert all(RecordFolder().get(key) for key in keys)
    with Processes(1) as processes:  # a worker finds them too
        assert all(processes.submit(has_record, key).result() for key in keys)
    first.__exit__(None, None, None)
    assert os.environ[FOLDER] == str(folders[1])
    assert RecordFolder().get(keys[0]) is None and RecordFolder().get(keys[1])
    second.__exit__(None, None, None)
    assert os.environ[FOLDER] == "before"
