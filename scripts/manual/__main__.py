"""Build the site of the documents: ``make docs``.

Pages come from the documents of the checkout and from the code; a warning of Sphinx ends the build with an error.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

from sphinx.cmd.build import build_main

from manual.plan import SITE
from manual.site import write

HERE = Path(__file__).resolve().parent
STRICT = ["-q", "-W", "--keep-going"]


def main() -> int:
    """Build the site, then put it into its folder or the one that is given; return the exit code."""
    site = Path(sys.argv[1]) if len(sys.argv) > 1 else SITE
    with tempfile.TemporaryDirectory() as made:
        source, built = Path(made, "source"), Path(made, "built")
        write(source)
        code: int = build_main([*STRICT, "-c", str(HERE), "-d", f"{made}/trees", str(source), str(built)])
        if code == 0:
            shutil.rmtree(site, ignore_errors=True)
            shutil.move(built, site)
    return code


if __name__ == "__main__":
    sys.exit(main())
