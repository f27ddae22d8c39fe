"""Run the checks and tests, and print how each step went.

``run_tests.py`` runs the short suite, ``all`` the long one too, ``check`` the static checks alone. ``ONLY=word`` in the
environment runs only tests whose file, folder or name has that word. A failing step does not stop the next ones.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path

from reports import Outcome, read

ROOT = Path(__file__).resolve().parent.parent
BIN = ".venv/bin/"
NPM = ["scripts/npm", "--silent", "--prefix", "web"]
SUITES = ("short", "all", "check")
MOST_REASONS = 40
"""Lines that say why tests failed, shown once more at the end."""
REPORT = Path(tempfile.gettempdir()) / f"combbench-tests-{os.getpid()}"


@dataclass
class Step:
    """A command; a step with tests writes ``report``, and a step ``aside`` shows its output at its end."""

    name: str
    command: list[str]
    report: Path | None = None
    aside: bool = False
    environment: dict[str, str] = field(default_factory=dict)
    code: int = 0
    seconds: float = 0.0
    cpu_seconds: float = 0.0
    outcomes: list[Outcome] = field(default_factory=list)

    def run(self) -> None:
        """Run the command; note its times and the outcome of each test."""
        heading = f"\n== {self.name}: {' '.join(self.command)}\n"
        kept = [heading]
        if not self.aside:
            print(heading, end="", flush=True)
        start = time.monotonic()
        process = subprocess.Popen(
            self.command,
            cwd=ROOT,
            env=os.environ | self.environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
        )
        assert process.stdout is not None
        for line in process.stdout:
            if self.aside:
                kept.append(line)
            else:
                print(line, end="", flush=True)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = self.code = os.waitstatus_to_exitcode(status)
        self.seconds, self.cpu_seconds = time.monotonic() - start, usage.ru_utime + usage.ru_stime
        if self.aside:
            print("".join(kept), end="", flush=True)
        if self.report is not None:
            self.outcomes = read(self.report)

    def count(self, state: str) -> int:
        """Return how many tests ended in a state."""
        return sum(outcome.state == state for outcome in self.outcomes)

    def summary(self) -> str:
        """Return a line with the times and the numbers of tests."""
        counts = ", ".join(f"{n} {state}" for state in ("passed", "failed", "skipped") if (n := self.count(state)))
        verdict = "ok" if self.code == 0 else "FAILED"
        return f"  {self.name:11}{verdict:8}{self.seconds:6.0f} s{self.cpu_seconds:7.0f} s CPU   {counts}".rstrip()


def checks() -> list[Step]:
    """List the static checks."""
    return [
        Step("format", [f"{BIN}ruff", "format", "--check", "."]),
        Step("lint", [f"{BIN}ruff", "check", "."]),
        Step("imports", [f"{BIN}lint-imports"]),
        Step("prose", [f"{BIN}python", "scripts/prose.py"]),
        Step("types", [f"{BIN}mypy"], aside=True),
        Step("page-check", [*NPM, "run", "check"], aside=True),
        Step("document", [*NPM, "run", "check-api"], aside=True),
    ]


def tests(suite: str, only: str = "") -> list[Step]:
    """List the steps that run tests; all steps with the word ``only``, if one is given."""
    page, python, browser = (REPORT / f"{name}.xml" for name in ("page", "python", "browser"))
    long = suite == "all"
    return [
        Step(
            "page",
            [*NPM, "run", "test", "--", "--passWithNoTests", "--reporter=default", "--reporter=junit", *words(only)],
            page,
            aside=True,
            environment={"VITEST_JUNIT": str(page)},
        ),
        Step("library", [f"{BIN}python", "-m", "tests.library_pass"]),
        # More processes than cores, because some tests wait for servers and other processes.
        Step(
            "python",
            [
                *[f"{BIN}pytest", "-q", "-n", "3", "--dist", "worksteal", f"--junitxml={python}"],
                *(["--long"] if long else []),
                *(["-k", only] if only else []),
            ],
            python,
        ),
        Step(
            "browser",
            [*NPM, "run", "e2e", "--", "--pass-with-no-tests", "--reporter=list,junit", *words(only)],
            browser,
            environment={"PLAYWRIGHT_JUNIT_OUTPUT_FILE": str(browser), "SUITE": suite},
        ),
    ]


def words(only: str) -> list[str]:
    """Return the filter by file of the page's test runners."""
    return [only] if only else []


def find_browser() -> None:
    """Install a Chromium if the machine has none; the browser tests find it by this name."""
    found = subprocess.run(["scripts/chromium"], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=False)
    os.environ["CHROMIUM"] = found.stdout.strip()
    if found.returncode:
        print("No Chromium could be found or installed, so the browser tests will fail.", file=sys.stderr)


def run_all(steps: list[Step]) -> None:
    """Run steps one after the other."""
    for step in steps:
        step.run()


def main() -> int:
    """Run the steps and print the summary."""
    suite = sys.argv[1] if len(sys.argv) > 1 else "short"
    if suite not in SUITES:
        print(f"suite must be one of {', '.join(SUITES)}", file=sys.stderr)
        return 2
    only = os.environ.get("ONLY", "")
    REPORT.mkdir(exist_ok=True)
    steps = [] if only else checks()
    if suite != "check":
        find_browser()
        steps += tests(suite, only)
    beside = threading.Thread(target=run_all, args=([step for step in steps if step.aside],))
    beside.start()
    run_all([step for step in steps if not step.aside and step.name != "browser"])
    beside.join()
    run_all([step for step in steps if step.name == "browser"])  # with the machine to itself

    for step in steps:
        # 5: pytest found no test of this word
        if step.report is not None and (not step.outcomes or step.code == 5):
            step.code = 0 if only and step.code in (0, 5) else step.code or 1
    print("\n== summary", *(step.summary() for step in steps), sep="\n")
    reasons = [line for step in steps for outcome in step.outcomes for line in outcome.reason_lines]
    if reasons:
        print("why:", *reasons[:MOST_REASONS], sep="\n")
    broken = [step.name for step in steps if step.code]
    if broken:
        print(f"FAILED: {', '.join(broken)}")
    if suite != "check":
        print(
            ", ".join(
                f"{sum(step.count(state) for step in steps)} {state}" for state in ("passed", "failed", "skipped")
            )
        )
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
