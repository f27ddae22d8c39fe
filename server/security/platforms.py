"""The learning platforms that may launch this bench by LTI 1.3, as the settings name them."""

from __future__ import annotations

from typing import Any
from urllib.parse import urlsplit

from pydantic import BaseModel, ConfigDict, Field, field_validator

from server.security.public import PublicOrigin


class Platform(BaseModel):
    """A learning platform, such as a Moodle or a Canvas."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    issuer: str = Field(min_length=1, description="As the platform names itself, such as https://moodle.example.")
    client_id: str = Field(min_length=1, description="Name of this tool on the platform.")
    auth_login_url: str = Field(description="Address at which browsers learn their user.")
    auth_token_url: str = Field(description="Where this server asks for the right to send scores.")
    key_set_url: str = Field(description="Where the platform's public keys are.")
    deployment_ids: list[str] = Field(min_length=1, description="Places in the platform where the tool is installed.")
    frames: list[str] = Field(
        [], description="Origins whose pages may show the bench in a frame; none: it opens in a tab of its own."
    )

    @field_validator("auth_login_url", "auth_token_url", "key_set_url")
    @classmethod
    def _is_address(cls, given: str) -> str:
        """Refuse a text that is no address of the web."""
        parts = urlsplit(given)
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise ValueError("must be an address such as https://moodle.example/mod/lti/auth.php")
        return given

    @field_validator("deployment_ids", mode="before")
    @classmethod
    def _are_texts(cls, given: Any) -> Any:
        """Take whole numbers too: some platforms show their ids so."""
        return [str(one) if type(one) is int else one for one in given] if isinstance(given, list) else given

    @field_validator("frames")
    @classmethod
    def _are_origins(cls, given: list[str]) -> list[str]:
        """Write origins as browsers do; anything else would open more than was meant."""
        for text in given:
            if not text or PublicOrigin.parse(text).prefix:
                raise ValueError("must be origins without a path, such as https://moodle.example")
        return [PublicOrigin.parse(text).origin for text in given]
