"""An exported bench runs in FMPy and in a program in C, with the bits of the bench, its faults acting."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu
from typer.testing import CliRunner

from core.errors import InputError
from scenarios.edit import with_values
from scenarios.fmu import linker
from scenarios.fmu.fmu import export
from scenarios.fmu.unit_text import base_unit
from scenarios.library import get
from scenarios.run import run
from scenarios.schema import Scenario
from server.cli.main import app

SAMPLES = 700
EVENTS: list[dict[str, Any]] = [
    {"fault": "added_mass", "severity": 0.05, "at_sample": 200},
    {"fault": "debris", "severity": 0.5, "at_sample": 233},
    {"fault": "sensor_bias", "severity": 0.1, "at_sample": 300},
    {"set": {"plant.drive_noise_v": 0.03}, "at_sample": 350},
    {"heal": ["debris"], "at_sample": 400},
    {"fault": "debris", "severity": 0.5, "at_sample": 450},
]
STEPS = {0: {}, **{event["at_sample"]: {} for event in EVENTS}}
for _event in EVENTS:
    if "fault" in _event:
        STEPS[_event["at_sample"]][f"severity.{_event['fault']}"] = _event["severity"]
    STEPS[_event["at_sample"]] |= {f"severity.{name}": 0.0 for name in _event.get("heal", ())}
    STEPS[_event["at_sample"]] |= _event.get("set", {})
SEEN = ("plant.displacement", "plant.velocity", "capacitive.displacement", "capacitive.positive", "sensor.displacement",
        "effects.mass_scale")  # fmt: skip


def bench(**values: Any) -> Scenario:
    base = {
        "samples": SAMPLES,
        "diagnosers": {},
        "plant.model": "nonlinear",
        "sensor.kind": "capacitive",
        "guard.travel_um": 4.0,
    }
    return with_values(get("first-look"), {**base, "controller.kind": "pid", **values})


class Importer:
    """FMPy's own calls, one by one."""

    def __init__(self, path: Path, folder: Path) -> None:
        fmpy.extract(str(path), str(folder))
        self.model = fmpy.read_model_description(str(path))
        self.numbers = {one.name: one.valueReference for one in self.model.modelVariables}
        arguments = {"guid": self.model.guid, "unzipDirectory": str(folder), "instanceName": "one"}
        self.slave = FMU3Slave(modelIdentifier=self.model.coSimulation.modelIdentifier, **arguments)
        self.slave.instantiate(loggingOn=True)
        self.begin()

    def begin(self) -> None:
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def set(self, values: dict[str, float]) -> None:
        if values:
            self.slave.setFloat64([self.numbers[name] for name in values], [*values.values()])

    def get(self, names: tuple[str, ...]) -> list[float]:
        found: list[float] = self.slave.getFloat64([self.numbers[name] for name in names])
        return found

    def step(self, number: int, dt_s: float, ticks: int = 1) -> tuple[bool, ...]:
        found: tuple[bool, ...] = self.slave.doStep(number * dt_s, ticks * dt_s)
        return found


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("fmu") / "made" / "bench.fmu"
    export(bench(), path, "0")
    assert [*path.parent.iterdir()] == [path]
    return path


@pytest.fixture
def importer(made: Path, tmp_path: Path) -> Importer:
    return Importer(made, tmp_path / "unzipped")


def test_it_is_valid_and_has_no_python(made: Path) -> None:
    assert validate_fmu(str(made)) == []
    with zipfile.ZipFile(made) as archive:
        assert archive.namelist() == ["modelDescription.xml", "binaries/x86_64-linux/combbench.so"]


def test_it_has_the_bits_of_the_bench_with_its_faults_and_values(importer: Importer) -> None:
    """The voltages of the PID of the bench, its faults and its values, at the same samples."""
    there = run(bench(events=EVENTS), taps=True)
    found = []
    for tick, voltage in enumerate(there.signal("pid.voltage")):
        importer.set({"voltage": voltage, **STEPS.get(tick, {})})
        found.append(importer.get(SEEN))
        importer.step(tick, 1e-5)
    for name, values in zip(SEEN, np.array(found).T, strict=True):
        np.testing.assert_array_equal(values, there.signal(name), name)
    assert np.ptp(there.signal("plant.displacement")) > 1.0
    assert importer.get(("effects.mass_scale",)) == [1.05]


def test_a_state_can_be_kept_and_time_can_be_taken_back(importer: Importer) -> None:
    def some(first: int) -> list[list[float]]:
        found = []
        for tick in range(first, first + 40):
            importer.set({"voltage": float(np.sin(0.3 * tick)), "severity.stiffness": 0.1 * (tick > first + 20)})
            importer.step(tick, 1e-5)
            found.append(importer.get(SEEN))
        return found

    some(0)
    state = importer.slave.getFMUState()
    first = some(40)
    importer.slave.setFMUState(state)
    assert some(40) == first
    kept = importer.slave.serializeFMUState(state)
    importer.slave.setFMUState(importer.slave.deserializeFMUState(kept))
    assert some(40) == first
    importer.slave.reset()
    importer.begin()
    assert importer.get(("plant.displacement", "effects.stiffness_scale")) == [0.0, 1.0]


def test_a_longer_step_holds_the_voltage_and_one_between_samples_is_refused(importer: Importer) -> None:
    voltages = np.repeat(np.random.default_rng(6).normal(size=50), 4)
    there = run(bench(samples=200), law=lambda x: voltages[x.tick])
    found = []
    for tick in range(0, 200, 4):
        importer.set({"voltage": voltages[tick]})
        found.append(importer.get(("plant.displacement",))[0])
        importer.step(tick, 1e-5, 4)
    np.testing.assert_array_equal(found, there.signal("plant.displacement")[::4])
    for step in (1.5e-5, 0.8e-5, 0.0):
        with pytest.raises(Exception, match="fmi3DoStep"):
            importer.slave.doStep(0.0, step)
    for now in (1e6, 1e8):  # the difference of two large times
        importer.slave.doStep(now, (now + 1e-5) - now)
    with pytest.raises(Exception, match="fmi3DoStep"):
        importer.slave.doStep(1e12, 1.25e-5)


def test_a_trip_ends_the_simulation(importer: Importer) -> None:
    there = run(bench(samples=3000), law=lambda x: 30.0 * (-1.0) ** (x.tick // 20), taps=True)
    assert there.trip is not None
    tick, ended = 0, False
    while not ended:
        importer.set({"voltage": 30.0 * (-1.0) ** (tick // 20)})
        _, ended, *_ = importer.step(tick, 1e-5)
        tick += 1
    assert tick == there.trip.tick
    with pytest.raises(Exception, match="fmi3DoStep"):
        importer.step(tick, 1e-5)


def test_bad_numbers_are_refused(importer: Importer) -> None:
    for values in ({"severity.added_mass": -2.0}, {"severity.debris": 0.123456}, {"plant.drive_noise_v": -1.0},
                   {"severity.added_mass": float("nan")}, {"plant.displacement": 1.0}, {"time": 1.0}):  # fmt: skip
        with pytest.raises(Exception, match="fmi3SetFloat64"):
            importer.set(values)
    importer.step(0, 1e-5)
    with pytest.raises(Exception, match="fmi3GetFloat64"):
        importer.slave.getFloat64([9999])


def test_its_description_names_causality_units_and_grids(made: Path) -> None:
    model = fmpy.read_model_description(str(made))
    known = {one.name: one for one in model.modelVariables}
    assert model.fmiVersion == "3.0" and model.defaultExperiment.stepSize == "1e-05"
    kinds = {"voltage": ("input", "V"), "severity.added_mass": ("input", "1"), "plant.displacement": ("output", "um"),
             "plant.drive_noise_v": ("parameter", "V"), "capacitive.positive": ("output", "fF")}  # fmt: skip
    assert {name: (known[name].causality, known[name].unit) for name in kinds} == kinds
    assert "one of" in known["severity.debris"].description and "0.5" in known["severity.debris"].description
    identifier = r"(?:[A-Za-z_][A-Za-z0-9_]*|'(?:[^'\\]|\\.)+')(?:\[\d+(?:,\d+)*\])?"  # FMI 3.0, 2.4.7.5.1
    assert [name for name in known if not re.fullmatch(rf"{identifier}(?:\.{identifier})*", name)] == []
    assert len(known) == len(model.modelVariables) > 50


@pytest.mark.parametrize(
    ("text", "factor", "exponents"),
    [
        ("um/ms^2", 1.0, {"m": 1, "s": -2}),
        ("uN/um^3", 1e12, {"kg": 1, "m": -2, "s": -2}),
        ("V/(um ms)", 1e9, {"kg": 1, "m": 1, "s": -4, "A": -1}),
        ("1", 1.0, {}),
        ("g", 9.80665, {"m": 1, "s": -2}),
    ],
)
def test_units(text: str, factor: float, exponents: dict[str, int]) -> None:
    found = base_unit(text)
    assert found is not None and found[1] == exponents
    assert found[0] == pytest.approx(factor, rel=1e-12)


def test_an_unknown_unit_has_no_base_unit() -> None:
    assert base_unit("week") is None and base_unit("LSB/um") is None


IMPORTER = """
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include "fmi3Functions.h"

int main(int count, char **given) {
  void *library = dlopen(given[1], RTLD_NOW);
  if (!library) return fprintf(stderr, "%s\\n", dlerror()), 1;
#define LOAD(name, function) function##TYPE *name = (function##TYPE *)dlsym(library, #function)
  LOAD(instantiate, fmi3InstantiateCoSimulation);
  LOAD(enter, fmi3EnterInitializationMode);
  LOAD(leave, fmi3ExitInitializationMode);
  LOAD(set, fmi3SetFloat64);
  LOAD(get, fmi3GetFloat64);
  LOAD(step, fmi3DoStep);
  fmi3Instance one = instantiate("one", given[2], NULL, false, false, false, false, NULL, 0, NULL, NULL, NULL);
  if (!one) return 2;
  enter(one, false, 0.0, 0.0, false, 0.0);
  leave(one);
  fmi3ValueReference voltage = atoi(given[3]), mass = atoi(given[4]), displacement = atoi(given[5]);
  for (int k = 0; k < 300; k++) {
    double u = k % 50 < 25 ? 4.0 : -4.0, severity = k < 100 ? 0.0 : 0.05, y, reached;
    bool event, ends, early;
    set(one, &voltage, 1, &u, 1);
    set(one, &mass, 1, &severity, 1);
    get(one, &displacement, 1, &y, 1);
    printf("%a\\n", y);
    if (step(one, k * 1e-5, 1e-5, true, &event, &ends, &early, &reached) != fmi3OK || ends) return 3;
  }
  return 0;
}
"""


def test_a_program_in_c_imports_it(made: Path, importer: Importer, tmp_path: Path) -> None:
    """It is written against the header of the standard, which checks the signatures, and has no Python."""
    header = Path(fmpy.__file__).parent / "c-code"
    (tmp_path / "importer.c").write_text(IMPORTER)
    command = [*linker.compiler(), f"-I{header}", "importer.c", "-o", "importer", "-ldl"]
    subprocess.run(command, cwd=tmp_path, check=True)
    library = tmp_path / "unzipped" / "binaries" / "x86_64-linux" / "combbench.so"
    names = ("voltage", "severity.added_mass", "plant.displacement")
    references = [str(importer.numbers[name]) for name in names]
    told = subprocess.run(
        [str(tmp_path / "importer"), str(library), importer.model.guid, *references],
        check=True, capture_output=True, text=True, env={},
    )  # fmt: skip
    event = {"fault": "added_mass", "severity": 0.05, "at_sample": 100}
    there = run(bench(samples=300, events=[event]), law=lambda x: 4.0 if x.tick % 50 < 25 else -4.0)
    np.testing.assert_array_equal(
        [float.fromhex(line) for line in told.stdout.split()], there.signal("plant.displacement")
    )


@pytest.mark.long
def test_a_gyroscope_with_its_two_axes(tmp_path: Path) -> None:
    scenario = with_values(get("gyro-first-look"), {"samples": 400, "diagnosers": {}})
    export(scenario, tmp_path / "gyro.fmu", "0")
    assert validate_fmu(str(tmp_path / "gyro.fmu")) == []
    importer = Importer(tmp_path / "gyro.fmu", tmp_path / "unzipped")
    there, dt_s = run(scenario), scenario.spec.dt_ms / 1e3
    forces = {f"command.{axis}": there.signal(f"drive.{axis}.force") for axis in scenario.spec.axes}
    found = []
    for tick in range(400):
        importer.set({name: values[tick] for name, values in forces.items()})
        found.append(importer.get(("plant.x", "plant.y")))
        importer.step(tick, dt_s)
    for name, values in zip(("plant.x", "plant.y"), np.array(found).T, strict=True):
        np.testing.assert_array_equal(values, there.signal(name))
    assert all(np.ptp(values) > 0.0 for values in np.array(found).T)


def test_what_it_cannot_be_is_refused_in_one_line(tmp_path: Path) -> None:
    for name, values, word in (
        ("ch1-table-1-1", {}, "study"),
        ("first-look", {"plant.drive": "analogue"}, "between samples"),
    ):
        with pytest.raises(InputError, match=word):
            export(with_values(get(name), values), tmp_path / "no.fmu", "0")
    assert not [*tmp_path.iterdir()]


def test_without_a_compiler_one_line_says_so(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(shutil, "which", lambda _: None)
    monkeypatch.setattr(linker.importlib.util, "find_spec", lambda _: None)
    done = CliRunner().invoke(app, ["fmu", "first-look", "--out", str(tmp_path / "device.fmu")])
    assert done.exit_code == 2 and not [*tmp_path.iterdir()] and len(done.stderr.splitlines()) == 1
    assert done.stderr.startswith("combbench: fmu: an FMU needs a C compiler") and "'.[fmi]'" in done.stderr


def test_the_package_with_a_compiler_is_used_where_the_machine_has_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda _: None)
    monkeypatch.setattr(linker.importlib.util, "find_spec", lambda name: name == "ziglang")
    assert linker.compiler() == [sys.executable, "-m", "ziglang", "cc"]


def test_the_command_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, made: Path) -> None:
    monkeypatch.chdir(tmp_path)
    command = ["fmu", "first-look", "--out", "made/device.fmu", "--set", "sample_rate_khz=50"]
    done = CliRunner().invoke(app, command)
    assert done.stdout.startswith("made/device.fmu, a step of 2e-05 s, for x86_64-linux\n")
    assert (tmp_path / "made" / "device.fmu").is_file()
