"""The page of the 3D view: viser's own client, with its panels hidden and its state told to our page."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import viser

INJECTED = """
<style>.mantine-Paper-root,.mantine-Notifications-root,[data-floating-window],[data-dock-region]\
{display:none!important}</style>
<script>document.hasFocus=()=>false;
(()=>{const W=window.Worker;window.Worker=class extends W{constructor(...a){super(...a);\
this.addEventListener('message',e=>{const t=e.data&&e.data.type;\
if(t==='closed'||t==='connected')parent.postMessage({viser:t},location.origin)})}}})();</script>
"""
"""A lost connection must reload the page: viser 1.1.1 goes blank when it reconnects to a skinned mesh, and
does not reconnect at all without the focus. So it is told it never has the focus, and our page is told."""

POLICY = "; ".join(
    (
        "default-src 'self'",
        "script-src 'self' 'unsafe-inline' 'unsafe-eval'",
        "worker-src blob: data:",
        "connect-src 'self' data: blob:",
        "img-src 'self' data: blob:",
        "font-src 'self' data:",
        "style-src 'self' 'unsafe-inline'",
        "frame-ancestors 'self'",
    )
)
"""Only for this document: its client is one file of inline script and compiles code at run time."""


@cache
def page() -> str:
    """Return viser's page with our lines in its head."""
    html = (Path(viser.__file__).parent / "client" / "build" / "index.html").read_text("utf-8")
    before, head, after = html.partition("</head>")
    if not head:
        raise RuntimeError("the page of this version of viser has no </head>")
    return before + INJECTED + head + after
