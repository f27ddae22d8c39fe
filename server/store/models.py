"""Tables: headless runs and campaigns, their results, recordings, links. Bulk data is in files; a row says which."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any, ClassVar

from sqlalchemy import (
    JSON,
    BigInteger,
    ColumnElement,
    DateTime,
    Dialect,
    Float,
    Integer,
    MetaData,
    String,
    Text,
    TypeDecorator,
    false,
    true,
)
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column


def now() -> datetime:
    """Return the time in UTC."""
    return datetime.now(UTC)


class Moment(TypeDecorator[datetime]):
    """A time in UTC, from a database that keeps time zones and from one that does not."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_result_value(self, value: datetime | None, dialect: Dialect) -> datetime | None:  # noqa: ARG002
        """Say that it is UTC."""
        return value if value is None else value.replace(tzinfo=value.tzinfo or UTC).astimezone(UTC)


class Base(DeclarativeBase):
    """Base of all tables; named constraints, so that SQLite can alter them."""

    metadata = MetaData(
        naming_convention={
            "ix": "ix_%(column_0_label)s",
            "uq": "uq_%(table_name)s_%(column_0_name)s",
            "ck": "ck_%(table_name)s_%(constraint_name)s",
            "fk": "fk_%(table_name)s_%(column_0_name)s_%(referred_table_name)s",
            "pk": "pk_%(table_name)s",
        }
    )
    type_annotation_map: ClassVar[dict[Any, Any]] = {
        dict[str, Any]: JSON,
        list[Any]: JSON,
        datetime: Moment(),
    }


class RequestRow(Base):
    """What somebody asked to be computed, a run with its seeds or a campaign; the table of results has the outcomes.

    Attributes
    ----------
    kind : str
        ``run`` or ``campaign``.
    shard : str
        The process that carries it out and has its files, where several share the table.
    key : str
        What it is known by; the id is its beginning.
    name : str
        Id of the scenario of a run, or of the campaign.
    document : dict
        The scenario of a run, or the campaign.
    seeds : list of int
        Those of a run.
    everything : bool
        Whether the trace of a run has the signals of blocks that only look on as well.
    version : str
        Of the code; runs from before it was kept have none.
    runs, done : int
        Different runs it is made of, and those in the table of results when it ended.
    attempts : int
        Starts in a row without a result.
    summary : dict
        That of a run.
    """

    __tablename__ = "requests"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    kind: Mapped[str] = mapped_column(String(16), index=True)
    shard: Mapped[str] = mapped_column(String(8), default="", server_default="")
    key: Mapped[str] = mapped_column(String(64), default="", server_default="")
    state: Mapped[str] = mapped_column(String(16), index=True)
    name: Mapped[str] = mapped_column(String(200))
    scenario_id: Mapped[str] = mapped_column(String(200))
    title: Mapped[str] = mapped_column(String(400))
    label: Mapped[str] = mapped_column(String(120), default="", server_default="")
    document: Mapped[dict[str, Any]]
    seeds: Mapped[list[Any] | None]
    everything: Mapped[bool] = mapped_column(default=False, server_default=false())
    version: Mapped[str] = mapped_column(String(16), default="", server_default="")
    runs: Mapped[int] = mapped_column(Integer)
    done: Mapped[int] = mapped_column(Integer, default=0, server_default="0")
    attempts: Mapped[int] = mapped_column(Integer, default=0, server_default="0")
    created: Mapped[datetime] = mapped_column(default=now, index=True)
    finished: Mapped[datetime | None]
    summary: Mapped[dict[str, Any] | None]
    error: Mapped[dict[str, Any] | None]

    @property
    def progress(self) -> float:
        """Share of the runs that were done when it ended."""
        return self.done / self.runs if self.runs else 0.0


def of_process(shard: str) -> ColumnElement[bool]:
    """Return the condition that a process carries a request out; one without a letter is alone and has all."""
    return RequestRow.shard == shard if shard else true()


class ResultRow(Base):
    """One single run, by its key: scenario, seed and version. All runs and campaigns share these rows."""

    __tablename__ = "results"

    key: Mapped[str] = mapped_column(String(64), primary_key=True)
    outcome: Mapped[dict[str, Any]]
    created: Mapped[datetime] = mapped_column(default=now, index=True)


class RecordingRow(Base):
    """One recording of a live bench."""

    __tablename__ = "recordings"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    bench_id: Mapped[str] = mapped_column(String(32), index=True)
    name: Mapped[str] = mapped_column(String(200))
    state: Mapped[str] = mapped_column(String(16), index=True)
    title: Mapped[str] = mapped_column(String(400))
    dt_ms: Mapped[float] = mapped_column(Float)
    start_tick: Mapped[int] = mapped_column(BigInteger)
    ticks: Mapped[int] = mapped_column(BigInteger, default=0)
    signals: Mapped[list[Any]]
    scenario: Mapped[dict[str, Any] | None]
    events: Mapped[list[Any] | None]
    layout: Mapped[dict[str, Any] | None]
    seed: Mapped[int | None] = mapped_column(BigInteger)
    version: Mapped[str] = mapped_column(String(64), default="", server_default="")
    condition: Mapped[str] = mapped_column(String(200), default="", server_default="")
    bytes: Mapped[int] = mapped_column(BigInteger, default=0, server_default="0")
    created: Mapped[datetime] = mapped_column(default=now, index=True)
    finished: Mapped[datetime | None]
    reason: Mapped[str] = mapped_column(String(400), default="")


class ParameterSetRow(Base):
    """A named set of parameters."""

    __tablename__ = "parameter_sets"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    name: Mapped[str] = mapped_column(String(100), unique=True)
    scenario: Mapped[str] = mapped_column(String(200))
    values: Mapped[dict[str, Any]]
    created: Mapped[datetime] = mapped_column(default=now)


class LinkRow(Base):
    """An experiment or a layout by a short id, or a bench that was let go by its own."""

    __tablename__ = "links"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    kind: Mapped[str] = mapped_column(String(16), index=True)
    title: Mapped[str] = mapped_column(String(200))
    note: Mapped[str] = mapped_column(String(2000))
    scenario_id: Mapped[str | None] = mapped_column(String(200))
    tick: Mapped[int | None] = mapped_column(BigInteger)
    digest: Mapped[str | None] = mapped_column(String(64))
    version: Mapped[str] = mapped_column(String(64))
    content: Mapped[dict[str, Any]]
    bytes: Mapped[int] = mapped_column(BigInteger)
    created: Mapped[datetime] = mapped_column(default=now, index=True)


class ClassRow(Base):
    """A class: students who join by a code, each with a bench of their own.

    Attributes
    ----------
    code_hash : str
        Of the join code, none while nobody can join.
    code_until : datetime
        When the code expires.
    until : datetime
        When the class ends and its students are forgotten.
    scenario : dict
        What their benches begin with, as ``POST /benches`` takes it.
    secret : str
        From which it is drawn what each student gets; it never leaves the server.
    shown : str
        The bench that all students see in place of their own.
    layout : dict
        The layout of panels that was given to all last.
    sheet : str
        The lab sheet that who joins begins with, instead of the scenario.
    """

    __tablename__ = "classes"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    name: Mapped[str] = mapped_column(String(100))
    code_hash: Mapped[str | None] = mapped_column(String(64))
    code_until: Mapped[datetime | None]
    scenario: Mapped[dict[str, Any]]
    secret: Mapped[str] = mapped_column(String(64), server_default="")
    shown: Mapped[str | None] = mapped_column(String(32))
    layout: Mapped[dict[str, Any] | None]
    sheet: Mapped[str | None] = mapped_column(String(40))
    created: Mapped[datetime] = mapped_column(default=now, index=True)
    until: Mapped[datetime]


class PersonRow(Base):
    """A session of a student or of a watcher; the secret that opens it is kept as its hash.

    Attributes
    ----------
    bench_id : str
        The bench of a student, or the one that a watcher sees.
    earlier : list of str
        Those that were the student's before.
    lent : str
        A bench of the teacher that the student drives.
    """

    __tablename__ = "people"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    role: Mapped[str] = mapped_column(String(16))
    name: Mapped[str] = mapped_column(String(100))
    class_id: Mapped[str | None] = mapped_column(String(32), index=True)
    bench_id: Mapped[str | None] = mapped_column(String(32))
    earlier: Mapped[list[str] | None] = mapped_column(JSON)
    lent: Mapped[str | None] = mapped_column(String(32))
    secret_hash: Mapped[str] = mapped_column(String(64), unique=True)
    joined: Mapped[datetime] = mapped_column(default=now)
    until: Mapped[datetime]


class AuditRow(Base):
    """Something that a person did, to a bench or in a class; it stays when the bench goes."""

    __tablename__ = "audit"

    id: Mapped[int] = mapped_column(BigInteger().with_variant(Integer, "sqlite"), primary_key=True, autoincrement=True)
    at: Mapped[datetime] = mapped_column(default=now, index=True)
    actor: Mapped[str] = mapped_column(String(120))
    class_id: Mapped[str | None] = mapped_column(String(32), index=True)
    bench_id: Mapped[str | None] = mapped_column(String(32), index=True)
    tick: Mapped[int | None] = mapped_column(BigInteger)
    kind: Mapped[str] = mapped_column(String(32))
    text: Mapped[str] = mapped_column(String(400))


class BlindAnswerRow(Base):
    """A fault hidden from somebody, and what was answered; it goes with the class."""

    __tablename__ = "blind_answers"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    class_id: Mapped[str | None] = mapped_column(String(32), index=True)
    person_id: Mapped[str] = mapped_column(String(32))
    began: Mapped[datetime] = mapped_column(default=now)
    answer: Mapped[dict[str, Any]]


class SheetRow(Base):
    """A lab sheet that somebody wrote; those of the library are files."""

    __tablename__ = "sheets"

    id: Mapped[str] = mapped_column(String(40), primary_key=True)
    text: Mapped[str] = mapped_column(Text)
    created: Mapped[datetime] = mapped_column(default=now, index=True)


class SheetProgressRow(Base):
    """How far a person has come with a sheet; that of a student goes with the class."""

    __tablename__ = "sheet_progress"

    person_id: Mapped[str] = mapped_column(String(32), primary_key=True)
    sheet_id: Mapped[str] = mapped_column(String(40), primary_key=True)
    class_id: Mapped[str | None] = mapped_column(String(32), index=True)
    bench_id: Mapped[str] = mapped_column(String(32))
    begun: Mapped[datetime] = mapped_column(default=now)
    progress: Mapped[dict[str, Any]]


class VoteRow(Base):
    """A question to a class before its answer is shown; without a class hands are raised in the room.

    Attributes
    ----------
    state : str
        ``open``, ``closed`` or ``revealed``.
    hands : list of int
        How many hands there were for each answer, as the teacher typed them.
    """

    __tablename__ = "votes"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    class_id: Mapped[str | None] = mapped_column(String(32), index=True)
    question: Mapped[dict[str, Any]]
    state: Mapped[str] = mapped_column(String(16))
    hands: Mapped[list[Any]]
    created: Mapped[datetime] = mapped_column(default=now)


class BallotRow(Base):
    """What a student answered; it goes with the student, the vote or the class."""

    __tablename__ = "ballots"

    vote_id: Mapped[str] = mapped_column(String(32), primary_key=True)
    person_id: Mapped[str] = mapped_column(String(32), primary_key=True)
    answer: Mapped[int]
    at_ms: Mapped[float | None]


class LtiKeyRow(Base):
    """What a keyed hash of a learning platform's ids stands for: a class, or a student of one."""

    __tablename__ = "lti_keys"

    key: Mapped[str] = mapped_column(String(64), primary_key=True)
    class_id: Mapped[str] = mapped_column(String(32), index=True)
    person_id: Mapped[str | None] = mapped_column(String(32))
