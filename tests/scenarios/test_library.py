"""The library: one scenario is read without the others, in the order of the text when all are."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from core.errors import InputError
from scenarios.library import get, ids, library
from scenarios.schema import Scenario

COUNTING = """
import json, sys
opened, loaded = [], []

def hook(event, arguments):
    if event == "open" and "scenarios/library/" in str(arguments[0]) and str(arguments[0]).endswith(".toml"):
        opened.append(str(arguments[0]).rpartition("/")[2])

sys.addaudithook(hook)
from scenarios.schema import Scenario
load = Scenario.load
Scenario.load = lambda text: loaded.append(1) or load(text)
from scenarios.library import get, library

def count(*steps):
    for step in steps:
        step()
    print(json.dumps([sorted(opened), len(loaded)]))

def refused():
    try:
        get("ch5-seven-stepp")
    except ValueError:
        pass

def one():
    return get("ch5-seven-step")

count(refused)
count(one, one)
count(library, one, library)
"""


def test_a_refusal_reads_no_scenario_and_the_library_reads_each_once():
    """Counted in a fresh process: its files that are opened and parsed, after each step."""
    done = subprocess.run([sys.executable, "-c", COUNTING], capture_output=True, text=True, check=True)
    refused, one, all_of_them = map(json.loads, done.stdout.splitlines())
    assert refused == [[], 0] and one == [["ch5-seven-step.toml"], 1]
    assert all_of_them == [sorted(f"{name}.toml" for name in ids()), len(ids())]


@pytest.mark.parametrize("name", ["ch5-seven-stepp", "", "../library/ch5-seven-step", "CH5-SEVEN-STEP", "__init__"])
def test_unknown_ids_are_refused_with_what_there_is(name: str):
    with pytest.raises(InputError) as refused:
        get(name)
    assert refused.value.field == "scenario" and refused.value.code == "unknown"
    assert f"allowed: {len(ids())} names" in refused.value.message
    if name == "ch5-seven-stepp":
        assert refused.value.hint == "did you mean ch5-seven-step?"


def test_the_library_goes_by_the_text():
    chapters = [name for name in ids() if name.startswith("ch")]
    gyroscopes = [name for name in ids() if name.startswith("gyro")]
    appendices = [name for name in ids() if name.startswith("app")]
    assert list(ids()) == ["first-look", *sorted(chapters), *sorted(gyroscopes), *sorted(appendices)]


def test_the_library_has_each_scenario_by_the_name_of_its_file():
    assert [scenario.id for scenario in library()] == list(ids())
    assert all(isinstance(scenario, Scenario) and get(scenario.id) is scenario for scenario in library())
