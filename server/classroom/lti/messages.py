"""The messages of LTI 1.3: the beginning of a launch, the check of its end, the answer to the choice of an exercise.

States and nonces are usually kept in cookies and sessions. In a frame of another site there are no cookies, so that
here both are kept by the server, behind the state, which is a secret that works once and for a short time. The server
checks by a third secret, which the page keeps, that the same browser began and ended a launch.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlencode

import jwt

from server.classroom.lti.keys import KeySets
from server.classroom.lti.launch import CLAIM, DEEP_LINKING, LINK_DATA, LINK_ITEMS, Launch, text_of
from server.classroom.lti.tool import ALGORITHM, Tool
from server.errors import ApiError
from server.security.once import Once
from server.security.person import hash_of, new_secret
from server.security.platforms import Platform

LOGIN_S = 300.0
ANSWER_S = 600
"""How long the answer to a choice may take to its platform."""
TOLERANCE_S = 60.0
"""How far the clocks of a platform and of this server may differ."""
FAR_S = 1e12
"""Times are nearer to 1970 than this."""
SIGNATURE_ALONE: Any = {f"verify_{name}": False for name in ("aud", "iss", "sub", "jti", "exp", "nbf", "iat")}
"""The claims are checked here: some platforms send numbers for texts, and clocks differ."""
NOTHING: Any = {**SIGNATURE_ALONE, "verify_signature": False}


@dataclass(frozen=True)
class Login:
    """A launch that has begun: its platform, and the values that have to come back."""

    platform: Platform
    nonce: str
    browser_hash: str


class Messages:
    """Begins launches, and checks how they end.

    Parameters
    ----------
    tool : Tool
        This server's keys and platforms.
    key_sets : KeySets
        The keys of platforms.
    """

    def __init__(self, tool: Tool, key_sets: KeySets) -> None:
        self._tool, self._key_sets = tool, key_sets
        self._logins = Once[Login](LOGIN_S)
        self.clock: Callable[[], float] = time.time
        """Seconds since 1970, by which messages are too old or too new."""

    def begin(self, given: Mapping[str, str], launch_url: str) -> tuple[str, str, str]:
        """Return the address at which a browser learns its user, the state, and the secret that this browser keeps.

        Raises
        ------
        ApiError
            For a platform that is not configured.
        """
        platform = self._tool.platform(given.get("iss", ""), given.get("client_id", ""))
        if platform is None:
            raise _refused("its platform is not configured here")
        if not given.get("login_hint"):
            raise _refused("the platform gives no login_hint")
        browser, nonce = new_secret(), new_secret()
        state = f"state-{self._logins.put(Login(platform, nonce, hash_of(browser)))}"
        asked = {
            "scope": "openid",
            "response_type": "id_token",
            "response_mode": "form_post",
            "prompt": "none",
            "client_id": platform.client_id,
            "redirect_uri": launch_url,
            "state": state,
            "nonce": nonce,
            **{name: given[name] for name in ("login_hint", "lti_message_hint") if given.get(name)},
        }
        return f"{platform.auth_login_url}?{urlencode(asked)}", state, browser

    async def end(self, given: Mapping[str, str]) -> tuple[Launch, Login]:
        """Return a launch that a platform has signed.

        Raises
        ------
        ApiError
            Where anything is not as it has to be.
        """
        login = self._logins.take(given.get("state", "").removeprefix("state-"))
        if login is None:
            raise _refused("this launch has been used, or began too long ago")
        if given.get("error"):
            raise _refused(given.get("error_description") or given["error"])
        message = given.get("id_token", "")
        key_id, claims = _unchecked(message)
        named = self._tool.platform(text_of(claims.get("iss")), _client_of(claims))
        if named is None:
            raise _refused("Registration not found: no platform of its issuer and client id is configured here")
        if named != login.platform:
            raise _refused("the launch ended at another platform than it began")
        key = await self._key_sets.key(named.key_set_url, key_id)
        if key is None:
            raise _refused("the platform shows no public key of the id that the message names")
        try:
            jwt.decode(message, key, algorithms=[ALGORITHM], options=SIGNATURE_ALONE)
        except jwt.PyJWTError as error:
            raise _refused(str(error)) from None
        self._check_times(claims)
        if claims.get("nonce") != login.nonce:
            raise _refused("its Nonce is not the one of this launch")
        launch = Launch(named, claims)
        _check(launch)
        return launch, login

    def _check_times(self, claims: Mapping[str, Any]) -> None:
        """Refuse a message that has expired, or is of the future."""
        now = self.clock()
        if (past_s := now - _time_of(claims, "exp")) >= TOLERANCE_S:
            raise _refused(f"it has expired {past_s:.0f} s ago by the clock of this server")
        for name in ("iat", *(["nbf"] if "nbf" in claims else [])):
            if (ahead_s := _time_of(claims, name) - now) > TOLERANCE_S:
                raise _refused(f"its time ({name}) is {ahead_s:.0f} s ahead of the clock of this server")

    def link(self, launch: Launch, resource: dict[str, Any]) -> tuple[str, str]:
        """Return where the choice of an exercise goes, and the signed message."""
        data, now = launch.claims[DEEP_LINKING].get("data"), int(self.clock())
        answer = {
            "iss": launch.platform.client_id,
            "aud": [launch.platform.issuer],
            "iat": now,
            "exp": now + ANSWER_S,
            "nonce": new_secret(),
            f"{CLAIM}deployment_id": launch.deployment,
            f"{CLAIM}message_type": "LtiDeepLinkingResponse",
            f"{CLAIM}version": "1.3.0",
            LINK_ITEMS: [resource],
            **({LINK_DATA: data} if data is not None else {}),  # to be sent back if it came, and only then
        }
        return launch.return_address, self._tool.sign(answer)


def _unchecked(message: str) -> tuple[str, Mapping[str, Any]]:
    """Return the id of the key that signed a message, and its claims; the algorithm is set by this server."""
    if message.count(".") != 2:
        raise _refused("its message has to have 3 parts")
    try:
        header = jwt.get_unverified_header(message)
        claims = jwt.decode(message, options=NOTHING)
    except jwt.PyJWTError:
        raise _refused("its message cannot be decoded") from None
    if (algorithm := header.get("alg")) != ALGORITHM:
        raise _refused(f"no public key can check it: it is signed by {algorithm}, not by {ALGORITHM}")
    if not (key_id := header.get("kid")):
        raise _refused("it does not name its key (KID)")
    return key_id, claims


def _client_of(claims: Mapping[str, Any]) -> str:
    """Return the client id of the audience; of several, ``azp``."""
    audience: Any = claims.get("aud")
    if isinstance(audience, list):
        named = claims.get("azp") if len(audience) > 1 else audience[0] if audience else None
        if named not in audience:
            raise _refused("it is for several tools, and does not say for which")
        audience = named
    if not isinstance(audience, str) or not audience:
        raise _refused("its client id is not registered for this issuer")
    return audience


def _time_of(claims: Mapping[str, Any], name: str) -> float:
    """Return a time of a message, seconds since 1970."""
    found = claims.get(name)
    if not isinstance(found, int | float) or isinstance(found, bool) or not abs(found) < FAR_S:
        raise _refused(f"its time {name} is missing or no number")
    return float(found)


def _check(launch: Launch) -> None:
    """Refuse a message that is for another deployment, or that is no launch of LTI 1.3."""
    if launch.deployment not in launch.platform.deployment_ids:
        raise _refused("its deployment is not configured here")
    if not launch.user:
        raise _refused("the platform does not say who the user is")
    if launch.claims.get(f"{CLAIM}version") != "1.3.0":
        raise _refused("its version is not 1.3.0")
    if launch.claims.get(f"{CLAIM}roles") is None:
        raise _refused("it names no roles")
    if launch.is_choice:
        settings = launch.claims.get(DEEP_LINKING)
        kinds = settings.get("accept_types") if isinstance(settings, dict) else None
        if not isinstance(kinds, list) or "ltiResourceLink" not in kinds:
            raise _refused("the platform takes no link to an exercise")
    elif launch.text(f"{CLAIM}message_type") != "LtiResourceLinkRequest":
        raise _refused("only links to exercises, and the choice of one, can be launched")
    elif not launch.text(f"{CLAIM}resource_link", "id"):
        raise _refused("it names no Resource Link")


def _refused(why: str) -> ApiError:
    hint = "open the exercise again from your course; if it stays so, tell who runs this server"
    return ApiError(403, "lti_refused", f"the launch was refused: {why}", hint=hint)
