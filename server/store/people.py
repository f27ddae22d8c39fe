"""Tables of classes and people, of their actions, and of lab sheets and votes."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from sqlalchemy import JSON, BigInteger, Float, Integer, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from server.store.base import Base, now


class ClassRow(Base):
    """A class: students who join by a code, each with a bench of their own.

    Attributes
    ----------
    code_hash : str
        Hash of the join code, None while joining is closed.
    code_until : datetime
        When the code expires.
    until : datetime
        When the class ends and its students are forgotten.
    scenario : dict
        The start of their benches, as ``POST /benches`` takes it.
    secret : str
        From it the server draws device, noise and fault of each student; it stays on the server.
    shown : str
        The bench that all students see in place of their own.
    layout : dict
        The layout of panels that was given to all last.
    sheet : str
        The lab sheet that students begin with when they join, instead of the scenario.
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
        The bench of a student, or the bench of a watcher.
    earlier : list of str
        Benches that the student had before.
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
    """A fault hidden from a person, and the answer; it is deleted with the class."""

    __tablename__ = "blind_answers"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    class_id: Mapped[str | None] = mapped_column(String(32), index=True)
    person_id: Mapped[str] = mapped_column(String(32))
    began: Mapped[datetime] = mapped_column(default=now)
    answer: Mapped[dict[str, Any]]


class GameAttemptRow(Base):
    """An answer at a game, or the note that its hidden values were shown; it is deleted with the student or the class.

    Attributes
    ----------
    seed : int
        As it was chosen.
    points : float
        None where the hidden values were shown without an answer.
    attempt : dict
        The answer, and its result.
    """

    __tablename__ = "game_attempts"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    class_id: Mapped[str | None] = mapped_column(String(32), index=True)
    person_id: Mapped[str] = mapped_column(String(32), index=True)
    name: Mapped[str] = mapped_column(String(100))
    game: Mapped[str] = mapped_column(String(40))
    seed: Mapped[int] = mapped_column(BigInteger)
    points: Mapped[float | None] = mapped_column(Float)
    at: Mapped[datetime] = mapped_column(default=now)
    attempt: Mapped[dict[str, Any]]


class SheetRow(Base):
    """A user's lab sheet; the sheets of the library are files."""

    __tablename__ = "sheets"

    id: Mapped[str] = mapped_column(String(40), primary_key=True)
    text: Mapped[str] = mapped_column(Text)
    created: Mapped[datetime] = mapped_column(default=now, index=True)


class SheetProgressRow(Base):
    """The progress of a person with a sheet; the progress of a student is deleted with the class."""

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
    """The answer of a student; it is deleted with the student, the vote or the class."""

    __tablename__ = "ballots"

    vote_id: Mapped[str] = mapped_column(String(32), primary_key=True)
    person_id: Mapped[str] = mapped_column(String(32), primary_key=True)
    answer: Mapped[int]
    at_ms: Mapped[float | None]


class LtiKeyRow(Base):
    """The class or the student behind a keyed hash of a learning platform's ids."""

    __tablename__ = "lti_keys"

    key: Mapped[str] = mapped_column(String(64), primary_key=True)
    class_id: Mapped[str] = mapped_column(String(32), index=True)
    person_id: Mapped[str | None] = mapped_column(String(32))
