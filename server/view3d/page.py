"""The page of the 3D view: viser's own client, with its panels hidden, our cameras, and our page's colours."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import viser

from server.view3d.layout import UM_PER_UNIT, Layout

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


def page(layout: Layout) -> str:
    """Return viser's page with our lines in its head."""
    before, ours, after = _parts()
    return before + ours.replace('"__DEVICE__"', json.dumps(cameras(layout))) + after


def cameras(layout: Layout) -> dict[str, Any]:
    """Return the presets of the camera, for tall and for wide pictures: box to show, in scene units, and direction.

    A direction is azimuth and elevation in degrees. Tall pictures have +x to the right; in wide ones the device lies
    on its side, +x up.
    """
    g, top = layout.geometry, layout.top_um
    whole = ((-layout.half_length_um, layout.half_length_um), (-layout.half_width_um, layout.half_width_um), (0, top))
    comb = ((layout.plate_um, layout.base_um), (0.39 * layout.comb_um, 0.5 * layout.comb_um + g.gap_um), (0, top))
    beams = ((-2 * layout.outer_um, 2 * layout.outer_um), (-20.0, layout.beam_to_um + 25.0), (0, top))
    views = {
        "whole": (whole, (-80, 56), (190, 54)),
        "top": (whole, (-90, 89.9), (180, 89.9)),
        "side": (whole, (-90, 14), (180, 14)),
        "fingers": (comb, (-90, 62), (-90, 62)),
        "beams": (beams, (-80, 56), (190, 56)),
    }
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
