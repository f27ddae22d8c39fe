"""A controller in a process of its own: the same bits as in Python, and one line for each error."""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from core.board.outside import Sample
from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.outside.process import Process
from scenarios.run import run
from scenarios.schema import Scenario
from server.cli.main import app

ROOT = Path(__file__).resolve().parents[3]
EXAMPLES = ROOT / "docs" / "controllers"
KP, KI = -2.0, -9.0
SAMPLES = 400
STORY = [{"switch": "open_loop", "at_sample": 150}, {"switch": "external", "at_sample": 250}]


class Pi:
    """The law of the examples."""

    integral = 0.0

    def __call__(self, x: Sample) -> float:
        e = x.model - x.measured
        self.integral = self.integral + KI * e * x.dt_ms if x.engaged else x.applied - KP * e
        return KP * e + self.integral


def scenario(events: list[dict[str, object]] | None = None) -> Scenario:
    return with_values(get("first-look"), {"samples": SAMPLES, "events": events or []})


def python(code: str) -> str:
    return shlex.join([sys.executable, "-c", code])


def same_as_in_python(command: str) -> None:
    with Process(command, 30.0) as law:
        own = run(scenario(STORY), law=law)
    assert own.digest == run(scenario(STORY), law=Pi()).digest
    assert own.samples == SAMPLES and np.ptp(own.signal("drive.voltage")) > 0.1


def test_the_example_in_python() -> None:
    same_as_in_python(shlex.join([sys.executable, str(EXAMPLES / "pi.py"), str(KP), str(KI)]))


@pytest.mark.skipif(shutil.which("cc") is None, reason="this machine has no C compiler")
def test_the_example_in_c(tmp_path: Path) -> None:
    program = tmp_path / "pi"
    options = ["-std=c99", "-O2", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror"]
    subprocess.run(["cc", *options, "-o", program, EXAMPLES / "pi.c"], check=True)
    same_as_in_python(f"{shlex.quote(str(program))} {KP} {KI}")


@pytest.mark.skipif(shutil.which("octave-cli") is None, reason="this machine has no Octave")
def test_the_example_in_octave() -> None:
    same_as_in_python(f"octave-cli --quiet {shlex.quote(str(EXAMPLES / 'pi.m'))}")


READ = "import sys, struct; sys.stdin.buffer.read(72); "


@pytest.mark.parametrize(
    ("command", "message"),
    [
        ("no-such-program-anywhere", "cannot start 'no-such-program-anywhere': No such file or directory"),
        ("", "names no command"),
        ("echo 'open", 'cannot read "echo \'open": No closing quotation'),
        (python(READ + "sys.exit(3)"), "ended with exit code 3 at sample 0"),
        (python(READ + "import os; os.kill(os.getpid(), 9)"), "ended by signal 9 at sample 0"),
        (python(READ + "sys.stdout.buffer.write(bytes(4))"), "ended with exit code 0 at sample 0"),
        (python(READ + "print('the voltage is 5 V', flush=True); sys.stdin.read()"), "with more than one number"),
        (python("import sys; sys.exit(4)"), "ended with exit code 4 at sample 0"),
    ],
)
def test_an_error_of_the_process_is_said_in_one_line(command: str, message: str) -> None:
    with pytest.raises(InputError) as refused, Process(command, 30.0) as law:
        run(scenario(), law=law)
    assert message in refused.value.message and refused.value.field == "--controller-process"


def test_a_process_that_stalls_is_ended_with_its_children(tmp_path: Path) -> None:
    """It answers two samples and no more; a pipe that it and its child hold open is at its end once both are gone."""
    alive = tmp_path / "alive"
    os.mkfifo(alive)
    reader = os.open(alive, os.O_RDONLY | os.O_NONBLOCK)
    code = (
        "import signal, subprocess, sys\n"
        f"held, no_input = open({str(alive)!r}, 'w'), subprocess.DEVNULL\n"
        "subprocess.Popen(['tail', '-f', '/dev/null'], stdin=no_input, stdout=held)\n"
        "for _ in range(2): sys.stdin.buffer.read(72); sys.stdout.buffer.write(bytes(8)); sys.stdout.flush()\n"
        "signal.pause()\n"
    )
    with pytest.raises(InputError, match=r"no voltage for sample 2 within 0\.01 s"), Process(python(code), 60.0) as law:

        def soon_impatient(sample: Sample) -> float:
            law._timeout_s = 60.0 if sample.tick < 2 else 0.01
            return law(sample)

        run(scenario(), law=soon_impatient)
    os.set_blocking(reader, True)
    assert os.read(reader, 1) == b""
    os.close(reader)


def test_a_voltage_that_is_no_number_trips_the_board() -> None:
    answer = "sys.stdout.buffer.write(struct.pack('<d', float('nan'))); sys.stdout.flush()"
    code = f"import sys, struct\nwhile sys.stdin.buffer.read(72): {answer}"
    with Process(python(code), 30.0) as law:
        result = run(scenario(), law=law)
    assert result.trip is not None and result.trip.tick == 1 and result.trip.signal == "external.voltage"


@pytest.fixture
def combbench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.chdir(tmp_path)
    return lambda *arguments: CliRunner().invoke(app, ["run", *arguments])


def test_the_command_line(combbench: Any, tmp_path: Path) -> None:
    command = shlex.join([sys.executable, str(EXAMPLES / "pi.py"), str(KP), str(KI)])
    values = ["first-look", "--set", f"samples={SAMPLES}", "--set", "events=[]"]
    done = combbench(*values, "--controller-process", command, "--json")
    assert done.exit_code == 0, done.stderr
    assert json.loads(done.stdout)["digest"] == run(scenario(), law=Pi()).digest
    refused = combbench(*values, "--out", "kept", "--controller-process", python(READ + "sys.exit(3)"))
    assert refused.exit_code == 2 and not [*tmp_path.glob("kept/*")]
    assert refused.stderr == "combbench: --controller-process: ended with exit code 3 at sample 0\n"
    kept = combbench(*values, "--out", "kept", "--controller-process", command)
    assert kept.exit_code == 0, kept.stderr
    assert sorted(path.suffix for path in (tmp_path / "kept").iterdir()) == [".json", ".parquet"]
    both = combbench("first-look", "--seeds", "1:2", "--controller-process", command)
    assert both.exit_code == 2 and both.stderr == "combbench: --controller-process: drives one run; use --seed\n"


def test_bad_options_are_refused_in_one_line(combbench: Any) -> None:
    for options, message in (
        (["--controller-process", "true", "--controller-timeout", "0"], "--controller-timeout: must be more than 0 s"),
        (["--set", "controller.kind=external"], "controller.kind: external is computed outside of the bench"),
    ):
        refused = combbench("first-look", *options)
        assert refused.exit_code == 2 and refused.stderr.startswith(f"combbench: {message}")
        assert len(refused.stderr.splitlines()) == 1


@pytest.mark.parametrize("name", ["ch1-bode-tolerances", "twins"])
def test_a_scenario_of_more_than_one_board_is_refused(name: str) -> None:
    twins = with_values(get("first-look"), {"twins.other.controller": {"kind": "pid"}})
    chosen, field = (twins, "twins") if name == "twins" else (get(name), "study")
    with pytest.raises(InputError, match="asked by one board") as refused:
        run(chosen, law=Pi())
    assert refused.value.field == field
