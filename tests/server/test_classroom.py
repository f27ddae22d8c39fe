"""The address for students: found without a request, printed with its QR code."""

from __future__ import annotations

import io
import re
import socket
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import httpx
import psutil
import pytest
import segno
from typer.testing import CliRunner

from core.errors import InputError
from server.classroom import addresses as classroom
from server.classroom.addresses import join_addresses, network_addresses, notice, qr_text
from server.cli import logs, serve
from server.cli import main as cli
from server.cli.doctor import examine
from server.settings import Settings, load_settings
from tests.server.test_process import TOKEN, client, process

UP, DOWN = "up,broadcast,running,multicast", "up,broadcast,multicast"
TUNNEL = "up,pointopoint,running,noarp"


@pytest.fixture
def on(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """A machine with these links and their addresses, whose packets leave from some of them."""

    def machine(links: dict[str, tuple[str, list[str]]], leaving: tuple[str, ...] = ()) -> None:
        def entry(text: str) -> SimpleNamespace:
            return SimpleNamespace(family=socket.AF_INET6 if ":" in text else socket.AF_INET, address=text)

        other = SimpleNamespace(family=psutil.AF_LINK, address="02:fc:00:00:00:01")
        addresses = {name: [*map(entry, given), other] for name, (_, given) in links.items()}
        states = {name: SimpleNamespace(isup="running" in flags, flags=flags) for name, (flags, _) in links.items()}
        monkeypatch.setattr(psutil, "net_if_addrs", lambda: addresses)
        monkeypatch.setattr(psutil, "net_if_stats", lambda: states)
        family = {":" in text: text for text in leaving}
        monkeypatch.setattr(classroom, "_leaving_address", lambda of: family.get(of == socket.AF_INET6, ""))

    return machine


LAPTOP = {
    "lo": (UP, ["127.0.0.1", "::1"]),
    "docker0": (UP, ["172.17.0.1"]),
    "wlan0": (UP, ["192.168.1.5", "fd00::5", "fe80::5%wlan0"]),
    "eth0": (DOWN, ["10.0.0.5"]),
    "tun0": (TUNNEL, ["10.8.0.2"]),
    "usb0": (UP, ["169.254.3.4"]),
}
"""It has a network, an unplugged network, a tunnel, a network for containers, and a network without an address."""


@pytest.mark.parametrize("leaving", ["192.168.1.5", "172.17.0.1"])
def test_the_way_packets_leave_comes_first(on: Any, leaving: str) -> None:
    on(LAPTOP, (leaving, "fd00::5"))
    *near, least, tunnel = [str(address) for address in network_addresses()]
    assert near[0] == leaving and set(near) == {"192.168.1.5", "172.17.0.1"}
    assert (least, tunnel) == ("169.254.3.4", "10.8.0.2")


def test_a_tunnel_comes_last_although_packets_leave_by_it(on: Any) -> None:
    on(LAPTOP, ("10.8.0.2",))
    assert str(network_addresses()[-1]) == "10.8.0.2"


def test_ipv6_is_told_only_where_there_is_no_ipv4_and_it_is_listened_to(on: Any) -> None:
    on(LAPTOP)
    assert not any("[" in address for address in join_addresses("::", 8000))
    on({"lo": LAPTOP["lo"], "wlan0": (UP, ["fe80::5%wlan0", "fd00::5", "2001:db8::5"])}, ("2001:db8::5",))
    assert join_addresses("::", 8000) == ["http://[2001:db8::5]:8000/join", "http://[fd00::5]:8000/join"]
    assert join_addresses("0.0.0.0", 8000) == []


def test_one_address_that_was_asked_for_is_the_one(on: Any) -> None:
    on(LAPTOP)
    assert join_addresses("10.1.2.3", 8080) == ["http://10.1.2.3:8080/join"]
    assert join_addresses("fd00::9", 8080) == ["http://[fd00::9]:8080/join"]


def test_a_machine_on_no_network_says_so(on: Any) -> None:
    on({"lo": LAPTOP["lo"], "eth0": LAPTOP["eth0"]})
    said = notice(Settings(classroom=True), 8000)
    assert "connect it to a network" in said and "/join" not in said


def test_this_machine_is_found_and_answers_at_what_was_found() -> None:
    for address in network_addresses():
        family = socket.AF_INET if address.version == 4 else socket.AF_INET6
        with socket.socket(family) as listener:
            listener.bind((str(address), 0))


def test_no_way_out_is_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    before = network_addresses()

    def refuse(*_: Any) -> None:
        raise OSError(101, "Network is unreachable")

    monkeypatch.setattr(socket, "socket", refuse)
    assert set(network_addresses()) == set(before)


def modules(drawn: str) -> list[list[int]]:
    """Read the output of a terminal: of each character the upper and the lower half, 1 where it is dark."""
    halves = {"\u2588": (0, 0), "\u2580": (0, 1), "\u2584": (1, 0), " ": (1, 1)}
    rows: list[list[int]] = []
    for line in drawn.splitlines():
        shown = re.fullmatch(r"\033\[38;5;231;48;5;16m(.*)\033\[0m", line)  # white blocks on black, in any theme
        assert shown is not None
        rows += [list(row) for row in zip(*(halves[sign] for sign in shown[1]), strict=True)]
    return rows


@pytest.mark.parametrize("address", ["http://192.168.1.5:8000/join", "http://[2001:db8::1234:5678]:18000/join"])
def test_the_qr_code_holds_exactly_the_address(address: str) -> None:
    rows = modules(qr_text(address))
    code = segno.make_qr(address, error="m")
    whole = [list(map(int, row)) for row in code.matrix_iter(border=4)]
    assert rows[: len(whole)] == whole and all(set(row) <= {1} for row in rows[len(whole) :])
    assert whole != [list(map(int, row)) for row in segno.make_qr(address + "s", error="m").matrix_iter(border=4)]


@pytest.mark.parametrize(
    ("is_terminal", "encoding", "drawn"), [(True, "utf-8", 1), (False, "utf-8", 0), (True, "latin-1", 0)]
)
def test_the_notice_says_what_is_exposed_and_where_to_join(
    on: Any, monkeypatch: pytest.MonkeyPatch, is_terminal: bool, encoding: str, drawn: bool
) -> None:
    on(LAPTOP, ("192.168.1.5",))
    stream = io.TextIOWrapper(io.BytesIO(), encoding)
    monkeypatch.setattr(stream, "isatty", lambda: is_terminal)
    monkeypatch.setattr(sys, "stdout", stream)
    said = notice(Settings(classroom=True), 8000)
    for words in ("this machine alone", "unencrypted", "Everyone on this network", "Names and answers", "-proxy.md"):
        assert words in said
    assert re.findall(r"http://\S+", said)[0] == "http://192.168.1.5:8000/join"
    assert ("\u2588" in said) == drawn and (not drawn or qr_text("http://192.168.1.5:8000/join") in said)
    stream.write(said)


PUBLIC = "https://lab.example"
BEFORE_A_PROXY = "classroom: cannot be used with public_origin"
NOBODY_COMES = "classroom: students cannot reach"
NEEDS_TOKEN = "needs an access token"
SHORT = "must have at least 16 characters"
STARTS = "it starts"


@pytest.mark.parametrize("token", [None, "short", TOKEN])
@pytest.mark.parametrize(
    ("host", "public", "in_class", "alone"),
    [  # with --classroom; without it and without a token
        (None, "", STARTS, STARTS),
        ("0.0.0.0", "", STARTS, NEEDS_TOKEN),
        ("::", "", STARTS, NEEDS_TOKEN),
        ("192.168.1.5", "", STARTS, NEEDS_TOKEN),
        ("127.0.0.1", "", NOBODY_COMES, STARTS),
        ("::1", "", NOBODY_COMES, STARTS),
        ("localhost", "", NOBODY_COMES, STARTS),
        (None, PUBLIC, BEFORE_A_PROXY, STARTS),
        ("0.0.0.0", PUBLIC, BEFORE_A_PROXY, NEEDS_TOKEN),
        ("192.168.1.5", PUBLIC, BEFORE_A_PROXY, NEEDS_TOKEN),
        ("127.0.0.1", PUBLIC, BEFORE_A_PROXY, STARTS),
    ],
)
def test_what_starts(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, host: Any, public: str, in_class: str, alone: str, token: Any
) -> None:
    def listen(settings: Settings) -> Any:
        assert settings.host == host or host is None
        raise InputError(STARTS)

    monkeypatch.setattr(serve, "bind", listen)
    monkeypatch.setattr(logs, "configure", lambda _: None)
    monkeypatch.chdir(tmp_path)
    given = [] if host is None else ["--host", host]
    environment = {"COMBBENCH_PUBLIC_ORIGIN": public, "COMBBENCH_TOKEN": token}
    for option, expected in (["--classroom"], in_class), ([], STARTS if alone == NEEDS_TOKEN and token else alone):
        done = CliRunner().invoke(cli.app, ["serve", *given, *option], env=environment)
        assert done.exit_code == 2 and len(done.stderr.splitlines()) == 1
        assert (SHORT if token == "short" else expected) in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_class_is_served_to_the_network_unless_an_address_is_given(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("COMBBENCH_HOST", raising=False)
    assert load_settings().host == "127.0.0.1" and load_settings(classroom=True).host == "0.0.0.0"
    assert load_settings(classroom=True, host="::").host == "::"
    monkeypatch.setenv("COMBBENCH_HOST", "10.1.2.3")
    assert load_settings(classroom=True).host == "10.1.2.3"
    monkeypatch.delenv("COMBBENCH_HOST")
    monkeypatch.setenv("COMBBENCH_CLASSROOM", "true")
    state, settings = examine()["state"], examine()["settings"]
    assert settings["host"] == "0.0.0.0  (classroom)" and settings["classroom"].startswith("True")
    assert state["students open"] == (
        ", ".join(join_addresses("0.0.0.0", 8000)) or "nothing: this machine is on no network"
    )


def pester(host: str, port: int, secrets: dict[str, str]) -> None:
    """Send the secrets in every way a student or a program may, well and ill."""
    code, token = secrets["code"], secrets["token"]
    with httpx.Client(base_url=f"http://{host}:{port}", trust_env=False, timeout=20) as student:
        for path in (f"/?token={token}", f"/join?code={code}&token={token}", f"/join/{code}", f"/benches/{code}/3d/"):
            assert student.get(path, headers={"Accept": "text/html"}).status_code in (200, 303, 401, 404)
        for secret in (token, code):
            headers = {"Origin": f"http://{host}:{port}", "Authorization": f"Bearer {secret}", "Cookie": f"a={secret}"}
            answer = student.post("/api/v1/classes/x/join", json=secrets, headers=headers)
            assert answer.status_code < 500
    for request in (
        f"GET /join/{code}?token={token} HTTP/1.1\r\nHost: {host}:{port}",
        f"GET /\x00{code} {token} HTTP/9",
    ):
        with socket.create_connection((host, port)) as hung_up:
            hung_up.sendall(f"{request}\r\n\r\n".encode())


def test_a_class_on_one_address_leaves_the_teacher_theirs_and_logs_no_secret(tmp_path: Path) -> None:
    """The token is accepted from loopback alone, so the service listens there too, on the same port.

    Neither token nor code is in the log, at the most detailed level, for any sender.
    """
    found = [str(address) for address in network_addresses() if address.version == 4]
    if not found:
        pytest.skip("this machine has no address but loopback")
    secrets = {"token": TOKEN, "code": "canary-code", "name": "canary-name"}
    with process(tmp_path, "--classroom", "--host", found[0]) as running, client(running.address) as teacher:
        assert running.address.startswith("CombBench is at http://127.0.0.1:")
        port = teacher.base_url.port
        assert teacher.get("/api/v1/benches").status_code == 200
        with httpx.Client(base_url=f"http://{found[0]}:{port}", trust_env=False, timeout=20) as student:
            assert student.get("/health/live").status_code == 200
            assert student.get("/api/v1/benches").status_code == 401
        for host in ("127.0.0.1", found[0]):
            pester(host, port, secrets)
        running.terminate()
        said = running.stdout.read()
        assert running.wait(30) == 0
    assert f"Students open  http://{found[0]}:{port}/join\n" in said and said.count("/join") == 1
    log = (tmp_path / "stderr").read_text()
    assert not [secret for secret in secrets.values() if secret in log or secret in said]
