"""The stream of a bench: one WebSocket per page."""

from __future__ import annotations

import asyncio
import json
import logging
import re
from typing import Any

from fastapi import WebSocket, WebSocketDisconnect
from pydantic import BaseModel, ValidationError

from core.errors import InputError
from core.format import format_short
from server.api.bodies import strict_json
from server.api.deps import ServiceDep, rate_limited
from server.api.router import Router
from server.bench.bench import LiveBench, Seen
from server.bench.events import Event
from server.classroom.access import Need
from server.errors import ApiError, ErrorBody, body_of, clear_line, not_found
from server.security.limits import Bucket
from server.security.person import Person
from server.service import Service
from server.stream.behind import Behind
from server.stream.client import CLOSE_FAILED, Client
from server.stream.hub import CLOSE_FULL, CLOSE_NO_BENCH
from server.stream.line import WebSocketLine
from server.stream.panel import Panel
from server.stream.wire import (
    CLIENT_MESSAGE,
    MAX_PANELS,
    MAX_POINTS,
    SUBPROTOCOL,
    Ack,
    BehindSpec,
    CommandMessage,
    ErrorMessage,
    Hello,
    Pong,
    Rearm,
    Reply,
    Resume,
    Subscribe,
    Took,
    Unsubscribe,
)

router = Router(tags=["stream"])
log = logging.getLogger(__name__)

CLOSE_VERSION, CLOSE_FLOOD = 4001, 1008

ACK = re.compile(rb'\{"type": ?"ack", ?"frame": ?(\d{1,10})\}')
TOOK = re.compile(rb'\{"type": ?"took", ?"statuses": ?(\d{1,10})\}')
"""Acknowledgements as pages write them; any other spelling is parsed like other messages."""

CLOSE_S = 1.0
"""A client that has not taken the close after this long is cut off."""

FLOOD_RATE, FLOOD_BURST = 500.0, 2000
"""Messages of any kind; sixty frames a second need sixty acknowledgements."""


@router.websocket("/benches/{bench_id}/stream")
async def stream(socket: WebSocket, bench_id: str, service: ServiceDep) -> None:
    """Let a page watch and command a bench."""
    offered = socket.scope["subprotocols"]
    session = service.benches.find(bench_id)
    refusal: tuple[int, str] | None = None
    if SUBPROTOCOL not in offered:
        refusal = (CLOSE_VERSION, f"this server speaks {SUBPROTOCOL}: reload the page")
    elif session is None:
        refusal = (CLOSE_NO_BENCH, "there is no such bench")
    else:
        try:
            service.hub.check_room(bench_id)
        except ApiError as error:
            refusal = (CLOSE_FULL, error.body.message)
    if refusal or session is None:
        await socket.accept(subprotocol=next(iter(offered), None))
        await socket.close(*(refusal or (CLOSE_NO_BENCH, "")))
        return
    await socket.accept(subprotocol=SUBPROTOCOL)
    person: Person = socket.scope["person"]
    seen, bench = service.views.seen(session, person), service.views.of(session, person)
    hub, line = service.hub, WebSocketLine.of(socket)
    room = hub.room(seen)
    client = Client(line, seen, service.metrics.sent, room.news, room.cuts, bench.last_event, person, hub.clock)
    conversation = Conversation(client, session, service, person)
    hub.add(client)
    if not person.is_teacher:
        client.name = person.name
    line.hear, line.drained = conversation.hear, client.flush
    client.post(Hello(server=service.id, bench=bench, last_event=bench.last_event))
    service.driving.come(bench_id, person)
    tasks = [asyncio.create_task(part) for part in (conversation.run(socket), client.closed.wait())]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        hub.remove(client)
        service.driving.go(bench_id, person)
        if service.benches.find(bench_id):
            service.idling.saw(bench_id)
        for task in tasks:
            task.cancel()
        for outcome in await asyncio.gather(*tasks, return_exceptions=True):
            if isinstance(outcome, Exception):
                log.error("a stream of bench %s broke off", bench_id, exc_info=outcome)
                client.close(CLOSE_FAILED, "the server failed on this stream; its log says why")
        await _close(socket, client)


async def _close(socket: WebSocket, client: Client) -> None:
    """Close with the reason; cut the line if the client does not take the close."""
    code, reason = client.closing or (1000, "")
    try:
        async with asyncio.timeout(CLOSE_S):
            await socket.close(code, reason)
        # The close may be in a buffer that is never emptied; a line that ended meanwhile is not touched.
        asyncio.get_running_loop().call_later(CLOSE_S, client.line.cut)
    except TimeoutError:
        client.line.cut()
    except (RuntimeError, WebSocketDisconnect):
        pass  # the other side has gone first


class Conversation:
    """The receiving half of a stream: it answers every message, and no message can harm the server.

    Parameters
    ----------
    client : Client
        The sending half.
    bench : LiveBench
        The bench that commands go to.
    service : Service
        Benches and limits.
    person : Person
        Whose page it is.
    """

    def __init__(self, client: Client, bench: LiveBench, service: Service, person: Person) -> None:
        self._client, self._bench, self._service, self._person = client, bench, service, person
        settings = service.settings
        self._messages = Bucket(FLOOD_RATE, FLOOD_BURST, service.clock)
        self._commands = Bucket(settings.command_rate_per_s, settings.command_burst, service.clock)
        self._subscribed: dict[int, int] = {}

    def hear(self, text: bytes) -> bool:
        """Take an acknowledgement at once: pages send one for each frame and status, and no answer is needed."""
        for form, note in ((ACK, self._client.acknowledge), (TOOK, self._client.took)):
            found = form.fullmatch(text)
            if found is not None and int(found[1]) < 2**32:
                if self._is_heard():
                    note(int(found[1]))
                return True
        return False

    async def run(self, socket: WebSocket) -> None:
        """Read messages until the client leaves or sends too many."""
        while True:
            message = await socket.receive()
            if message["type"] == "websocket.disconnect" or not self._is_heard():
                return
            await self._read(message.get("text"))

    def _is_heard(self) -> bool:
        """Count a message; close the stream of a client that sends too many."""
        if self._messages.take():
            return True
        if self._client.closing is None:
            self._service.metrics.streams_closed.labels("flooding").inc()
            self._client.close(CLOSE_FLOOD, "too many messages")
        return False

    async def _read(self, text: str | None) -> None:
        """Parse one message and carry it out, or answer in one line why not."""
        document: Any = None
        try:
            if text is None:
                raise InputError("messages to the server are JSON text", code="malformed")
            document = strict_json(text)
            if not isinstance(document, dict):
                raise InputError("a message must be a JSON object with a type")
            await self._do(CLIENT_MESSAGE.validate_python(document, strict=True))
        except json.JSONDecodeError as error:
            self._refuse(None, ErrorBody(code="malformed", message=f"not valid JSON: {error.msg}"))
        except ValidationError as error:
            self._refuse(document, _line(error))
        except (InputError, ApiError) as error:
            self._refuse(document, body_of(error))
        except Exception:
            log.exception("unexpected error in a message to bench %s", self._client.session.id)
            text = "the server failed on this message; its log says why"
            self._refuse(document, ErrorBody(code="internal", message=text))

    async def _do(self, message: BaseModel) -> None:
        """Carry out a valid message."""
        client = self._client
        if isinstance(message, Ack):
            client.acknowledge(message.frame)
        elif isinstance(message, Took):
            client.took(message.statuses)
        elif isinstance(message, CommandMessage):
            await self._command(message)
        elif isinstance(message, Subscribe):
            self._subscribe(message)
        elif isinstance(message, Unsubscribe):
            client.panels.pop(message.panel, None)
        elif isinstance(message, Rearm):
            panel = client.panels.get(message.panel)
            if panel is None:
                raise InputError(f"panel {message.panel} is not subscribed", "panel")
            panel.view.rearm(client.session.history.end_tick)
            client.cuts.refresh()
            client.offer(frame=True)
        elif isinstance(message, Resume):
            client.resume(message.after)
        elif isinstance(message, Pong):
            self._service.driving.heard(client.session.id, self._person)

    async def _command(self, message: CommandMessage) -> None:
        """Carry out a command and reply with its tick; further messages are read while a step runs."""
        if not self._commands.take():
            raise rate_limited(self._service.settings)
        if not self._service.people.may(self._person, Need.DRIVE, self._client.session.id):
            raise ApiError(403, "forbidden", "you watch this bench and may not change it")
        self._service.driving.check(self._client.session.id, self._person)

        def done(event: Event) -> None:
            self._client.answer(Reply(id=message.id, ok=True, tick=event.tick))

        outcome = await self._service.benches.begin(self._bench, message.command, self._client.name)
        if isinstance(outcome, Event):
            done(outcome)
        else:
            asyncio.wrap_future(outcome).add_done_callback(lambda step: done(step.result()))

    def _subscribe(self, message: Subscribe) -> None:
        """Show signals in a panel."""
        client, session = self._client, self._client.session
        indices = session.indices(message.signals)
        trigger = None
        if message.mode != "roll" and message.trigger is not None and message.window_ms is not None:
            try:
                (trigger,) = session.indices([message.trigger.signal])
            except InputError as error:
                raise InputError(error.message, "trigger.signal", error.hint, error.code) from None
        others = [panel for number, panel in client.panels.items() if number != message.panel]
        if len(others) >= MAX_PANELS:
            raise InputError(f"{MAX_PANELS} panels are shown, the limit", "panel")
        behind = [self._behind(spec, at, message.signals) for at, spec in enumerate(message.behind)]
        points = sum(panel.points for panel in others) + len(indices) * message.width * (1 + len(behind))
        if points > MAX_POINTS:
            raise InputError(f"all panels together have {points} points; at most {MAX_POINTS}", "width")
        revision = self._subscribed[message.panel] = self._subscribed.get(message.panel, 0) + 1
        client.cuts.refresh()
        client.panels[message.panel] = Panel(client.cuts.view(message, indices, trigger, behind), revision)
        client.offer(frame=True)

    def _behind(self, spec: BehindSpec, at: int, names: list[str]) -> Behind:
        """Return a bench behind a panel, as this person may see it at any time."""
        service, person = self._service, self._person

        def find() -> Seen | None:
            session = service.benches.find(spec.bench)
            if session is None or not service.people.may(person, Need.WATCH, spec.bench):
                return None
            return service.views.seen(session, person)

        other = find()
        if other is None:
            raise not_found("bench", spec.bench, field=f"behind.{at}.bench")
        if other.dt_ms != self._bench.dt_ms:
            rate = format_short(1.0 / other.dt_ms, "kHz")
            raise InputError(f"bench {spec.bench} runs at {rate}, this one does not", f"behind.{at}.bench")
        return Behind(names, spec.shift_ticks, find)

    def _refuse(self, document: Any, error: ErrorBody) -> None:
        """Answer a command by a reply with its id, any other message by an error."""
        is_command = isinstance(document, dict) and document.get("type") == "command"
        command_id = document.get("id") if is_command else None
        if isinstance(command_id, str) and len(command_id) <= 64:
            self._client.post(Reply(id=command_id, ok=False, error=error))
        else:
            self._client.post(ErrorMessage(error=error))


def _line(error: ValidationError) -> ErrorBody:
    """Describe the error of a message; the type of the message, which pydantic adds to the place, is left out."""
    return clear_line([{**complaint, "loc": complaint["loc"][1:]} for complaint in error.errors(include_url=False)])
