"""The notebooks run from top to bottom in a kernel of their own, and print the promised output."""

from __future__ import annotations

import json
import math
import os
import re
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.server.conftest import TOKEN

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))


def printed(name: str, folder: Path, **environment: str) -> str:
    """Run a notebook and return all it prints."""
    import nbformat
    from nbclient import NotebookClient

    book = nbformat.read(ROOT / "docs" / "notebooks" / f"{name}.ipynb", as_version=4)
    commands = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    usual = {"PATH": commands, "MPLBACKEND": "agg", "MPLCONFIGDIR": str(folder), "IPYTHONDIR": str(folder)}
    known = {**os.environ, **usual, "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "clients")]), **environment}
    NotebookClient(book, timeout=100, resources={"metadata": {"path": str(folder)}}).execute(env=known)
    outputs = [output for cell in book.cells if cell.cell_type == "code" for output in cell.outputs]
    assert not [output for output in outputs if output.get("name") == "stderr"], outputs
    return "".join(output.text for output in outputs if output.output_type == "stream")


def errors_um(said: str) -> dict[str, float]:
    """Return the tracking errors a notebook has printed, by controller."""
    return {name.strip(): float(value) for name, value in re.findall(r"^(.{10}) (\d\.\d+) um$", said, re.M)}


def test_there_are_eight_and_none_has_outputs() -> None:
    assert [path.stem for path in NOTEBOOKS] == [
        "campaign",
        "design",
        "detectors",
        "first-run",
        "lqg",
        "own-controller",
        "own-diagnoser",
        "policy",
    ]
    for path in NOTEBOOKS:
        cells = json.loads(path.read_text("utf-8"))["cells"]
        code = [cell for cell in cells if cell["cell_type"] == "code"]
        assert code and not [cell for cell in code if cell["outputs"] or cell["execution_count"]], path.name


@pytest.mark.long
def test_the_files_are_notebooks_of_version_4() -> None:
    import nbformat

    for path in NOTEBOOKS:
        nbformat.validate(nbformat.read(path, as_version=4))


@pytest.mark.long
def test_the_first_run(tmp_path: Path) -> None:
    said = printed("first-run", tmp_path)
    found = re.search(r"told after (\d+) samples, right in (0\.\d+)", said)
    assert found is not None and 0 < int(found[1]) < 300 and float(found[2]) > 0.9


@pytest.mark.long
def test_a_controller_of_ones_own(tmp_path: Path) -> None:
    errors = errors_um(printed("own-controller", tmp_path))
    assert errors["mrac"] < errors["own"] < errors["open loop"]


@pytest.mark.long
def test_a_diagnoser_of_ones_own(tmp_path: Path) -> None:
    said = printed("own-diagnoser", tmp_path)
    right = {name: float(value) for name, value in re.findall(r"^(\w+) +(0\.\d+) right$", said, re.M)}
    assert 0.8 < right["own"] < right["kalman"]
    assert len(re.findall(r"^\w+ +\d+ samples$", said, re.M)) == 2


@pytest.mark.long
def test_a_design_with_python_control(tmp_path: Path) -> None:
    errors = errors_um(printed("lqg", tmp_path))
    assert errors["LQG"] < 0.5 * errors["open loop"]


@pytest.mark.long
@pytest.mark.timeout(240)
def test_designs_of_other_programs(tmp_path: Path) -> None:
    """Sobol indices of a table of 2048 points are exact within 0.02, and the optimiser finds a gain that tracks."""
    said = printed("design", tmp_path)
    indices = re.findall(r"^(S1|ST) device\.\w+ +(0\.\d+), exactly (0\.\d+)$", said, re.M)
    assert "2048 points" in said and len(indices) == 4
    assert all(abs(float(value) - float(exact)) < 0.02 for _, value, exact in indices), indices
    assert float(indices[0][2]) == pytest.approx(0.4455, abs=0.001)  # by quadrature
    best = re.search(r"best gain ([\d.]+): ([\d.]+) nm", said)
    right = re.search(r"right in (0\.\d+) to (0\.\d+|1\.00) of samples, at 32 points", said)
    assert best is not None and float(best[2]) < 100.0
    assert right is not None and float(right[1]) < float(right[2])


@pytest.mark.long
@pytest.mark.timeout(240)
def test_detectors_of_other_tools(tmp_path: Path) -> None:
    """Filters of filterpy score as the Kalman bank does; a classifier that saw no case scores better than a guess."""
    said = printed("detectors", tmp_path)
    scores = {
        name: float(value) for name, value in re.findall(r"^ *(\S+) (?:\(computed outside\) )? *(0\.\d+) ±", said, re.M)
    }
    assert abs(scores["filterpy"] - scores["mmae"]) < 0.005
    assert scores["mmae"] < scores["scikit-learn"] < 0.5 < math.log(6)


@pytest.mark.long
@pytest.mark.timeout(240)
def test_a_policy_that_learns(tmp_path: Path) -> None:
    """On episodes that it has not seen, most with a fault, its error is less than the error of the default PID."""
    said = printed("policy", tmp_path)
    found = re.search(r"\{'policy': ([\d.]+), 'pid': ([\d.]+), 'open_loop': ([\d.]+)\}", said)
    assert found is not None and said.count("no fault") < 8
    policy, pid, open_loop = map(float, found.groups())
    assert policy < pid < 1.0 and policy < open_loop


@pytest.mark.long
@pytest.mark.timeout(240)
def test_a_campaign_over_rest(live: Any, tmp_path: Path) -> None:
    said = printed("campaign", tmp_path, COMBBENCH_ADDRESS=live.address, COMBBENCH_TOKEN=TOKEN)
    right = [float(value) for value in re.findall(r"um (0\.\d+|1\.\d+)$", said, re.M)]
    assert "20 of 20 runs" in said and len(right) == 4
    assert right[0] > 0.95 and right[-1] < right[0]
