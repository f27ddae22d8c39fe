"""Hidden faults, for one person or for a class: hides, judges answers, reveals, and keeps the answers."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Awaitable, Callable
from datetime import datetime
from typing import Literal

from pydantic import BaseModel, Field
from sqlalchemy import delete, select
from sqlalchemy.orm import Session as DatabaseSession

from core.errors import InputError, unknown
from server.bench.bench import LiveBench
from server.bench.engine import Engine
from server.bench.view import View
from server.classroom.blind import hide
from server.classroom.brier import points
from server.classroom.draw import draw
from server.classroom.hiding import GAME_HINT, Blind, blind_of, clear, hide_on, reveal
from server.classroom.resonance import Resonance, resonance_of
from server.errors import ApiError
from server.security.person import Person
from server.store.base import now
from server.store.change import Change
from server.store.database import Database
from server.store.people import BlindAnswerRow

OF_DRAW = 2**31
"""Numbers that are drawn are below this."""
ALONE_KEPT = 100
"""Kept answers of a single user."""


class Answer(BaseModel):
    """A hidden fault, and the answer to it."""

    id: str
    exercise: str = Field(
        description="Shared by the students who were asked the same; empty: they hid it from themselves"
    )
    class_id: str
    person_id: str
    name: str
    bench: str
    title: str
    seed: int | None = Field(description="For a user outside a class: the same seed hides the same fault")
    state: Literal["hidden", "answered", "revealed"] = "hidden"
    said: str | None = None
    confidence: float | None = None
    points: float = 0.0
    truth: str
    factors: dict[str, dict[str, float]] = Field(description="How each answer differs from the nominal device")
    came_tick: int | None = Field(description="When the fault came; null for a healthy device")
    ended_tick: int | None = None
    took_ms: float | None = Field(None, description="Device time from the fault to the answer; null: none had come")
    verdicts: dict[str, str] = Field({}, description="Verdict of each diagnoser then")
    healthy: Resonance | None = Field(None, description="Response of the device without the fault")
    faulty: Resonance | None = Field(None, description="Response with the fault; null for a device of two axes")
    began: datetime
    ended: datetime | None = None


class Blinds:
    """The hidden faults of all benches, and the answers to them.

    Parameters
    ----------
    database : Database
        Where the answers are kept.
    engine : Engine
        Whose thread changes a bench.
    turn : callable
        Closes the pages of a bench, so that they come back to its present view.
    """

    def __init__(self, database: Database, engine: Engine, turn: Callable[[LiveBench], Awaitable[None]]) -> None:
        self._database, self._engine, self._turn_pages = database, engine, turn
        self._answers: dict[str, Answer] = {}
        self._turn = asyncio.Lock()

    async def recover(self) -> None:
        """Take the answers of the last start back."""
        query = select(BlindAnswerRow).order_by(BlindAnswerRow.began)
        rows = await self._database.run(lambda session: list(session.scalars(query)))
        self._answers = {row.id: Answer.model_validate(row.answer) for row in rows}

    def find(self, question: str) -> Answer | None:
        """Return the answer to a question, by its id."""
        return self._answers.get(question)

    def of_person(self, person_id: str) -> list[Answer]:
        """Return the answers of a person, given or revealed, oldest first."""
        return [one for one in self._answers.values() if one.person_id == person_id and one.state != "hidden"]

    def of_class(self, class_id: str) -> list[Answer]:
        """Return the hidden faults of the exercises of a class, oldest first, answered or not."""
        return [one for one in self._answers.values() if one.class_id == class_id and one.exercise]

    def last_of(self, person_id: str) -> Answer | None:
        """Return the last fault that an exercise hid from a student."""
        found = (one for one in reversed(self._answers.values()) if one.person_id == person_id and one.exercise)
        return next(found, None)

    async def begin(self, session: LiveBench, person: Person, seed: int, shows: bool, secret: str = "") -> None:
        """Hide a fault on an existing bench, by a seed; a student cannot know the fault of a seed beforehand.

        Raises
        ------
        ApiError
            If one is hidden there already, or the past is played.
        InputError
            If the bench has no bank of hypotheses.
        """
        async with self._turn:
            if (there := blind_of(session)) is not None:
                if there.question.game is not None:
                    raise ApiError(409, "blind", "a game is played on this bench", hint=GAME_HINT)
                raise ApiError(409, "blind", "a fault is hidden here already", hint="answer or give up first")
            if session.replay_of:
                raise ApiError(409, "conflict", "a recording that is played has no faults to hide")
            words = [str(seed), *([person.id, str(len(self.of_person(person.id)))] if secret else [])]
            which, when = draw(secret, *words, "fault"), draw(secret, *words, "moment") / OF_DRAW

            id_ = secrets.token_hex(8)

            def chosen() -> Blind:
                return hide(session.board, session.document, id_, shows, which, when)

            def inject() -> None:
                clear(session)
                hide_on(session, chosen(), person.name)

            blind = await self._engine.call(chosen)  # refuses before anything has changed
            await self._database.keep(self.noting(session, person, blind, seed=seed))
            session.view = View(session, blind)  # from here on no page and no program gets more
            await self._turn_pages(session)
            try:
                await self._engine.call(inject)
            except InputError:  # the bench has no such fault
                session.view = None
                self._answers.pop(id_)
                self._database.run_later(_deleted([id_]))
                raise
            finally:
                await self._turn_pages(session)

    def noting(
        self, session: LiveBench, person: Person, blind: Blind, exercise: str = "", seed: int | None = None
    ) -> Change:
        """Note a hidden fault."""
        return self._keeping(_unanswered(session, person, blind, exercise, seed))

    async def commit(self, session: LiveBench, person: Person, said: str, confidence: float) -> Answer:
        """Take an answer, count it and reveal the fault; an answer from before a crash stays unchanged.

        Raises
        ------
        ApiError
            If nothing is hidden here.
        InputError
            If it is none of the answers.
        """
        async with self._turn:
            blind = hidden_on(session)
            answers = blind.question.answers
            if said not in answers:
                raise unknown("answer", said, answers, "said")
            given = {"said": said, "confidence": confidence, "state": "answered"}
            worth = points(said == blind.truth, confidence, len(answers))
            return await self._end(session, person, {**given, "points": worth})

    async def reveal(self, session: LiveBench, person: Person) -> Answer:
        """Reveal a fault without an answer: no points.

        Raises
        ------
        ApiError
            If nothing is hidden here.
        """
        async with self._turn:
            hidden_on(session)
            return await self._end(session, person, {"state": "revealed"})

    def closing(self, session: LiveBench) -> list[Change]:
        """Note that the bench of a hidden fault goes without an answer."""
        blind = blind_of(session)
        known = self._answers.get(blind.question.id) if blind is not None else None
        if known is None or known.state != "hidden":
            return []
        return [self._keeping(known.model_copy(update={"state": "revealed", "ended": now()}))]

    def forgetting(self, class_id: str) -> Change:
        """Forget the answers of a class."""
        statement = delete(BlindAnswerRow).where(BlindAnswerRow.class_id == class_id)

        def take() -> None:
            self._answers = {key: one for key, one in self._answers.items() if one.class_id != class_id}

        return Change(lambda session: session.execute(statement), take)

    async def _end(self, session: LiveBench, person: Person, said: dict[str, object]) -> Answer:
        """Keep how it ended, then serve everything again: a crash between the two reveals on the next try."""
        blind = hidden_on(session)
        answer = self._answers.get(blind.question.id) or _unanswered(session, person, blind)
        if answer.state == "hidden":
            tick, verdicts = await self._engine.call(lambda: (session.board.tick, verdicts_of(session)))
            came = blind.came_tick
            took = (tick - came) * session.dt_ms if came is not None and tick >= came else None
            ending = {"came_tick": came, "ended_tick": tick, "took_ms": took, "verdicts": verdicts, "ended": now()}
            spec, factors = session.board.spec, answer.factors[answer.truth]
            told = {"healthy": resonance_of(spec, {}), "faulty": resonance_of(spec, factors)}
            answer = answer.model_copy(update={**said, **ending, **told})
            await self._database.keep(self._keeping(answer))
        await self._engine.call(reveal, session, person.name)
        await self._turn_pages(session)
        return answer

    def _keeping(self, answer: Answer) -> Change:
        """Keep an answer; without a class the oldest are deleted."""
        row = BlindAnswerRow(
            id=answer.id,
            class_id=answer.class_id or None,
            person_id=answer.person_id,
            began=answer.began,
            answer=answer.model_dump(mode="json"),
        )
        after = {**self._answers, answer.id: answer}
        old = [key for key, one in after.items() if not one.class_id and one.state != "hidden"][:-ALONE_KEPT]

        def write(session: DatabaseSession) -> None:
            session.merge(row)
            _deleted(old)(session)

        def take() -> None:
            self._answers[answer.id] = answer
            for key in old:
                self._answers.pop(key, None)

        return Change(write, take)


def _deleted(ids: list[str]) -> Callable[[DatabaseSession], object]:
    """Return the deletion of the rows of some answers."""
    return lambda session: session.execute(delete(BlindAnswerRow).where(BlindAnswerRow.id.in_(ids)))


def _unanswered(
    session: LiveBench, person: Person, blind: Blind, exercise: str = "", seed: int | None = None
) -> Answer:
    """Return the record of a hidden fault without an answer."""
    return Answer(
        id=blind.question.id,
        exercise=exercise,
        class_id=session.class_id,
        person_id=person.id,
        name=person.name,
        bench=session.id,
        title=session.scenario.head.title or session.scenario.id,
        seed=seed,
        truth=blind.truth,
        factors=dict(zip(blind.question.answers, blind.question.factors, strict=True)),
        came_tick=blind.came_tick,
        began=now(),
    )


def hidden_on(session: LiveBench) -> Blind:
    """Return the hidden part of a bench, or refuse."""
    if (blind := blind_of(session)) is None:
        raise ApiError(409, "conflict", "no fault is hidden on this bench")
    if blind.question.game is not None:
        raise ApiError(409, "conflict", "a game is played on this bench", hint=GAME_HINT)
    return blind


def verdicts_of(session: LiveBench) -> dict[str, str]:
    """Return the present verdict of each diagnoser (a job of the engine)."""
    return {
        name: score.names[score.winner] if 0 <= score.winner < len(score.names) else "none"
        for name, score in session.board.scores().items()
    }
