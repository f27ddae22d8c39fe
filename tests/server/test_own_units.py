"""User units over the network: the scenarios that may carry them, live and as runs, the same bits everywhere."""

from __future__ import annotations

import copy
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from core.compile import code
from core.wall import wall
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from scenarios.schema import Scenario
from scenarios.speed import units
from server.cli.main import app
from tests.core.own.price import PRICE_NS, priced
from tests.core.own.texts import PI, ROOT, odd
from tests.core.wall.test_bits import GALLERY
from tests.server.classroom.group import join, open_class
from tests.server.runs.test_runs import wait

LOOK = get("first-look").document
NAMED = {"units": {"pi": {"source": PI}}}
WALLED = PI + "\n# behind the wall\n"


def document(**more: Any) -> dict[str, Any]:
    """Return the first look with a PI, five milliseconds long."""
    return {**copy.deepcopy(LOOK), **NAMED, "duration_ms": 5.0, **more}


def test_a_file_gives_the_same_digest_by_command_line_and_rest_and_live(live: Any, tmp_path: Path) -> None:
    (tmp_path / "pi.py").write_text(PI, "utf-8")
    (tmp_path / "look.toml").write_text(Scenario.load(document(units={})).toml(), "utf-8")
    told = [
        "run",
        str(tmp_path / "look.toml"),
        "--unit",
        str(tmp_path / "pi.py"),
        "--set",
        "controller.kind=pi",
        "--json",
    ]
    by_hand = json.loads(CliRunner().invoke(app, told, catch_exceptions=False).stdout)
    whole = document(controller={"kind": "pi"})
    made = live.http.post("/api/v1/runs", json={"scenario": whole})
    assert made.status_code in (200, 201, 202), made.text
    assert wait(live, made.json()["id"])["summary"]["digest"] == by_hand["digest"] == run(Scenario.load(whole)).digest
    bench = live.bench(whole)
    live.until(bench["id"], lambda now: now["state"] == "paused" and now["tick"] >= 500)
    assert live.http.get(f"/api/v1/benches/{bench['id']}/digest").json()["digest"] == by_hand["digest"]


def test_a_unit_is_live_in_shadow_and_takes_over(live: Any) -> None:
    bench = live.bench(document(duration_ms=200.0))["id"]
    names = {signal["name"] for signal in live.get(bench)["signals"]}
    assert {"pi.voltage", "pi.error"} <= names
    assert live.command(bench, switch="pi").status_code == 200
    assert live.get(bench)["controller"] == "pi"
    assert live.command(bench, set={"controllers.pi.proportional_v_um": -1.0}).status_code == 200
    refused = live.command(bench, set={"units.pi.source": PI + "\n# other\n"})
    assert refused.status_code in (409, 422) and refused.json()["error"]["code"] == "not_live"


def test_a_wrong_unit_is_refused_with_its_place_and_nothing_is_made(live: Any) -> None:
    before = live.http.get("/api/v1/benches").json()
    answer = live.http.post(
        "/api/v1/benches", json={"scenario": document(units={"pi": {"source": odd("step", "import os")}})}
    )
    assert answer.status_code == 422
    error = answer.json()["error"]
    assert error["field"].startswith("scenario.units.pi.source.line ") or error["field"].startswith(
        "units.pi.source.line "
    )
    assert live.http.get("/api/v1/benches").json() == before


def test_a_student_brings_no_unit_by_any_door(live: Any) -> None:
    group = open_class(live)
    try:
        student = join(live, group, "Ada")
        values = {"units.pi.source": PI}
        for path, body in (
            (f"/api/v1/benches/{student.bench}/commands", {"kind": "reset", "values": values}),
            ("/api/v1/benches", {"scenario": document()}),
            ("/api/v1/links", {"scenario": document()}),
        ):
            answer = student.ask("POST", path, json=body)
            assert answer.status_code in (403, 422), answer.text
        with student.stream() as stream:
            reply = stream.command("reset", values=values)
            assert "error" in reply and "units" in json.dumps(reply), reply
        assert "pi.voltage" not in json.dumps(student.ask("GET", f"/api/v1/benches/{student.bench}").json())
    finally:
        live.http.delete(f"/api/v1/classes/{group['id']}")


def test_the_teacher_begins_a_scenario_with_a_unit_on_all_benches(live: Any) -> None:
    group = open_class(live)
    try:
        ada = join(live, group, "Ada")
        answer = live.http.post(
            f"/api/v1/classes/{group['id']}/scenario", json={"scenario": document(duration_ms=200.0)}
        )
        assert answer.status_code == 200, answer.text
        (member,) = live.http.get(f"/api/v1/classes/{group['id']}/members").json()["members"]
        assert "pi.voltage" in {signal["name"] for signal in live.get(member["bench"])["signals"]}
        late = join(live, group, "Bob")
        assert "pi.voltage" in {signal["name"] for signal in live.get(late.bench)["signals"]}
        reset = ada.ask("POST", f"/api/v1/benches/{member['bench']}/commands", json={"kind": "reset"})
        assert reset.status_code == 200, reset.text
        path = f"/api/v1/benches/{member['bench']}/commands"
        other = {"kind": "reset", "values": {"units.pi.source": PI + "\n# other\n"}}
        assert ada.ask("POST", path, json=other).status_code in (403, 422)
    finally:
        live.http.delete(f"/api/v1/classes/{group['id']}")


def test_a_server_may_take_none_at_all(serve: Any) -> None:
    with serve(units="off") as live:
        answer = live.http.post("/api/v1/benches", json={"scenario": document()})
        assert answer.status_code in (403, 422) and "takes no user units" in answer.json()["error"]["message"]
        assert live.http.post("/api/v1/runs", json={"scenario": document()}).status_code in (403, 422)


def test_everyone_may_bring_units_behind_the_wall_and_by_every_door(serve: Any) -> None:
    alone = run(Scenario.load(document(controller={"kind": "pi"}))).digest
    try:
        with serve(units="everyone") as live:
            group = open_class(live)
            student = join(live, group, "Ada")
            begun = document(controller={"kind": "pi"}, duration_ms=200.0)
            assert live.http.post(f"/api/v1/classes/{group['id']}/scenario", json={"scenario": begun}).is_success
            (member,) = live.http.get(f"/api/v1/classes/{group['id']}/members").json()["members"]
            path = f"/api/v1/benches/{member['bench']}"
            other = {"kind": "reset", "values": {"units.pi.source": WALLED}}
            reset = student.ask("POST", f"{path}/commands", json=other)
            assert reset.status_code == 200, reset.text
            assert student.ask("POST", f"{path}/commands", json={"kind": "start"}).status_code == 200
            live.until(member["bench"], lambda now: now["tick"] > 100)
            assert live.get(member["bench"])["controller"] == "pi"
            asked = document(controller={"kind": "pi"}, units={"pi": {"source": WALLED}})
            made = live.http.post("/api/v1/runs", json={"scenario": asked})
            assert wait(live, made.json()["id"])["summary"]["digest"] == alone
            with live.anonymous(headers={"Origin": live.address}) as nobody:
                assert nobody.post("/api/v1/benches", json={"scenario": document()}).status_code == 401
            wrong = {"kind": "reset", "values": {"units.pi.source": odd("step", "import os")}}
            assert student.ask("POST", f"{path}/commands", json=wrong).status_code == 422
            own = [block for block, _ in code._addresses if "behind the wall" in (getattr(block, "text", None) or "")]
            assert own == [], "a unit ran as machine code"
    finally:
        wall.demand(False)


def test_a_server_for_everyone_does_not_start_without_the_wall(tmp_path: Path) -> None:
    """The package is hidden by a module of its name that cannot be loaded."""
    (tmp_path / "wasmtime.py").write_text("raise ImportError('no wasmtime here')", "utf-8")
    told = [sys.executable, "-m", "server.cli.main", "serve", "--port", "0", "--data", str(tmp_path / "data")]
    environment = {**os.environ, "COMBBENCH_UNITS": "everyone", "PYTHONPATH": str(tmp_path)}
    ended = subprocess.run(told, cwd=ROOT, env=environment, capture_output=True, text=True, check=False, timeout=110)
    assert ended.returncode == 2 and ended.stdout == ""
    assert "units" in ended.stderr and "no wasmtime here" in ended.stderr and "'.[wall]' in a checkout" in ended.stderr


def test_check_says_what_is_wrong_and_what_it_costs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(units, "block_costs", priced)
    good, bad = tmp_path / "pi.py", tmp_path / "bad.py"
    good.write_text(PI, "utf-8")
    bad.write_text(PI.replace("e = x.model - x.measured", "e = x.model - x.truth"), "utf-8")
    said = CliRunner().invoke(app, ["check", str(good)], catch_exceptions=False)
    assert said.exit_code == 0 and "control/pi" in said.stdout and "a sample" in said.stdout
    told = json.loads(CliRunner().invoke(app, ["check", str(good), "--json"], catch_exceptions=False).stdout)
    assert told[0]["family"] == "control" and told[0]["ns_per_sample"] == PRICE_NS
    said = CliRunner().invoke(app, ["check", str(bad)], catch_exceptions=False)
    line = 1 + bad.read_text("utf-8").split("\n").index("        e = x.model - x.truth")
    assert said.exit_code == 2 and f"line {line}, column 23: has no truth" in said.stdout
    bad.write_text(bad.read_text("utf-8").replace("x.engaged == 0.0", "x.engagd == 0.0"), "utf-8")
    said = CliRunner().invoke(app, ["check", str(bad)], catch_exceptions=False)
    assert [text.partition(": ")[2].split(";")[0] for text in said.stdout.splitlines()] == [
        f"line {line}, column 23: has no truth",
        f"line {line + 2}, column 12: has no engagd",
    ]
    assert CliRunner().invoke(app, ["run", "first-look", "--unit", str(bad)]).exit_code == 2
    missing = CliRunner().invoke(app, ["run", "first-look", "--unit", str(tmp_path / "none.py")])
    assert missing.exit_code == 2 and "--unit" in missing.stderr


OFFERED = [ROOT / "docs" / "template" / "lead.py", *(ROOT / "docs" / "units" / f"{name}.py" for name in GALLERY)]


@pytest.mark.parametrize("file", OFFERED, ids=[file.stem for file in OFFERED])
def test_check_admits_the_units_of_the_documents_and_tells_a_step_outside_the_notation(
    file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(units, "block_costs", priced)
    said = CliRunner().invoke(app, ["check", str(file)], catch_exceptions=False)
    assert said.exit_code == 0 and f"/{file.stem}, " in said.stdout
    wrong, text = tmp_path / file.name, file.read_text("utf-8")
    lines = text.split("\n")
    step = next(i for i, one in enumerate(lines) if one.startswith("    def step("))
    first = next(i for i in range(step + 1, len(lines)) if lines[i].startswith("        ") and '"""' not in lines[i])
    lines.insert(first, "        with s:\n            pass")
    wrong.write_text("\n".join(lines), "utf-8")
    said = CliRunner().invoke(app, ["check", str(wrong)], catch_exceptions=False)
    assert said.exit_code == 2 and said.stdout.startswith(f"{wrong}: line {first + 1}, column 9: "), said.stdout
    assert "if" in said.stdout and "for" in said.stdout, "it says what a step may have"


def test_a_campaign_with_a_unit_from_a_file(tmp_path: Path) -> None:
    (tmp_path / "pi.py").write_text(PI, "utf-8")
    (tmp_path / "sweep.toml").write_text(
        'id = "gains"\nscenario = "ch3-mrac-mass-x10"\nseeds = "1:2"\n'
        '[set]\n"controller.kind" = "pi"\n[grid]\n"controllers.pi.proportional_v_um" = [-0.5, -0.25]\n',
        "utf-8",
    )
    told = ["sweep", str(tmp_path / "sweep.toml"), "--unit", str(tmp_path / "pi.py"), "--out", str(tmp_path / "out")]
    ended = CliRunner().invoke(app, [*told, "--workers", "1"], catch_exceptions=False)
    assert ended.exit_code == 0, ended.output
    import pyarrow.parquet as pq

    rows = pq.ParquetDataset(tmp_path / "out" / "runs").read().to_pylist()
    assert len(rows) == 4
    for row in rows:
        base = {**copy.deepcopy(get("ch3-mrac-mass-x10").document), **NAMED}
        gain = row["controllers.pi.proportional_v_um"]
        one = with_values(Scenario.load(base), {"controller.kind": "pi", "controllers.pi.proportional_v_um": gain})
        assert run(one, row["seed"]).digest == row["digest"]


def test_every_new_bench_of_a_server_has_its_units(serve: Any, tmp_path: Path) -> None:
    (tmp_path / "pi.py").write_text(PI, "utf-8")
    with serve(unit_files=[tmp_path / "pi.py"]) as live:
        bench = live.bench("first-look")
        assert "pi.voltage" in {signal["name"] for signal in bench["signals"]}
        assert [card["title"] for card in bench["units"]] == ["PI"]
        other = PI.replace('title = "PI"', 'title = "Other"')
        (card,) = live.bench(document(units={"pi": {"source": other}}))["units"]
        assert card["title"] == "Other", "what a scenario carries stays"
        student = join(live, open_class(live), "Ada")
        assert "pi.voltage" in {signal["name"] for signal in live.get(student.bench)["signals"]}


def test_a_server_does_not_start_with_a_wrong_unit(tmp_path: Path) -> None:
    (tmp_path / "bad.py").write_text("import os", "utf-8")
    told = [sys.executable, "-m", "server.cli.main", "serve", "--port", "0"]
    where = ["--data", str(tmp_path / "data"), "--unit", str(tmp_path / "bad.py")]
    ended = subprocess.run([*told, *where], cwd=ROOT, capture_output=True, text=True, check=False, timeout=110)
    assert ended.returncode == 2 and ended.stdout == ""
    (line,) = ended.stderr.strip().split("\n")
    assert "units.bad.source.line 1, column 1" in line
