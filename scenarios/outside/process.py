"""A controller in a process of its own, in any language, in lockstep over a pipe."""

from __future__ import annotations

import os
import select
import shlex
import signal
import struct
import subprocess
import time
from types import TracebackType
from typing import Self

from core.board.outside import Sample
from core.errors import InputError, short

SAMPLE = struct.Struct("<9d")
"""Sent at each sample: begins, tick, time_ms, dt_ms, reference, model, measured, applied, engaged."""
VOLTAGE = struct.Struct("<d")
"""The answer, V."""
FIELD = "--controller-process"
ENDS_S = 2.0
"""Time a process has to end by itself once its input is closed."""


class Process:
    """A law that a process computes: nine little-endian doubles on its input, one on its output, sample by sample.

    A context, at whose end the input of the process is closed; a process that does not end soon after is killed. Its
    error output is shown unchanged.

    Parameters
    ----------
    command : str
        The command with its arguments, as in a shell; no shell runs it.
    timeout_s : float
        Longest time it may take for an answer.

    Raises
    ------
    InputError
        When it cannot be started, and from a call when it has ended, is too slow, or answers with something else.
    """

    def __init__(self, command: str, timeout_s: float) -> None:
        try:
            self._arguments = shlex.split(command)
        except ValueError as error:
            raise InputError(f"cannot read {short(command)}: {error}", FIELD) from None
        if not self._arguments:
            raise InputError("names no command", FIELD)
        if not timeout_s > 0.0:
            raise InputError(f"must be more than 0 s, got {timeout_s}", "--controller-timeout")
        self._timeout_s = timeout_s

    def __enter__(self) -> Self:
        pipe = subprocess.PIPE
        try:
            self._process = subprocess.Popen(
                self._arguments, stdin=pipe, stdout=pipe, bufsize=0, start_new_session=True
            )
        except OSError as error:
            raise InputError(f"cannot start {short(self._arguments[0])}: {error.strerror}", FIELD) from None
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._input, self._output = self._process.stdin.fileno(), self._process.stdout.fileno()
        self._poll = select.poll()
        self._poll.register(self._output, select.POLLIN)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        process = self._process
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.close()
        try:
            process.wait(0.0 if kind is not None else ENDS_S)
        except subprocess.TimeoutExpired:
            pass
        try:  # its child processes end with it
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        process.wait()
        process.stdout.close()

    def __call__(self, sample: Sample) -> float:
        """Return the voltage for a sample."""
        try:
            os.write(self._input, SAMPLE.pack(*sample))
        except BrokenPipeError:
            raise self._ended(sample) from None
        answer, end = b"", time.monotonic() + self._timeout_s
        while len(answer) < VOLTAGE.size:
            left_ms = 1e3 * (end - time.monotonic())
            if left_ms <= 0.0 or not self._poll.poll(left_ms):
                text = f"gave no voltage for sample {sample.tick} within {self._timeout_s:g} s"
                raise InputError(text, FIELD, "give it more time with --controller-timeout")
            part = os.read(self._output, 2 * VOLTAGE.size)
            if not part:
                raise self._ended(sample)
            answer += part
        if len(answer) > VOLTAGE.size:
            text = f"answered sample {sample.tick} with more than one number: {short(answer)}"
            raise InputError(text, FIELD, "it must print nothing else; messages go to its error output")
        return float(VOLTAGE.unpack(answer)[0])

    def _ended(self, sample: Sample) -> InputError:
        """Return why there is no answer from a process whose pipe is closed."""
        try:
            code = self._process.wait(ENDS_S)
        except subprocess.TimeoutExpired:
            return InputError(f"closed its pipe at sample {sample.tick}", FIELD)
        how = f"with exit code {code}" if code >= 0 else f"by signal {-code}"
        return InputError(f"ended {how} at sample {sample.tick}", FIELD)
