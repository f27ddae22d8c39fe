"""A bench as the API shows it: its fixed and its changing part."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import BaseModel, Field

from core.board.commands import COMMANDS, Trip
from core.board.document import Document
from core.cards import BlockCard
from core.faults.fault import Profile
from core.loop.score import Scores
from core.signals import Signal
from scenarios.json_schema.components import described_by

State = Literal["running", "paused", "tripped"]


class ActiveFault(BaseModel):
    """A fault on the device now."""

    name: str
    severity: float
    profile: Profile
    parameters: dict[str, Any] = Field(default={}, description="Its other parameters, chosen or default")
    since_tick: int


class Pending(BaseModel):
    """A command that waits for its moment."""

    text: str
    actor: str
    tick: int | None
    when: str | None
    command: Annotated[Document, described_by(*(one.__name__ for one in COMMANDS.values()))] = Field(
        description="As an event of a scenario"
    )


class Snapshot(BaseModel):
    """A moment that can be gone back to."""

    id: str
    tick: int
    name: str
    created: datetime


class Undoable(BaseModel):
    """A change that can be taken back or made again."""

    seq: int = Field(description="Number of its event")
    text: str = Field(description="The change in words")


class Somebody(BaseModel):
    """A person at a bench."""

    id: str
    name: str


class Company(BaseModel):
    """The users of a bench that several have open."""

    is_leased: bool = Field(description="Two or more who may drive have it open, so only one of them does")
    driver: Somebody | None = Field(
        description="The driver; null: none, and the next person who gives a command drives"
    )
    drivers: list[Somebody] = Field(description="Present persons who may drive")
    asking: list[Somebody] = Field(description="Persons who have requested the bench")
    lent_by: str = Field(description="Id of the person who handed it over and may take it back; empty: none")
    watching: list[str] = Field(description="Names of students who watch")
    more_watching: int = Field(description="And so many more")
    links: int = Field(description="Pages opened by links to watch")


class Origin(BaseModel):
    """The moment of another bench from which a bench continues."""

    bench: str = Field(description="The other bench, which may be gone by now")
    tick: int
    window_ticks: int = Field(description="Ticks before it that were computed again too")
    is_past: bool = Field(True, description="It shows that moment still and may seek another; it has not gone on")


class Travel(BaseModel):
    """A requested moment of the past that is computed again now."""

    tick: int
    share: float = Field(description="Finished ticks of the ticks that it takes")


class SupervisorAct(BaseModel):
    """An act of the supervisor."""

    tick: int
    text: str = Field(description="The act in words: sets LQG to mass × 1.05")
    reason: str


class SupervisorStatus(BaseModel):
    """The supervisor now: its verdict, and its last act."""

    kind: str
    diagnoser: str
    verdict: str = Field(description="Hypothesis that the weights name now; 'none fits', or empty without a verdict")
    acting: str = Field(description="Verdict that was acted on last, in the same words")
    held_ms: float | None = Field(description="Time for which the verdict has lasted; null: it has no verdict")
    dead_ms: float | None = Field(description="Time left in which nothing counts; null: it has no such time")
    acts: int = Field(description="Acts so far")
    last_act: SupervisorAct | None


class InstrumentStatus(BaseModel):
    """The instrument whose samples a bench plays as they come."""

    source: str
    is_connected: bool = Field(description="Whether it sends; the bench waits for one that is gone")
    is_growing: bool = Field(description="Whether more samples may come; else the board trips at the end of the record")
    ended: str = Field(description="Why no more samples come, and where the record is kept; empty: it grows")
    names: list[str] = Field(description="Its names of drive and displacement")
    received_khz: float = Field(description="Samples for each ms that came lately")
    lag_ms: float = Field(description="Time for which the oldest block waits that the board has not played")
    latency_p95_ms: float | None = Field(
        description="95th percentile of the time from the arrival of a block to its last verdict; null: no verdict yet"
    )
    record: str = Field(description="Key of the record that grows from it")
    samples: int = Field(description="Samples of the record so far")
    blocks: int
    lost_blocks: int
    late_blocks: int
    doubled_blocks: int
    lost_samples: int = Field(description="Samples that are missing; the measurement is held meanwhile")
    breaks: int = Field(description="Gaps of unknown length, each marked by one lost sample")


class BenchStatus(BaseModel):
    """The changing part of a bench."""

    state: State
    tick: int = Field(description="The next tick to be computed")
    first_tick: int = Field(description="The oldest tick of the history")
    time_scale: float | None = Field(description="Device seconds per wall second wanted; null: no limit")
    achieved_scale: float = Field(description="Device seconds per wall second over the last second")
    fast_forward: Literal["quiet_lead", "skip"] | None = Field(
        description="Why it runs as fast as possible now, whatever its time scale: to be shortly before what waits"
    )
    capped: bool = Field(description="The machine has been below 80 % of the rate for 3 s")
    overruns: int = Field(description="Rounds that missed their target")
    given_up_ms: float = Field(description="Wall time dropped while catching up")
    controller: str = Field(description="The controller that drives, of the last slot where there are several")
    slots: dict[str, str] = Field(description="The controller that drives in each slot, in their order")
    faults: list[ActiveFault]
    pending: list[Pending] = Field(description="Commands that wait for their moment")
    undo: Undoable | None = Field(None, description="The change that undo takes back")
    redo: Undoable | None = Field(None, description="The change that redo makes again")
    trip: Trip | None
    supervisor: SupervisorStatus | None = Field(None, description="The supervisor, if the bench has one")
    instrument: InstrumentStatus | None = Field(None, description="The instrument that it plays, if it does")
    scores: dict[str, Scores] = Field(description="Of each diagnoser that has judged a sample, against the truth")
    last_event: int
    recording: list[str] = Field(description="Recordings under way")
    armed: list[str] = Field(description="Recordings that wait for their condition")
    earliest_tick: int | None = Field(None, description="The first tick that can be computed again; null: none can")
    origin: Origin | None = Field(None, description="Its first moment, if it was forked at a tick")
    travel: Travel | None = Field(
        None, description="A moment of its past that is being computed; seeking another ends it"
    )
    watchers: int = 0
    company: Company | None = Field(None, description="Its users; null while it is one person")
    is_stuck: bool = Field(False, description="The engine hangs for good: the server has to be restarted")
    loop_lag_ms: float = Field(0.0, description="99th percentile of the event loop's lateness, last minute")
    wake_late_ms: float = Field(0.0, description="99th percentile of the engine's lateness, last minute")


class Opened(BaseModel):
    """How a bench came from an experiment that was kept."""

    link: str | None = Field(description="The link it was opened by; null: it was closed while idle and came back")
    note: str
    version: str = Field(description="Version of the program and hash of the code the experiment was made with")
    version_now: str
    same_bits: bool = Field(description="Whether repeating it has given the bits it had then")


class Played(BaseModel):
    """The game that is played on a bench."""

    game: str
    seed: int


class HiddenQuestion(BaseModel):
    """The words people get about a hidden fault, or about the game that is played."""

    id: str
    game: Played | None = Field(None, description="Of a game, which has no answers; null for a hidden fault")
    answers: list[str] = Field(description="One of these is true, each as likely as the others")
    factors: list[dict[str, float]] = Field(description="How each differs from the nominal device")
    shows: list[str] = Field(description="Diagnosers that may be looked at; none unless the exercise is about trust")
    began_tick: int
    by_tick: int = Field(description="The fault has come by then, if there is one")


class BenchRecord(BaseModel):
    """A record of a real device that a bench plays: nothing can act on it."""

    key: str
    samples: int
    labels: list[str] = Field(description="Names of its labels; empty: the truth is not known, and so no score")


class DiagnoserInfo(BaseModel):
    """The hypotheses of a diagnoser, in the order of its indices."""

    kind: str
    names: list[str]
    factors: list[dict[str, float]] = Field(description="How each differs from the nominal device")


class Bench(BenchStatus):
    """A live bench."""

    id: str
    title: str
    scenario_id: str
    source: str
    created: datetime
    seed: int
    dt_ms: float
    sample_rate_khz: float
    samples: int | None = Field(description="Where the scenario ends; the bench pauses there once")
    drive_period_ticks: float | None
    history_ticks: int
    axes: list[str] = Field(description="Axes the plant moves along; none for one displacement")
    signals: list[Signal]
    controllers: list[str]
    diagnosers: dict[str, DiagnoserInfo]
    units: list[BlockCard] = Field([], description="Its units that are not of the library, as the catalogue has them")
    parameters: dict[str, Any] = Field(description="The scenario as it is now, every live change in it")
    view3d: str | None = Field(description="Path of the 3D page, if there is one")
    replay_of: str | None = Field(None, description="The recording it plays; such a bench takes no changes")
    record: BenchRecord | None = Field(None, description="The record of a device that plays in place of its plant")
    recorded_scale: float | None = Field(None, description="Device seconds per wall second it was recorded at")
    opened: Opened | None = Field(None, description="The experiment it was opened from, if it was")
    blind: HiddenQuestion | None = Field(
        None, description="Asked while a fault is hidden here; little else is served then"
    )
    name: str = Field("", description="Its name in addition to the title, such as a branch: with PID")
    keep: bool = Field(False, description="It stays open while unused")
    let_go_in_s: float | None = Field(None, description="Time until it is closed if unused; null: it stays")
