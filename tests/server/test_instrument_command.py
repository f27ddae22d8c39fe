"""`combbench instrument`: shots of a simulated oscilloscope come to the bench, and a generator gets its table."""

from __future__ import annotations

import json
import socket
import struct
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from core.measured_record import find_on
from scenarios import extras
from scenarios.library import get
from scenarios.record_folders import FOLDER
from scenarios.records.shelf import RecordFolder
from scenarios.run import build
from server.cli.main import app
from tests.server.conftest import HANGS_S, Live, serving

DRIVE, MOTION = bytes([40, 60, 100, 60]), bytes([45, 50, 55, 65])
"""Shots in units of the converter: letters and signs, because the simulator reads them from a text."""
SIMULATED = """
spec: "1.1"
devices:
  scope:
    eom: {{ TCPIP INSTR: {{ q: "\\n", r: "\\n" }} }}
    error: ERROR
    dialogues:
      - {{ q: "ACQ:START" }}
      - {{ q: "RESET" }}
      - {{ q: "ACQ:READY?", r: "1" }}
      - {{ q: "CH1?", r: "#14{drive}" }}
      - {{ q: "CH2?", r: "#14{motion}" }}
resources:
  TCPIP::scope::INSTR: {{ device: scope }}
"""
COMMANDS = """
[scope]
rate_khz = 50.0
setup = ["RESET"]
shot = ["ACQ:START"]
ready = { query = "ACQ:READY?", answer = "1" }
drive = "CH1?"
displacement = "CH2?"
type = "b"
volts_per_unit = 0.5
um_per_unit = 0.01

[generator]
setup = ["FREQ {frequency_hz}", "VOLT {amplitude_v}"]
table = "DATA {count},{values}"
start = ["OUTPUT ON"]
"""


@pytest.fixture
def files(tmp_path: Path) -> Path:
    text = SIMULATED.format(drive=DRIVE.decode(), motion=MOTION.decode())
    (tmp_path / "scope.yaml").write_text(text)
    (tmp_path / "commands.toml").write_text(COMMANDS)
    return tmp_path


@pytest.fixture
def live(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Live]:
    monkeypatch.setenv(FOLDER, str(tmp_path / "records"))
    with serving(tmp_path, instrument_port=0) as found:
        yield found
    find_on(RecordFolder())


def call(files: Path, *args: object, address: str = "TCPIP::scope::INSTR") -> Any:
    usual = [address, files / "commands.toml", "--visa", f"{files / 'scope.yaml'}@sim"]
    return CliRunner().invoke(app, ["instrument", *map(str, (*usual, *args))], catch_exceptions=False)


def test_shots_come_to_the_bench_and_a_gap_between_two_is_a_break(files: Path, live: Live) -> None:
    listens = live.http.get("/api/v1/instruments").json()["listens"]
    first = call(files, "--to", listens, "--shots", 1)
    assert first.exit_code == 0 and first.output.endswith("1 shots sent\n"), first.output
    live.wait(lambda: not live.http.get("/api/v1/instruments").json()["instruments"][0]["is_connected"])
    bench = live.http.post("/api/v1/instruments/scope/benches", json={"scenario": "ch5-seven-step"}).json()
    assert call(files, "--to", listens, "--shots", 2).exit_code == 0
    live.until(bench["id"], lambda one: one["tick"] >= 9)
    status = live.get(bench["id"])["instrument"]
    assert (status["blocks"], status["samples"], status["breaks"], status["lost_samples"]) == (2, 9, 1, 1)
    record = RecordFolder().get(status["record"])
    assert record is not None
    drive, displacement, _ = record.stretch(0, 9)
    shot = np.frombuffer(DRIVE, np.int8) * 0.5
    assert np.array_equal(drive, [*shot, shot[-1], *shot])
    assert np.allclose(displacement[[0, 3, 5, 8]], [0.45, 0.65, 0.45, 0.65]) and np.isnan(displacement[4])


class Listener:
    """An instrument on a socket: it keeps the lines that it gets, and answers a query for binary samples."""

    def __init__(self, answers: dict[str, bytes]) -> None:
        self._socket = socket.create_server(("127.0.0.1", 0))
        self.address = f"TCPIP::127.0.0.1::{self._socket.getsockname()[1]}::SOCKET"
        self.lines: list[str] = []
        self._answers = answers
        self.thread = threading.Thread(target=self._run)
        self.thread.start()

    def _run(self) -> None:
        connection, _ = self._socket.accept()
        with connection, connection.makefile("rb") as lines:
            for line in lines:
                self.lines.append(line.decode().strip())
                if (answer := self._answers.get(self.lines[-1])) is not None:
                    connection.sendall(answer)
        self._socket.close()


def test_a_generator_gets_the_reference_of_a_scenario(files: Path, live: Live) -> None:
    generator = Listener({})
    values = struct.pack(">4f", 1.0, -2.0, 3.0, 300.5)  # any byte, in the usual order of instruments
    scope = Listener(dict.fromkeys(("CH1?", "CH2?"), b"#216" + values + b"\n") | {"ACQ:READY?": b"1\n"})
    text = COMMANDS.replace('type = "b"\n', "")
    (files / "commands.toml").write_text(text)
    listens = live.http.get("/api/v1/instruments").json()["listens"]
    found = call(
        files,
        *("--to", listens, "--shots", 1, "--visa", "@py", "--generator", generator.address, "--samples", 100),
        *("--excitation", "ch5-seven-step"),
        address=scope.address,
    )
    assert found.exit_code == 0, found.output
    for one in (generator, scope):
        one.thread.join(HANGS_S)
    board = build(get("ch5-seven-step"))
    volts = board.advance(100).outputs[:, board.signals.index("reference.voltage")]
    frequency, amplitude, table, on = generator.lines
    assert (frequency, on) == ("FREQ 500", "OUTPUT ON")
    peak = float(amplitude.removeprefix("VOLT "))
    count, *sent = map(float, table.removeprefix("DATA ").split(","))
    assert peak == pytest.approx(np.abs(volts).max()) and count == 100
    assert np.allclose(peak * np.array(sent), volts, atol=1e-5 * peak)
    assert live.http.get("/api/v1/instruments").json()["instruments"][0]["blocks"] == 1


@pytest.mark.parametrize(
    ("change", "args", "complaint"),
    [
        (lambda text: text, ["--to", "127.0.0.1:1"], "--to: cannot connect to 127.0.0.1:1"),
        (lambda text: text, ["--to", "elsewhere"], "--to: must be HOST:PORT"),
        (lambda text: text.replace("rate_khz = 50.0", ""), [], "scope.rate_khz: is required"),
        (lambda text: text.replace("shot =", "shots ="), [], "scope.shot: is required"),
        (lambda text: text.partition("[generator]")[0], ["--generator", "X"], "FILE: has no table [generator]"),
        (lambda text: text, ["--source", "a b"], "header.source"),
    ],
)
def test_a_mistake_is_one_line(change: Callable[[str], str], args: list[str], complaint: str, files: Path) -> None:
    path = files / "commands.toml"
    path.write_text(change(path.read_text()))
    found = call(files, "--shots", 1, *args)
    assert found.exit_code == 2 and complaint in found.stderr and found.stderr.count("\n") == 1, found.stderr


def test_an_instrument_that_is_not_there_is_one_line(files: Path) -> None:
    address = "TCPIP::127.0.0.1::1::SOCKET"
    found = call(files, "--visa", "@py", address=address)
    assert found.exit_code == 2 and found.stderr.startswith(f"combbench: ADDRESS: {address}"), found.stderr
    assert found.stderr.count("\n") == 1


def test_without_the_extra_the_command_says_how_to_get_it(files: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(extras, "find_spec", lambda name: None)
    found = call(files)
    line = "combbench: instrument: needs the package pyvisa, which is not installed (pip install '.[instruments]'"
    assert found.exit_code == 2 and found.stderr.startswith(line), found.stderr


def test_the_answer_of_the_server_is_the_line_of_the_refusal(files: Path, live: Live) -> None:
    listens = live.http.get("/api/v1/instruments").json()["listens"]
    host, _, port = listens.rpartition(":")
    with socket.create_connection((host, int(port)), timeout=HANGS_S) as other:
        other.sendall(json.dumps({"version": 1, "source": "scope", "rate_khz": 50.0}).encode() + b"\n")
        assert other.recv(100) == b'{"ok": true}\n'
        found = call(files, "--to", listens, "--shots", 1)
    assert found.exit_code == 2 and "scope sends already" in found.stderr, found.stderr
