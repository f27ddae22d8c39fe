"""Write the generated parts of the documents: settings, commands, refused scenarios, and the picture of the layers.

``write_documents.py`` renews them in ``docs/``; ``make codegen`` runs it, and a test holds the files to its output.
"""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path
from typing import Any

import typer

from scenarios.in_a_file.bench_file import refusal
from scenarios.library import library
from server.cli.main import app
from server.settings import Settings

ROOT = Path(__file__).resolve().parent.parent
SETTINGS, COMMANDS, PICTURE = "docs/settings.md", "docs/command-line.md", "docs/pictures/layers.svg"
FILES = "docs/in-a-file.md"
ABOUT = {
    "server": "serves benches, classes and runs to the page",
    "scenarios": "what to run, and its results",
    "core": "one tick, in plain numbers",
}
"""The packages from left to right, each with its purpose."""
COLUMN, GAP, LINE, PAD, TOP = 300, 32, 17, 8, 66
"""Measures of the picture, px."""
CHARACTERS = 41
"""Characters that fit into a line of a layer."""
STYLE = """
  svg { font: 13px system-ui, sans-serif }
  svg { --paper: #ffffff; --box: #eef3f8; --edge: #b8c6d4; --ink: #17222d; --soft: #51606e }
  @media (prefers-color-scheme: dark) {
    svg { --paper: #12181e; --box: #1e2831; --edge: #3d4d5b; --ink: #e8eef3; --soft: #a5b4c1 }
  }
  .paper { fill: var(--paper) } .layer { fill: var(--box); stroke: var(--edge) }
  text { fill: var(--ink) } .name { font-weight: 600; font-size: 17px } .about { fill: var(--soft) }
  .arrow { stroke: var(--soft); stroke-width: 1.5; fill: none } .head { fill: var(--soft) }
"""


def cell(text: str) -> str:
    """Return a text as the cell of a table, with links to the documents that it names."""
    escaped = " ".join(text.split()).replace("|", "\\|").replace("<", "\\<")
    return re.sub(r"\bdocs/([\w-]+\.md)", r"[\1](\1)", escaped)


def settings_table() -> str:
    """Return the settings with default and meaning."""
    lines = ["| setting | default | meaning |", "|---|---|---|"]
    for name, field in Settings.model_fields.items():
        default = "" if field.default in (None, "", []) else str(field.default)
        shown = default.lower() if isinstance(field.default, bool) else default
        lines.append(f"| `{name}` | {f'`{shown}`' if shown else ''} | {cell(field.description or '')} |")
    return "\n".join(lines)


def commands_list() -> str:
    """Return each command with its purpose, its arguments and its options."""
    group: Any = typer.main.get_command(app)
    return "\n\n".join(command_text(name, group.commands[name]) for name in sorted(group.commands))


def command_text(name: str, command: Any) -> str:
    """Return the heading, the purpose and the table of a command."""
    given = [one for one in command.params if one.name != "help"]
    arguments = [one for one in given if one.param_type_name == "argument"]
    wanted = [shown(one) if one.required else f"[{shown(one)}]" for one in arguments]
    lines = [f"## combbench {name}", "", f"`{' '.join(['combbench', name, *wanted])}`", "", cell(command.help)]
    rows = [f"| `{shown(one)}` | {cell(one.help or '')}{usual(one)} |" for one in given]
    return "\n".join([*lines, "", "| option | meaning |", "|---|---|", *rows] if rows else lines)


def shown(parameter: Any) -> str:
    """Return an argument or an option as people type it."""
    value = parameter.metavar or parameter.name.upper()
    if parameter.param_type_name == "argument":
        return str(value)
    return str(parameter.opts[0]) if parameter.is_flag else f"{parameter.opts[0]} {value}"


def usual(parameter: Any) -> str:
    """Return the default of a parameter in brackets, if it has one to show."""
    default = parameter.default
    is_shown = isinstance(default, str | int | float | Path) and default not in ("", False)
    return f" (default `{default}`)" if is_shown else ""


def refused_table() -> str:
    """Return the scenarios of the library that cannot be a bench in a file, by the reason."""
    reasons: dict[str, list[str]] = {}
    for scenario in library():
        reasons.setdefault(refusal(scenario), []).append(scenario.id)
    count = len(reasons.pop(""))
    rows = [
        f"| {cell(reason)} | {len(ids)} | {', '.join(f'`{one}`' for one in ids)} |" for reason, ids in reasons.items()
    ]
    return "\n".join([f"{count} scenarios can.", "", "| reason | count | scenarios |", "|---|---|---|", *rows])


def layers(contracts: list[dict[str, Any]], package: str) -> list[str]:
    """Return the layers of a package from above to below, each with its folders and files."""
    (contract,) = [one for one in contracts if one.get("containers") == [package]]

    def shown(name: str) -> str:
        return f"{name}/" if (ROOT / package / name).is_dir() else name

    return [" ".join(map(shown, re.findall(r"\w+", layer))) for layer in contract["layers"]]


def wrapped(names: str) -> list[str]:
    """Break the names of a layer into lines."""
    lines = [""]
    for name in names.split():
        longer = f"{lines[-1]}   {name}".strip()
        if len(longer) <= CHARACTERS:
            lines[-1] = longer
        else:
            lines.append(name)
    return lines


def column(left: int, package: str, rows: list[list[str]]) -> tuple[list[str], int]:
    """Draw the layers of a package one below the other; return the shapes and their lower end."""
    shapes = [
        f'<text class="name" x="{left}" y="30">{package}/</text>',
        f'<text class="about" x="{left}" y="50">{ABOUT[package]}</text>',
    ]
    top = TOP
    for lines in rows:
        height = LINE * len(lines) + PAD
        shapes.append(f'<rect class="layer" x="{left}" y="{top}" width="{COLUMN}" height="{height}" rx="5"/>')
        for number, line in enumerate(lines):
            spaced = line.replace("   ", "\u2003")
            shapes.append(f'<text x="{left + 10}" y="{top + LINE * (number + 1)}">{spaced}</text>')
        top += height + 4
    return shapes, top


def picture() -> str:
    """Draw the layers of the three packages, as the contracts of the import linter permit imports."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
    shapes, bottom = [], 0
    for place, package in enumerate(ABOUT):
        left = GAP + place * (COLUMN + GAP)
        drawn, end = column(left, package, [wrapped(names) for names in layers(contracts, package)])
        shapes += drawn
        bottom = max(bottom, end)
        if place:
            shapes.append(f'<path class="arrow" d="M{left - GAP + 4} 25H{left - 9}"/>')
            shapes.append(f'<path class="head" d="M{left - 5} 25l-8 -4v8z"/>')
    width, height = GAP + len(ABOUT) * (COLUMN + GAP), bottom + 34
    words = "A module may import from the layers below its own, and from the packages to the right."
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
        f'role="img" aria-label="The layers of {", ".join(ABOUT)}">\n<style>{STYLE}</style>\n'
        f'<rect class="paper" width="{width}" height="{height}" rx="8"/>\n'
        + "\n".join(shapes)
        + f'\n<text class="about" x="{GAP}" y="{height - 14}">{words}</text>\n</svg>\n'
    )


def with_part(text: str, name: str, part: str) -> str:
    """Put a generated part between its marks."""
    begin, end = f"<!-- generated: {name} -->\n", "<!-- end -->"
    before, _, rest = text.partition(begin)
    return f"{before}{begin}\n{part}\n\n{end}{rest.partition(end)[2]}"


def documents() -> dict[str, str]:
    """Return the generated files as they should be, by path."""
    return {
        SETTINGS: with_part((ROOT / SETTINGS).read_text(), "settings", settings_table()),
        COMMANDS: with_part((ROOT / COMMANDS).read_text(), "commands", commands_list()),
        FILES: with_part((ROOT / FILES).read_text(), "refused", refused_table()),
        PICTURE: picture(),
    }


def main() -> int:
    """Write the files."""
    for path, text in documents().items():
        (ROOT / path).write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
