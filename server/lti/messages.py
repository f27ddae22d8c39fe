"""The messages of a launch, as pylti1p3 checks them: an adapter whose memory is a store of single use.

The library keeps states in cookies and nonces in sessions. In a frame of another site there are no cookies, so that
here both are kept by the server, behind the state, which is a secret that works once and for a short time. Whether the
browser that ends a launch is the one that began it is checked by a third secret, which the page keeps.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pylti1p3.cookie import CookieService
from pylti1p3.deep_link import DeepLink
from pylti1p3.deep_link_resource import DeepLinkResource
from pylti1p3.exception import LtiException, OIDCException
from pylti1p3.message_launch import MessageLaunch
from pylti1p3.oidc_login import OIDCLogin
from pylti1p3.redirect import Redirect
from pylti1p3.request import Request
from pylti1p3.session import SessionService

from server.errors import ApiError
from server.lti.launch import CLAIM, DEEP_LINKING, Launch
from server.lti.tool import Tool, Web
from server.people.person import hash_of, new_secret
from server.platforms import Platform
from server.security.once import Once

LOGIN_S = 300.0
ALGORITHM = "RS256"


@dataclass(frozen=True)
class Login:
    """A launch that has begun: whose it is, and what has to come back."""

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
        """Whether it is that of the login whose state came back."""
        return bool(nonce) and nonce == self.nonce

    def get_cookie(self, name: str) -> str | None:
        """Return the state of the login, under its own name."""
        return self._state if name == self._state else None

    def set_cookie(self, *_: Any, **__: Any) -> None:
        """Keep no cookie: the state is a secret of ours."""

    def check_state_is_valid(self, *_: Any) -> bool:
        """Take no state for one that was checked before."""
        return False

    def save_launch_data(self, *_: Any) -> None:
        """Keep nothing of what the platform says."""

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

    def _get_request_param(self, key: str) -> str:
        return self._request.get_param(key)

    def get_public_key(self) -> tuple[str, str]:
        """Return the key of the platform that signed; the algorithm is ours to say, not the message's."""
        key, algorithm = super().get_public_key()
        if algorithm != ALGORITHM:
            raise LtiException(f"signed by {algorithm}, not by {ALGORITHM}")
        return key, algorithm


class Messages:
    """Begins launches, and checks how they end.

    Parameters
    ----------
    tool : Tool
        This server's keys and platforms.
    """

    def __init__(self, tool: Tool) -> None:
        self._tool = tool
        self._logins = Once[Login](LOGIN_S)

    def begin(self, given: Mapping[str, str], launch_url: str) -> tuple[str, str, str]:
        """Return where a browser goes to be told who it is, the state, and the secret that this browser keeps.

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

    def end(self, given: Mapping[str, str]) -> tuple[Launch, Login]:
        """Return a launch that a platform has signed; asks the platform for its keys, so call it in a thread.

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
        with Web() as web:
            message = _Message(_Parameters(given), self._tool, memory, memory, requests_session=web)
            # the audience is compared with the client id by the library itself
            message.set_jwt_verify_options({"verify_aud": False, "require": ["exp", "iat", "nonce"]})  # type: ignore[dict-item]
            try:
                message.validate()
                claims: Mapping[str, Any] = message.get_launch_data()
            except LtiException as error:
                raise _refused(str(error)) from None
            except (KeyError, TypeError, AttributeError, ValueError, AssertionError):
                raise _refused("the message is not one of LTI 1.3") from None
        audience = claims["aud"]
        if isinstance(audience, list) and len(audience) > 1 and claims.get("azp") != login.platform.client_id:
            raise _refused("the message is for several tools, and does not say that it is for this one")
        if (message.get_iss(), message.get_client_id()) != (login.platform.issuer, login.platform.client_id):
            raise _refused("the launch ended at another platform than it began")
        if not (message.is_resource_launch() or message.is_deep_link_launch()):
            raise _refused("only links to exercises, and the choice of one, can be launched")
        return Launch(login.platform, claims), login

    def link(self, launch: Launch, resource: DeepLinkResource) -> tuple[str, str]:
        """Return where the choice of an exercise goes, and the signed message."""
        settings = launch.claims[DEEP_LINKING]
        answer = DeepLink(self._tool.registration(launch.platform), launch.text(f"{CLAIM}deployment_id"), settings)
        message = answer.get_message_jwt([resource])
        if settings.get("data") is None:  # to be sent back if it came, and only then
            del message["https://purl.imsglobal.org/spec/lti-dl/claim/data"]
        return str(settings.get("deep_link_return_url", "")), str(answer.encode_jwt(message))  # type: ignore[no-untyped-call]


def _refused(why: str) -> ApiError:
    hint = "open the exercise again from your course; if it stays so, tell who runs this server"
    return ApiError(403, "lti_refused", f"the launch was refused: {why}", hint=hint)
