"""Several processes at one PostgreSQL: each has its letter, and what both are asked for at once is carried out once."""

from __future__ import annotations

import asyncio
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, suppress
from pathlib import Path

import pytest

from core.errors import InputError
from server.errors import Elsewhere
from server.runs.listing import Requests, fresh
from server.settings import Settings
from server.store.base import now
from server.store.database import Database
from server.store.keeping import Keeping
from server.store.models import RequestRow
from tests.server.store.postgres import new_database

ROUNDS = 20
pytestmark = pytest.mark.long


def row(name: str, state: str = "queued", **values: object) -> RequestRow:
    given = {"id": name, "kind": "run", "key": name, "name": name, "scenario_id": name, "title": name}
    made = fresh(**given, document={}, seeds=[1], runs=1)
    for field, value in {"state": state, **values}.items():
        setattr(made, field, value)
    return made


def test_letters_share_a_database_that_one_without_has_alone(postgres_server: str) -> None:
    address = new_database(postgres_server, "letters")

    def refused(shard: str) -> bool:
        with closing(Database(address)) as late, suppress(InputError):
            late.claim(shard)
            return False
        return True

    with closing(Database(address)) as a, closing(Database(address)) as b:
        a.claim("a")
        b.claim("b")
        assert refused("a") and refused("b") and refused("") and not refused("c")
    assert not refused("")
    with closing(Database(address)) as late:
        with closing(Database(address)) as early:
            early.claim("a")
            with pytest.raises(InputError, match="another server"):
                late.claim("a")
        assert not refused("")  # who was refused holds nothing
    with closing(Database(address)) as alone:
        alone.claim()
        assert refused("a") and refused("")
    assert not refused("a")


def test_processes_that_start_at_once_migrate_once(postgres_server: str) -> None:
    address = new_database(postgres_server, "at-once")
    databases = [Database(address) for _ in range(4)]
    with ThreadPoolExecutor(len(databases)) as threads:
        list(threads.map(Database.migrate, databases))
    for database in databases:
        database.close()


@pytest.mark.parametrize("before", [None, "failed"])
def test_what_two_are_asked_for_at_once_is_carried_out_once(
    before: str | None, postgres_server: str, tmp_path: Path
) -> None:
    address = new_database(postgres_server, "asked")
    databases = [Database(address), Database(address)]
    databases[0].migrate()
    processes = [Requests(one, tmp_path, letter) for one, letter in zip(databases, "ab", strict=True)]

    async def ask(name: str) -> None:
        if before:
            await databases[0].run(lambda session: session.add(row(name, before)))
        known = await asyncio.gather(*(one.settle(row(name), has_room=True) for one in processes))
        assert [found is None for found in known].count(True) == 1, name
        starts = processes[known.index(None)]
        assert [one.id for one in await starts.recover() if one.id == name] == [name]
        (other,) = (one for one in processes if one is not starts)
        assert name not in [one.id for one in await other.recover()]

    for number in range(ROUNDS):
        asyncio.run(ask(f"run-{number}"))
    for database in databases:
        database.close()


def test_each_recovers_removes_and_expires_its_own(postgres_server: str, tmp_path: Path) -> None:
    address = new_database(postgres_server, "own")
    settings = Settings(data=tmp_path, shard="b", retention_days=1.0)
    with closing(Database(address)) as database:
        database.migrate()
        long_ago = now().replace(year=2020)
        kept = [
            row("before"),
            row("mine", shard="b"),
            row("theirs", shard="a"),
            *(row(f"old-{letter}", "done", shard=letter, finished=long_ago) for letter in "ab"),
            *(row(f"new-{letter}", "done", shard=letter, finished=now()) for letter in "ab"),
        ]
        database.transact(lambda session: session.add_all(kept))
        requests = Requests(database, tmp_path, "b")

        async def go_on() -> None:
            assert [one.id for one in await requests.recover()] == ["before", "mine"]
            assert [one.id for one in await Requests(database, tmp_path, "a").recover()] == ["theirs"]
            assert await Keeping(database, database, settings).expire() == 1
            with pytest.raises(Elsewhere):
                await requests.remove("run", ["new-a"])
            assert await requests.remove("run", None) == 1
            ids = {found.id for found in await requests.some("run", [one.id for one in kept])}
            assert ids == {"before", "mine", "theirs", "old-a", "new-a"}

        asyncio.run(go_on())
