"""A small learning platform: it signs launches with a key of its own, takes choices of exercises, and keeps scores.

As a program, for the tests in a browser, it shows a course whose page has the exercise in a frame:
``python -m tests.server.classroom.lti.platform PORT ADDRESS_OF_THE_TOOL [SHEET]``.
"""

from __future__ import annotations

import html
import json
import sys
import threading
import time
from functools import cache
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import parse_qs, parse_qsl, urlencode, urlsplit

import jwt
from cryptography.hazmat.primitives.asymmetric import rsa
from jwt.algorithms import RSAAlgorithm

CLAIM = "https://purl.imsglobal.org/spec/lti/claim/"
DEEP_LINKING = "https://purl.imsglobal.org/spec/lti-dl/claim/deep_linking_settings"
GRADES = "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint"
SCORE = "https://purl.imsglobal.org/spec/lti-ags/scope/score"
MEMBERSHIP = "http://purl.imsglobal.org/vocab/lis/v2/membership#"
KID = "key of the platform"


@cache
def key_of(name: str) -> rsa.RSAPrivateKey:
    """Return a key, made once for each name: that takes a while."""
    return rsa.generate_private_key(public_exponent=65537, key_size=2048)


class Platform:
    """A platform on loopback.

    Parameters
    ----------
    client_id : str
        Its name for the tool.
    port : int
        Where it listens; 0 picks a free one.
    tool : str
        Address of the tool, for the page of the course.
    sheet : str
        The target of the link on that page.
    """

    def __init__(self, client_id: str = "combbench", port: int = 0, tool: str = "", sheet: str = "first-look") -> None:
        self.client_id, self.tool, self.sheet = client_id, tool, sheet
        self.key = key_of(client_id)
        self.scores: list[dict[str, Any]] = []
        self.tokens: list[dict[str, str]] = []
        self.key_set: Any = None
        """Its answer instead of its keys."""
        self.asked = 0
        """How often it was asked for its keys."""
        self.shows_keys = threading.Event()
        """Keys are answered only while it is set."""
        self.shows_keys.set()
        self.refusals = 0
        """How many scores are refused before one is taken."""
        self.is_free = threading.Event()
        """Scores are answered only while it is set."""
        self.is_free.set()
        handler = type("Handler", (Handler,), {"platform": self})
        self._server = ThreadingHTTPServer(("127.0.0.1", port), handler)
        self.url = f"http://127.0.0.1:{self._server.server_port}"
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)

    def __enter__(self) -> Platform:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join(5)

    @property
    def settings(self) -> dict[str, Any]:
        """The data of the tool about it."""
        return {
            "issuer": self.url,
            "client_id": self.client_id,
            "auth_login_url": f"{self.url}/auth",
            "auth_token_url": f"{self.url}/token",
            "key_set_url": f"{self.url}/keys",
            "deployment_ids": ["1"],
        }

    def claims(self, nonce: str, role: str = "Learner", **changed: Any) -> dict[str, Any]:
        """Return the message of a launch."""
        custom = {"sheet": self.sheet} if self.sheet else {}
        return {
            "iss": self.url,
            "aud": self.client_id,
            "sub": "user-17",
            "name": "Ada Lovelace",
            "nonce": nonce,
            "iat": int(time.time()),
            "exp": int(time.time()) + 300,
            f"{CLAIM}message_type": "LtiResourceLinkRequest",
            f"{CLAIM}version": "1.3.0",
            f"{CLAIM}deployment_id": "1",
            f"{CLAIM}target_link_uri": f"{self.tool}/lti/launch",
            f"{CLAIM}resource_link": {"id": "link-1"},
            f"{CLAIM}roles": [MEMBERSHIP + role],
            f"{CLAIM}context": {"id": "course-1", "title": "Microsystems"},
            f"{CLAIM}custom": custom,
            GRADES: {"scope": [SCORE], "lineitem": f"{self.url}/items/1?type=2"},
            **changed,
        }

    def choice(self, nonce: str, **changed: Any) -> dict[str, Any]:
        """Return the message by which an instructor is asked for an exercise."""
        settings = {
            "deep_link_return_url": f"{self.url}/choice",
            "accept_types": ["ltiResourceLink"],
            "accept_presentation_document_targets": ["iframe", "window"],
            "data": "to be sent back",
        }
        kind = {f"{CLAIM}message_type": "LtiDeepLinkingRequest", DEEP_LINKING: settings}
        return self.claims(nonce, "Instructor", **kind, **changed)

    def sign(self, claims: dict[str, Any], key: Any = None, kid: str = KID) -> str:
        """Return a message that is signed, however strange its claims are."""
        return jwt.PyJWS().encode(json.dumps(claims).encode(), key or self.key, "RS256", {"kid": kid})


def public_key(key: rsa.RSAPrivateKey, kid: str = KID, **changed: Any) -> dict[str, Any]:
    """Return a key as a key set has it."""
    return {**RSAAlgorithm.to_jwk(key.public_key(), as_dict=True), "kid": kid, "alg": "RS256", "use": "sig", **changed}


class Handler(BaseHTTPRequestHandler):
    """The addresses of a platform."""

    platform: Platform

    def do_GET(self) -> None:
        """Show the keys, the course, or the page that ends a login."""
        path, query = urlsplit(self.path).path, dict(parse_qsl(urlsplit(self.path).query))
        if path == "/keys":
            self.platform.asked += 1
            self.platform.shows_keys.wait(60)
            usual = {"keys": [public_key(self.platform.key)]}
            self._answer(json.dumps(usual if self.platform.key_set is None else self.platform.key_set))
        elif path == "/auth":
            message = self.platform.sign(self.platform.claims(query["nonce"]))
            fields = {"id_token": message, "state": query["state"]}
            inputs = "".join(f"<input type='hidden' name='{k}' value='{html.escape(v)}'>" for k, v in fields.items())
            form = f"<form method='post' action='{html.escape(query['redirect_uri'])}'>{inputs}</form>"
            self._answer(f"<!doctype html>{form}<script>document.forms[0].submit()</script>", "text/html")
        elif path == "/course":
            login = {
                "iss": self.platform.url,
                "login_hint": "17",
                "target_link_uri": f"{self.platform.tool}/lti/launch",
            }
            address = html.escape(f"{self.platform.tool}/lti/login?{urlencode(login)}")
            frame = f"<iframe title='Exercise' src='{address}' width='1380' height='840'></iframe>"
            link = f"<a href='{address}'>Open here</a>"
            self._answer(f"<!doctype html><title>Course</title>{link if 'link' in query else frame}", "text/html")
        elif path == "/scores":
            self._answer(json.dumps(self.platform.scores))
        else:
            self._answer("{}", status=404)

    def do_POST(self) -> None:
        """Give a token, or take a score."""
        body = self.rfile.read(int(self.headers["Content-Length"])).decode()
        path = urlsplit(self.path).path
        if path == "/token":
            self.platform.tokens.append({name: values[0] for name, values in parse_qs(body).items()})
            self._answer(json.dumps({"access_token": "for scores", "token_type": "Bearer", "expires_in": 3600}))
        elif path == "/items/1/scores" and self.headers["Authorization"] == "Bearer for scores":
            self.platform.is_free.wait(60)
            if self.platform.refusals > 0:
                self.platform.refusals -= 1
                self._answer("{}", status=503)
                return
            self.platform.scores.append({**json.loads(body), "type": self.headers["Content-Type"]})
            self._answer("", status=204)
        else:
            self._answer("{}", status=401)

    def _answer(self, text: str, kind: str = "application/json", status: int = 200) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(text.encode())))
        self.end_headers()
        self.wfile.write(text.encode())

    def log_message(self, *_: object) -> None:
        """Say nothing."""


if __name__ == "__main__":
    with Platform(port=int(sys.argv[1]), tool=sys.argv[2], sheet=(*sys.argv, "")[3]):
        print("ready", flush=True)
        sys.stdin.read()
