"""Prints the OpenAPI document: ``python -m server.openapi > web/openapi.json``."""

from __future__ import annotations

import json
import sys
import tempfile
from pathlib import Path

from server.app import create_app
from server.settings import Settings


def main() -> None:
    """Print the document of an application with the usual settings."""
    with tempfile.TemporaryDirectory() as folder:
        document = create_app(Settings(data=Path(folder))).openapi()
    json.dump(document, sys.stdout, indent=1)
    sys.stdout.write("\n")


if __name__ == "__main__":
    main()
