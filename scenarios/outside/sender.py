"""The sending end of the line protocol: the samples of an instrument to a server."""

from __future__ import annotations

import json
import socket
from types import TracebackType
from typing import Any, Self

from core.errors import InputError, short
from scenarios.records.columns import Numbers
from scenarios.records.line import MOST_BLOCK, BlockHead, LineHeader, block, header_line

ANSWERS_S = 10.0
"""Longest time for the answer to the header."""


class LineSender:
    """A connection to the port of a server for instruments; a context, at whose end it is closed.

    Parameters
    ----------
    address : str
        HOST:PORT.
    header : LineHeader
        The description of the instrument.

    Raises
    ------
    InputError
        When the server cannot be reached, or refuses.
    """

    def __init__(self, address: str, header: LineHeader) -> None:
        host, _, port = address.rpartition(":")
        if not host or not port.isdecimal():
            raise InputError(f"must be HOST:PORT, got {short(address)}", "--to")
        try:
            self._socket = socket.create_connection((host, int(port)), timeout=ANSWERS_S)
        except (OSError, OverflowError) as error:
            raise InputError(f"cannot connect to {address}: {error}", "--to", "set instrument_port there") from None
        self._answers = self._socket.makefile("rb")
        self._number = 0
        self._send(header_line(header))
        answer = self._answer()
        if not answer.get("ok"):
            self._refuse(answer)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._close()

    def send(self, time_ns: int, rate_khz: float, drive: Numbers, displacement: Numbers) -> None:
        """Send samples that follow each other, as one block or several.

        Raises
        ------
        InputError
            When the server has closed the connection, with its reason.
        """
        for first in range(0, len(drive), MOST_BLOCK):
            part = slice(first, first + MOST_BLOCK)
            head = BlockHead(self._number, time_ns + round(first * 1e6 / rate_khz), len(drive[part]))
            self._send(block(head, drive[part], displacement[part]))
            self._number += 1

    def _send(self, content: bytes) -> None:
        try:
            self._socket.sendall(content)
        except OSError:
            self._refuse(self._answer())

    def _answer(self) -> dict[str, Any]:
        try:
            return dict(json.loads(self._answers.readline()))
        except (OSError, ValueError):
            return {}

    def _close(self) -> None:
        self._answers.close()
        self._socket.close()

    def _refuse(self, answer: dict[str, Any]) -> None:
        self._close()
        raise InputError(str(answer.get("error", "the server has closed the connection")), "--to")
