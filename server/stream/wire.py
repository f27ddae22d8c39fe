"""Every text message of the stream, both ways."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, model_validator

from scenarios.narrator.sentence import Sentence
from server.bench.captures import Capture
from server.bench.commands import Command
from server.bench.events import Event
from server.bench.status import Bench, BenchStatus
from server.errors import ErrorBody
from server.stream.codec import WIRE

SUBPROTOCOL = f"combbench.v{WIRE}"
MAX_PANELS = 32
MAX_SIGNALS = 32
MAX_BEHIND = 8
MAX_COLUMNS = 4096
MAX_POINTS = 262_144
MAX_TICK = 2**53

Panel = Annotated[int, Field(ge=0, le=65535, description="The client's number of the panel")]


class Message(BaseModel):
    """A message of a client: unknown fields and numbers that are not finite are refused."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


class TriggerSpec(Message):
    """The trigger of a panel; it sets the moment of the picture."""

    signal: str = Field(max_length=200)
    edge: Literal["rising", "falling", "either", "enters", "leaves"] = Field(
        "rising", description="Of the level; or the signal enters or leaves the window from it to the upper level"
    )
    level: float = 0.0
    upper: float | None = Field(None, description="Upper level of the window; more than the level")
    hysteresis: float = Field(0.0, ge=0, description="How far the signal must go back before the next trigger")
    position: float = Field(0.1, ge=0, le=1, description="Share of the window before the trigger")
    sweep: Literal["auto", "normal", "single"] = "auto"

    @model_validator(mode="after")
    def _has_its_window(self) -> TriggerSpec:
        if self.edge in ("enters", "leaves"):
            if self.upper is None:
                raise ValueError("give the upper level of the window")
            if not self.upper > self.level:
                raise ValueError("the upper level of the window must be above the level")
        return self


class BehindSpec(Message):
    """Another bench whose signals of the same names are shown behind the signals of a panel."""

    bench: str = Field(max_length=64)
    shift_ticks: int = Field(0, ge=-MAX_TICK, le=MAX_TICK, description="Its tick minus the tick of this bench")


class Subscribe(Message):
    """Show signals in a panel; a second one for the same panel replaces the first.

    The frame has the signals of the bench, then for each bench behind them the same once more.
    """

    type: Literal["subscribe"]
    panel: Panel
    signals: list[Annotated[str, Field(max_length=200)]] = Field(min_length=1, max_length=MAX_SIGNALS)
    mode: Literal["roll", "frozen", "triggered"] = "roll"
    width: int = Field(800, ge=1, le=MAX_COLUMNS, description="Columns: one per pixel")
    window_ms: float | None = Field(None, gt=0, le=1e9)
    start_tick: int | None = Field(None, ge=-MAX_TICK, le=MAX_TICK)
    end_tick: int | None = Field(None, ge=-MAX_TICK, le=MAX_TICK)
    trigger: TriggerSpec | None = Field(
        None, description="Of a frozen panel, with window_ms: the scope whose captures it looks at"
    )
    behind: list[BehindSpec] = Field([], max_length=MAX_BEHIND)

    @model_validator(mode="after")
    def _has_its_span(self) -> Subscribe:
        """Each mode needs its own fields."""
        if self.mode == "frozen":
            if self.start_tick is None or self.end_tick is None or self.end_tick <= self.start_tick:
                raise ValueError("mode frozen needs start_tick < end_tick")
        elif self.window_ms is None:
            raise ValueError(f"mode {self.mode} needs window_ms")
        if self.mode == "triggered" and self.trigger is None:
            raise ValueError("mode triggered needs trigger")
        return self


class Rearm(Message):
    """Take one more picture of a panel in single sweep."""

    type: Literal["rearm"]
    panel: Panel


class Unsubscribe(Message):
    """Stop sending a panel."""

    type: Literal["unsubscribe"]
    panel: Panel


class Ack(Message):
    """The client has drawn (or taken) every frame up to this one."""

    type: Literal["ack"]
    frame: int = Field(ge=0, lt=2**32)


class Took(Message):
    """The client has taken so many statuses of this stream; from then on the server sends a few more at most."""

    type: Literal["took"]
    statuses: int = Field(ge=0, lt=2**32)


class Resume(Message):
    """Send every event after the event number ``after``: the first message after a reconnect."""

    type: Literal["resume"]
    after: int = Field(ge=0)


class Pong(Message):
    """The answer to a ping."""

    type: Literal["pong"]


class CommandMessage(Message):
    """A command; answered by a reply with the same id."""

    type: Literal["command"]
    id: str = Field(max_length=64)
    command: Command


ClientMessage = Annotated[
    Subscribe | Rearm | Unsubscribe | Ack | Took | Resume | Pong | CommandMessage, Field(discriminator="type")
]
CLIENT_MESSAGE: TypeAdapter[Any] = TypeAdapter(ClientMessage)


class Hello(BaseModel):
    """The first message of the server."""

    type: Literal["hello"] = "hello"
    wire: int = WIRE
    server: str = Field(description="Changes with every start of the server")
    bench: Bench
    last_event: int


class Status(BenchStatus):
    """The changing part of a bench: sent five times a second, and after events at most twenty times."""

    type: Literal["status"] = "status"
    parameters: dict[str, Any] | None = Field(None, description="The scenario as it is now; null: unchanged")
    dropped_frames: int = Field(description="Frames this client was too slow for")


class EventsMessage(BaseModel):
    """Events since the last such message, numbered without gaps."""

    type: Literal["events"] = "events"
    events: list[Event]


class Narrated(BaseModel):
    """The sentences of the narrator after the first ``after`` of the present run; any others are void."""

    type: Literal["narration"] = "narration"
    after: int
    sentences: list[Sentence]


class CaptureMark(BaseModel):
    """A capture of a triggered panel."""

    tick: int = Field(description="The first tick beyond the crossing")
    trigger_tick: float = Field(description="Its place between ticks, on the line between them")
    start_tick: int
    end_tick: int

    @classmethod
    def of(cls, capture: Capture) -> CaptureMark:
        """Describe a capture."""
        crossing = capture.crossing
        return cls(tick=crossing.tick, trigger_tick=crossing.at, start_tick=capture.start, end_tick=capture.stop)


class CaptureList(BaseModel):
    """The captures kept of the trigger of a panel, oldest first: sent when they have changed.

    Frozen panels show them at full rate, also where the history has gone on.
    """

    type: Literal["captures"] = "captures"
    panel: int
    captures: list[CaptureMark]
    most: int = Field(description="Captures of one trigger")
    is_short: bool = Field(description="Memory leaves room for fewer, or the bench keeps captures of too many triggers")


class Reply(BaseModel):
    """The answer to a command."""

    type: Literal["reply"] = "reply"
    id: str
    ok: bool
    tick: int | None = None
    error: ErrorBody | None = None


class ErrorMessage(BaseModel):
    """A message of the client was refused; the connection stays."""

    type: Literal["error"] = "error"
    error: ErrorBody


class Notice(BaseModel):
    """Something the person should know about this connection."""

    type: Literal["notice"] = "notice"
    code: Literal["slow_client", "events_lost", "shutdown", "ask_me"] = Field(
        description="ask_me: the view or the rights of this person have changed; read /me"
    )
    message: str


class Ping(BaseModel):
    """Asks the page of the driver for a sign; the page answers at once by a pong."""

    type: Literal["ping"] = "ping"


ServerMessage = Hello | Status | EventsMessage | Narrated | CaptureList | Reply | ErrorMessage | Notice | Ping
