"""The short way of messages: the same messages as the parser of the library finds, however they are cut."""

from __future__ import annotations

import asyncio
import itertools
import json
from typing import Any
from unittest.mock import Mock

import pytest
from hypothesis import given
from hypothesis import strategies as st
from uvicorn.config import Config
from uvicorn.server import ServerState
from websockets.frames import Frame, Opcode

from server.stream.line import WebSocketLine, binary_head, ends_whole, short_text, text_message

SIZES = st.one_of(st.integers(0, 130), st.sampled_from([65_535, 65_536]))
OPCODES = st.sampled_from([Opcode.TEXT, Opcode.BINARY, Opcode.PING])


def sent(text: bytes, opcode: Opcode = Opcode.TEXT) -> bytes:
    """A message as a client frames it."""
    return Frame(opcode, text).serialize(mask=True)


@given(st.binary(max_size=200))
def test_a_short_text_is_what_was_sent(text: bytes) -> None:
    assert short_text(sent(text)) == (text if len(text) < 126 else None)
    assert short_text(sent(text) + b"\x81") is None
    assert short_text(sent(text)[:-1]) is None
    assert short_text(sent(text, Opcode.BINARY)) is None
    assert short_text(Frame(Opcode.TEXT, text).serialize(mask=False)) is None


@given(st.lists(st.tuples(OPCODES, SIZES), min_size=1, max_size=4), st.data())
def test_the_end_of_whole_messages_is_known(messages: list[tuple[Opcode, int]], data: st.DataObject) -> None:
    whole = [sent(bytes(min(size, 125) if opcode is Opcode.PING else size), opcode) for opcode, size in messages]
    joined = b"".join(whole)
    edges = {sum(map(len, whole[: count + 1])) for count in range(len(whole))}
    cut = data.draw(st.one_of(st.integers(1, len(joined)), st.sampled_from(sorted(edges))))
    assert ends_whole(joined[:cut]) == (cut in edges)


@given(SIZES)
def test_messages_are_framed_as_the_library_frames_them(size: int) -> None:
    body = b"x" * size
    assert binary_head(size) + body == Frame(Opcode.BINARY, body).serialize(mask=False)
    assert text_message(body.decode()) == Frame(Opcode.TEXT, body).serialize(mask=False)


def test_messages_are_heard_however_they_are_cut(live: Any) -> None:
    async def turn() -> None:
        """Let the loop read the received data."""

    bench = live.bench(time_scale=0.01)
    with live.stream(bench["id"]) as stream:
        stream.acks = False
        stream.send(type="subscribe", panel=1, signals=["plant.displacement"], window_ms=1.0)
        for pieces in (1, 2, 3, 7, 40):
            for number in range(3):
                for _ in range(3):  # two pictures are on their way, and one waits
                    live.advance(bench=bench["id"], ticks=10)
                    stream.settle()
                last = stream.frames[-1].frame
                name = f"{pieces}-{number}"
                command = {"type": "command", "id": name, "command": {"kind": "time_scale", "value": 0.01}}
                ack = {"type": "ack", "frame": last}
                data = sent(json.dumps(ack).encode()) + sent(json.dumps(command).encode())
                at = [round(len(data) * piece / pieces) for piece in range(pieces + 1)]
                for start, end in itertools.pairwise(at):
                    stream.connection.socket.sendall(data[start:end])
                    live.on_loop(turn())
                    live.on_loop(turn())
                assert stream.until_type("reply")["id"] == name
                while stream.frames[-1].frame <= last:  # the acknowledgement made room for it
                    stream.step()


REQUEST = (
    b"GET / HTTP/1.1\r\nHost: a\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    b"Sec-WebSocket-Key: MDAwMDAwMDAwMDAwMDAwMA==\r\nSec-WebSocket-Version: 13\r\n\r\n"
)


EARLY = {
    "not UTF-8": sent(b"\xff\xfe"),
    "end of nothing": sent(b"x", Opcode.CONT),
    "unknown kind": b"\x85\x81\0\0\0\0x",
}


@pytest.mark.parametrize("refused", EARLY.values(), ids=EARLY)
def test_who_breaks_the_rules_before_the_answer_is_cut(refused: bytes, caplog: pytest.LogCaptureFixture) -> None:
    heard = []

    async def answer(_scope: Any, receive: Any, send: Any) -> None:
        heard.append(await receive())
        await send({"type": "websocket.accept"})
        raise AssertionError("nobody is there")

    async def meet() -> Mock:
        config = Config(answer, interface="asgi3", log_config=None)
        config.load()
        line, transport = WebSocketLine(config, ServerState(), {}, asyncio.get_running_loop()), Mock()
        transport.get_extra_info.return_value = None
        transport.is_closing.side_effect = lambda: transport.abort.called
        line.connection_made(transport)
        line.data_received(REQUEST)
        line.data_received(refused)  # in the same turn of the loop: the application has not answered yet
        await asyncio.gather(*line.tasks)
        return transport

    transport = asyncio.run(meet())
    transport.abort.assert_called_once_with()
    transport.write.assert_not_called()
    assert [message["type"] for message in heard] == ["websocket.connect"]
    assert all(record.message.startswith("Invalid UTF-8") for record in caplog.records)
