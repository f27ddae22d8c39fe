"""The public keys of platforms: fetched in threads of their own, once for all who wait, and kept for some minutes."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import requests
from cryptography.hazmat.primitives.asymmetric.rsa import RSAPrivateKey, RSAPublicKey
from jwt.algorithms import RSAAlgorithm
from jwt.exceptions import PyJWTError

from server.classroom.lti.tool import Web
from server.errors import ApiError

KEPT_S = 300.0
"""How long the keys of a platform are good for."""
AGAIN_S = 5.0
"""Time until the next request for an unknown key, or after an invalid answer."""
LONGEST_S, LONGEST = 20.0, 256 << 10
"""Most time and most bytes of an answer."""
THREADS = 2

Keys = list[Mapping[str, Any]]


@dataclass(frozen=True)
class _Answer:
    """The keys of a platform, or why there are none."""

    at: float
    keys: Keys
    wrong: str = ""


class KeySets:
    """The keys of all platforms.

    Parameters
    ----------
    clock : callable
        Seconds.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._pool = ThreadPoolExecutor(THREADS, thread_name_prefix="combbench-keys")
        self._known: dict[str, _Answer] = {}
        self._asked: dict[str, asyncio.Task[_Answer]] = {}

    async def key(self, url: str, kid: str) -> RSAPublicKey | None:
        """Return a key by its id; nothing if the platform has none of that id.

        Raises
        ------
        ApiError
            When the platform does not answer as it has to.
        """
        answer = self._known.get(url)
        age = self._clock() - answer.at if answer is not None else KEPT_S
        has_it = answer is not None and any(one["kid"] == kid for one in answer.keys)
        if answer is None or age >= (KEPT_S if has_it else AGAIN_S):
            if url not in self._asked:
                self._asked[url] = asyncio.get_running_loop().create_task(self._ask(url))
            answer = await asyncio.shield(self._asked[url])
        if answer.wrong:
            hint = "the platform has to be mended, or its key_set_url in the settings of this server"
            raise ApiError(502, "lti_platform", f"the key set of the platform {answer.wrong}", hint=hint)
        found = next((one for one in answer.keys if one["kid"] == kid), None)
        return _read(found) if found is not None else None

    def close(self) -> None:
        """Cancel the requests that wait."""
        self._pool.shutdown(wait=False, cancel_futures=True)

    async def _ask(self, url: str) -> _Answer:
        """Ask a platform for its keys."""
        try:
            found = await asyncio.get_running_loop().run_in_executor(self._pool, _fetched, url)
            keys = _usable(found)
            answer = _Answer(self._clock(), keys, "" if keys else f"at {url} has no RSA key to check signatures with")
        except (requests.RequestException, ValueError) as error:
            answer = _Answer(self._clock(), [], f"cannot be read from {url}: {error}")
        finally:
            self._asked.pop(url, None)
        self._known[url] = answer
        return answer


def _fetched(url: str) -> Any:
    """Ask a platform for its key set; runs in a thread."""
    until, body = time.monotonic() + LONGEST_S, b""
    with Web() as web, web.get(url, stream=True) as answer:
        if answer.status_code != 200:
            raise ValueError(f"it answers {answer.status_code}")
        for part in answer.iter_content(1 << 14):
            body += part
            if len(body) > LONGEST or time.monotonic() > until:
                raise ValueError("the answer does not end")
    return json.loads(body)


def _usable(found: Any) -> Keys:
    """Return the RSA keys of a key set that are meant for signatures."""
    keys = found.get("keys") if isinstance(found, dict) else None
    return [
        one
        for one in (keys if isinstance(keys, list) else [])
        if isinstance(one, dict)
        and one.get("kty") == "RSA"
        and isinstance(one.get("kid"), str)
        and one.get("alg", "RS256") == "RS256"
        and one.get("use", "sig") == "sig"
    ]


def _read(key: Mapping[str, Any]) -> RSAPublicKey:
    try:
        read = RSAAlgorithm.from_jwk(dict(key))
        return read.public_key() if isinstance(read, RSAPrivateKey) else read
    except (PyJWTError, ValueError, TypeError, KeyError, AttributeError) as error:
        raise ApiError(502, "lti_platform", f"a key of the platform cannot be read: {error}") from None
