"""The exercises that a platform can link to, and the data by which it finds this server."""

from __future__ import annotations

from typing import Any

from pylti1p3.deep_link_resource import DeepLinkResource
from pylti1p3.lineitem import LineItem

from scenarios import library
from server.classroom.sheets import Sheets
from server.errors import not_found

Choice = tuple[str, str]
"""Name and title of an exercise."""


def choices(sheets: Sheets) -> tuple[list[Choice], list[Choice]]:
    """Return the lab sheets and the scenarios that an instructor chooses from."""
    of_sheets = [(sheet.id, f"{sheet.head.title} ({sheet.points:g} points)") for sheet in sheets.all()]
    return of_sheets, [(name, library.get(name).head.title) for name in library.ids()]


def resource(kind: str, name: str, address: str, sheets: Sheets) -> DeepLinkResource:
    """Describe the link to an exercise; the link of a lab sheet has a column of points.

    Raises
    ------
    ApiError
        For an unknown exercise.
    """
    if kind == "sheet":
        sheet = sheets.get(name)
        column = LineItem().set_label(sheet.head.title).set_score_maximum(sheet.points).set_resource_id(sheet.id)
        found = DeepLinkResource().set_title(sheet.head.title).set_lineitem(column)
    elif kind == "scenario" and name in library.ids():
        found = DeepLinkResource().set_title(library.get(name).head.title)
    else:
        raise not_found("exercise", name)
    return found.set_url(address).set_custom_params({kind: name})


def configuration(base: str) -> dict[str, Any]:
    """Return the configuration for a platform, in the form that Canvas reads; others need the same addresses."""
    launch = f"{base}/launch"
    placement = {"placement": "link_selection", "message_type": "LtiDeepLinkingRequest", "target_link_uri": launch}
    canvas = {
        "platform": "canvas.instructure.com",
        "privacy_level": "name_only",
        "settings": {
            "platform": "canvas.instructure.com",
            "text": "CombBench",
            "placements": [placement, {**placement, "placement": "assignment_selection"}],
        },
    }
    return {
        "title": "CombBench",
        "description": "A live lab for tiny comb resonators: benches and lab sheets with points.",
        "target_link_uri": launch,
        "oidc_initiation_url": f"{base}/login",
        "redirect_uris": [launch],
        "public_jwk_url": f"{base}/jwks",
        "scopes": ["https://purl.imsglobal.org/spec/lti-ags/scope/score"],
        "claims": ["sub", "iss", "name", "given_name", "family_name"],
        "custom_fields": {},
        "extensions": [canvas],
    }
