"""Run every check and test, and say plainly how each went.

``run_tests.py quick`` leaves out slow tests and the browser. A failing step does not stop the next ones. Steps that
need one core run beside the tests of Python, which wait a third of their time for servers and other processes.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import threading
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BIN = ".venv/bin/"
NPM = ["scripts/npm", "--silent", "--prefix", "web"]
COUNT = re.compile(r"(\d+) (passed|failed|errors?|skipped|xfailed|flaky)")
COLOUR = re.compile(r"\x1b\[[\d;]*m")
CLOSING = re.compile(r"^(=+ .*\bin [\d.]+s.*=+|\s*Tests\s+.*\(\d+\)|\s+\d+ (passed|failed|flaky|skipped)\b.*)$")
REASON = re.compile(
    r"^(FAILED |ERROR |server said: |\s+\d+\) \S+\.ts:|\s+(Error|Locator|Expected|Received)[\w ]*: "
    r"|\s+> *\d+ \||\s+[-+] {2,}\S)"
)
MOST_REASONS = 40
"""Lines that say why something failed, shown once more at the end."""


@dataclass
class Step:
    """One command; ``tests`` when it prints how many tests passed, ``aside`` when it may run beside others."""

    name: str
    command: list[str]
    tests: bool = False
    aside: bool = False
    code: int = 0
    seconds: float = 0.0
    closing: list[str] = field(default_factory=list)
    reasons: list[str] = field(default_factory=list)

    def run(self) -> None:
        """Run the command, showing its output as it comes, or all at the end if it runs aside; keep closing lines."""
        said = [f"\n== {self.name}: {' '.join(self.command)}\n"]
        if not self.aside:
            print(*said, end="", flush=True)
        start = time.monotonic()
        with subprocess.Popen(
            self.command,
            cwd=ROOT,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
        ) as process:
            assert process.stdout is not None
            for line in process.stdout:
                if self.aside:
                    said.append(line)
                else:
                    print(line, end="", flush=True)
                plain = COLOUR.sub("", line).rstrip()
                if self.tests and CLOSING.match(plain):
                    self.closing.append(plain.strip())
                if REASON.match(plain):
                    self.reasons.append(plain[:200])
        self.code = process.returncode
        self.seconds = time.monotonic() - start
        if self.aside:
            print("".join(said), end="", flush=True)
        if self.tests and self.code == 0 and not self.count()["passed"]:
            print(f"{self.name}: no test was run")
            self.code = 1

    def count(self) -> dict[str, int]:
        """Return how many tests passed, failed and were skipped; one expected to fail that did counts apart."""
        total = {"passed": 0, "failed": 0, "skipped": 0, "xfailed": 0}
        for number, word in COUNT.findall(" ".join(self.closing)):
            total["failed" if word.startswith("error") or word == "flaky" else word] += int(number)
        return total


def steps(quick: bool) -> list[Step]:
    """List what to run, the cheapest first."""
    some = ["-m", "not slow"] if quick else []
    listed = [
        Step("format", [f"{BIN}ruff", "format", "--check", "."]),
        Step("lint", [f"{BIN}ruff", "check", "."]),
        Step("imports", [f"{BIN}lint-imports"]),
        Step("types", [f"{BIN}mypy"], aside=True),
        Step("page-check", [*NPM, "run", "check"], aside=True),
        Step("page", [*NPM, "run", "test"], tests=True, aside=True),
        # more processes than cores, because they wait for servers and other processes
        Step("python", [f"{BIN}pytest", "-n", "3", "--dist", "worksteal", *some], tests=True),
    ]
    return listed if quick else [*listed, Step("browser", [*NPM, "run", "e2e"], tests=True)]


def run_all(several: list[Step]) -> None:
    """Run steps one after the other."""
    for step in several:
        step.run()


def main() -> int:
    """Run the steps and print the summary."""
    quick = sys.argv[1:] == ["quick"]
    todo = steps(quick)
    if not quick:
        # The browser tests find their browser by this name.
        browser = subprocess.run(["scripts/chromium"], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=False)
        os.environ["CHROMIUM"] = browser.stdout.strip()
        if browser.returncode:
            print("No Chromium could be found or installed, so the browser tests will fail.", file=sys.stderr)
    beside = threading.Thread(target=run_all, args=([step for step in todo if step.aside],))
    beside.start()
    run_all([step for step in todo if not step.aside and step.name != "browser"])
    beside.join()
    run_all([step for step in todo if step.name == "browser"])  # with the machine to itself

    print("\n== summary")
    total: Counter[str] = Counter(passed=0, failed=0, skipped=0)
    for step in todo:
        counts = step.count() if step.tests else {}
        said = ", ".join(f"{number} {word}" for word, number in counts.items() if number)
        print(f"  {step.name:11}{'ok' if step.code == 0 else 'FAILED':8}{step.seconds:6.1f} s   {said}".rstrip())
        total.update(counts)
    for step in todo:
        if step.name == "python" and step.closing:
            print(step.closing[-1])
    broken = [step.name for step in todo if step.code]
    for step in todo:
        if step.code and step.reasons:
            print(f"why {step.name} failed:", *step.reasons[:MOST_REASONS], sep="\n")
    if broken:
        print(f"FAILED: {', '.join(broken)}")
    print(", ".join(f"{total[word]} {word}" for word in ("passed", "failed", "skipped")))
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
