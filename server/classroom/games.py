"""Games for one person or for a class: their benches, the answers, and the time of revealing."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from pydantic import BaseModel, Field

from scenarios.campaign.executor import LOST, Processes
from scenarios.games import game_of, judged
from scenarios.games.draw import BENCH
from scenarios.games.game import DIAGNOSER, Fact, Game, Kind, Outcome
from server.bench.bench import LiveBench
from server.bench.benches import Benches
from server.bench.engine import Engine
from server.bench.status import Played
from server.classroom.blind import play
from server.classroom.classes import Classes
from server.classroom.game_table import Attempt, GameTable, Standing, Turns
from server.classroom.hiding import HINT, Blind, blind_of, from_the_start, reveal
from server.classroom.student_benches import Swap
from server.errors import ApiError
from server.security.person import Person


class Play(BaseModel):
    """A game at a seed, as the player may see it."""

    game: str
    seed: int
    kinds: list[Kind] = Field(description="The faults that can be named, if one is to be named")
    left: int = Field(description="How often the caller may still hand in")
    attempts: list[Attempt] = Field(description="The caller's own, oldest first")
    best: float | None = Field(description="The most points of all in the table")
    table: list[Standing] = Field(description="Most points first, of the same the earlier first")
    hidden: list[Fact] | None = Field(
        description="The hidden values of the seed; null while the caller may still hand in"
    )
    bench: str | None = Field(description="The bench on which the caller plays it")


class StudentGame(BaseModel):
    """The game of a student."""

    name: str
    draw: int = Field(description="The seed that gives the same game headless; it is secret")
    hidden: list[Fact]


class ClassGame(BaseModel):
    """A game of a class, as its teacher sees it."""

    table: list[Standing]
    students: list[StudentGame] = Field(description="In the order in which they came; each has a game of their own")


class Games:
    """The games that are played on this server.

    Parameters
    ----------
    table : GameTable
        Where the attempts are kept.
    classes : Classes
        From whose secrets games are drawn, with the benches of their students.
    benches : Benches
        Where benches are made.
    engine : Engine
        Whose thread changes a bench.
    processes : Processes
        Processes that judge.
    workers : int
        How many hand-ins are judged at once; 0 for none.
    turn : callable
        Closes the pages of a bench, so that they come back to its present view.
    swap : callable
        Lets a bench take the place of others.
    """

    def __init__(
        self,
        table: GameTable,
        classes: Classes,
        benches: Benches,
        engine: Engine,
        processes: Processes,
        workers: int,
        turn: Callable[[LiveBench], Awaitable[None]],
        swap: Swap,
    ) -> None:
        self._table, self._classes, self._benches, self._engine = table, classes, benches, engine
        self._processes, self._turn_pages, self._swap = processes, turn, swap
        self._is_open, self._room = workers > 0, asyncio.Semaphore(max(1, workers))
        self._judging: set[str] = set()

    async def view(self, person: Person, name: str, seed: int) -> Play:
        """Show a game at a seed to a player."""
        number = await self._drawn(person, name, seed)
        return await self._shown(person, name, seed, number, *await self._table.of(person, name, seed))

    async def _shown(
        self, person: Person, name: str, seed: int, number: int, turns: Turns, table: list[Standing]
    ) -> Play:
        """Show a game; the settings of others come with the last attempt."""
        game = game_of(name)
        left = _left(game, turns)
        bench = self._bench_of(person, Played(game=name, seed=seed))
        return Play(
            game=name,
            seed=seed,
            kinds=game.kinds(number),
            left=left,
            attempts=turns.attempts,
            best=table[0].points if table else None,
            table=[line if line.mine or left == 0 else line.model_copy(update={"handed_in": None}) for line in table],
            hidden=await asyncio.to_thread(game.hidden, number) if left == 0 else None,
            bench=bench.id if bench is not None else None,
        )

    async def of_class(self, teacher: Person, class_id: str, name: str, seed: int) -> ClassGame:
        """Show a game of a class to its teacher."""
        game, students = game_of(name), self._classes.students(class_id)
        numbers = [await self._drawn(student, name, seed) for student in students]
        hidden = await asyncio.to_thread(lambda: [game.hidden(number) for number in numbers])
        return ClassGame(
            table=await self._table.of_class(class_id, name, seed, teacher),
            students=[
                StudentGame(name=student.name, draw=number, hidden=facts)
                for student, number, facts in zip(students, numbers, hidden, strict=True)
            ],
        )

    async def begin(self, person: Person, name: str, seed: int, values: Mapping[str, Any]) -> Play:
        """Give a player the bench of a game; answers stay, and a game that is over hides nothing any more.

        Raises
        ------
        InputError
            If the bank cannot be set so.
        ApiError
            If a fault is hidden on the bench of a student.
        """
        game, number = game_of(name), await self._drawn(person, name, seed)
        played = Played(game=name, seed=seed)
        handed = game.read(number, values) if values else None
        document = await asyncio.to_thread(game.bench, number, handed)
        seen = await self._table.of(person, name, seed)
        over = _left(game, seen[0]) == 0

        def hide(_: object) -> Blind:
            may_set = [f"diagnosers.{DIAGNOSER}.{field}" for field in game.turned]
            faults = [kind.name for kind in game.kinds(number)]
            return play(played, secrets.token_hex(8), BENCH, may_set, faults, DIAGNOSER)

        wanted: dict[str, Any] = {
            "source": document,
            "values": {},
            "seed": None,
            "paused": False,
            "time_scale": None,
            "own_scale": True,
        }
        if person.role == "student":
            blind = blind_of(await self._classes.benches.get(person))
            if blind is not None and blind.question.game is None:
                raise ApiError(409, "blind", "a fault is hidden on your bench", hint=HINT)
            await self._classes.benches.replace(person, wanted, None if over else hide)
        else:
            before = self._benches_of(person)
            made = await self._benches.create(**wanted, before=from_the_start(None if over else hide))
            await self._swap(made, before)
        return await self._shown(person, name, seed, number, *seen)

    async def hand_in(self, person: Person, name: str, seed: int, values: Mapping[str, Any]) -> Play:
        """Judge the answer of a player, and keep it.

        Raises
        ------
        InputError
            If it is none.
        ApiError
            If a player has no attempt left, or hands in twice at once.
        """
        if not self._is_open:
            raise ApiError(409, "runs_disabled", "this server takes no headless runs (run_workers = 0)")
        game, number = game_of(name), await self._drawn(person, name, seed)
        handed = game.read(number, values)
        if person.id in self._judging:
            raise ApiError(409, "conflict", "what you handed in before is still judged", hint="wait for its points")
        self._judging.add(person.id)
        try:
            turns, _ = await self._table.of(person, name, seed)
            if not _left(game, turns):
                text = f"you have no attempt left at seed {seed}"
                raise ApiError(409, "limit", text, hint="take another seed")
            outcome = await self._judged(name, number, handed.model_dump())
            seen = await self._table.add(person, name, seed, handed.model_dump(), outcome)
        finally:
            self._judging.discard(person.id)
        await self._tell(person, game, seed, seen[0])
        return await self._shown(person, name, seed, number, *seen)

    async def look(self, person: Person, name: str, seed: int) -> Play:
        """Show a player the hidden values of a game; no answer can be handed in after that."""
        game, number = game_of(name), await self._drawn(person, name, seed)
        if person.id in self._judging:
            raise ApiError(409, "conflict", "what you handed in is still judged", hint="wait for its points")
        seen = await self._table.of(person, name, seed)
        if _left(game, seen[0]):
            seen = await self._table.looked(person, name, seed)
        await self._tell(person, game, seed, seen[0])
        return await self._shown(person, name, seed, number, *seen)

    async def _drawn(self, person: Person, name: str, seed: int) -> int:
        """Return the seed of a game; for a student it is drawn from the secret of the class and the student."""
        return await self._classes.draw(person, "game", name, str(seed)) if person.class_id else seed

    async def _judged(self, name: str, number: int, handed: dict[str, Any]) -> Outcome:
        """Judge in a process of its own: it takes a second of computing."""
        async with self._room:
            try:
                work = await asyncio.to_thread(self._processes.submit, judged, name, number, handed)
                return await asyncio.wrap_future(work)
            except LOST as error:
                text = "the process that judges was lost; nothing is counted"
                raise ApiError(503, "unavailable", text, hint="hand in again") from error

    async def _tell(self, person: Person, game: Game[Any], seed: int, turns: Turns) -> None:
        """Let the bench of a game that is over show everything."""
        session = self._bench_of(person, Played(game=game.id, seed=seed))
        if session is None or _left(game, turns):
            return
        await self._engine.call(reveal, session, person.name)
        await self._turn_pages(session)

    def _benches_of(self, person: Person) -> list[LiveBench]:
        """Return the benches on which a player plays."""
        if person.role == "student":
            found = self._classes.benches.find(person)
            there = [found] if found is not None else []
        else:
            there = [session for session in self._benches.all() if not session.class_id]
        return [one for one in there if (blind := blind_of(one)) is not None and blind.question.game is not None]

    def _bench_of(self, person: Person, played: Played) -> LiveBench | None:
        """Return the bench on which a player plays a game at a seed."""
        for session in self._benches_of(person):
            if (blind := blind_of(session)) is not None and blind.question.game == played:
                return session
        return None


def _left(game: Game[Any], turns: Turns) -> int:
    """Return the number of attempts left."""
    return 0 if turns.looked else max(0, game.attempts - len(turns.attempts))
