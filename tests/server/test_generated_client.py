"""A client that another program generates from the OpenAPI document serves a script."""

from __future__ import annotations

import importlib
import pkgutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from server.api.document import PARAMETERS
from tests.server.conftest import TOKEN

PACKAGE = "combbench_generated"
CONFIG = "post_hooks: []\ncontent_type_overrides: {image/svg+xml: application/octet-stream}\n"
CAMPAIGN = {
    "id": "generated",
    "scenario": "first-look",
    "set": {"samples": 200},
    "grid": {"sensor.noise_um": [0.05, 0.1]},
    "seeds": "1:2",
}


@pytest.fixture
def generated(live: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """A client of the server, as the generator writes it from the document that the server gives."""
    document, config = tmp_path / "openapi.json", tmp_path / "config.yaml"
    document.write_text(live.http.get("/api/v1/openapi.json").text)
    config.write_text(CONFIG)
    command = [sys.executable, "-m", "openapi_python_client", "generate", "--meta", "none", "--fail-on-warning"]
    places = ["--path", document, "--config", config, "--output-path", tmp_path / PACKAGE]
    done = subprocess.run([*command, *places], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    monkeypatch.syspath_prepend(tmp_path)
    package = importlib.import_module(PACKAGE)
    yield package
    for name in [name for name in sys.modules if name.partition(".")[0] == PACKAGE]:
        del sys.modules[name]


def test_a_generated_client_does_the_work_of_a_script(live: Any, generated: Any) -> None:
    models = importlib.import_module(f"{PACKAGE}.models")

    def ask(group: str, operation: str, *path: str, **fields: Any) -> Any:
        function = importlib.import_module(f"{PACKAGE}.api.{group}.{operation}").sync
        return function(*path, client=client, **fields)

    with generated.AuthenticatedClient(base_url=live.address, token=TOKEN) as client:
        bench = ask("benches", "create_bench", body=models.NewBench("first-look", paused=True, seed=3))
        assert isinstance(bench, models.Bench)
        ask("benches", "command", bench.id, body=models.Step(ticks=100))
        done = ask("benches", "command", bench.id, body=models.Inject(fault="added_mass", severity=0.05))
        assert (done.tick, done.entry.kind) == (100, "inject")
        seen = ask("benches", "get_bench", bench.id)
        assert [fault.name for fault in seen.faults] == ["added_mass"]
        trace = ask("trace", "get_trace", bench.id, signals=["plant.displacement"], start_tick=0, end_tick=100)
        assert trace.end_tick == 100
        assert ask("benches", "delete_bench", bench.id) is None
        gone = ask("benches", "get_bench", bench.id)
        assert isinstance(gone, models.ErrorReply) and gone.error.code == "not_found"

        sensor = models.IdealSensor(kind="ideal", noise_um=0.05)
        fault = models.ScenarioEvent(at_ms=1.0, fault="added_mass", severity=0.05)
        scenario = models.Scenario(id="typed", samples=200, sensor=sensor, events=[fault])
        bench = ask("benches", "create_bench", body=models.NewBench(scenario, paused=True))
        assert isinstance(bench, models.Bench), bench
        assert (bench.scenario_id, bench.pending[0].tick) == ("typed", 100)

        document = models.Campaign.from_dict(CAMPAIGN)
        sweep = ask("sweeps", "start_sweep", body=models.NewSweep(sweep=document))
        live.ended(sweep.id)
        page = ask("sweeps", "get_sweep_points", sweep.id, limit=1, sort="sensor.noise_um", descending=True)
        assert (page.found, len(page.points), page.points[0].runs) == (2, 1, 2)
        assert page.points[0].labels.additional_properties == {"sensor.noise_um": 0.1}


def test_all_that_is_generated_can_be_imported(live: Any, generated: Any) -> None:
    api = importlib.import_module(f"{PACKAGE}.api")
    found = [module.name for module in pkgutil.walk_packages(api.__path__, f"{PACKAGE}.api.")]
    operations = [importlib.import_module(name) for name in found if name.count(".") == 3]
    document = live.http.get("/api/v1/openapi.json").json()
    assert len(operations) == sum(len(one) for one in document["paths"].values())


def test_each_shared_description_belongs_to_a_parameter(live: Any) -> None:
    paths = live.http.get("/api/v1/openapi.json").json()["paths"].values()
    named = {one["name"] for each in paths for operation in each.values() for one in operation.get("parameters", [])}
    assert set(PARAMETERS) <= named
