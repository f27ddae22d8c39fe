"""A checked launch: the person, the course, the exercise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from server.security.platforms import Platform

CLAIM = "https://purl.imsglobal.org/spec/lti/claim/"
LINK = "https://purl.imsglobal.org/spec/lti-dl/claim/"
DEEP_LINKING, LINK_ITEMS, LINK_DATA = f"{LINK}deep_linking_settings", f"{LINK}content_items", f"{LINK}data"
GRADES = "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint"
SCORE = "https://purl.imsglobal.org/spec/lti-ags/scope/score"
MEMBERSHIP = "http://purl.imsglobal.org/vocab/lis/v2/membership"
INSTRUCTORS = ("Instructor", "ContentDeveloper", "Administrator")


def text_of(found: object) -> str:
    """Return a text, or the digits of a whole number, as some platforms send ids; of anything else nothing."""
    return found if isinstance(found, str) else str(found) if type(found) is int else ""


@dataclass(frozen=True)
class Launch:
    """The message that a platform has signed.

    Parameters
    ----------
    platform : Platform
        Which platform.
    claims : mapping
        The body of its message.
    """

    platform: Platform
    claims: Mapping[str, Any]

    def text(self, *path: str) -> str:
        """Return a text of the message, of a number its digits; nothing where it has none."""
        found: Any = self.claims
        for name in path:
            found = found.get(name) if isinstance(found, Mapping) else None
        return text_of(found)

    @property
    def user(self) -> str:
        """The name that the platform gives the person."""
        return self.text("sub")

    @property
    def deployment(self) -> str:
        """The place in the platform where this tool is installed."""
        return self.text(f"{CLAIM}deployment_id")

    @property
    def name(self) -> str:
        """The name of the person, if the platform gives it."""
        return self.text("name") or " ".join(filter(None, (self.text("given_name"), self.text("family_name"))))

    @property
    def course(self) -> tuple[str, ...]:
        """The ids by which a course is known; where there is none, all of a deployment are one."""
        return (self.platform.issuer, self.platform.client_id, self.deployment, self.text(f"{CLAIM}context", "id"))

    @property
    def course_name(self) -> str:
        """The name of the course."""
        return self.text(f"{CLAIM}context", "title") or self.text(f"{CLAIM}context", "label")

    def has_role(self, *roles: str) -> bool:
        """Whether the person has one of some roles in the course; a role may be narrowed, such as a tutor's."""
        found = self.claims.get(f"{CLAIM}roles")
        given = [one for one in found if isinstance(one, str)] if isinstance(found, list) else []
        full = tuple(f"{MEMBERSHIP}#{role}" for role in roles)
        narrowed = tuple(f"{MEMBERSHIP}/{role}#" for role in roles)
        return any(one in roles or one in full or one.startswith(narrowed) for one in given)

    @property
    def is_instructor(self) -> bool:
        """Whether the person teaches the course."""
        return self.has_role(*INSTRUCTORS)

    @property
    def is_learner(self) -> bool:
        """Whether the person learns in the course, and does not teach it."""
        return self.has_role("Learner") and not self.is_instructor

    @property
    def sheet(self) -> str:
        """The lab sheet that the link leads to."""
        return self.text(f"{CLAIM}custom", "sheet")

    @property
    def scenario(self) -> str:
        """The scenario that the link leads to."""
        return self.text(f"{CLAIM}custom", "scenario")

    @property
    def line_item(self) -> str:
        """Where the platform takes the score of this link; nothing if it takes none."""
        endpoint = self.claims.get(GRADES)
        scopes = endpoint.get("scope") if isinstance(endpoint, Mapping) else None
        return self.text(GRADES, "lineitem") if isinstance(scopes, list) and SCORE in scopes else ""

    @property
    def is_choice(self) -> bool:
        """Whether an exercise is to be chosen for a link."""
        return self.text(f"{CLAIM}message_type") == "LtiDeepLinkingRequest"

    @property
    def return_address(self) -> str:
        """Where the choice goes."""
        return self.text(DEEP_LINKING, "deep_link_return_url")
