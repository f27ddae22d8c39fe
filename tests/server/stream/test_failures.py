"""Unexpected errors on a stream: they are reported and logged, and the rest continues."""

from __future__ import annotations

import logging
from typing import Any

import pytest

from server.stream.client import Client


def broken(*_: Any) -> Any:
    raise RuntimeError("broken on purpose")


def test_a_message_the_server_fails_on_is_answered(
    live: Any, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    bench = live.bench()
    with live.stream(bench["id"]) as stream:
        with monkeypatch.context() as patched:
            patched.setattr(live.service.benches, "begin", broken)
            reply = stream.command("pause")
            assert reply["ok"] is False and reply["error"]["code"] == "internal"
            assert "broken on purpose" not in reply["error"]["message"]
            patched.setattr(Client, "resume", broken)
            stream.send(type="resume", after=0)
            assert stream.until_type("error")["error"]["code"] == "internal"
        assert stream.command("time_scale", value=0.002)["ok"]
    assert caplog.text.count("RuntimeError: broken on purpose") == 2 and bench["id"] in caplog.text


def test_a_stream_that_breaks_off_says_so(
    live: Any, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    bench = live.bench()
    with live.stream(bench["id"]) as stream:
        stream.step()
        monkeypatch.setattr(Client, "_status", broken)
        assert stream.until_closed().code == 1011
    assert "RuntimeError: broken on purpose" in caplog.text


def test_a_page_that_goes_is_no_failure(live: Any, caplog: pytest.LogCaptureFixture) -> None:
    bench = live.bench(time_scale=0.02)
    for hard in (False, True):
        with live.stream(bench["id"]) as stream:
            stream.send(type="subscribe", panel=1, signals=["plant.displacement"], window_ms=1.0)
            stream.until_frame(1)
            if hard:
                stream.connection.socket.close()
    with live.stream(bench["id"]) as stream:
        live.advance(seconds=0.5)
        stream.settle()
    ours = [record for record in caplog.records if record.name.startswith("server.")]
    assert [record for record in ours if record.levelno >= logging.ERROR] == []
