"""An exported device runs in FMPy, another program's simulator, with the trace of the bench."""

from __future__ import annotations

import itertools
import re
import sys
import zipfile
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu
from typer.testing import CliRunner

from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.outside.fmu import export
from scenarios.outside.fmu_slave import CombBenchDevice
from scenarios.run import run
from scenarios.schema import Scenario
from server.cli.main import app

SAMPLES = 600
QUIET = {"samples": SAMPLES, "diagnosers": {}, "plant.drive_noise_v": 0.0, "plant.thermal_noise": False}
STARTED = {"plant.initial_displacement_um": 1.5, "plant.initial_velocity_um_ms": -3.0}
COLD = {"environment.pressure_pa": 5000.0, "environment.temperature_k": 250.0}


def quiet(**values: Any) -> Scenario:
    return with_values(get("first-look"), {**QUIET, **values})


def simulated(path: Path, voltages: np.ndarray, dt_s: float, step_s: float) -> Any:
    """Return what FMPy makes of held voltages."""
    times = dt_s * np.arange(len(voltages))
    given = np.array(list(zip(times, voltages, strict=True)), dtype=[("time", float), ("voltage", float)])
    return fmpy.simulate_fmu(
        str(path), stop_time=times[-1], step_size=step_s, output_interval=step_s, input=given,
        output=["displacement", "velocity"],
    )  # fmt: skip


@pytest.mark.parametrize("values", [{}, {**STARTED, **COLD}])
def test_it_has_the_trace_of_the_bench(values: dict[str, Any], tmp_path: Path) -> None:
    scenario, path = quiet(**values), tmp_path / "device.fmu"
    export(scenario, path)
    assert validate_fmu(str(path)) == []
    voltages = np.random.default_rng(5).normal(scale=3.0, size=SAMPLES)
    here = run(scenario, law=lambda x: voltages[x.tick])
    there = simulated(path, voltages, 1e-5, 1e-5)
    assert len(there) == SAMPLES and np.ptp(there["displacement"]) > 0.1
    np.testing.assert_allclose(there["displacement"], here.signal("plant.displacement"), rtol=0, atol=1e-11)
    np.testing.assert_allclose(1e-3 * there["velocity"], here.signal("plant.velocity"), rtol=0, atol=1e-9)


def test_its_description_names_the_units(tmp_path: Path) -> None:
    path = tmp_path / "device.fmu"
    export(quiet(), path)
    described = fmpy.read_model_description(str(path))
    assert described.fmiVersion == "3.0" and "ch3" in described.description
    assert {v.name: v.unit for v in described.modelVariables} == {
        "time": "s", "voltage": "V", "displacement": "um", "velocity": "um/s",
    }  # fmt: skip
    assert described.defaultExperiment.stepSize == "1e-05"
    assert [*tmp_path.iterdir()] == [path]


def test_each_variable_has_a_structured_name_of_fmi_3(tmp_path: Path) -> None:
    path = tmp_path / "device.fmu"
    export(quiet(title='Ω+5, "m" & <b>'), path)
    names = [variable.name for variable in fmpy.read_model_description(str(path)).modelVariables]
    identifier = r"(?:[A-Za-z_][A-Za-z0-9_]*|'(?:[^'\\]|\\.)+')(?:\[\d+(?:,\d+)*\])?"  # FMI 3.0, 2.4.7.5.1
    assert names and len(set(names)) == len(names)
    assert [name for name in names if not re.fullmatch(rf"{identifier}(?:\.{identifier})*", name)] == []


def test_a_longer_step_holds_the_voltage_and_one_between_samples_is_refused(tmp_path: Path) -> None:
    scenario, path = quiet(), tmp_path / "device.fmu"
    export(scenario, path)
    voltages = np.repeat(np.random.default_rng(6).normal(size=SAMPLES // 4), 4)
    here = run(scenario, law=lambda x: voltages[x.tick])
    there = simulated(path, voltages[::4], 4e-5, 4e-5)
    np.testing.assert_allclose(there["displacement"], here.signal("plant.displacement")[::4], rtol=0, atol=1e-11)
    with pytest.raises(Exception, match="fmi3DoStep"):
        simulated(path, voltages, 1e-5, 1.5e-5)


@pytest.mark.parametrize("start_s", [0.0, 1e6, 1e8])
def test_a_step_may_be_the_difference_of_two_large_times(start_s: float, tmp_path: Path) -> None:
    export(quiet(), tmp_path / "device.fmu")
    with zipfile.ZipFile(tmp_path / "device.fmu") as archive:
        archive.extract("resources/device.json", tmp_path)
    slave = CombBenchDevice(instance_name="one", resources=str(tmp_path / "resources"))
    slave.log = lambda *_: None
    times = start_s + 1e-5 * np.arange(200)
    assert all(slave.do_step(now, later - now) for now, later in itertools.pairwise(times))
    assert not slave.do_step(start_s, 1.5e-5) and not slave.do_step(start_s, 0.8e-5)
    assert not slave.do_step(1e12, 1.25e-5)  # a clock that cannot tell samples apart excuses no more than a tenth


def test_another_plant_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"plant.model: nonlinear cannot be exported"):
        export(quiet(**{"plant.model": "nonlinear"}), tmp_path / "device.fmu")


def test_the_command_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    command = ["fmu", "first-look", "--out", "made/device.fmu", "--set"]
    done = CliRunner().invoke(app, [*command, "sample_rate_khz=50"])
    assert done.stdout == "made/device.fmu, a step of 2e-05 s\n" and (tmp_path / "made" / "device.fmu").is_file()
    refused = CliRunner().invoke(app, [*command, "device.id=gyro-a"])
    assert refused.exit_code == 2 and len(refused.stderr.splitlines()) == 1


def test_without_the_package_one_line_says_so(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in ("scenarios.outside.fmu", "scenarios.outside.fmu_slave", "pythonfmu3"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.setitem(sys.modules, "pythonfmu3", None)
    done = CliRunner().invoke(app, ["fmu", "first-look", "--out", str(tmp_path / "device.fmu")])
    assert done.exit_code == 2 and not [*tmp_path.iterdir()]
    assert (
        done.stderr.startswith("combbench: fmu: needs the package pythonfmu3")
        and "'.[fmi]' in a checkout" in done.stderr
    )
