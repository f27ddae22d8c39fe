"""The pages of a launch that the server writes itself: they work in a frame, without a session and without a cookie."""

from __future__ import annotations

import html
import secrets
from collections.abc import Iterable

from starlette.responses import HTMLResponse

from server.errors import ErrorBody
from server.security.headers import POLICY
from server.security.visitor import page

STORED = "combbench.lti."
"""Under this name and the state, the browser keeps the secret of a launch that it has begun."""


def _page(title: str, body: str, status: int = 200, nonce: str = "", referrer: str = "same-origin") -> HTMLResponse:
    """Build a page; without a referrer a browser would give its forms no origin."""
    script = f"script-src 'nonce-{nonce}'; " if nonce else ""
    forms = "https: http:" if nonce else "'self'"
    policy = (
        f"default-src 'none'; {script}style-src 'unsafe-inline'; form-action {forms}; "
        "base-uri 'none'; frame-ancestors 'none'"
    )
    headers = {POLICY: policy, "Cache-Control": "no-store", "Referrer-Policy": referrer}
    return HTMLResponse(page(title, body, f"{title} · CombBench"), status, headers)


def login_page(address: str, state: str, browser: str, again: str) -> HTMLResponse:
    """Let this browser remember that it began the launch, and send it to the platform.

    A browser without storage for pages in a frame is offered a tab of its own, where it has storage.
    """
    nonce = secrets.token_urlsafe(16)
    body = (
        "<p id='said'>Asking the course who you are.</p>"
        f"<p id='again' hidden><a href='{html.escape(again)}' target='_blank'>Open the bench in a new tab</a></p>"
        f"<script nonce='{nonce}' data-to='{html.escape(address)}' data-name='{STORED}{html.escape(state)}' "
        f"data-secret='{browser}'>"
        "const { to, name, secret } = document.currentScript.dataset;"
        "try { sessionStorage.setItem(name, secret); location.replace(to); }"
        "catch { document.getElementById('said').textContent = 'This browser keeps nothing for pages in a frame.';"
        "document.getElementById('again').hidden = false; }"
        "</script><noscript><p>The bench needs JavaScript.</p></noscript>"
    )
    return _page("Opening the bench", body, nonce=nonce, referrer="no-referrer")


def refusal_page(status: int, error: ErrorBody) -> HTMLResponse:
    """Say why there is no bench."""
    hint = f"<p>{_sentence(error.hint)}</p>" if error.hint else ""
    return _page(
        "The bench did not open", f"<p class='wrong' role='alert'>{_sentence(error.message)}</p>{hint}", status
    )


def instructor_page(course: str, students: int) -> HTMLResponse:
    """Tell an instructor where the class is; a launch never gives the rights of the teacher of this server."""
    there = "1 student has" if students == 1 else f"{students} students have"
    body = (
        f"<p>The class <strong>{html.escape(course)}</strong> is open, and {there} come from your course so far. "
        "Each gets a bench of their own when they open the exercise.</p>"
        "<p>To see their benches, open CombBench with the teacher's link, which has the access token, and choose "
        "<strong>Class</strong>. The person who runs the server has that link.</p>"
        "<p>To try the exercise yourself, open it as a student: your platform can switch roles.</p>"
    )
    return _page("You teach this course", body)


def choice_page(
    action: str, code: str, sheets: Iterable[tuple[str, str]], scenarios: Iterable[tuple[str, str]]
) -> HTMLResponse:
    """Ask which exercise a link of the course leads to."""

    def options(kind: str, entries: Iterable[tuple[str, str]]) -> str:
        return "".join(
            f"<option value='{kind}:{html.escape(name)}'>{html.escape(title)}</option>" for name, title in entries
        )

    body = (
        "<p>Students who open the link get a bench of their own. The points of a lab sheet are sent to your course.</p>"
        f"<form method='post' action='{html.escape(action)}'>"
        f"<input type='hidden' name='code' value='{html.escape(code)}'>"
        "<label>Exercise<select name='choice' required>"
        f"<optgroup label='Lab sheets, with points'>{options('sheet', sheets)}</optgroup>"
        f"<optgroup label='Benches, without points'>{options('scenario', scenarios)}</optgroup>"
        "</select></label><button>Add to the course</button></form>"
    )
    return _page("Choose an exercise", body)


def answer_page(address: str, message: str) -> HTMLResponse:
    """Send the choice to the platform."""
    nonce = secrets.token_urlsafe(16)
    body = (
        f"<form id='answer' method='post' action='{html.escape(address)}'>"
        f"<input type='hidden' name='JWT' value='{html.escape(message)}'><button>Back to the course</button></form>"
        f"<script nonce='{nonce}'>document.getElementById('answer').submit();</script>"
    )
    return _page("Adding the exercise", body, nonce=nonce, referrer="strict-origin")


def _sentence(text: str) -> str:
    return html.escape(text[:1].upper() + text[1:]) + "."
