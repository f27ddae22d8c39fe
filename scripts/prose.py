"""List sentences of changed lines that may need a second look: for information, never a failure.

``prose.py`` reads the lines that differ from the branch ``main``, or from the last commit on ``main`` itself; with
paths it reads whole files. A sentence has a subject, a verb and an object: rewrite a listed sentence, or keep it.
"""

from __future__ import annotations

import io
import re
import subprocess
import sys
import tokenize
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROSE = (".md", ".py", ".ts", ".tsx")
LEFT_OUT = ("schema.d.ts",)
MOST_WORDS = 40
DONE_TO = (
    r"\b(?:is|are|was|were|be|been|being)\s+(?:\w+ly\s+|not\s+)?(?:\w+(?:ed|en|wn|ld|ought)|kept|made|read|sent|put)\b"
)
RULES = {
    "a pronoun in place of a noun": re.compile(
        r"(?:^|[,;:(] ?)(?:[Ww]hat|[Ww]hoever|[Tt]hose) (?:is|are|has|was|were|it|the|who|which|that|of|a)\b(?!.*\?)"
        r"|\b(?:one|ones|that|those) (?:of which|whose|who|of (?:a|the) \w+ (?:is|are))\b|\b(?:some|any|no)body\b"
    ),
    "a thing that acts like a person": re.compile(
        r"\b(?:bench|board|page|server|file|block|tick|panel|run|door|signal|state|table|view|figure|bank|list)s? "
        r"(?:stands?|lies?|hears?|tells?|wants?|wishes|looks?(?! (?:up|for))|thinks?|sits?|goes on|is let go|speaks?)\b"
    ),
    "a chain of passives": re.compile(rf"{DONE_TO}.*{DONE_TO}.*{DONE_TO}"),
    "a long sentence": re.compile(rf"^(?:\S+\s+){{{MOST_WORDS},}}\S+$"),
}
SENTENCE = re.compile(r"(?<=[.!?])\s+(?=[A-Z`*\[])")


def said_in(path: Path) -> Iterator[tuple[int, int, str]]:
    """Yield the prose of a file: first and last line, and the text."""
    text = path.read_text(errors="replace")
    if path.suffix == ".py":
        before = tokenize.NEWLINE
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            begins = before in (tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT)
            if token.type == tokenize.COMMENT or (token.type == tokenize.STRING and begins):
                yield token.start[0], token.end[0], token.string.strip("#\"'r ")
            if token.type not in (tokenize.COMMENT, tokenize.NL):
                before = token.type
        return
    pattern = r"/\*\*?(.*?)\*/|//([^\n]*)" if path.suffix != ".md" else r"((?:^(?!```|\|)[^\n]+\n?)+|^\|[^\n]+)"
    bare = text if path.suffix != ".md" else re.sub(r"```.*?```", lambda m: "\n" * m[0].count("\n"), text, flags=re.S)
    for match in re.finditer(pattern, bare, re.S | re.M):
        first = bare.count("\n", 0, match.start()) + 1
        said = match[1] or match[match.lastindex or 0]
        yield first, first + match[0].rstrip().count("\n"), re.sub(r"\n\s*\*", " ", said)


def findings(text: str) -> list[tuple[str, str]]:
    """Return the rule and the sentence for each sentence of a text that may need a second look."""
    blocks = re.split(r"\n\s*\n|\n\s*(?:[-*]|\d+\.) ", text)
    parts = [part for block in blocks for part in SENTENCE.split(" ".join(block.split()))]
    return [(rule, part) for part in parts for rule, pattern in RULES.items() if pattern.search(part)]


def git(*words: str) -> str:
    """Return the output of git, empty if it fails."""
    return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False).stdout


def changed_lines() -> dict[str, set[int]]:
    """Return the lines of each file that differ from the branch ``main``, or from the last commit."""
    base = git("merge-base", "HEAD", "main").strip() or "HEAD"
    lines: dict[str, set[int]] = {}
    name = ""
    for line in git("diff", "-U0", base).splitlines():
        if line.startswith("+++ "):
            name = line.removeprefix("+++ b/")
        elif match := re.match(r"@@ -\S+ \+(\d+)(?:,(\d+))?", line):
            first, count = int(match[1]), int(match[2] or 1)
            lines.setdefault(name, set()).update(range(first, first + count))
    return lines


def main() -> int:
    """Print the sentences."""
    whole, changed = sys.argv[1:], {} if sys.argv[1:] else changed_lines()
    count = 0
    for name in whole or sorted(changed):
        path = ROOT / name
        if path.suffix not in PROSE or path.name in LEFT_OUT or not path.is_file():
            continue
        for first, last, text in said_in(path):
            if whole or not changed[name].isdisjoint(range(first, last + 1)):
                for rule, sentence in findings(text):
                    count += 1
                    print(f"{name}:{first}: {rule}: {sentence[:160]}")
    print(f"{count} sentences of changed lines may need a second look (for information)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
