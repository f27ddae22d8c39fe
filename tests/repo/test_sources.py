"""Files stay short, and none knows a machine or a registry."""

from __future__ import annotations

import re
from pathlib import Path

LONGEST = 400
GENERATED = {"web/src/api/schema.d.ts"}
TEXT = {".py", ".ts", ".tsx", ".css", ".html", ".md", ".toml", ".json", ".yaml", ".yml", ".lock", ".sh", ".mako", ""}
MACHINE = re.compile(r"""(?:^|[\s"'`=(:])/(?:work|root|home/\w+|Users/\w+|opt/\w+)/""", re.M)
REGISTRY = re.compile(
    r"pypi\.org|pythonhosted\.org|registry\.npmjs|npmjs\.(?:org|com)|deb\.debian\.org|crates\.io|"
    r"--(?:extra-)?index-url|find-links",
    re.I,
)


def test_no_file_is_too_long(root: Path, files: list[Path]) -> None:
    long = {}
    for path in files:
        name = path.relative_to(root).as_posix()
        if path.suffix in {".py", ".ts", ".tsx"} and name not in GENERATED:
            lines = path.read_text().count("\n")
            if lines > LONGEST:
                long[name] = lines
    assert not long, f"more than {LONGEST} lines; a file has one noun"


def test_no_file_names_a_machine_or_a_registry(root: Path, files: list[Path]) -> None:
    found = []
    for path in files:
        if path.suffix in TEXT and path != Path(__file__):
            text = path.read_text(errors="replace")
            found += [f"{path.relative_to(root)}: {m[0].strip()}" for m in MACHINE.finditer(text)]
            found += [f"{path.relative_to(root)}: {m[0]}" for m in REGISTRY.finditer(text)]
    assert not found


def test_no_file_is_big(root: Path, files: list[Path]) -> None:
    big = {str(p.relative_to(root)): p.stat().st_size for p in files if p.stat().st_size > 1_000_000}
    assert not big, "the repository holds sources, not data"


def test_the_board_and_its_loop_do_not_know_what_turns(root: Path) -> None:
    sources = [*root.glob("core/board/*.py"), *root.glob("core/loop/*.py")]
    words = re.compile("gyro|coriolis", re.IGNORECASE)
    assert len(sources) > 20
    assert [path.name for path in sources if words.search(path.read_text())] == []
