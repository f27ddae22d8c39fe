"""Two processes at one address, as docs/scaling.md sets them up: each has its own classes, both have the same runs."""

from __future__ import annotations

import contextlib
import re
import socket
import ssl
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import psycopg
import pytest
from websockets.sync.client import connect

from server.classroom.code import CLASS_LETTERS, CODE_LETTERS
from server.stream.wire import SUBPROTOCOL
from tests.server.forks import TOKEN, Served, forks
from tests.server.nginx import NAME, nginx, sharded_site
from tests.server.security.test_proxy import Here
from tests.server.store.postgres import ROOT, free_port, new_database, postgres

pytestmark = [pytest.mark.long, pytest.mark.timeout(600)]
RUN = {"scenario": "ch5-seven-step", "set": {"samples": 1500}, "seed": 5}
VOTE = {"text": "Which?", "answers": ["this", "that"]}
SHEET = (ROOT / "scenarios" / "sheets" / "first-look.md").read_text()
VIEW = "viser-v1.1.1"
LOCKS = "SELECT count(*) FROM pg_locks WHERE locktype = 'advisory'"


class Lab:
    """Two processes behind nginx, and a browser's way to both."""

    def __init__(
        self, origin: str, port: int, folder: Path, start: Callable[[str], Served], stack: contextlib.ExitStack
    ) -> None:
        self.origin, self.port, self.start, self._stack = origin, port, start, stack
        self.context = ssl.create_default_context(cafile=str(folder / f"{NAME}.pem"))
        self.processes = {letter: start(letter) for letter in "ab"}
        self.teachers = {letter: self.teacher(letter) for letter in "ab"}
        self.groups = {
            letter: one.post("/api/v1/classes", json={"name": letter}).json() for letter, one in self.teachers.items()
        }
        self.students = {letter: self.student(group["code"], "Ada") for letter, group in self.groups.items()}
        self.benches = {letter: bench_of(one) for letter, one in self.students.items()}

    def direct(self, letter: str) -> httpx.Client:
        """Return a script's way to a process."""
        return self.processes[letter].http

    def browser(self) -> httpx.Client:
        transport = Here(self.port, verify=self.context, trust_env=False)
        base = {"base_url": self.origin, "headers": {"Origin": self.origin}, "timeout": 60}
        return self._stack.enter_context(httpx.Client(transport=transport, **base))  # type: ignore[arg-type]

    def teacher(self, letter: str) -> httpx.Client:
        """A teacher who opened the address that a process printed."""
        client = self.browser()
        led = client.get("/", params={"shard": letter, "token": TOKEN})
        assert (led.status_code, led.headers["location"]) == (303, "/")
        assert "Secure" in led.headers["set-cookie"] and client.cookies["combbench_shard"] == letter
        return client

    def student(self, code: str, name: str) -> httpx.Client:
        """A student who typed a code on the page to join without one, which belongs to the first process."""
        client, typed = self.browser(), {"code": code, "name": name}
        form = form_of(client.get("/join"))
        assert form == "/join?shard=a"
        joined = client.post(form, data=typed)
        if not code.startswith("A"):
            assert joined.status_code == 307
            joined = client.post(joined.headers["location"], data=typed)
        assert (joined.status_code, joined.headers["location"]) == (303, "/")
        return client

    def socket(self, client: httpx.Client, path: str, protocol: str = SUBPROTOCOL) -> Any:
        return connect(
            f"wss://{NAME}:{self.port}{path}",
            sock=socket.create_connection(("127.0.0.1", self.port)),
            ssl=self.context,
            origin=self.origin,  # type: ignore[arg-type]
            additional_headers={"Cookie": "; ".join(f"{name}={value}" for name, value in client.cookies.items())},
            subprotocols=[protocol],  # type: ignore[list-item]
            proxy=None,
            max_size=None,
        )


@pytest.fixture(scope="module")
def database() -> Iterator[str]:
    with postgres() as server:
        yield new_database(server, "shared")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("shards")


@pytest.fixture(scope="module")
def lab(folder: Path, database: str) -> Iterator[Lab]:
    free = socket.create_server(("127.0.0.1", 0))  # kept until nginx takes its port
    port = free.getsockname()[1]
    origin, ports = f"https://{NAME}:{port}", {letter: free_port() for letter in "ab"}
    with contextlib.ExitStack() as stack:
        loaded = stack.enter_context(forks(folder / "log"))

        def start(letter: str) -> Served:
            given = {"shard": letter, "port": ports[letter], "public_origin": origin, "database_url": database}
            served = stack.enter_context(loaded.serve(folder / letter, figures=False, **given))
            assert served.address == origin
            served.http.base_url = httpx.URL(f"http://127.0.0.1:{ports[letter]}")  # scripts need no proxy
            return served

        free.close()
        at = stack.enter_context(nginx(port, ports, sharded_site))
        yield Lab(origin, port, at, start, stack)


def until(holds: Callable[[], Any]) -> Any:
    """Wait for something, however slow the machine is."""
    end = time.monotonic() + 120
    while not (found := holds()):
        assert time.monotonic() < end
        time.sleep(0.05)
    return found


def form_of(page: httpx.Response) -> str:
    """Return where the form of a page goes."""
    return re.findall(r'action="([^"]+)"', page.text)[0]


def frames(stream: Any, count: int) -> None:
    """Take so many messages of a stream."""
    for _ in range(count):
        assert stream.recv(timeout=60)


def bench_of(client: httpx.Client) -> str:
    return str(client.get("/api/v1/me").json()["bench"])


def ended(client: httpx.Client, run_id: str) -> dict[str, Any]:
    return dict(until(lambda: (run := client.get(f"/api/v1/runs/{run_id}").json())["finished"] and run))


def test_each_has_classes_of_its_own(lab: Lab) -> None:
    for letter, group in lab.groups.items():
        code = group["code"].replace(" ", "").lower()
        assert code.startswith(letter) and len(code) == CLASS_LETTERS + CODE_LETTERS
        assert group["addresses"] == [f"{lab.origin}/join?code={code}"]
        assert form_of(lab.browser().get(f"/join?code={code}")) == f"/join?shard={letter}"  # by the QR code
        assert [one["id"] for one in lab.teachers[letter].get("/api/v1/classes").json()["classes"]] == [group["id"]]
        (member,) = lab.teachers[letter].get(f"/api/v1/classes/{group['id']}/members").json()["members"]
        assert member["bench"] == lab.benches[letter] and member["bench"].startswith(letter)
    for letter, other in ("ab", "ba"):
        client, there = lab.students[letter], lab.benches[other]
        assert client.get(f"/api/v1/benches/{there}").status_code == 401  # a session that is unknown there
        assert lab.direct(letter).get(f"/api/v1/benches/{there}").status_code == 404
        assert lab.direct(letter).get(f"/api/v1/classes/{lab.groups[other]['id']}").status_code == 404
    wrong = lab.browser().post("/join", data={"code": "zzzzzzzzzz", "name": "Eve"}, follow_redirects=True)
    assert wrong.status_code == 403 and wrong.url.params["shard"] == "z"


def test_what_a_path_names_is_found_whatever_the_cookie_says(lab: Lab) -> None:
    for letter, client in lab.students.items():
        bench = lab.benches[letter]
        with lab.socket(client, f"/api/v1/benches/{bench}/stream") as stream:
            frames(stream, 2)
        assert client.get(f"/benches/{bench}/3d/").status_code == 200
        with lab.socket(client, f"/benches/{bench}/3d", VIEW) as scene:
            frames(scene, 3)
    teacher, bench = lab.teachers["a"], lab.benches["b"]
    assert teacher.get(f"/api/v1/classes/{lab.groups['b']['id']}").json()["students"] == 1
    guest, link = lab.browser(), teacher.post(f"/api/v1/benches/{bench}/watchers", json={}).json()["path"]
    assert guest.get(link).status_code == 303 and bench_of(guest) == bench
    kept = teacher.post(f"/api/v1/benches/{bench}/recordings", json={"past_ticks": 5, "ticks": 0})
    assert teacher.get(f"/api/v1/recordings/{kept.json()['id']}").json()["bench_id"] == bench
    asked = lab.teachers["b"].post("/api/v1/votes", json=VOTE | {"class_id": lab.groups["b"]["id"]})
    assert teacher.get(f"/api/v1/votes/{asked.json()['id']}").json()["state"] == "open"


def test_a_browser_stays_where_it_came_in(lab: Lab) -> None:
    teacher = lab.teacher("a")
    assert teacher.post("/api/v1/benches", json={"scenario": "first-look"}).json()["id"].startswith("a")
    led = teacher.get("/?shard=b&layout=lab")
    assert (led.status_code, led.headers["location"]) == (303, "/?layout=lab")
    assert teacher.post("/api/v1/benches", json={"scenario": "first-look"}).json()["id"].startswith("b")


def test_a_run_is_carried_out_where_it_is_asked_for_and_once(lab: Lab, folder: Path) -> None:
    asked = [lab.teachers[letter].post("/api/v1/runs", json=RUN) for letter in "ab"]
    run_id = asked[0].json()["id"]
    assert [answer.status_code for answer in asked] == [202, 200] and asked[1].json()["id"] == run_id
    seen = [ended(lab.teachers[letter], run_id) for letter in "ba"]
    assert seen[0]["state"] == "done" and seen[0] == seen[1]
    assert [(folder / letter / "runs" / run_id).exists() for letter in "ab"] == [True, False]
    counted = re.compile(r'^combbench_runs_total\{.*?state="done"\} (\S+)', re.M)
    assert [counted.findall(lab.direct(letter).get("/metrics").text) for letter in "ab"] == [["1.0"], []]
    teacher, trace = lab.teachers["b"], f"/api/v1/runs/{run_id}/trace"
    sent = teacher.get(trace)
    assert sent.status_code == 307 and sent.headers["location"] == f"{trace}?shard=a"
    assert teacher.get(sent.headers["location"]).content == lab.teachers["a"].get(trace).content != b""
    assert lab.direct("b").get(f"{trace}?shard=a").json()["error"]["code"] == "elsewhere"
    assert lab.direct("b").post("/api/v1/runs/remove", json={}).json() == {"removed": 0}
    gone = teacher.post("/api/v1/runs/remove", json={"ids": [run_id]}, follow_redirects=True)
    assert gone.json() == {"removed": 1} and not (folder / "a" / "runs" / run_id).exists()


def test_links_sheets_and_parameter_sets_are_those_of_both(lab: Lab) -> None:
    first, second = lab.teachers["a"], lab.teachers["b"]
    link = first.post("/api/v1/links", json={"title": "mine", "layout": {"panels": []}}).json()
    assert second.get(f"/api/v1/links/{link['id']}").json()["title"] == "mine"
    opened = first.post("/api/v1/sheets", json={"text": SHEET}).json()["id"]
    assert opened in [sheet["id"] for sheet in second.get("/api/v1/sheets").json()["sheets"]]
    assert second.delete(f"/api/v1/sheets/{opened}").status_code == 204
    assert opened not in [sheet["id"] for sheet in first.get("/api/v1/sheets").json()["sheets"]]


def test_one_that_is_killed_takes_nothing_of_the_other_along(lab: Lab, folder: Path, database: str) -> None:
    students, benches = lab.students, lab.benches
    with lab.socket(students["a"], f"/api/v1/benches/{benches['a']}/stream") as undisturbed:
        frames(undisturbed, 1)
        until((folder / "b" / "benches" / f"{benches['b']}.npz").is_file)
        lab.processes["b"].kill()
        assert students["b"].get("/api/v1/me").status_code == 502
        with psycopg.connect(database) as connection:  # until the locks of b are free: a holds two
            until(lambda: connection.execute(LOCKS).fetchall() == [(2,)])
        assert bench_of(students["a"]) == benches["a"]
        lab.processes["b"] = lab.start("b")
        assert bench_of(students["b"]) == benches["b"]
        assert students["b"].get(f"/api/v1/benches/{benches['b']}").json()["tick"] > 0
        with lab.socket(students["b"], f"/api/v1/benches/{benches['b']}/stream") as stream:
            frames(stream, 2)
        # a class that ends leaves the class of the other unchanged
        assert lab.teachers["a"].delete(f"/api/v1/classes/{lab.groups['b']['id']}").status_code == 204
        assert students["b"].get("/api/v1/me").status_code == 401
        assert bench_of(students["a"]) == benches["a"]
        frames(undisturbed, 3)


def test_a_class_goes_on_while_the_shared_database_is_away(lab: Lab, database: str) -> None:
    server, _, name = database.rpartition("/")

    def allow(allowed: bool) -> None:
        with psycopg.connect(f"{server}/postgres", autocommit=True) as connection:
            connection.execute(f'ALTER DATABASE "{name}" ALLOW_CONNECTIONS {allowed}')
            connection.execute("SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = %s", [name])

    allow(False)
    try:
        refused = lab.teachers["a"].get("/api/v1/runs")
        assert (refused.status_code, refused.json()["error"]["code"]) == (503, "storage")
        late = lab.student(lab.groups["a"]["code"], "Bea")
        assert late.get(f"/api/v1/benches/{bench_of(late)}").json()["state"] == "running"
        with lab.socket(late, f"/api/v1/benches/{bench_of(late)}/stream") as stream:
            frames(stream, 2)
        assert late.get("/api/v1/sheets").status_code == 200
    finally:
        allow(True)
    assert lab.teachers["a"].get("/api/v1/runs").status_code == 200
