"""The page of a visitor without a token: the service, the person to contact, or the way to a class."""

from __future__ import annotations

import html
from base64 import b64encode
from collections.abc import Iterable
from hashlib import sha256

STYLE = """<style>
:root { color-scheme: light dark; color: light-dark(#1a1f26, #e8ecf1); background: light-dark(#e9edf1, #090c0f);
  --muted: light-dark(#56616e, #9aa6b4); --line: light-dark(#818d99, #6b7886); --accent: light-dark(#2c55c8, #8fb0ff) }
* { box-sizing: border-box }
body { display: grid; justify-content: center; margin: 0; padding: 8vh 1rem 2rem; font: 16px/1.55 system-ui }
main { width: min(29rem, calc(100vw - 2rem)); padding: 1.75rem; border-radius: 8px;
  background: light-dark(#ffffff, #161b21) }
h1 { margin: 0 0 .75rem; font-size: 1.4rem }
p { margin: 0 0 1rem }
main > :last-child { margin-bottom: 0 }
a { color: var(--accent); font-weight: 600 }
form { display: grid; grid-template-columns: minmax(0, 1fr); gap: 1.1rem; margin: 1.5rem 0 }
label { display: grid; gap: .35rem; min-width: 0; font-size: .95rem; font-weight: 600 }
input, select, button { width: 100%; min-height: 3rem; padding: 0 .9rem; border-radius: 6px; font: inherit }
input, select { border: 1px solid var(--line); background: light-dark(#ffffff, #1e252d); color: inherit }
input, select { font-size: 1.05rem }
button { border: 0; background: light-dark(#2c55c8, #3f63c4); color: #ffffff; font-weight: 600; cursor: pointer }
:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px }
.code { font-size: 1.5rem; font-weight: 650; letter-spacing: .14em; text-transform: uppercase }
.wrong { color: light-dark(#c4261d, #ff6b60); font-weight: 600 }
small { color: var(--muted) }
</style>"""
"""The look of the pages that need no session: the page's own colours, without its files, which need one."""
STYLE_HASH = "sha256-" + b64encode(sha256(STYLE[len("<style>") : -len("</style>")].encode()).digest()).decode()
"""By which the content policy knows it."""

ABOUT = """\
<p>A live lab for tiny comb resonators and gyroscopes etched in silicon. A simulated control board drives the device;
you inject faults, change controllers and watch the diagnosis find out, in the browser.</p>
"""

WITH_TOKEN = """\
<p>This bench is not open to everyone. Ask the person who runs it, or gave you this address, for the link with its
access token; it opens everything and needs no account. <a href="{join}">Join a class</a> if you have a code.</p>
{wrong}<form method="get">{hidden}<label>Access token
<input name="token" type="password" autocomplete="current-password" required autofocus></label>
<button>Open</button></form>
<p><small>You run it yourself? It printed the link when it started. <code>combbench doctor</code> says where the token
is kept.</small></p>
"""

WRONG = ' class="wrong" role="alert"'
ELSEWHERE = "The teacher's address, the one at 127.0.0.1 with the access token, works on the teacher's machine only."

OF_A_CLASS = """\
<p>This bench serves a class. Students <a href="{join}">join with the code</a> that their teacher shows.</p>
<p{mark}>{elsewhere}</p>
"""


def page(heading: str, body: str, title: str = "CombBench") -> str:
    """Build a page for a person without a session; its body is HTML."""
    return (
        '<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
        f"<title>{html.escape(title)}</title>\n{STYLE}\n<main><h1>{html.escape(heading)}</h1>\n{body}</main>\n"
    )


def visitor_page(
    query: Iterable[tuple[str, str]], may_use_token: bool = True, join: str = "/join", refusal: str = ""
) -> str:
    """Build the page; the address keeps the target for the time when the visitor has the token.

    Parameters
    ----------
    query : iterable of (str, str)
        The query of the requested address.
    may_use_token : bool
        Whether the token is accepted from the visitor's address; if not, the page does not ask for it.
    join : str
        Path of the page by which students join.
    refusal : str
        A further reason why the address opens nothing without the token.
    """
    fields = list(query)
    has_sent_token = any(name == "token" and value for name, value in fields)
    why = f"<p{WRONG}>{html.escape(refusal)}</p>\n" if refusal else ""
    if not may_use_token:
        mark = WRONG if has_sent_token else ""
        way_in = OF_A_CLASS.format(mark=mark, join=join, elsewhere=html.escape(ELSEWHERE))
        return page("CombBench", ABOUT + why + way_in)
    hidden = "".join(
        f'<input type="hidden" name="{html.escape(name)}" value="{html.escape(value)}">'
        for name, value in fields
        if name != "token"
    )
    wrong = f"<p{WRONG}>This token is not the one of this bench.</p>\n" if has_sent_token else ""
    return page("CombBench", ABOUT + why + WITH_TOKEN.format(hidden=hidden, wrong=wrong, join=join))
