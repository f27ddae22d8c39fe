"""Limits around a piece of work, in the process that does it: processor time and memory."""

from __future__ import annotations

import signal
import sys
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from core.errors import InputError
from core.own.admission import Terms, admit

MOST_BYTES = 1 << 30
"""Memory that a process may take beyond its memory at the beginning."""

_limited: list[bool] = []


@dataclass(frozen=True)
class EndedWork:
    """A piece of work that has ended.

    Parameters
    ----------
    value
        The result of the function.
    used_s : float
        Processor time.
    refusal : tuple of str, optional
        Message, field, hint and code where the input was refused.
    """

    value: Any
    used_s: float
    refusal: tuple[str, str, str, str] | None = None


def within(most_s: float, terms: Terms, function: Callable[..., Any], *arguments: Any) -> EndedWork:
    """Call a function; this process ends when that takes more processor time than it may.

    Raises
    ------
    RuntimeError
        When the function failed, with its place.
    """
    _limit_memory()
    admit(terms)
    begun = time.process_time()
    refusal, value = None, None
    _end_after(most_s)
    try:
        value = function(*arguments)
    except InputError as error:
        refusal = error.message, error.field, error.hint, error.code
    except MemoryError:
        refusal = f"takes more than {MOST_BYTES >> 20} MB of memory", "", "", "too_much"
    except Exception:
        raise RuntimeError(traceback.format_exc()) from None  # any other might not reach the server whole
    finally:
        _end_after(0.0)
    return EndedWork(value, time.process_time() - begun, refusal)


def _end_after(seconds: float) -> None:
    """Let the system end this process after an amount of processor time, also within a single instruction of Python."""
    if sys.platform != "win32":
        signal.setitimer(signal.ITIMER_PROF, seconds)


def _limit_memory() -> None:
    if sys.platform == "linux" and not _limited:
        import resource

        pages = int(Path("/proc/self/statm").read_text().split()[0])
        most = pages * resource.getpagesize() + MOST_BYTES
        resource.setrlimit(resource.RLIMIT_AS, (most, most))
        _limited.append(True)
