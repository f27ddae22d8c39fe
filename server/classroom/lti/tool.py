"""The server as a tool of learning platforms: its key pair, and its data about each of them."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import requests
from cryptography.hazmat.primitives.asymmetric import rsa
from cryptography.hazmat.primitives.serialization import (
    Encoding,
    NoEncryption,
    PrivateFormat,
    PublicFormat,
    load_pem_private_key,
)
from pylti1p3.deployment import Deployment
from pylti1p3.registration import Registration
from pylti1p3.request import Request
from pylti1p3.tool_config.abstract import ToolConfAbstract

from server.security.keyed import keyed_hash
from server.security.platforms import Platform
from server.security.privacy import write_private

KEY_FILE = "lti-key.pem"
KEY_BITS = 2048
CONNECT_S, READ_S = 5.0, 10.0


class Tool(ToolConfAbstract[Request]):
    """The key pair, and the registrations of this tool.

    Parameters
    ----------
    platforms : list of Platform
        Who may launch it.
    folder : Path
        Where the private key is kept, for the owner alone; it is made when it is missing.
    """

    def __init__(self, platforms: list[Platform], folder: Path) -> None:
        self.platforms = platforms
        pem = _private_key(folder)
        public = load_pem_private_key(pem, None).public_key()
        self._private = pem.decode()
        self._public = public.public_bytes(Encoding.PEM, PublicFormat.SubjectPublicKeyInfo).decode()
        self._hash_key = hashlib.sha256(b"combbench ids of learning platforms" + pem).digest()

    def key_set(self) -> dict[str, Any]:
        """Return the public key; with it platforms check the signatures of this server."""
        return {"keys": [Registration.get_jwk(self._public)]}

    def hash_of(self, *words: str) -> str:
        """Return the stored hash of a platform's ids: without the private key it cannot be made or guessed."""
        return keyed_hash(self._hash_key, *words).hex()

    def platform(self, issuer: str, client_id: str | None) -> Platform | None:
        """Return a platform; without a client id, the only one of its issuer."""
        found = [one for one in self.platforms if one.issuer == issuer and client_id in (None, "", one.client_id)]
        return found[0] if len(found) == 1 else None

    def registration(self, platform: Platform) -> Registration:
        """Describe a platform for the library."""
        return (
            Registration()
            .set_issuer(platform.issuer)
            .set_client_id(platform.client_id)
            .set_auth_login_url(platform.auth_login_url)
            .set_auth_token_url(platform.auth_token_url)
            .set_key_set_url(platform.key_set_url)
            .set_tool_private_key(self._private)
            .set_tool_public_key(self._public)
        )

    def check_iss_has_one_client(self, iss: str) -> bool:  # noqa: ARG002
        """Answer no: an issuer such as Canvas may have many."""
        return False

    def find_registration_by_issuer(self, iss: str, *_: Any, **__: Any) -> Registration:
        """Return the registration of an issuer that has one."""
        return self.find_registration_by_params(iss, "")

    def find_registration_by_params(self, iss: str, client_id: str, *_: Any, **__: Any) -> Registration:
        """Return a registration; nothing if there is none."""
        platform = self.platform(iss, client_id)
        return self.registration(platform) if platform is not None else None  # type: ignore[return-value]

    def find_deployment(self, iss: str, deployment_id: str) -> Deployment | None:
        """Return a deployment of an issuer that has one registration."""
        return self.find_deployment_by_params(iss, deployment_id, "")

    def find_deployment_by_params(
        self, iss: str, deployment_id: str, client_id: str, *_: Any, **__: Any
    ) -> Deployment | None:
        """Return a deployment; nothing if it is not configured."""
        platform = self.platform(iss, client_id)
        if platform is None or deployment_id not in platform.deployment_ids:
            return None
        return Deployment().set_deployment_id(deployment_id)


class Web(requests.Session):
    """Requests of this server to platforms: with time limits, and without following redirects."""

    def request(self, method: str, url: str | bytes, *args: Any, **options: Any) -> requests.Response:
        """Ask, for some seconds at most."""
        given: Mapping[str, Any] = {"timeout": (CONNECT_S, READ_S), "allow_redirects": False}
        return super().request(method, url, *args, **{**options, **given})


def _private_key(folder: Path) -> bytes:
    """Return the private key that is kept, or make one."""
    path = folder / KEY_FILE
    if path.is_file():
        return path.read_bytes()
    key = rsa.generate_private_key(public_exponent=65537, key_size=KEY_BITS)
    pem = key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())
    write_private(path, pem)
    return pem
