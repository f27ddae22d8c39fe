"""A job: a function that the engine runs between two slices, and a caller that awaits it."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import Any


class Job:
    """A function and its outcome.

    Parameters
    ----------
    function : callable
        The function.
    """

    def __init__(self, function: Callable[[], Any]) -> None:
        self._function = function
        self.future: Future[Any] = Future()

    def __call__(self) -> None:
        """Run it, unless its caller was cancelled."""
        if not self.future.set_running_or_notify_cancel():
            return
        try:
            result = self._function()
        except BaseException as error:
            self.fail(error)
            if not isinstance(error, Exception):
                raise
        else:
            self.future.set_result(result)

    def fail(self, error: BaseException) -> None:
        """Answer with an error, unless it has been answered."""
        if not self.future.done():
            self.future.set_exception(error)
