"""A server with a class for a test, and all its memory and disk."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy.exc import OperationalError

from server.classroom.access import API
from server.store.base import Base
from server.store.database import Database
from tests.server.classroom.group import Somebody, join, open_class, the_teacher
from tests.server.conftest import Live

SHEET = (Path(__file__).parents[2] / "scenarios" / "sheets" / "blind-diagnosis.md").read_text()
CASE = (
    SHEET.split("## Which stiffness")[0] + '## First case\n\n```step\nid = "first"\nkind = "blind"\npoints = 4.0\n```\n'
)
ASKED = (
    CASE.split("## First case")[0]
    + '## Ask\n\n```step\nid = "ask"\nkind = "question"\npoints = 3.0\nquestion = "What?"\n'
    + 'hints = [{ text = "Look.", costs = 0.5 }]\n[number]\nvalue = "tone_hz"\nunit = "Hz"\n```\n'
)


@dataclass
class World:
    """A server for a case; the objects of a case go with it."""

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
        for noun, key in (
            ("votes", "votes"),
            ("links", "links"),
            ("recordings", "recordings"),
            ("measured-devices", "devices"),
            ("records", "records"),
        ):
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
            await service.database.run(lambda _: None)  # after later writes
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
                        one.board.tick, one.events.last, one.name, one.keep, one.view and one.view.rules,
                        sorted(one.recordings.under_way), len(one.snapshots.all()), one.is_running,
                    )
                    for one in benches
                },
            }  # fmt: skip

        known = self.live.on_loop(memory())
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
        return {**known, "files": files, **rows}


class Injector:
    """Fails one database call of a server, counted from a given moment; calls of tasks that ran before go through."""

    def __init__(self, live: Live, monkeypatch: pytest.MonkeyPatch) -> None:
        self.live, self.left, self.has_failed = live, -1, False
        self.others = set[asyncio.Task[Any]]()
        run = Database.run

        async def failing(database: Database, work: Any) -> Any:
            if database is live.service.database and asyncio.current_task() not in self.others:
                self.left -= 1
                if self.left == -1 and self.is_armed:
                    self.has_failed = True
                    raise OperationalError("a statement", {}, Exception("the database is gone"))
            return await run(database, work)

        self.is_armed = False
        monkeypatch.setattr(Database, "run", failing)

    def arm(self, calls: int) -> None:
        async def tasks() -> set[asyncio.Task[Any]]:
            return asyncio.all_tasks()

        self.others = self.live.on_loop(tasks())
        self.left, self.has_failed, self.is_armed = calls, False, True
