"""List what CombBench is made of, and ask whether anything of it is known to be vulnerable.

``audit.py python FOLDER`` looks at the packages of the environment it runs in, or of ``--python``; ``audit.py page
FOLDER`` at those the page is built from. Each leaves a list of components there (CycloneDX, JSON). A known weakness is
an error. An index that knows no advisories, such as a mirror, is none: it is said how many packages it knew.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
ASK_S = 300.0


def said(*command: str | Path) -> str:
    """Return the output of a command, whatever its exit code means."""
    return subprocess.run(command, cwd=ROOT, text=True, stdout=subprocess.PIPE, timeout=ASK_S, check=False).stdout


def answered(text: str) -> dict[str, Any]:
    """Return an answer in JSON; an invalid answer is empty."""
    try:
        found = json.loads(text)
    except json.JSONDecodeError:
        return {}
    return found if isinstance(found, dict) else {}


def packages(python: Path, folder: Path) -> tuple[list[str], int, int]:
    """List and check the packages of an environment; return weaknesses, packages known to the index, and all."""
    tools, out = Path(sys.executable).parent, folder / "python.cdx.json"
    listing: list[str | Path] = [
        tools / "cyclonedx-py",
        "environment",
        "--output-format",
        "JSON",
        "--output-file",
        out,
        python,
    ]
    subprocess.run(listing, cwd=ROOT, check=True, timeout=ASK_S)
    place = said(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").strip()
    found = answered(said(tools / "pip-audit", "--path", place, "--format", "json", "--progress-spinner", "off"))
    entries = found.get("dependencies", [])
    known = [entry for entry in entries if "skip_reason" not in entry]
    weak = [
        f"{entry['name']} {entry['version']}: {one['id']}, mended in {', '.join(one['fix_versions']) or 'no version'}"
        for entry in known
        for one in entry["vulns"]
    ]
    return weak, len(known), len(entries)


def page(folder: Path) -> tuple[list[str], int, int]:
    """List and check the packages of the page; return weaknesses, packages known to the index, and all."""
    npm: list[str | Path] = [ROOT / "scripts" / "npm", "--silent", "--prefix", "web"]
    text = said(*npm, "sbom", "--sbom-format", "cyclonedx", "--omit", "dev", "--package-lock-only")
    (folder / "page.cdx.json").write_text(text)
    count = len(answered(text)["components"])
    found = answered(said(*npm, "audit", "--json", "--omit", "dev"))
    weak = [f"{name}: {entry['severity']}" for name, entry in found.get("vulnerabilities", {}).items()]
    return weak, count if "vulnerabilities" in found else 0, count


def main() -> int:
    """List and check one kind of package."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("kind", choices=["python", "page"])
    parser.add_argument("folder", type=Path, help="where the list of components goes")
    parser.add_argument("--python", type=Path, default=Path(sys.executable), help="interpreter of the environment")
    told = parser.parse_args()
    told.folder.mkdir(parents=True, exist_ok=True)
    folder = told.folder.resolve()
    weak, known, count = packages(told.python, folder) if told.kind == "python" else page(folder)
    print(
        f"{told.kind}: {count} packages, {known} of them known to the index, {len(weak)} known weaknesses", flush=True
    )
    for line in weak:
        print(f"  {line}")
    return 1 if weak else 0


if __name__ == "__main__":
    sys.exit(main())
