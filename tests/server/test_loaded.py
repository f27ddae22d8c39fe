"""A start loads what it uses: libraries of few requests and few runs are loaded with the first of them."""

from __future__ import annotations

import json
import os
import subprocess
import sys

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
SERVICE = ["asyncio", "fastapi", "multiprocessing", "sqlalchemy", "starlette", "uvicorn"]


@pytest.mark.parametrize(
    ("code", "unwanted"),
    [
        ("import server.app", SELDOM),
        ("from server.cli.main import app; app(['run', 'first-look'], standalone_mode=False)", SELDOM + SERVICE),
    ],
    ids=["server", "run"],
)
def test_a_start_loads_no_library_that_it_seldom_uses(code: str, unwanted: list[str]) -> None:
    told = f"import atexit, json, sys; atexit.register(lambda: print(json.dumps([*sys.modules])))\n{code}"
    # with bytecode kept: without it every start compiles all packages
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": ""}
    done = subprocess.run([sys.executable, "-c", told], capture_output=True, text=True, check=True, env=environment)
    loaded = json.loads(done.stdout.splitlines()[-1])
    assert "scenarios.schema" in loaded
    assert [name for name in unwanted if name in loaded] == []
