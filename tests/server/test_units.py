"""The doors of units: texts for a start, the check during typing, the folder of the server."""

from __future__ import annotations

import gc
import json
import linecache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from core.own.unit import unit
from scenarios.library import get
from scenarios.run import run
from server.cli.main import app
from tests.core.own.test_own_units import COPIED, source_of, with_unit
from tests.core.own.texts import PI, ROOT, odd
from tests.server.classroom.group import join, open_class
from tests.server.runs.test_runs import wait

DOOR = "/api/v1/units"


def check(live: Any, source: str, name: str = "pi") -> dict[str, Any]:
    answer = live.http.post(DOOR, json={"name": name, "source": source})
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def test_one_may_begin_with_the_files_of_the_library_that_are_units(live: Any) -> None:
    listed = live.http.get(DOOR).json()
    assert listed["refusal"] == ""
    assert sorted(one["name"] for one in listed["units"] if one["origin"] == "library") == sorted(COPIED)
    text = live.http.get(f"{DOOR}/pid").json()
    assert text["source"] == source_of("control", "pid") and text["hash"] == unit("pid", text["source"]).hash
    refused = live.http.get(f"{DOOR}/mrac")
    assert refused.status_code == 404 and "mrac" in refused.json()["error"]["message"]


def test_the_list_has_a_blank_of_three_lines_and_the_pi_of_the_documents(live: Any) -> None:
    listed = live.http.get(DOOR).json()["units"]
    assert [one["name"] for one in listed if one["origin"] == "starter"] == ["blank", "pi"]
    for name in ("blank", "pi"):
        text = live.http.get(f"{DOOR}/{name}").json()
        assert text["source"] == (ROOT / "scenarios" / "starters" / f"{name}.py").read_text("utf-8")
    step = live.http.get(f"{DOOR}/blank").json()["source"].split('"""')[-1]
    assert len(step.strip().splitlines()) == 3


def test_the_blank_unit_runs_and_does_what_its_lines_say(live: Any) -> None:
    """u = r - 2 e, with the error of the same sample."""
    source = live.http.get(f"{DOOR}/blank").json()["source"]
    assert check(live, source, "blank")["error"] is None
    result = run(with_unit("blank", source, {"controller.kind": "blank", "samples": 300}, "first-look"))
    error = result.signal("model.displacement") - result.signal("sensor.displacement")
    reference, voltage = result.signal("reference.voltage"), result.signal("blank.voltage")
    np.testing.assert_allclose(voltage, reference - 2.0 * error, rtol=0, atol=1e-12)


def test_a_checked_unit_comes_with_all_the_page_shows(live: Any) -> None:
    found = check(live, PI)
    assert found["error"] is None
    card = found["unit"]["card"]
    assert (card["family"], card["name"], card["title"]) == ("control", "pi", "PI")
    assert [one["name"] for one in card["parameters"]] == ["proportional_v_um", "integral_v_um_ms"]
    assert [(one["name"], one["unit"], one["meaning"]) for one in card["taps"]] == [
        ("error", "um", "model minus measured displacement")
    ]
    assert card["equations"][0]["latex"].startswith("u=K_pe")
    assert found["unit"]["operations"] == unit("pi", PI).operations
    assert found["unit"]["hash"] == unit("pi", PI).hash


def test_a_mistake_comes_with_its_place(live: Any) -> None:
    for text, line, column, words in (
        ("import os\n", 1, 1, "only math is imported"),
        ("x = = 1\n", 1, 5, "no Python syntax"),
        ("", 1, 1, "declares no unit"),
        ("x = 1\n" * 20_000, 1, 1, "characters long"),
    ):
        found = check(live, text)
        error = found["error"]
        assert found["unit"] is None and words in error["message"], found
        assert (error["line"], error["column"]) == (line, column), found


def test_the_place_is_that_of_the_mistake(live: Any) -> None:
    wrong = PI.replace("e = x.model - x.measured", "e = x.model - x.truth")
    line = 1 + wrong.split("\n").index("        e = x.model - x.truth")
    error = check(live, wrong)["error"]
    assert (error["line"], error["column"]) == (line, 23) and "truth" in error["message"]


def test_all_mistakes_come_at_once_and_the_first_is_the_error(live: Any) -> None:
    wrong = PI.replace("x.model - x.measured", "x.modell").replace("x.error = e", "x.error = gone")
    found = check(live, wrong)
    assert [one["message"].partition(";")[0] for one in found["errors"]] == ["has no modell", "gone has no value here"]
    assert found["error"] == found["errors"][0]
    assert check(live, PI)["errors"] == []


def test_a_name_is_one_of_small_letters(live: Any) -> None:
    for name in ("", "Pi", "a-b", "../x", "p" * 33):
        answer = live.http.post(DOOR, json={"name": name, "source": PI})
        assert answer.status_code == 422 and answer.json()["error"]["field"] == "name", name


def test_texts_that_were_checked_are_let_go() -> None:
    for number in range(300):
        unit("pi", f"{PI}\n# {number}\n")
    gc.collect()
    assert sum(file.startswith("<unit pi ") for file in linecache.cache) < 290


def test_a_student_reads_and_brings_none(live: Any) -> None:
    group = open_class(live)
    try:
        student = join(live, group, "Ada")
        assert "teacher" in student.ask("GET", DOOR).json()["refusal"]
        refused = student.ask("POST", DOOR, json={"name": "pi", "source": PI})
        assert refused.status_code in (403, 422) and refused.json()["error"]["code"] == "forbidden"
        assert student.ask("PUT", f"{DOOR}/pi", json={"source": PI}).status_code == 403
        assert student.ask("DELETE", f"{DOOR}/pi").status_code == 403
    finally:
        live.http.delete(f"/api/v1/classes/{group['id']}")


def test_a_server_that_takes_no_units_says_so(serve: Any) -> None:
    with serve(units="off") as live:
        assert "takes no user units" in live.http.get(DOOR).json()["refusal"]
        for method, path in (("POST", DOOR), ("PUT", f"{DOOR}/pi")):
            body = {"source": PI} | ({"name": "pi"} if method == "POST" else {})
            assert live.http.request(method, path, json=body).json()["error"]["code"] == "forbidden"


def test_what_a_server_keeps_is_on_every_new_bench_and_in_runs_that_name_it(serve: Any, tmp_path: Path) -> None:
    with serve(folder=tmp_path) as live:
        before = live.http.post("/api/v1/runs", json={"scenario": "first-look", "set": {"duration_ms": 5.0}}).json()
        kept = live.http.put(f"{DOOR}/my_pi", json={"source": PI})
        assert kept.status_code == 200 and kept.json()["origin"] == "folder", kept.text
        file = tmp_path / "units" / "my_pi.py"
        assert file.read_text("utf-8") == PI and [*file.parent.iterdir()] == [file]
        bench = live.bench("first-look", set={"controller.kind": "my_pi"})
        assert bench["controller"] == "my_pi"
        short = {"duration_ms": 5.0}
        plain = live.http.post("/api/v1/runs", json={"scenario": "first-look", "set": short}).json()
        assert plain["id"] == before["id"], "a run that does not name it is the one it was"
        named = {**short, "controller.kind": "my_pi"}
        run = live.http.post("/api/v1/runs", json={"scenario": "first-look", "set": named})
        assert run.status_code == 202, run.text
        digests = [wait(live, one["id"])["summary"]["digest"] for one in (plain, run.json())]
        told = ["run", "first-look", "--set", "duration_ms=5", "--json"]
        by_hand = [CliRunner().invoke(app, told), CliRunner().invoke(app, [*told, "--unit", str(file), *WITH_PI])]
        assert digests == [json.loads(one.stdout)["digest"] for one in by_hand]
    with serve(folder=tmp_path) as live:
        assert "my_pi.voltage" in {one["name"] for one in live.bench("first-look")["signals"]}
        assert live.http.delete(f"{DOOR}/my_pi").status_code == 204
        assert not file.exists() and live.http.get(f"{DOOR}/my_pi").status_code == 404
        assert live.bench("first-look")["units"] == []


def test_a_student_has_the_units_of_the_server_and_brings_no_other(serve: Any, tmp_path: Path) -> None:
    with serve(folder=tmp_path) as live:
        assert live.http.put(f"{DOOR}/my_pi", json={"source": PI}).status_code == 200
        student = join(live, open_class(live), "Ada")
        bench = student.ask("POST", "/api/v1/benches", json={"scenario": "first-look"})
        assert bench.status_code == 201 and [one["name"] for one in bench.json()["units"]] == ["my_pi"]
        document = {**get("first-look").document, "units": {"own": {"source": PI}}}
        for body in (
            {"scenario": document},
            {"scenario": "first-look", "set": {"units.own.source": PI}},
            {"scenario": "first-look", "set": {"units.my_pi.source": PI + "\n# mine\n"}},
        ):
            refused = student.ask("POST", "/api/v1/benches", json=body)
            assert refused.status_code in (403, 422) and refused.json()["error"]["code"] == "forbidden", refused.text


WITH_PI = ("--set", "controller.kind=my_pi")


def test_what_cannot_be_kept_is_not_written_and_a_server_keeps_so_many_units(serve: Any, tmp_path: Path) -> None:
    with serve(folder=tmp_path) as live:
        for name, source, status, field in (
            ("pid", PI, 409, "name"),
            ("my_pi", odd("step", "import os"), 422, "source.line"),
            ("my_pi", PI.replace("p.dt_ms = context.dt_ms", "p.dt_ms = 1e400 - 1e400"), 422, ""),
            ("Pi", PI, 422, "name"),
        ):
            refused = live.http.put(f"{DOOR}/{name}", json={"source": source})
            assert refused.status_code == status and refused.json()["error"]["field"].startswith(field), refused.text
            assert not [*tmp_path.glob("units/*")]
        for number in range(8):
            assert live.http.put(f"{DOOR}/pi_{number}", json={"source": PI}).status_code == 200
        full = live.http.put(f"{DOOR}/one_more", json={"source": PI})
        assert full.status_code == 409 and full.json()["error"]["code"] == "limit"
        assert live.http.put(f"{DOOR}/pi_0", json={"source": PI + "\n# another\n"}).status_code == 200


def test_a_file_that_is_no_unit_is_left_out_of_the_start(
    serve: Any, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    folder = tmp_path / "units"
    folder.mkdir(parents=True)
    (folder / "bad.py").write_text("import os\n", "utf-8")
    (folder / "pid.py").write_text(PI, "utf-8")
    (folder / "good.py").write_text(PI, "utf-8")
    with serve(folder=tmp_path) as live:
        own = [one["name"] for one in live.http.get(DOOR).json()["units"] if one["origin"] == "folder"]
        assert own == ["good"]
    said = [record.message for record in caplog.records if "left out" in record.message]
    assert len(said) == 2 and "bad.py" in said[0] and "line 1, column 1" in said[0]


def test_doctor_lists_what_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "units").mkdir()
    (tmp_path / "units" / "lead.py").write_text(PI, "utf-8")
    monkeypatch.setenv("COMBBENCH_DATA", str(tmp_path))
    said = CliRunner().invoke(app, ["doctor"], catch_exceptions=False)
    assert "units kept" in said.stdout and "lead" in said.stdout
