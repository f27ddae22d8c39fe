"""A start loads what it uses: libraries of few requests and few runs are loaded with the first of them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

SELDOM = [
    "alembic",  # when the tables are older than the code
    "dask",  # campaigns on a cluster
    "distributed",
    "duckdb",  # for tests alone
    "jinja2",  # reports
    "latex2mathml",  # lab sheets that are handed in
    "markdown_it",
    "matplotlib",  # for notebooks alone
    "psutil",  # a classroom
    "psycopg",  # a database by address
    "pyarrow",  # traces, recordings and campaigns
    "jwt",  # launches from learning platforms
    "requests",
    "rich",  # the help of the command line
    "scipy",  # reports of campaigns, peers of the benchmark, one estimate of noise
    "segno",
    "server.classroom.lti",
    "tomlkit",  # a scenario that is saved
    "viser",  # the 3D view
    "wasmtime",  # units of students
]
OPTIONAL = {
    "pyjwt": "launches from learning platforms",
    "cryptography": "the same",
    "requests": "the same",
    "distributed": "campaigns on a cluster",
    "dask": "the same",
    "psycopg": "a database by address",
    "psycopg-binary": "the same",
}
"""Distributions of features that are configured."""
STARTED = """
from pathlib import Path
from server.cli import serve
from server.settings import Settings
start = serve.Server.startup
async def startup(self, sockets):
    await start(self, sockets)
    self.should_exit = True
serve.Server.startup = startup
serve.serve(Settings(port=0, data=Path(sys.argv[1]), figures=False, run_workers=0))
"""
FORKED = """
import asyncio
from server.clock import ManualClock
from server.computing.computing import Computing
computing = Computing(ManualClock())
print(asyncio.run(computing.call(eval, "'server.api.experiments' in __import__('sys').modules")))
computing.close()
"""
SERVICE = ["asyncio", "fastapi", "multiprocessing", "sqlalchemy", "starlette", "uvicorn"]


def loaded_by(code: str, *arguments: str) -> list[str]:
    """Return the modules that a program has loaded at its end."""
    told = f"import atexit, json, sys; atexit.register(lambda: print(json.dumps([*sys.modules])))\n{code}"
    # with bytecode kept: without it every start compiles all packages
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": ""}
    command = [sys.executable, "-c", told, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=environment)
    loaded: list[str] = json.loads(done.stdout.splitlines()[-1])
    return loaded


@pytest.mark.parametrize(
    ("code", "unwanted"),
    [
        ("import server.app", SELDOM),
        ("from server.cli.main import app; app(['run', 'first-look'], standalone_mode=False)", SELDOM + SERVICE),
    ],
    ids=["server", "run"],
)
def test_a_start_loads_no_library_that_it_seldom_uses(code: str, unwanted: list[str]) -> None:
    loaded = loaded_by(code)
    assert "scenarios.schema" in loaded
    assert [name for name in unwanted if name in loaded] == []


def test_a_started_server_has_no_distribution_of_what_is_not_configured(tmp_path: Path) -> None:
    modules = loaded_by(STARTED, str(tmp_path))
    loaded = {name.partition(".")[0] for name in modules}
    owners = packages_distributions()
    there = {owner.lower().replace("_", "-") for name in loaded for owner in owners.get(name, ())}
    assert {"fastapi", "sqlalchemy", "uvicorn"} <= there and not there & OPTIONAL.keys()
    assert not [name for name in modules if name.startswith("server.classroom.lti")]
    assert "scenarios.campaign.cluster" not in modules


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere each process loads the code itself")
def test_a_process_that_computes_for_requests_is_forked_with_its_code() -> None:
    done = subprocess.run([sys.executable, "-c", FORKED], capture_output=True, text=True, check=True)
    assert done.stdout == "True\n"
