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
{do}
print(json.dumps([opened, len(loaded)]))
"""


def count(do: str) -> tuple[list[str], int]:
    """Return the files of the library that a fresh process opens when it does this, and how many it parses."""
    program = COUNTING.replace("{do}", do)
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    opened, loaded = json.loads(done.stdout)
    return opened, loaded


def test_one_scenario_is_read_without_the_others():
    assert count("get('ch5-seven-step'); get('ch5-seven-step')") == (["ch5-seven-step.toml"], 1)


def test_all_are_read_once():
    opened, loaded = count("get('ch2-doppler'); library(); get('ch5-seven-step'); library()")
    assert sorted(opened) == sorted(f"{name}.toml" for name in ids())
    assert loaded == len(ids())


def test_a_refusal_reads_none():
    refused = "try: get('ch5-seven-stepp')\nexcept ValueError: pass"
    assert count(refused) == ([], 0)


@pytest.mark.parametrize("name", ["ch5-seven-stepp", "", "../library/ch5-seven-step", "CH5-SEVEN-STEP", "__init__"])
def test_unknown_ids_are_refused_with_what_there_is(name: str):
    with pytest.raises(InputError) as refused:
        get(name)
    assert refused.value.field == "scenario" and refused.value.code == "unknown"
    assert refused.value.message.endswith(f"allowed: {', '.join(ids())}")
    if name == "ch5-seven-stepp":
        assert refused.value.hint == "did you mean ch5-seven-step?"


def test_the_id_of_a_scenario_is_the_name_of_its_file():
    assert [scenario.id for scenario in library()] == list(ids())


def test_the_library_goes_by_the_text():
    chapters = [name for name in ids() if name.startswith("ch")]
    gyroscopes = [name for name in ids() if name.startswith("gyro")]
    appendices = [name for name in ids() if name.startswith("app")]
    assert list(ids()) == ["first-look", *sorted(chapters), *sorted(gyroscopes), *sorted(appendices)]


def test_the_library_and_one_of_it_are_the_same():
    scenarios = library()
    assert all(isinstance(scenario, Scenario) and get(scenario.id) is scenario for scenario in scenarios)
