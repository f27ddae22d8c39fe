"""One panel of one page: its picture, and the picture that was sent last."""

from __future__ import annotations

from server.bench.captures import MOST
from server.stream.codec import Picture
from server.stream.cuts import SharedCuts
from server.stream.view import PictureCutter
from server.stream.wire import CaptureList, CaptureMark


class Panel:
    """A subscription of a page.

    Parameters
    ----------
    view : View
        Cuts the pictures; pages with the same subscription share it.
    revision : int
        Number of the subscription of this panel.
    """

    def __init__(self, view: PictureCutter, revision: int) -> None:
        self.view, self.revision = view, revision
        self._sent: Picture | None = None
        self._edition = -1

    @property
    def points(self) -> int:
        """Columns times signals: the cost of a picture."""
        spec = self.view.spec
        return len(self.view.indices) * spec.width * (1 + len(spec.behind))

    def picture(self, cuts: SharedCuts) -> Picture | None:
        """Return the picture, or None if it was sent already."""
        picture = cuts.picture(self.view)
        if picture is self._sent:
            return None
        self._sent = picture
        return picture

    def captures(self, number: int) -> CaptureList | None:
        """Return the captures of its trigger, or nothing if they were sent already."""
        spec, kept = self.view.spec, self.view.captures
        edition = kept.edition if kept is not None else 0
        if spec.trigger is None or spec.mode == "roll" or edition == self._edition:
            return None
        self._edition = edition
        marks = [CaptureMark.of(one) for one in kept.captures] if kept is not None else []
        return CaptureList(panel=number, captures=marks, most=MOST, is_short=kept is None or kept.is_short)
