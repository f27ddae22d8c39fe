"""The page of a visitor who has no token: what this is, and whom to ask."""

from __future__ import annotations

import html
from collections.abc import Iterable

PAGE = """<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>CombBench</title>
<style>
:root {{ color-scheme: light dark; color: CanvasText; background: Canvas }}
body {{ max-width: 34rem; margin: 12vh auto; padding: 0 1.5rem; font: 16px/1.6 system-ui }}
h1 {{ font-size: 1.4rem }}
form {{ display: flex; flex-wrap: wrap; gap: .5rem; align-items: end; margin: 1.5rem 0 }}
label {{ flex: 1 1 14rem; font-size: .9rem }}
input, button {{ box-sizing: border-box; min-height: 2.6rem; padding: 0 .8rem; font: inherit }}
input {{ width: 100% }}
.wrong {{ color: light-dark(#b3261e, #ff8a80) }}
small {{ opacity: .75 }}
</style>
<h1>CombBench</h1>
<p>A live lab for tiny comb resonators and gyroscopes etched in silicon. A simulated control board drives the device;
you inject faults, change controllers and watch the diagnosis find out, in the browser.</p>
<p>This bench is not open to everyone. Ask whoever runs it, or gave you this address, for the link with its access
token; it opens everything and needs no account.</p>
{wrong}<form method="get">{hidden}<label>Access token
<input name="token" type="password" autocomplete="current-password" required autofocus></label>
<button>Open</button></form>
<p><small>You run it yourself? It printed the link when it started. <code>combbench doctor</code> says where the token
is kept.</small></p>
"""


def visitor_page(query: Iterable[tuple[str, str]]) -> str:
    """Build the page; the address goes on to where the visitor wanted once the token is there.

    Parameters
    ----------
    query : iterable of (str, str)
        The query of the address that was asked for.
    """
    fields = list(query)
    hidden = "".join(
        f'<input type="hidden" name="{html.escape(name)}" value="{html.escape(value)}">'
        for name, value in fields
        if name != "token"
    )
    is_wrong = any(name == "token" and value for name, value in fields)
    wrong = '<p class="wrong" role="alert">This token is not the one of this bench.</p>\n' if is_wrong else ""
    return PAGE.format(hidden=hidden, wrong=wrong)
