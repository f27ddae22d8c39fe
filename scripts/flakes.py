"""Run tests again and again on a busy machine, and list the tests that did not pass every time.

``make flakes ARGS="browser --times 20 --busy 2"``: a part of the suite, how often, and beside how many busy processes.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
from collections import Counter

from run_tests import REPORT, ROOT, find_browser, tests

PARTS = ("python", "page", "browser")
BUSY = "while True: pass"
# The browser part keeps the pictures of its failures here until it runs again.
PICTURES = ROOT / "web" / "test-results"


def main() -> int:
    """Run the parts, print a line for each round, and the tests that failed at the end."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("parts", nargs="*", help=f"of {', '.join(PARTS)}; all if none is named")
    parser.add_argument("--times", type=int, default=6)
    parser.add_argument("--busy", type=int, default=2, help="processes that keep the processors busy meanwhile")
    parser.add_argument("--suite", choices=("short", "all"), default="short")
    given = parser.parse_args()
    if unknown := set(given.parts) - set(PARTS):
        parser.error(f"unknown part {', '.join(sorted(unknown))}; allowed: {', '.join(PARTS)}")
    find_browser()
    REPORT.mkdir(exist_ok=True)
    failures: Counter[str] = Counter()
    broken = 0
    busy = [subprocess.Popen([sys.executable, "-c", BUSY]) for _ in range(given.busy)]
    try:
        for number in range(given.times):
            for step in tests(given.suite):
                if step.report is None or step.name not in (given.parts or PARTS):
                    continue
                step.aside = False
                step.run()
                failed = [outcome.name for outcome in step.outcomes if outcome.state == "failed"]
                failures.update(failed)
                broken += step.code != 0
                if step.code and PICTURES.exists():
                    shutil.copytree(PICTURES, REPORT / f"round-{number + 1}", dirs_exist_ok=True)
                print(f"round {number + 1}: {step.summary().strip()}", flush=True)
    finally:
        for process in busy:
            process.kill()
            process.wait()
    print(
        f"\n{broken} of the steps failed; pictures of them are in {REPORT}",
        *(f"{count:4} x {name}" for name, count in failures.most_common()),
        sep="\n",
    )
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
