"""The server as a tool of learning platforms: its key pair, its signatures, and the platforms it knows."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

import jwt
import requests
from cryptography.hazmat.primitives.asymmetric import rsa
from cryptography.hazmat.primitives.serialization import Encoding, NoEncryption, PrivateFormat, load_pem_private_key
from jwt.algorithms import RSAAlgorithm
from jwt.utils import base64url_encode

from server.security.keyed import keyed_hash
from server.security.platforms import Platform
from server.security.privacy import write_private

KEY_FILE = "lti-key.pem"
KEY_BITS = 2048
ALGORITHM = "RS256"
CONNECT_S, READ_S = 5.0, 10.0


class Tool:
    """The key pair of this tool, and who may launch it.

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
        self._private = cast(rsa.RSAPrivateKey, load_pem_private_key(pem, None))
        shown = RSAAlgorithm.to_jwk(self._private.public_key(), as_dict=True)
        self._public = {name: shown[name] for name in ("e", "kty", "n")}
        self._hash_key = hashlib.sha256(b"combbench ids of learning platforms" + pem).digest()

    @property
    def key_id(self) -> str:
        """The name of the key: its thumbprint (RFC 7638)."""
        text = json.dumps(self._public, sort_keys=True, separators=(",", ":"))
        return base64url_encode(hashlib.sha256(text.encode()).digest()).decode()

    def key_set(self) -> dict[str, Any]:
        """Return the public key; with it platforms check the signatures of this server."""
        return {"keys": [{**self._public, "kid": self.key_id, "alg": ALGORITHM, "use": "sig"}]}

    def sign(self, claims: dict[str, Any]) -> str:
        """Return a message that platforms know to be from this server."""
        return jwt.encode(claims, self._private, ALGORITHM, {"kid": self.key_id})

    def hash_of(self, *words: str) -> str:
        """Return the stored hash of a platform's ids: without the private key it cannot be made or guessed."""
        return keyed_hash(self._hash_key, *words).hex()

    def platform(self, issuer: str, client_id: str) -> Platform | None:
        """Return a platform; without a client id, the only one of its issuer."""
        found = [one for one in self.platforms if one.issuer == issuer and client_id in ("", one.client_id)]
        return found[0] if len(found) == 1 else None


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
