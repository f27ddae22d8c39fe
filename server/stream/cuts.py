"""The history of a bench at one moment, and the pictures that pages show of it."""

from __future__ import annotations

import time
from collections.abc import Sequence
from weakref import WeakKeyDictionary, WeakSet, WeakValueDictionary

import numpy as np
from numpy.typing import NDArray

from server.bench.bench import Seen
from server.bench.captures import Captured, CaptureSet
from server.stream.behind import Behind
from server.stream.codec import Moment, Picture
from server.stream.view import PictureCutter, window_of
from server.stream.wire import Subscribe


class SharedCuts:
    """The history of one bench as all its pages see it at one moment.

    Parameters
    ----------
    session : LiveBench or View
        The bench as those pages see it; its history may be replaced by a reset.
    """

    def __init__(self, session: Seen) -> None:
        self._session = session
        self._views: WeakValueDictionary[str, PictureCutter] = WeakValueDictionary()
        self._with_behind: WeakSet[PictureCutter] = WeakSet()
        self._history = session.history
        self._pictures: WeakKeyDictionary[PictureCutter, Picture] = WeakKeyDictionary()
        self.refresh()

    def refresh(self) -> int:
        """Take the present moment; return its tick."""
        self._session.captures.follow()
        if self._session.history is not self._history:
            self._history = self._session.history
            for view in self._views.values():
                view.forget()
        self.moment = Moment(self._history.end_tick, self._session.dt_ms, time.monotonic())
        self._pictures.clear()
        return self.moment.head

    def picture(self, view: PictureCutter) -> Picture:
        """Return the picture of a view at this moment."""
        picture = self._pictures.get(view)
        if picture is None:
            picture = self._pictures[view] = view.picture(self)
        return picture

    @property
    def behind(self) -> list[tuple[tuple[int, int], ...]]:
        """Dependencies of pictures on other benches: the benches behind it continue by themselves."""
        return [view.behind for view in self._with_behind]

    def view(
        self, spec: Subscribe, indices: list[int], trigger_index: int | None, behind: Sequence[Behind] = ()
    ) -> PictureCutter:
        """Return the view of a subscription: pages with the same subscription share one.

        People may see other benches than others do, so a view with benches behind it is its own.
        """
        captures = self._captures(spec, indices) if trigger_index is not None else None
        fresh = PictureCutter(spec, indices, trigger_index, self.moment.dt_ms, self.moment.head, behind, captures)
        if behind:
            self._with_behind.add(fresh)
            return fresh
        if spec.trigger is not None and spec.trigger.sweep == "single":
            return fresh  # each page arms its own trigger
        key = f"{self.moment.dt_ms} {spec.model_copy(update={'panel': 0}).model_dump_json()}"
        return self._views.setdefault(key, fresh)

    def gather(self) -> bool:
        """Find the crossings to capture at this moment and copy some of them; return whether others still wait."""
        captures = self._session.captures
        for view in [view for one in captures.sets() for view in one.views]:
            view.find(self)
        return captures.gather()

    def _captures(self, spec: Subscribe, indices: list[int]) -> CaptureSet | None:
        """Return the captures of a subscription; all that differ in width or sweep alone share them."""
        assert spec.trigger is not None
        named = dict(sorted(zip(spec.signals, indices, strict=True)))
        window, before = window_of(spec, self.moment.dt_ms)
        trigger = spec.trigger.model_dump(exclude={"position", "sweep", "signal"})
        what = Captured(tuple(named), spec.trigger.signal, **trigger, window=window, before=before)
        return self._session.captures.open(what, list(named.values()))

    # Views read the history by the methods below, and report their findings.

    @property
    def end_tick(self) -> int:
        """First tick that is not shown yet."""
        return self.moment.head

    @property
    def first_tick(self) -> int:
        """Oldest tick kept."""
        return self._history.first_tick

    def read(self, signals: list[int], start: int, stop: int) -> NDArray[np.float32]:
        """Return ``(n, ticks)`` samples."""
        return self._history.read(signals, start, stop)

    def columns(self, signals: list[int], start: int, stop: int, columns: int) -> NDArray[np.float32]:
        """Return ``(n, 2, columns)`` minima and maxima."""
        found = self._history.columns(signals, start, stop, columns)
        self._session.captures.fold(found, signals, start, stop)
        return found

    def capture(self, captures: CaptureSet, tick: int, at: float) -> None:
        """Keep the window around a crossing."""
        self._session.captures.found(captures, tick, at)
