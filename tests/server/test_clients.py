"""The clients people copy, against a real server."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from tests.server.conftest import TOKEN

CLIENTS = Path(__file__).resolve().parents[2] / "clients"
CAMPAIGN = {
    "schema": 1,
    "id": "clients",
    "scenario": "ch3-mrac-spring-x2",
    "seeds": "1:2",
    "grid": {"controller.adaptation_gain": [10.0, 30.0]},
}


@pytest.fixture(scope="module")
def client() -> Any:
    spec = importlib.util.spec_from_file_location("combbench_client", CLIENTS / "combbench_client.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def lab(client: Any, live: Any) -> Any:
    return client.Client(live.address, TOKEN)


def test_a_run_and_its_trace(lab: Any) -> None:
    values = {"samples": 500, "expect": []}
    done = lab.run("first-look", set=values, seed=7)
    here = run(with_values(get("first-look"), values), 7)
    assert done["summary"]["digest"] == here.digest
    trace = lab.trace(done, "plant.displacement", start_tick=100)
    np.testing.assert_array_equal(trace["plant.displacement"], here.signal("plant.displacement")[100:])
    assert trace["tick"].tolist() == list(range(100, 500))


def test_a_campaign(lab: Any) -> None:
    sweep = lab.sweep(CAMPAIGN)
    points = lab.points(sweep)
    assert [point["labels"]["controller.adaptation_gain"] for point in points] == [10.0, 30.0]
    assert [point["runs"] for point in points] == [2, 2]
    assert lab.points(sweep, limit=1) == points[:1]
    pages = lab.pages(f"/sweeps/{sweep['id']}/points", limit=1, sort="runs")
    assert [[point["labels"] for point in page["points"]] for page in pages] == [[one["labels"]] for one in points]


def test_a_run_is_waited_for_with_and_without_a_stream_of_progress(client: Any, lab: Any) -> None:
    wanted = {"scenario": "first-look", "set": {"samples": 700, "expect": []}}
    path = f"/runs/{lab.ask('POST', '/runs', {**wanted, 'seed': 71})['id']}"
    *_, (event, found) = lab.watch(path)
    assert event == "done" and found == lab.ask("GET", path)
    begun = lab.ask("POST", "/runs", {**wanted, "seed": 72})
    path, lab.watch = (
        f"/runs/{begun['id']}",
        lambda _: (_ for _ in ()).throw(client.Refused("not_found", "no such door")),
    )
    assert lab._ended("/runs", begun) == lab.ask("GET", path)


def test_a_live_bench_and_its_stream(lab: Any) -> None:
    """A column for each tick: minimum, maximum and the sample itself are one number, up to float32."""
    with lab.bench("first-look", paused=True, seed=3) as bench:
        bench.command(kind="step", ticks=400)
        names = ("plant.displacement", "reference.voltage", "drive.voltage")
        pictures = bench.pictures(*names, window_ms=1.0, width=100)
        shown = next(one for one in pictures if one.head == 400)
        pictures.close()
        here = run(with_values(get("first-look"), {"samples": 400}), 3)
        assert shown.end - shown.start == pytest.approx(100.0) and shown.dt_ms == 0.01
        for name in names:
            expected = here.signal(name)[300:].astype(np.float32)
            np.testing.assert_array_equal(shown.low[name], shown.high[name])
            np.testing.assert_array_equal(shown.low[name], expected)
            assert shown.latest[name] == expected[-1]
        bench_id = bench.id
    assert bench_id not in [one["id"] for one in lab.ask("GET", "/benches")["benches"]]


def test_refusals_are_errors_with_their_field(client: Any, lab: Any) -> None:
    with pytest.raises(client.Refused, match="unknown scenario 'ch5-sevn-step'") as refused:
        lab.run("ch5-sevn-step")
    assert refused.value.field == "scenario"
    with lab.bench("first-look", paused=True) as bench:
        with pytest.raises(client.Refused) as of_field:
            bench.command(fault="added_mass", severity=-5.0)
        assert of_field.value.field == "severity"
        with pytest.raises(client.Refused, match=r"plant\.nowhere"):
            next(bench.pictures("plant.nowhere", window_ms=1.0))
    with pytest.raises(client.Refused):
        client.Client(lab.address.removesuffix("/api/v1"), "wrong").ask("GET", "/benches")


OCTAVE = """
addpath('{clients}');
lab = CombBench('{address}', '{token}');
done = lab.run('first-look', struct('seed', 7, 'set', containers.Map({{'samples', 'sensor.noise_um'}}, {{300, 0.06}})));
trace = lab.trace(done, {{'plant.displacement', 'kalman.probability.m+5'}});
printf('%s\\n%.17g\\n%d\\n', done.summary.digest, sum(trace.plant_displacement), numel(trace.tick));
printf('%s %d\\n', trace.names.kalman_probability_m_plus_5, numel(trace.kalman_probability_m_plus_5));
campaign = struct('schema', 1, 'id', 'clients', 'scenario', 'ch3-mrac-spring-x2', 'seeds', '1:2');
campaign.grid = containers.Map({{'controller.adaptation_gain'}}, {{[10.5, 30.5]}});
points = lab.points(lab.sweep(campaign));
printf('%d %d\\n', numel(points), points(1).runs);
bench = lab.bench('first-look', struct('paused', true, 'seed', 3));
lab.command(bench, struct('kind', 'step', 'ticks', 100));
lab.command(bench, struct('switch', 'mrac'));
printf('%s\\n', lab.ask('GET', ['/benches/', bench.id]).controller);
lab.close(bench);
try
    lab.run('ch5-sevn-step');
catch refused
    printf('%s|%s\\n', refused.identifier, refused.message);
end
"""


@pytest.mark.long
@pytest.mark.skipif(shutil.which("octave-cli") is None, reason="this machine has no Octave")
def test_the_client_of_matlab_in_octave(live: Any, tmp_path: Path) -> None:
    program = tmp_path / "lab.m"
    program.write_text(OCTAVE.format(clients=CLIENTS, address=live.address, token=TOKEN))
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    environment = {**os.environ, "TMPDIR": str(temporary)}
    command = ["octave-cli", "--quiet", program]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=110)
    digest, total, ticks, named, campaign, controller, refused = done.stdout.splitlines()
    here = run(with_values(get("first-look"), {"samples": 300, "sensor.noise_um": 0.06}), 7)
    assert (digest, int(ticks), campaign, controller) == (here.digest, 300, "2 2", "mrac"), done.stderr
    assert named == "kalman.probability.m+5 300"
    assert float(total) == pytest.approx(here.signal("plant.displacement").sum(), rel=1e-12)
    assert not [*temporary.iterdir()], "it leaves files behind"
    assert refused.startswith("CombBench:unknown|scenario: unknown scenario 'ch5-sevn-step'")
