"""What is refused has not happened: each database call of each door fails once, and all is as before.

All is what the server has in memory, and what is on its disk.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy.exc import OperationalError

from scenarios.campaign.executor import Processes
from server.people.access import API, BENCH, CLASS, DOORS, SOCKET
from server.runs.queue import Queue
from server.store.base import Base
from server.store.database import Database
from tests.server.conftest import Live
from tests.server.people.group import Somebody, join, open_class, the_teacher

SHEET = (Path(__file__).parents[2] / "scenarios" / "sheets" / "blind-diagnosis.md").read_text()
CASE = (
    SHEET.split("## Which stiffness")[0] + '## First case\n\n```step\nid = "first"\nkind = "blind"\npoints = 4.0\n```\n'
)
ASKED = (
    CASE.split("## First case")[0]
    + '## Ask\n\n```step\nid = "ask"\nkind = "question"\npoints = 3.0\nquestion = "What?"\n'
    + 'hints = [{ text = "Look.", costs = 0.5 }]\n[number]\nvalue = "tone_hz"\nunit = "Hz"\n```\n'
)
GAME = f"{API}/games/fool-the-bank"
RUN = {"scenario": "first-look", "set": {"samples": 100}}
SWEEP = {"sweep": {"schema": 1, "id": "two", "scenario": "first-look", "set": {"samples": 100}, "seeds": "1:3"}}


@dataclass
class World:
    """A server with what a case needs; what a case makes goes with it."""

    live: Live
    groups: list[dict[str, Any]] = field(default_factory=list)

    @property
    def teacher(self) -> Somebody:
        return the_teacher(self.live)

    def ask(self, method: str, path: str, who: Somebody | None = None, **body: Any) -> Any:
        answer = (who or self.teacher).ask(method, path, **({"json": body} if body or method != "GET" else {}))
        assert answer.is_success, (method, path, answer.text)
        return answer.json() if answer.content else None

    def group(self) -> dict[str, Any]:
        self.groups.append(open_class(self.live, bench={"scenario": "first-look", "paused": True}))
        return self.groups[-1]

    def student(self, group: dict[str, Any] | None = None) -> Somebody:
        return join(self.live, group or self.group(), f"Ada {len(self.live.service.people.students())}")

    def bench(self) -> str:
        return str(self.live.bench("first-look", paused=True)["id"])

    def blind(self, who: Somebody) -> str:
        self.ask("POST", f"{API}/benches/{who.bench}/blind", who, seed=1)
        return who.bench

    def at_sheet(self, who: Somebody, text: str) -> str:
        sheet = self.ask("POST", f"{API}/sheets", text=text)["id"]
        who.bench = self.ask("POST", f"{API}/sheets/{sheet}/begin", who)["bench"]
        self.ask("POST", f"{API}/benches/{who.bench}/commands", who, kind="pause")
        return str(sheet)

    def recording(self, bench: str, ended: bool = True) -> str:
        made = self.ask("POST", f"{API}/benches/{bench}/recordings", name="one")["id"]
        if ended:
            self.ask("POST", f"{API}/benches/{bench}/recordings/{made}/stop")
        return str(made)

    def vote(self, **body: Any) -> str:
        for one in self.ask("GET", f"{API}/votes")["votes"]:
            self.ask("DELETE", f"{API}/votes/{one['id']}")
        return str(self.ask("POST", f"{API}/votes", text="Which?", answers=["a", "b"], **body)["id"])

    def end(self) -> None:
        for group in self.groups:
            self.live.http.delete(f"{API}/classes/{group['id']}")
        for noun, key in (("votes", "votes"), ("links", "links"), ("recordings", "recordings")):
            for one in self.live.http.get(f"{API}/{noun}").json()[key]:
                self.live.http.delete(f"{API}/{noun}/{one['id']}")
        for one in self.live.http.get(f"{API}/parameter-sets").json()["sets"]:
            self.live.http.delete(f"{API}/parameter-sets/{one['id']}")
        for one in self.live.http.get(f"{API}/sheets").json()["sheets"]:
            if one["own"]:
                self.live.http.delete(f"{API}/sheets/{one['id']}")
        for noun, key in (("runs", "runs"), ("sweeps", "sweeps")):
            for one in self.live.http.get(f"{API}/{noun}").json()[key]:
                self.live.http.delete(f"{API}/{noun}/{one['id']}")
            self.live.http.post(f"{API}/{noun}/remove", json={})

    def state(self) -> dict[str, Any]:
        """Return all that the server knows, and all that is on its disk."""
        service = self.live.service

        async def memory() -> dict[str, Any]:
            people, benches, works = service.people, service.benches.all(), service.sheets._works._all
            return {
                "people": {one.id: one.name for one in people._by_hash.values()},
                "theirs": [dict(people._benches), dict(people._earlier), dict(people._lent), set(people.hands)],
                "shown": {key: bench for key, bench in people._shown.items() if bench},
                "hidden": {key: one.model_dump() for key, one in service.blinds._answers.items()},
                "works": {key: (one.bench_id, one.progress.model_dump()) for key, one in works.items()},
                "sheets": sorted(service.sheets.shelf._own),
                "layouts": {key: one.model_dump() for key, one in service.lesson._layouts.items()},
                "codes": dict(service.classes._codes),
                "said": [(one["actor"], one["kind"], one["text"]) for one in service.audit._waiting],
                "leases": sorted(service.driving._leases),
                "benches": {
                    one.id: (
                        one.board.tick, one.events.last, one.name, one.keep, one.hiding.blind,
                        sorted(one.recordings.under_way), len(one.snapshots.all()), one.is_running,
                    )
                    for one in benches
                },
            }  # fmt: skip

        folder = service.settings.data
        files = {
            str(path.relative_to(folder)): path.stat().st_size if path.suffix != ".npz" else 0
            for path in folder.rglob("*")
            if path.is_file() and "sqlite3" not in path.name
        }
        rows = {}
        for table in Base.metadata.sorted_tables:
            if table.name not in ("results", "audit"):
                query = table.select()
                rows[table.name] = sorted(map(str, service.database.transact(lambda s, q=query: list(s.execute(q)))))
        return {**self.live.on_loop(memory()), "files": files, **rows}


Asked = tuple[Somebody, dict[str, str], Any]
CASES: dict[tuple[str, str], Callable[[World], Asked]] = {}


def case(method: str, path: str) -> Any:
    """Say how a door is asked, so that it would do what it is for."""

    def put(made: Callable[[World], Asked]) -> Callable[[World], Asked]:
        CASES[method, path] = made
        return made

    return put


def of_teacher(method: str, path: str, body: Any = None, **ids: Callable[[World], str]) -> None:
    """Say how a door is asked by the teacher."""
    CASES[method, path] = lambda w: (w.teacher, {name: made(w) for name, made in ids.items()}, body)


def a_class(w: World) -> str:
    return str(w.group()["id"])


def with_two(w: World) -> str:
    group = w.group()
    for _ in "12":
        w.student(group)
    return str(group["id"])


def shown(w: World) -> str:
    group = a_class(w)
    w.ask("PUT", f"{API}/classes/{group}/shown", bench=w.bench())
    return group


def a_set(w: World) -> str:
    return str(w.ask("POST", f"{API}/benches/{w.bench()}/parameter-sets", name=f"set {w.bench()}")["id"])


def a_link(w: World) -> str:
    return str(w.ask("POST", f"{API}/links", bench=w.bench())["id"])


def a_run(w: World) -> str:
    return str(w.ask("POST", f"{API}/runs", **RUN)["id"])


def an_ended_run(w: World) -> str:
    run = a_run(w)
    w.ask("DELETE", f"{API}/runs/{run}")
    return run


def a_sweep(w: World) -> str:
    return str(w.ask("POST", f"{API}/sweeps", **SWEEP)["id"])


def own_sheet(w: World) -> str:
    return str(w.ask("POST", f"{API}/sheets", text=CASE)["id"])


def worked_sheet(w: World) -> str:
    return w.at_sheet(w.teacher, ASKED)


of_teacher("POST", f"{API}/benches", {"scenario": "first-look", "paused": True})
of_teacher("DELETE", BENCH, bench_id=World.bench)
of_teacher("PATCH", BENCH, {"name": "mine"}, bench_id=World.bench)
of_teacher("POST", f"{BENCH}/parameter-sets", {"name": "a set"}, bench_id=World.bench)
of_teacher("POST", f"{BENCH}/parameter-sets/{{set_id}}", bench_id=World.bench, set_id=a_set)
of_teacher("PATCH", f"{API}/parameter-sets/{{set_id}}", {"name": "another"}, set_id=a_set)
of_teacher("DELETE", f"{API}/parameter-sets/{{set_id}}", set_id=a_set)
of_teacher("POST", f"{BENCH}/recordings", {"name": "one"}, bench_id=World.bench)
of_teacher("DELETE", f"{API}/recordings/{{recording_id}}", recording_id=lambda w: w.recording(w.bench()))
of_teacher("POST", f"{BENCH}/watchers", {"hours": 1.0}, bench_id=World.bench)
of_teacher("POST", f"{API}/links", {"scenario": "first-look"})
of_teacher("PATCH", f"{API}/links/{{link_id}}", {"note": "other words"}, link_id=a_link)
of_teacher("DELETE", f"{API}/links/{{link_id}}", link_id=a_link)
of_teacher("POST", f"{API}/links/{{link_id}}/open", link_id=a_link)
of_teacher("POST", f"{API}/runs", RUN)
of_teacher("PATCH", f"{API}/runs/{{run_id}}", {"label": "named"}, run_id=a_run)
of_teacher("DELETE", f"{API}/runs/{{run_id}}", run_id=a_run)
of_teacher("POST", f"{API}/sweeps", SWEEP)
of_teacher("PATCH", f"{API}/sweeps/{{sweep_id}}", {"label": "named"}, sweep_id=a_sweep)
of_teacher("DELETE", f"{API}/sweeps/{{sweep_id}}", sweep_id=a_sweep)
of_teacher("POST", f"{API}/gallery/run", {"only": "ch1-step"})
of_teacher("POST", f"{API}/sheets", {"text": CASE})
of_teacher("DELETE", f"{API}/sheets/{{sheet_id}}", sheet_id=worked_sheet)
of_teacher("POST", f"{API}/sheets/{{sheet_id}}/begin", sheet_id=own_sheet)
of_teacher("DELETE", f"{API}/sheets/{{sheet_id}}/progress", sheet_id=worked_sheet)
of_teacher("POST", f"{API}/votes", {"text": "Which?", "answers": ["a", "b"]})
of_teacher("POST", f"{API}/votes/{{vote_id}}/close", vote_id=World.vote)
of_teacher("POST", f"{API}/votes/{{vote_id}}/reveal", vote_id=World.vote)
of_teacher("PUT", f"{API}/votes/{{vote_id}}/hands", {"counts": [1, 2]}, vote_id=World.vote)
of_teacher("DELETE", f"{API}/votes/{{vote_id}}", vote_id=World.vote)
of_teacher("POST", f"{API}/classes", {"name": "Tuesday"})
of_teacher("DELETE", CLASS, class_id=with_two)
of_teacher("POST", f"{CLASS}/code", {"minutes": 5}, class_id=a_class)
of_teacher("DELETE", f"{CLASS}/code", class_id=a_class)
of_teacher("POST", f"{CLASS}/commands", {"command": {"heal": "all"}}, class_id=with_two)
of_teacher("POST", f"{CLASS}/scenario", {"scenario": "first-look", "paused": True}, class_id=with_two)
of_teacher("POST", f"{CLASS}/start", {}, class_id=with_two)
of_teacher("DELETE", f"{CLASS}/shown", class_id=shown)
of_teacher("PUT", f"{CLASS}/layout", {"name": "lab"}, class_id=a_class)
of_teacher("POST", f"{CLASS}/blind", {"scenario": "first-look"}, class_id=with_two)


@case("POST", f"{BENCH}/recordings/{{recording_id}}/stop")
def _(w: World) -> Asked:
    bench = w.bench()
    return w.teacher, {"bench_id": bench, "recording_id": w.recording(bench, ended=False)}, None


@case("DELETE", f"{BENCH}/watchers/{{watcher_id}}")
def _(w: World) -> Asked:
    bench = w.bench()
    watcher = w.ask("POST", f"{API}/benches/{bench}/watchers", hours=1.0)["id"]
    return w.teacher, {"bench_id": bench, "watcher_id": watcher}, None


@case("POST", f"{BENCH}/reopen")
def _(w: World) -> Asked:
    service, bench = w.live.service, w.bench()
    w.live.on_loop(service.reopening._let_go(service.benches.get(bench)))
    if service.benches.find(bench) is not None:  # nobody needs it from now on
        service.idling._seen[bench], service.idling._patience_s = -1e9, 1.0
        w.live.on_loop(service.reopening._let_go(service.benches.get(bench)))
        service.idling._patience_s = 60.0 * service.settings.idle_minutes
    return w.teacher, {"bench_id": bench}, None


@case("POST", f"{API}/recordings/{{recording_id}}/replay")
def _(w: World) -> Asked:
    bench = w.bench()
    w.live.on_loop(w.live.service.benches.command(w.live.service.benches.get(bench), _step(), "teacher"))
    return w.teacher, {"recording_id": _past(w, bench)}, {"paused": True}


@case("POST", f"{API}/recordings/{{recording_id}}/compare")
def _(w: World) -> Asked:
    bench = w.bench()
    w.live.on_loop(w.live.service.benches.command(w.live.service.benches.get(bench), _step(), "teacher"))
    one = _past(w, bench)
    return w.teacher, {"recording_id": one}, {"other": one}


def _step() -> Any:
    from server.bench.commands import Step

    return Step(ticks=20)


def _past(w: World, bench: str) -> str:
    made = w.ask("POST", f"{API}/benches/{bench}/recordings", ticks=0, past_ticks=10)["id"]
    w.live.wait(lambda: w.ask("GET", f"{API}/recordings/{made}")["state"] == "done")
    return str(made)


@case("POST", f"{API}/runs/remove")
def _(w: World) -> Asked:
    return w.teacher, {}, {"ids": [an_ended_run(w)]}


@case("POST", f"{API}/sweeps/remove")
def _(w: World) -> Asked:
    sweep = a_sweep(w)
    w.ask("DELETE", f"{API}/sweeps/{sweep}")
    return w.teacher, {}, {"ids": [sweep]}


@case("PUT", f"{API}/sheets/{{sheet_id}}/recordings/{{recording_id}}")
def _(w: World) -> Asked:
    ada = w.student()
    sheet = w.at_sheet(ada, ASKED)
    return ada, {"sheet_id": sheet, "recording_id": w.recording(ada.bench)}, None


def at_step(word: str, text: str, body: Any) -> None:
    """Say how somebody does something at a step."""

    def made(w: World) -> Asked:
        ada = w.student()
        return ada, {"sheet_id": w.at_sheet(ada, text), "step_id": "first" if text is CASE else "ask"}, body

    CASES["POST", f"{API}/sheets/{{sheet_id}}/steps/{{step_id}}/{word}"] = made


at_step("answer", ASKED, {"answer": "1 Hz"})
at_step("hint", ASKED, None)
at_step("close", ASKED, None)
at_step("hide", CASE, None)


@case("POST", f"{CLASS}/sheet")
def _(w: World) -> Asked:
    return w.teacher, {"class_id": with_two(w)}, {"sheet": own_sheet(w)}


def at_game(word: str, body: dict[str, Any]) -> None:
    """Say how somebody does something at a game."""

    def made(w: World) -> Asked:
        ada = w.student()
        kinds = w.ask("GET", f"{GAME}?seed=1", ada)["kinds"]
        handed = {"hand_in": {"fault": kinds[0]["name"], "severity": 0.01}} if word == "attempts" else {}
        return ada, {"game_id": "fool-the-bank"}, {**body, **handed}

    CASES["POST", f"{API}/games/{{game_id}}/{word}"] = made


at_game("begin", {"seed": 1})
at_game("attempts", {"seed": 1})
at_game("reveal", {"seed": 1})


@case("PUT", f"{API}/me/hand")
def _(w: World) -> Asked:
    return w.student(), {}, {"raised": True}


@case("PUT", f"{API}/me/vote")
def _(w: World) -> Asked:
    group = w.group()
    return w.student(group), {}, {"vote": w.vote(class_id=group["id"]), "answer": 1}


@case("POST", f"{CLASS}/join")
def _(w: World) -> Asked:
    group = w.group()
    w.ask("POST", f"{API}/classes/{group['id']}/sheet", sheet=own_sheet(w))
    return Somebody(w.live, "nobody's"), {"class_id": group["id"]}, {"code": group["code"], "name": "Ben"}


def of_member(method: str, path: str) -> None:
    """Say how the teacher does something to a student."""

    def made(w: World) -> Asked:
        group = w.group()
        ada = w.student(group)
        w.ask("PUT", f"{API}/me/hand", ada, raised=True)
        w.blind(ada)
        return w.teacher, {"class_id": group["id"], "member_id": ada.id}, None

    CASES[method, path] = made


of_member("DELETE", f"{CLASS}/members/{{member_id}}")
of_member("DELETE", f"{CLASS}/members/{{member_id}}/hand")


@case("PUT", f"{CLASS}/shown")
def _(w: World) -> Asked:
    return w.teacher, {"class_id": a_class(w)}, {"bench": w.bench()}


@case("DELETE", f"{CLASS}/blind")
def _(w: World) -> Asked:
    group = w.group()
    for _ in "12":
        w.blind(w.student(group))
    return w.teacher, {"class_id": group["id"]}, None


def at_blind(method: str, path: str, body: Any, hidden: bool) -> None:
    """Say how a student does something at a hidden fault."""

    def made(w: World) -> Asked:
        ada = w.student()
        if hidden:
            w.blind(ada)
        return ada, {"bench_id": ada.bench}, body

    CASES[method, path] = made


at_blind("POST", f"{BENCH}/blind", {"seed": 2}, hidden=False)
at_blind("POST", f"{BENCH}/blind/answer", {"said": "m+5", "confidence": 0.5}, hidden=True)
at_blind("DELETE", f"{BENCH}/blind", None, hidden=True)

WITHOUT = {
    (method, path)
    for method, path in DOORS
    if path.startswith((f"{API}/theory", f"{API}/devices", f"{API}/scenarios", f"{API}/units", f"{API}/thresholds"))
    or path.startswith((f"{BENCH}/commands", f"{BENCH}/snapshots", f"{BENCH}/driving", f"{BENCH}/fork"))
    or path in (f"{BENCH}/variant", f"{BENCH}/identification", f"{BENCH}/diagnosers/{{name}}/aliases", "/join")
    or path == f"{API}/lectures/{{lecture_id}}/cues/{{number}}"
}
"""Doors that ask no database, or the same as others: a search as a run, the page to join as the door of the class."""
AFTER_ALL: dict[tuple[str, str], Callable[[Live, dict[str, str]], bool]] = {
    ("POST", f"{BENCH}/recordings/{{recording_id}}/stop"): lambda live, ids: (
        not live.service.benches.get(ids["bench_id"]).recordings.under_way
    ),
    ("DELETE", f"{API}/runs/{{run_id}}"): lambda live, ids: _has_ended(live, f"runs/{ids['run_id']}"),
    ("DELETE", f"{API}/sweeps/{{sweep_id}}"): lambda live, ids: _has_ended(live, f"sweeps/{ids['sweep_id']}"),
    ("POST", f"{API}/gallery/run"): lambda live, _: len(live.http.get(f"{API}/runs").json()["runs"]) == 1,
}
"""Doors that do something, then look at what has become of it: if that look fails, all of it is done."""


def _has_ended(live: Live, path: str) -> bool:
    return bool(live.http.get(f"{API}/{path}").json()["state"] == "cancelled")


@pytest.fixture
def world(live: Live, monkeypatch: pytest.MonkeyPatch) -> Iterator[World]:
    """The shared server; runs that are queued wait until they are cancelled."""

    async def waits(self: Queue, row: Any) -> None:
        try:
            await asyncio.Event().wait()
        except asyncio.CancelledError:
            self._tasks.pop(row.id, None)
            await self._end(row.id, "cancelled")

    monkeypatch.setattr(Queue, "_carry_out", waits)
    with ThreadPoolExecutor(1) as thread:
        monkeypatch.setattr(Processes, "submit", lambda _, *work: thread.submit(*work))
        made = World(live)
        yield made
        made.end()
    live.service.joining._tries._buckets.clear()


class Injector:
    """Fails one database call, counted from the moment it is told to."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.left, self.has_failed = -1, False
        run = Database.run

        async def failing(database: Database, work: Any) -> Any:
            self.left -= 1
            if self.left == -1 and self.is_armed:
                self.has_failed = True
                raise OperationalError("a statement", {}, Exception("the database is gone"))
            return await run(database, work)

        self.is_armed = False
        monkeypatch.setattr(Database, "run", failing)

    def arm(self, calls: int) -> None:
        self.left, self.has_failed, self.is_armed = calls, False, True


def test_every_door_that_writes_is_tried() -> None:
    writing = {door for door in DOORS if door[0] not in ("GET", SOCKET)}
    assert writing == {*CASES} | (WITHOUT & writing)


@pytest.mark.parametrize("door", CASES, ids=" ".join)
def test_what_is_refused_for_want_of_the_database_has_not_happened(
    world: World, door: tuple[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    who, ids, body = CASES[door](world)
    method, path = door[0], door[1].format(**ids)
    injector = Injector(monkeypatch)
    for calls in range(40):
        before = world.state()
        injector.arm(calls)
        answer = who.ask(method, path, **({"json": body} if body is not None else {}))
        injector.is_armed = False
        if not injector.has_failed:
            assert answer.is_success, answer.text
            return
        after = world.state()
        if door in AFTER_ALL and after != before:
            assert AFTER_ALL[door](world.live, ids)
            return
        if answer.is_success:
            assert answer.json()["failed"]  # it is said of whom it has not been done
            continue
        assert answer.status_code == 503, answer.text
        assert {key: (before[key], after[key]) for key in after if before[key] != after[key]} == {}, (calls, door)
    raise AssertionError(f"{door} asks the database too often")
