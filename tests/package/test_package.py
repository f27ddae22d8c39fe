"""The public module: its names, its version, the packages it loads, its client."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest

import combbench as cb
from core.registry import FAMILIES
from scenarios.extras import require

ROOT = Path(__file__).resolve().parents[2]
MOST_DISTRIBUTIONS = 12
COUNT = """
import json, sys
from importlib.metadata import packages_distributions
import pytest

import combbench as cb
cb.run("first-look", set={"samples": 20})
known = packages_distributions()
print(json.dumps(sorted({name for module in list(sys.modules) for name in known.get(module.partition(".")[0], [])})))
"""


def test_a_run_loads_few_distributions() -> None:
    done = subprocess.run([sys.executable, "-c", COUNT], capture_output=True, text=True, check=True, cwd=ROOT)
    loaded = json.loads(done.stdout)
    assert {"numpy", "pydantic"} <= set(loaded)
    assert len(loaded) <= MOST_DISTRIBUTIONS, loaded


def test_every_public_name_exists_and_has_a_docstring() -> None:
    assert cb.__version__ == version("combbench")
    for name in cb.__all__:
        assert getattr(cb, name).__doc__ or name == "__version__"
    assert (ROOT / "combbench/py.typed").exists()


def test_devices_and_catalogue_are_those_of_the_bench() -> None:
    assert {"ch3", "gyro-a"} <= {device.id for device in cb.devices()}
    assert {card.family for card in cb.catalog()} <= set(FAMILIES)
    assert {card.family for card in cb.catalog("faults")} == {"faults"}


def test_the_client_is_one_file_to_copy() -> None:
    assert (ROOT / "combbench/client.py").read_bytes() == (ROOT / "clients/combbench_client.py").read_bytes()


def test_a_missing_package_is_named_with_its_extra() -> None:
    with pytest.raises(cb.InputError, match=r"--scheduler: needs the package no_such_package") as refused:
        require("no_such_package", "cluster", "--scheduler")
    assert "pip install '.[cluster]'" in refused.value.hint
    require("numpy", "cluster", "--scheduler")
