"""The page to join a class, which needs no session, and the limit of attempts."""

from __future__ import annotations

import html
from collections.abc import Callable

from server.classroom.classes import Classes
from server.classroom.code import split
from server.classroom.name import LONGEST_NAME
from server.errors import ApiError, ErrorBody
from server.security.limits import Buckets
from server.security.person import Person
from server.security.visitor import page

WRONG_PER_S, WRONG_AT_ONCE = 0.2, 8
"""Wrong codes and links of one address that are answered as such; a whole class may share it."""

FORM = """\
<p>You get a bench of your own: a tiny resonator that you drive, break and look after. Your teacher sees your bench and
the name you give here. Both are forgotten when the class ends.</p>
{wrong}<form method="post" action="{action}">
<label>Code on the wall<input class="code" name="code" value="{code}" autocapitalize="characters" autocomplete="off"
spellcheck="false" required maxlength="40"{focus_code}></label>
<label>Your name<input name="name" value="{name}" autocomplete="nickname" required maxlength="{longest}"{focus_name}>
</label><button>Join</button></form>
"""


class Joining:
    """Admits students, and limits the rate of attempts.

    Parameters
    ----------
    classes : Classes
        Which they join.
    clock : callable
        Seconds.
    """

    def __init__(self, classes: Classes, clock: Callable[[], float]) -> None:
        self._classes = classes
        self._tries = Buckets(WRONG_PER_S, WRONG_AT_ONCE, clock=clock)

    def note_wrong(self, address: str) -> None:
        """Note that a code from an address was wrong; refuse an address with too many wrong codes."""
        if not self._tries.take(address):
            headers = {"Retry-After": "10"}
            raise ApiError(429, "rate_limited", "too many tries from here", hint="wait a minute", headers=headers)

    async def join(self, address: str, code: str, name: str, class_id: str = "") -> tuple[Person, str]:
        """Let a student in, into one class if it is named; return the person and the secret of the session.

        A right code never pays for wrong ones from the same address. The number of codes keeps strangers from guessing.

        Raises
        ------
        ApiError
            As `Classes.join`, for the code of another class, and for an address with too many wrong codes.
        """
        if class_id and split(code)[0] != class_id:
            raise ApiError(422, "invalid", "begins with the id of another class", "code")
        try:
            return await self._classes.join(code, name)
        except ApiError as error:
            if error.body.code == "wrong_code":
                self.note_wrong(address)
            raise


def join_page(action: str, code: str = "", name: str = "", refusal: ErrorBody | None = None) -> str:
    """Build the page.

    Parameters
    ----------
    action : str
        Where the form goes.
    code, name : str
        The fields so far.
    refusal : ErrorBody, optional
        Why it did not work.
    """
    wrong = ""
    if refusal is not None:
        said = [part[:1].upper() + part[1:] for part in (_whose(refusal), refusal.hint) if part]
        wrong = f'<p class="wrong" role="alert">{html.escape(". ".join(said))}.</p>\n'
    focus = " autofocus"
    to_code = not code or (refusal is not None and refusal.field == "code")
    form = FORM.format(
        wrong=wrong,
        action=html.escape(action),
        code=html.escape(code),
        name=html.escape(name),
        longest=LONGEST_NAME,
        focus_code=focus if to_code else "",
        focus_name="" if to_code else focus,
    )
    return page("Join a class", form, "Join a class · CombBench")


def _whose(refusal: ErrorBody) -> str:
    """Return the error; an error in a value names its field."""
    return f"{refusal.field} {refusal.message}" if refusal.code == "invalid" else refusal.message
