"""Print the service's OpenAPI document, from which the page's types are generated."""

from __future__ import annotations

import json
import sys
import tempfile
from pathlib import Path

from server.app import create_app
from server.settings import Settings


def main() -> None:
    """Build the application over an empty data folder, never started, and print its document."""
    with tempfile.TemporaryDirectory() as folder:
        document = create_app(Settings(data=Path(folder))).openapi()
    json.dump(document, sys.stdout, indent=2)
    print()


if __name__ == "__main__":
    main()
