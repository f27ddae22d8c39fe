"""Plant the faults of ``tests/mutations`` one by one in a copy of the checkout, and see the tests that name them fail.

``make mutations`` tries all; ``ARGS="slider-tap ack"`` those whose names have one of these words. A patch that no
longer applies is reported, like a fault that no test notices.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import tomllib
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "tests" / "mutations"
LINKED = (".venv", "web/node_modules")


@dataclass(frozen=True)
class Mutation:
    """A planted fault.

    Parameters
    ----------
    patch : str
        Name of the patch in the folder.
    origin : str
        The commit whose fix it reverses, or how it was made.
    layer, kind : str
        Where it is and of what sort.
    breaks : str
        The symptom for a user.
    caught_by : tuple of str
        The tests that fail with it: ids of pytest, or files of the page with ``::title``.
    """

    patch: str
    origin: str
    layer: str
    kind: str
    breaks: str
    caught_by: tuple[str, ...]

    @property
    def name(self) -> str:
        """The name of the patch without its ending."""
        return self.patch.removesuffix(".patch")


def listed() -> list[Mutation]:
    """Read the lists of the folder."""
    found = []
    for path in sorted(FOLDER.glob("*.toml")):
        for entry in tomllib.loads(path.read_text("utf-8"))["mutation"]:
            fields = {name: entry[name] for name in ("patch", "origin", "layer", "kind", "breaks")}
            found.append(Mutation(**fields, caught_by=tuple(entry["caught_by"])))
    return found


def command_of(test: str) -> list[list[str]]:
    """Return the commands that run one test of a checkout."""
    file, _, title = test.partition("::")
    if not file.startswith("web/"):
        return [
            [".venv/bin/python", "-m", "pytest", "-q", "-x", "--long", "--timeout=60", "-p", "no:cacheprovider", test]
        ]
    inside = file.removeprefix("web/")
    chosen = ["-t", title] if title else []
    if inside.startswith("src/"):
        return [["scripts/npm", "--prefix", "web", "exec", "--", "vitest", "run", "--root", "web", inside, *chosen]]
    grep = ["-g", title] if title else []
    build = ["scripts/npm", "--silent", "--prefix", "web", "exec", "--", "vite", "build", "web", "--logLevel", "error"]
    run = ["scripts/npm", "--prefix", "web", "run", "e2e", "--", inside, *grep]
    return [build, run]


def is_caught(mutation: Mutation, checkout: Path) -> str:
    """Plant a fault and return what came of it: the test that failed, or why none did."""
    patch = str(FOLDER / mutation.patch)
    if subprocess.run(["git", "apply", "--3way", patch], cwd=checkout, capture_output=True).returncode:
        subprocess.run(["git", "checkout", "-q", "--force", "HEAD", "--", "."], cwd=checkout, check=True)
        return "does not apply"
    environment = os.environ | {"PYTHONPATH": str(checkout), "SUITE": "all"}
    try:
        for test in mutation.caught_by:
            for command in command_of(test):
                ended = subprocess.run(command, cwd=checkout, env=environment, capture_output=True, text=True)
                if ended.returncode > 1:  # pytest found no such test, or broke off
                    return f"cannot run {test}"
                if ended.returncode:
                    return f"caught by {test}"
        return "not caught"
    finally:
        subprocess.run(["git", "checkout", "-q", "--force", "HEAD", "--", "."], cwd=checkout, check=True)


def main() -> int:
    """Try the mutations and print a line for each."""
    wanted = [one for one in listed() if not sys.argv[1:] or any(word in one.name for word in sys.argv[1:])]
    missed = 0
    with tempfile.TemporaryDirectory(prefix="combbench-mutations-") as folder:
        checkout = Path(folder) / "checkout"
        subprocess.run(["git", "worktree", "add", "-q", "--detach", str(checkout), "HEAD"], cwd=ROOT, check=True)
        try:
            for name in LINKED:
                (checkout / name).symlink_to(ROOT / name)
            for mutation in wanted:
                result = is_caught(mutation, checkout)
                missed += not result.startswith("caught")
                print(f"{mutation.name:36} {mutation.layer:10} {result}", flush=True)
        finally:
            subprocess.run(["git", "worktree", "remove", "--force", str(checkout)], cwd=ROOT, check=True)
    print(f"{len(wanted) - missed} of {len(wanted)} caught")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
