"""One panel of one page: its picture, and the picture that was sent last."""

from __future__ import annotations

from server.stream.codec import Picture
from server.stream.cuts import SharedCuts
from server.stream.view import View


class Panel:
    """A subscription of a page.

    Parameters
    ----------
    view : View
        Cuts the pictures; pages with the same subscription share it.
    revision : int
        Number of the subscription of this panel.
    """

    def __init__(self, view: View, revision: int) -> None:
        self.view, self.revision = view, revision
        self._sent: Picture | None = None

    @property
    def points(self) -> int:
        """Columns times signals: the cost of a picture."""
        spec = self.view.spec
        return len(self.view.indices) * spec.width * (1 + len(spec.behind))

    def picture(self, cuts: SharedCuts) -> Picture | None:
        """Return the picture, or nothing if it is the one already sent."""
        picture = cuts.picture(self.view)
        if picture is self._sent:
            return None
        self._sent = picture
        return picture
