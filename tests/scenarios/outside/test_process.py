"""A controller in a process of its own: the same bits as in Python, and one line for all that can go wrong."""

from __future__ import annotations

import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from core.board.outside import Sample
from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.outside.process import Process
from scenarios.run import run
from scenarios.schema import Scenario

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


READ = "import sys, time, struct; sys.stdin.buffer.read(72); "


@pytest.mark.parametrize(
    ("command", "message"),
    [
        ("no-such-program-anywhere", "cannot start 'no-such-program-anywhere': No such file or directory"),
        ("", "names no command"),
        ("echo 'open", 'cannot read "echo \'open": No closing quotation'),
        (python(READ + "sys.exit(3)"), "ended with exit code 3 at sample 0"),
        (python(READ + "import os; os.kill(os.getpid(), 9)"), "ended by signal 9 at sample 0"),
        (python(READ + "sys.stdout.buffer.write(bytes(4))"), "ended with exit code 0 at sample 0"),
        (python(READ + "print('the voltage is 5 V', flush=True); time.sleep(60)"), "with more than one number"),
        (python("import sys; sys.exit(4)"), "ended with exit code 4 at sample 0"),
    ],
)
def test_what_goes_wrong_is_said_in_one_line(command: str, message: str) -> None:
    with pytest.raises(InputError) as refused, Process(command, 30.0) as law:
        run(scenario(), law=law)
    assert message in refused.value.message and refused.value.field == "--controller-process"


def test_a_process_that_stalls_is_let_go_with_all_it_has_started(tmp_path: Path) -> None:
    """It answers two samples and then sleeps, with a child that sleeps too."""
    written = tmp_path / "pid"
    code = (
        "import subprocess, sys, time\n"
        f"child = subprocess.Popen(['sleep', '600']); open({str(written)!r}, 'w').write(str(child.pid))\n"
        "for _ in range(2): sys.stdin.buffer.read(72); sys.stdout.buffer.write(bytes(8)); sys.stdout.flush()\n"
        "time.sleep(600)\n"
    )
    began = time.monotonic()
    with pytest.raises(InputError, match=r"gave no voltage for sample 2 within 2 s"), Process(python(code), 2.0) as law:
        run(scenario(), law=law)
    assert time.monotonic() - began < 60.0
    child = int(written.read_text())
    for _ in range(1000):
        try:
            os.kill(child, 0)
        except ProcessLookupError:
            break
        if Path(f"/proc/{child}/stat").exists() and Path(f"/proc/{child}/stat").read_text().split()[2] == "Z":
            break
        time.sleep(0.01)
    else:
        os.kill(child, signal.SIGKILL)
        pytest.fail("the child of the controller lives on")


def test_a_voltage_that_is_no_number_trips_the_board() -> None:
    answer = "sys.stdout.buffer.write(struct.pack('<d', float('nan'))); sys.stdout.flush()"
    code = f"import sys, struct\nwhile sys.stdin.buffer.read(72): {answer}"
    with Process(python(code), 30.0) as law:
        result = run(scenario(), law=law)
    assert result.trip is not None and result.trip.tick == 1 and result.trip.signal == "external.voltage"


def combbench(*arguments: str, folder: Path) -> subprocess.CompletedProcess[str]:
    program = Path(sys.executable).parent / "combbench"
    return subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True, timeout=110)


def test_the_command_line(tmp_path: Path) -> None:
    command = shlex.join([sys.executable, str(EXAMPLES / "pi.py"), str(KP), str(KI)])
    values = ["--set", f"samples={SAMPLES}", "--set", "events=[]"]
    done = combbench("run", "first-look", *values, "--controller-process", command, "--json", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["digest"] == run(scenario(), law=Pi()).digest
    stopped = python(READ + "sys.exit(3)")
    options = ["--out", "kept", "--controller-process", stopped]
    refused = combbench("run", "first-look", *values, *options, folder=tmp_path)
    assert refused.returncode == 2 and not [*tmp_path.glob("kept/*")]
    assert refused.stderr == "combbench: --controller-process: ended with exit code 3 at sample 0\n"
    kept = combbench("run", "first-look", *values, "--out", "kept", "--controller-process", command, folder=tmp_path)
    assert kept.returncode == 0, kept.stderr
    assert sorted(path.suffix for path in (tmp_path / "kept").iterdir()) == [".json", ".parquet"]
    both = combbench("run", "first-look", "--seeds", "1:2", "--controller-process", command, folder=tmp_path)
    assert both.returncode == 2 and both.stderr == "combbench: --controller-process: drives one run; use --seed\n"


def test_bad_options_are_said_in_one_line(tmp_path: Path) -> None:
    for options, message in (
        (["--controller-process", "true", "--controller-timeout", "0"], "--controller-timeout: must be more than 0 s"),
        (["--set", "controller.kind=external"], "controller.kind: external is computed outside of the bench"),
    ):
        refused = combbench("run", "first-look", *options, folder=tmp_path)
        assert refused.returncode == 2 and refused.stderr.startswith(f"combbench: {message}")
        assert len(refused.stderr.splitlines()) == 1


@pytest.mark.parametrize("name", ["ch1-bode-tolerances", "twins"])
def test_what_no_single_controller_drives_is_refused(name: str) -> None:
    twins = with_values(get("first-look"), {"twins.other.controller": {"kind": "pid"}})
    chosen, field = (twins, "twins") if name == "twins" else (get(name), "study")
    with pytest.raises(InputError, match="asked by one board") as refused:
        run(chosen, law=Pi())
    assert refused.value.field == field
