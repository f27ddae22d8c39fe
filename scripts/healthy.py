"""Ask the service on this machine whether it is ready: exit 0 if so, and print its answer."""

from __future__ import annotations

import os
import sys
import urllib.error
import urllib.request


def main() -> int:
    """Return the exit code."""
    url = f"http://127.0.0.1:{os.environ.get('COMBBENCH_PORT', '8000')}/health/ready"
    try:
        with urllib.request.urlopen(url, timeout=3) as answer:
            print(answer.read().decode())
    except urllib.error.HTTPError as error:
        print(f"{url}: {error}: {error.read().decode()}", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"{url}: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
