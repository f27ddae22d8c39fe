"""The exercises that a platform can link to, and the data by which it finds this server."""

from __future__ import annotations

from typing import Any

from scenarios import library
from server.classroom.sheets import Sheets
from server.errors import not_found

Choice = tuple[str, str]
"""Name and title of an exercise."""


def choices(sheets: Sheets) -> tuple[list[Choice], list[Choice]]:
    """Return the lab sheets and the scenarios that an instructor chooses from."""
    of_sheets = [(sheet.id, f"{sheet.head.title} ({sheet.points:g} points)") for sheet in sheets.all()]
    return of_sheets, [(name, library.get(name).head.title) for name in library.ids()]


def resource(kind: str, name: str, address: str, sheets: Sheets) -> dict[str, Any]:
    """Describe the link to an exercise; the link of a lab sheet has a column of points.

    Raises
    ------
    ApiError
        For an unknown exercise.
    """
    link = {"type": "ltiResourceLink", "url": address, "custom": {kind: name}}
    if kind == "sheet":
        sheet = sheets.get(name)
        column = {"label": sheet.head.title, "scoreMaximum": sheet.points, "resourceId": sheet.id}
        return {**link, "title": sheet.head.title, "lineItem": column}
    if kind == "scenario" and name in library.ids():
        return {**link, "title": library.get(name).head.title}
    raise not_found("exercise", name)


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
