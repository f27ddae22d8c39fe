"""The page of the 3D view: viser's own client, with its panels hidden, our cameras, and our page's colours."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import viser

from server.view3d.part import UM_PER_UNIT
from server.view3d.solids import View

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
"""Content policy of this document only: its client is one file of inline script and compiles code at run time."""


def page(views: dict[str, View]) -> str:
    """Return viser's page with our lines in its head."""
    before, ours, after = _parts()
    return before + ours.replace('"__DEVICE__"', json.dumps(cameras(views))) + after


def cameras(views: dict[str, View]) -> dict[str, Any]:
    """Return the presets of the camera for tall and for wide pictures; boxes in scene units."""
    return {
        name: {
            "box": [[end / UM_PER_UNIT for end in ends] for ends in box],
            "portrait": portrait,
            "landscape": landscape,
        }
        for name, (box, portrait, landscape) in views.items()
    }


@cache
def _parts() -> tuple[str, str, str]:
    """Return viser's page before the end of its head, our lines, and the rest."""
    html = (Path(viser.__file__).parent / "client" / "build" / "index.html").read_text("utf-8")
    before, head, after = html.partition("</head>")
    if not head:
        raise RuntimeError("the page of this version of viser has no </head>")
    return before, Path(__file__).with_name("client.html").read_text("utf-8"), head + after
