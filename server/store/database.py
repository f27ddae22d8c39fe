"""The database: SQLite in WAL mode, or PostgreSQL; migrated at the start, used from one thread of its own."""

from __future__ import annotations

import asyncio
import logging
import sqlite3
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from sqlalchemy import Connection, Engine, create_engine, event, inspect, make_url, text
from sqlalchemy.exc import ArgumentError, DBAPIError
from sqlalchemy.orm import Session, sessionmaker

from core.errors import InputError
from scenarios.extras import require
from server.store.change import Change

if TYPE_CHECKING:
    from alembic.config import Config

log = logging.getLogger(__name__)

FILE = "combbench.sqlite3"
"""The database in a data folder, if none is given by address."""
MIGRATIONS = Path(__file__).parent / "migrations"
CLAIM = b"combben"
"""Name of the advisory lock of a server, as a number; others of the same database have other numbers."""
KEEPALIVES = "SET tcp_keepalives_idle = 30; SET tcp_keepalives_interval = 10; SET tcp_keepalives_count = 3"
"""Within a minute the database notices that a host has lost its power, and frees its lock."""
MIGRATION = b"combmigr"
"""Name of the lock that a process holds while it migrates."""
T = TypeVar("T")


class Database:
    """Sessions over one database.

    Parameters
    ----------
    place : Path or str
        A file for SQLite, whose folder is made; or the address of a database.
    """

    def __init__(self, place: Path | str) -> None:
        if isinstance(place, Path):
            place.parent.mkdir(parents=True, exist_ok=True)
            place = f"sqlite:///{place}"
        self.url = full_url(place)
        self._engine = make_engine(self.url)
        self._sessions = sessionmaker(self._engine, expire_on_commit=False)
        self._thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix="combbench-db")
        self._claim: Connection | None = None

    def migrate(self) -> None:
        """Bring the tables to this version; the tools for it are loaded only when there is something to do.

        Raises
        ------
        InputError
            When the database cannot be used.
        """
        try:
            if self._revision() != newest_revision():
                self._upgrade()
        except DBAPIError as error:
            raise InputError(f"the database cannot be used: {reason_of(error)}", "database_url") from None

    def claim(self) -> None:
        """Lock a PostgreSQL database for this process until `close`; the lock of the data folder protects SQLite.

        Raises
        ------
        InputError
            When another server has it.
        """
        if self.url.startswith("sqlite"):
            return
        connection = self._engine.connect()
        if connection.execute(text("SELECT pg_try_advisory_lock(:key)"), {"key": _number(CLAIM)}).scalar():
            connection.execute(text(KEEPALIVES))
            connection.commit()  # the locks and the settings stay
            self._claim = connection
        else:
            connection.close()
            raise InputError(
                "the database is in use by another server", "database_url", "stop that one, or name another database"
            )

    def _upgrade(self) -> None:
        from alembic import command

        level = logging.getLogger("alembic").level
        logging.getLogger("alembic").setLevel(logging.WARNING)
        try:
            with self._engine.begin() as connection:
                if not self.url.startswith("sqlite"):  # several processes may start at once
                    connection.execute(text("SELECT pg_advisory_xact_lock(:key)"), {"key": _number(MIGRATION)})
                command.upgrade(alembic_config(self.url, connection), "head")
        finally:
            logging.getLogger("alembic").setLevel(level)

    def _revision(self) -> str | None:
        """Return the version of the tables, none for an empty file."""
        with self._engine.connect() as connection:
            if not inspect(connection).has_table("alembic_version"):
                return None
            return connection.execute(text("SELECT version_num FROM alembic_version")).scalar()

    def transact(self, work: Callable[[Session], T]) -> T:
        """Run ``work`` in a transaction, here and now."""
        with self._sessions.begin() as session:
            return work(session)

    async def run(self, work: Callable[[Session], T]) -> T:
        """Run ``work`` in a transaction on the database thread."""
        return await asyncio.get_running_loop().run_in_executor(self._thread, self.transact, work)

    async def keep(self, *changes: Change) -> None:
        """Write changes in one transaction, then make them true in memory; nothing changes if one cannot be written."""
        if changes:
            await self.run(lambda session: [change.write(session) for change in changes])
        for change in changes:
            change.take()

    async def run_or_make_room(self, work: Callable[[Session], object], remove: Callable[[], object]) -> None:
        """Delete rows, then their files; on a full disk the files go first, which makes room for the rows to go."""
        try:
            await self.run(work)
        except DBAPIError as error:
            if "full" not in reason_of(error):
                raise
            await asyncio.to_thread(remove)
            await self.run(work)
        else:
            await asyncio.to_thread(remove)

    def run_later(self, work: Callable[[Session], object]) -> None:
        """Run ``work`` on the database thread after the waiting work; errors are logged."""
        self._thread.submit(self._try, work)

    def _try(self, work: Callable[[Session], object]) -> None:
        try:
            self.transact(work)
        except Exception:
            log.exception("something could not be kept in the database")

    async def is_writable(self) -> bool:
        """Return whether the database can be written now."""

        def probe(session: Session) -> bool:
            if session.get_bind().dialect.name == "sqlite":
                session.execute(text("PRAGMA user_version = 0"))  # writes a page even though the version is 0 already
                return True
            return not session.execute(text("SELECT pg_is_in_recovery()")).scalar()

        try:
            return await asyncio.wait_for(self.run(probe), 2.0)
        except Exception:
            return False

    async def used_bytes(self) -> int:
        """Return the bytes of a file of SQLite that are in use; 0 for PostgreSQL, which manages its own storage."""
        if not self.url.startswith("sqlite"):
            return 0
        pages = "SELECT page_size * (page_count - freelist_count) FROM pragma_page_size, pragma_page_count, "
        return await self.run(lambda session: int(session.execute(text(f"{pages}pragma_freelist_count")).scalar() or 0))

    def close(self) -> None:
        """Finish the active work and close the file."""
        self._thread.shutdown(wait=True)
        if self._claim is not None:
            with suppress(DBAPIError):  # a database that is gone has freed them
                # explicitly: the database frees the locks of a closed connection only later
                self._claim.execute(text("SELECT pg_advisory_unlock_all()"))
            self._claim.close()
        self._engine.dispose()


def _number(lock: bytes) -> int:
    """Return a lock as PostgreSQL names it."""
    return int.from_bytes(lock, "big")


def reason_of(error: DBAPIError) -> str:
    """Say in one line why the database refused."""
    return " ".join(str(error.orig).split())[:300]


def full_url(address: str) -> str:
    """Return the address with the driver we have.

    Raises
    ------
    InputError
        For an address that is neither SQLite's nor PostgreSQL's.
    """
    try:
        url = make_url(address)
    except (ArgumentError, ValueError):
        raise InputError("is no address of a database", "database_url", "postgresql://user@host/name") from None
    if url.drivername in ("postgresql", "postgres"):
        url = url.set(drivername="postgresql+psycopg")
    if url.drivername not in ("sqlite", "postgresql+psycopg"):
        raise InputError(f"{url.drivername} is not known; use sqlite or postgresql", "database_url")
    if url.drivername != "sqlite":
        require("psycopg", "postgres", "database_url")
    return url.render_as_string(hide_password=False)


def make_engine(url: str) -> Engine:
    """Open the database, SQLite with its pragmas; errors, which are logged, do not quote the stored values."""
    if not url.startswith("sqlite"):
        return create_engine(url, pool_pre_ping=True, hide_parameters=True)
    engine = create_engine(url, hide_parameters=True)

    @event.listens_for(engine, "connect")
    def _(connection: Any, _record: Any) -> None:
        cursor = connection.cursor()
        cursor.execute("PRAGMA journal_mode=WAL")
        cursor.execute("PRAGMA synchronous=NORMAL")
        cursor.execute("PRAGMA busy_timeout=5000")
        cursor.close()

    return engine


def check_left_behind(file: Path) -> None:
    """Check that no class is left out: earlier versions kept classes here in addition to a shared database.

    Ids of that time began with the letter of their process, so they have one character more.

    Parameters
    ----------
    file : Path
        The SQLite file of a data folder that is to be used with another database.

    Raises
    ------
    InputError
        If it holds classes or recordings of such a process.
    """
    if not file.is_file():
        return
    marked = "SELECT id FROM recordings WHERE length(id) = 31 UNION SELECT id FROM people WHERE length(bench_id) = 13"
    with closing(sqlite3.connect(f"{file.absolute().as_uri()}?mode=ro", uri=True)) as connection:
        with suppress(sqlite3.OperationalError):  # no such tables
            if connection.execute(marked).fetchone() is None:
                return
            text = f"{file} holds classes and recordings of a process with a letter (shard)"
            raise InputError(text, "database_url", "leave database_url out, or choose another data folder")


def newest_revision() -> str:
    """Return the last of the numbered migrations."""
    return max(path.stem.split("_")[0] for path in (MIGRATIONS / "versions").glob("[0-9]*.py"))


def alembic_config(url: str, connection: Any = None) -> Config:
    """Describe the migrations to Alembic without an ini file."""
    from alembic.config import Config

    config = Config(stdout=sys.stdout)  # the present standard output; the default is the output at import
    config.set_main_option("script_location", str(MIGRATIONS))
    config.set_main_option("sqlalchemy.url", url.replace("%", "%%"))
    config.attributes["connection"] = connection
    return config
