"""The report of `combbench doctor`: settings and their sources, versions, caches."""

from __future__ import annotations

import os
import platform
from importlib.metadata import PackageNotFoundError, version

from core.errors import InputError
from scenarios.kernel_cache import folder
from scenarios.key import code_version
from server.api.page import DIST
from server.classroom.addresses import join_addresses
from server.security.identity import TOKEN_FILE
from server.settings import describe_settings, load_settings
from server.store.units import FOLDER
from server.version import VERSION

PACKAGES = (
    "numpy",
    "scipy",
    "llvmlite",
    "pydantic",
    "fastapi",
    "uvicorn",
    "websockets",
    "sqlalchemy",
    "viser",
    "wasmtime",
)


def examine() -> dict[str, dict[str, str]]:
    """Return the report: title to name to text.

    Raises
    ------
    InputError
        If the settings themselves are not valid.
    """
    settings = load_settings()
    kernels = folder()
    compiled = sum(1 for _ in kernels.iterdir()) if kernels else 0
    join = ", ".join(join_addresses(settings.host, settings.port)) or "nothing: this machine is on no network"
    token = "from the settings" if settings.token else str(settings.data / TOKEN_FILE)
    return {
        "settings": {row.name: f"{row.value}  ({row.source})" for row in describe_settings(settings)},
        "versions": {
            "combbench": VERSION,
            "python": platform.python_version(),
            **{name: _version(name) for name in PACKAGES},
        },
        "state": {
            "code": code_version(),
            "kernel cache": f"{kernels}, {compiled} kernels" if kernels else "no writable folder",
            "page": "built" if (DIST / "index.html").is_file() else "not built: make setup",
            "data folder": "can be written" if _can_write(settings.data) else "cannot be written",
            "units kept": ", ".join(sorted(file.stem for file in (settings.data / FOLDER).glob("*.py"))) or "none",
            "access token": token,
            "wall around units": _wall() if settings.units == "everyone" else "not asked for: units is not everyone",
            "students open": join if settings.classroom else "nothing: classroom is off",
        },
    }


def _wall() -> str:
    """Say whether the wall around units can be built here."""
    from scenarios import wall  # a slow import that only this function needs

    try:
        wall.build()
    except InputError as error:
        return f"cannot be built: {error.message}"
    return "stands, with the same bits"


def _version(package: str) -> str:
    """Return the installed version."""
    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed"


def _can_write(path: os.PathLike[str]) -> bool:
    """Whether a folder can be written, or made."""
    place = os.path.abspath(path)
    while not os.path.exists(place):
        place = os.path.dirname(place)
    return os.access(place, os.W_OK)
