"""The messages of a launch, as pylti1p3 checks them: an adapter whose memory is a store of single use.

The library keeps states in cookies and nonces in sessions. In a frame of another site there are no cookies, so that
here both are kept by the server, behind the state, which is a secret that works once and for a short time. The server
checks by a third secret, which the page keeps, that the same browser began and ended a launch.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import jwt
from cryptography.hazmat.primitives.asymmetric.rsa import RSAPublicKey
from pylti1p3.cookie import CookieService
from pylti1p3.deep_link import DeepLink
from pylti1p3.deep_link_resource import DeepLinkResource
from pylti1p3.exception import LtiException, OIDCException
from pylti1p3.message_launch import MessageLaunch
from pylti1p3.oidc_login import OIDCLogin
from pylti1p3.redirect import Redirect
from pylti1p3.request import Request
from pylti1p3.session import SessionService

from server.classroom.lti.keys import KeySets
from server.classroom.lti.launch import CLAIM, DEEP_LINKING, Launch, text_of
from server.classroom.lti.tool import Tool
from server.errors import ApiError
from server.security.once import Once
from server.security.person import hash_of, new_secret
from server.security.platforms import Platform

LOGIN_S = 300.0
ALGORITHM = "RS256"
TOLERANCE_S = 60.0
"""How far the clocks of a platform and of this server may differ."""
FAR_S = 1e12
"""Times are nearer to 1970 than this."""
SIGNATURE_ALONE: Any = {f"verify_{name}": False for name in ("aud", "iss", "sub", "jti", "exp", "nbf", "iat")}
"""The library compares audience and issuer itself; times are checked by our tolerance."""


@dataclass(frozen=True)
class Login:
    """A launch that has begun: its platform, and the values that have to come back."""

    platform: Platform
    nonce: str
    browser_hash: str


class _Parameters(Request):
    """The parameters of a request."""

    def __init__(self, given: Mapping[str, str]) -> None:
        self._given = given

    def is_secure(self) -> bool:
        """Answer yes: the parts of the library that we use do not ask."""
        return True

    def get_param(self, key: str) -> str:
        """Return a parameter."""
        return self._given.get(key, "")


class _Memory(SessionService, CookieService):
    """The nonce and the state of one login, which the library would keep in a session and a cookie."""

    def __init__(self, nonce: str = "", state: str = "") -> None:
        self.nonce, self._state = nonce, state

    def save_nonce(self, nonce: str) -> None:
        """Keep the nonce that the library has made."""
        self.nonce = nonce

    def check_nonce(self, nonce: str) -> bool:
        """Whether it belongs to the login whose state came back."""
        return bool(nonce) and nonce == self.nonce

    def get_cookie(self, name: str) -> str | None:
        """Return the state of the login, under its own name."""
        return self._state if name == self._state else None

    def set_cookie(self, *_: Any, **__: Any) -> None:
        """Keep no cookie: the state is a secret of ours."""

    def check_state_is_valid(self, *_: Any) -> bool:
        """Never count a state as checked before."""
        return False

    def save_launch_data(self, *_: Any) -> None:
        """Store nothing from the platform."""

    def set_state_valid(self, *_: Any) -> None:
        """Keep nothing: a state works once."""


class _Login(OIDCLogin[_Parameters, Tool, _Memory, _Memory, str]):
    """The beginning of a launch."""

    def get_redirect(self, url: str) -> Redirect[str]:
        """Lead nowhere: our page does."""
        raise NotImplementedError

    def address(self, launch_url: str, state: str) -> str:
        """Return where the browser goes; the state of the library gives way to one of ours."""
        self._get_uuid = lambda: state  # type: ignore[method-assign]
        return self._prepare_redirect_url(launch_url)


class _Message(MessageLaunch[_Parameters, Tool, _Memory, _Memory]):
    """The end of a launch."""

    key: RSAPublicKey | None = None
    """The key of the platform, by the id that the message names."""
    now: float = 0.0
    """The time by our clock."""

    def _get_request_param(self, key: str) -> str:
        return self._request.get_param(key)

    def key_id(self) -> str:
        """Return the id of the key that signed; this server sets the algorithm, not the message."""
        self.validate_jwt_format()
        header, body = self._jwt.get("header"), self._jwt.get("body")
        if not isinstance(header, dict) or not isinstance(body, dict):
            raise LtiException("Invalid JWT format, can't be decoded")
        if (algorithm := header.get("alg")) != ALGORITHM:
            raise LtiException(f"Unable to find public key: signed by {algorithm}, not by {ALGORITHM}")
        if not (kid := header.get("kid")) or not isinstance(kid, str):
            raise LtiException("JWT KID not found")
        return kid

    def get_client_id(self) -> str:
        """Return the client id of the audience; of several, ``azp``."""
        body = self._get_jwt_body()
        audience: Any = body.get("aud")
        if isinstance(audience, list):
            named = body.get("azp") if len(audience) > 1 else audience[0] if audience else None
            if named not in audience:
                raise LtiException("it is for several tools, and does not say for which")
            audience = named
        if not isinstance(audience, str):
            raise LtiException("Client id not registered for this issuer")
        return audience

    def _get_deployment_id(self) -> str:
        return text_of(super()._get_deployment_id())

    def validate_jwt_signature(self) -> _Message:
        """Check signature and times."""
        if self.key is None:
            raise LtiException("Unable to find public key")
        try:
            jwt.decode(self._get_id_token(), self.key, algorithms=[ALGORITHM], options=SIGNATURE_ALONE)
        except jwt.PyJWTError as error:
            raise LtiException(f"Can't decode id_token: {error}") from error
        body: Mapping[str, Any] = self._get_jwt_body()
        if (past_s := self.now - _time_of(body, "exp")) >= TOLERANCE_S:
            raise LtiException(f"it has expired {past_s:.0f} s ago by the clock of this server")
        for name in ("iat", *(["nbf"] if "nbf" in body else [])):
            if (ahead_s := _time_of(body, name) - self.now) > TOLERANCE_S:
                raise LtiException(f"its time ({name}) is {ahead_s:.0f} s ahead of the clock of this server")
        return self


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
        browser, memory, parameters = new_secret(), _Memory(), _Parameters(given)
        login = _Login(parameters, self._tool, memory, memory)
        try:
            registration = login.validate_oidc_login()
            platform = self._tool.platform(str(registration.get_issuer()), registration.get_client_id())
            assert platform is not None
            nonce = new_secret()
            login._generate_nonce = lambda: nonce  # type: ignore[method-assign]
            state = self._logins.put(Login(platform, nonce, hash_of(browser)))
            return login.address(launch_url, state), f"state-{state}", browser
        except OIDCException as error:
            raise _refused(str(error)) from None

    async def end(self, given: Mapping[str, str]) -> tuple[Launch, Login]:
        """Return a launch that a platform has signed.

        Raises
        ------
        ApiError
            Where anything is not as it has to be.
        """
        state = given.get("state", "")
        login = self._logins.take(state.removeprefix("state-"))
        if login is None:
            raise _refused("this launch has been used, or began too long ago")
        if given.get("error"):
            raise _refused(given.get("error_description") or given["error"])
        memory = _Memory(login.nonce, state)
        message = _Message(_Parameters(given), self._tool, memory, memory)
        message.set_auto_validation(enable=False)
        try:
            kid = message.key_id()
            named = self._tool.platform(str(message.get_iss()), message.get_client_id())
            if named is not None and named != login.platform:
                raise LtiException("the launch ended at another platform than it began")
            message.key = await self._key_sets.key(login.platform.key_set_url, kid)
            message.now = self.clock()
            message.validate()
            claims: Mapping[str, Any] = message.get_launch_data()
        except LtiException as error:
            raise _refused(str(error)) from None
        except (KeyError, TypeError, AttributeError, ValueError, AssertionError):
            raise _refused("the message is not one of LTI 1.3") from None
        if not (message.is_resource_launch() or message.is_deep_link_launch()):
            raise _refused("only links to exercises, and the choice of one, can be launched")
        launch = Launch(login.platform, claims)
        if not launch.user:
            raise _refused("the platform does not say who the user is")
        return launch, login

    def link(self, launch: Launch, resource: DeepLinkResource) -> tuple[str, str]:
        """Return where the choice of an exercise goes, and the signed message."""
        settings = launch.claims[DEEP_LINKING]
        answer = DeepLink(self._tool.registration(launch.platform), launch.text(f"{CLAIM}deployment_id"), settings)
        message = answer.get_message_jwt([resource])
        if settings.get("data") is None:  # to be sent back if it came, and only then
            del message["https://purl.imsglobal.org/spec/lti-dl/claim/data"]
        return str(settings.get("deep_link_return_url", "")), str(answer.encode_jwt(message))  # type: ignore[no-untyped-call]


def _time_of(claims: Mapping[str, Any], name: str) -> float:
    """Return a time of a message, seconds since 1970."""
    found = claims.get(name)
    if not isinstance(found, int | float) or isinstance(found, bool) or not abs(found) < FAR_S:
        raise LtiException(f"its time {name} is missing or no number")
    return float(found)


def _refused(why: str) -> ApiError:
    hint = "open the exercise again from your course; if it stays so, tell who runs this server"
    return ApiError(403, "lti_refused", f"the launch was refused: {why}", hint=hint)
