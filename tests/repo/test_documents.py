"""All names in the documents exist: files, folders, links, commands, settings."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner

from server.cli.main import app

PLACEHOLDER = re.compile(r"[<>{}…]|\.\.\.")


def code_spans(text: str) -> list[str]:
    """Return the inline code of a document, fenced blocks left out."""
    return re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", text, flags=re.S))


@pytest.mark.parametrize("name", ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "SECURITY.md"])
def test_named_paths_exist(name: str, root: Path, documents: dict[str, str]) -> None:
    missing = []
    for span in code_spans(documents[name]):
        top = span.split("/")[0]
        if "/" in span and (new := PLACEHOLDER.search(span)):  # the folder of a new file exists
            folder = span[: new.start()].rpartition("/")[0]
            if (root / top).is_dir() and not (root / folder).is_dir():
                missing.append(span)
        is_ours = "/" in span and top and (root / top).is_dir() and re.fullmatch(r"[\w.*/-]+", span)
        if is_ours and not PLACEHOLDER.search(span) and not list(root.glob(span.rstrip("/"))):
            missing.append(span)
    assert not missing, f"{name} names what is not there (a new file's name is written <name>): {missing}"


def test_what_is_installed_is_the_checkout_with_extras_that_it_has(root: Path, files: list[Path]) -> None:
    extras = tomllib.loads((root / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    texts = {path: path.read_text() for path in files if path.suffix in (".md", ".py") and path.name != "CHANGELOG.md"}
    named = {(extra, path) for path, text in texts.items() for extra in re.findall(r"pip install '\.\[(\w+)\]'", text)}
    assert {extra for extra, _ in named} >= {"fmi", "wall"}
    assert [(extra, path) for extra, path in named if extra not in extras] == []
    assert [path for path, text in texts.items() if re.search(r"pip install [^\n]*combbench\[", text)] == [], (
        "no index has the project"
    )


def test_links_between_documents_resolve(root: Path, files: list[Path]) -> None:
    broken = []
    for path in files:
        if path.suffix == ".md":
            for target in re.findall(r"\]\((?!https?:|mailto:|#)([^)#\s]+)", path.read_text()):
                if not (path.parent / target).exists():
                    broken.append(f"{path.relative_to(root)} -> {target}")
    assert not broken


def layout(text: str) -> list[str]:
    """Return the paths of a layout block: names, then two spaces and words; indented under their folder."""
    block = next(block for block in re.findall(r"```\w*\n(.*?)```", text, re.S) if "core/" in block)
    paths: list[str] = []
    parents: list[tuple[int, str]] = []
    for line in filter(str.strip, block.splitlines()):
        indent = len(line) - len(line.lstrip())
        parents = [item for item in parents if item[0] < indent]
        above = parents[-1][1] if parents else ""
        names = [n for n in re.split(r"\s{2,}", line.strip())[0].split() if not PLACEHOLDER.search(n)]
        paths += [above + name for name in names]
        if len(names) == 1 and names[0].endswith("/"):
            parents.append((indent, above + names[0]))
    return paths


def test_architecture_lists_what_exists_and_all_of_it(root: Path, documents: dict[str, str]) -> None:
    listed = layout(documents["ARCHITECTURE.md"])
    assert not [path for path in listed if not list(root.glob(path.rstrip("/")))]
    packages = {
        f"{path.parent.relative_to(root)}/"
        for top in ("core", "scenarios", "server")
        for path in [*root.glob(f"{top}/__init__.py"), *root.glob(f"{top}/*/__init__.py")]
    }
    assert not packages - set(listed), "folders that ARCHITECTURE.md does not list"


def test_named_commands_exist(root: Path, documents: dict[str, str]) -> None:
    code = "\n".join(re.findall(r"```.*?```|`[^`\n]+`", documents["README.md"], re.S))
    commands = set(re.findall(r"\bcombbench ([a-z]+)", code))
    assert {"serve", "run"} <= commands
    helped = CliRunner().invoke(app, ["--help"]).stdout
    for command in commands:
        assert re.search(rf"\b{command}\b", helped), f"combbench has no command {command}"


def test_every_setting_is_in_the_readme_with_its_default(documents: dict[str, str]) -> None:
    from server.settings import Settings

    rows = dict(re.findall(r"^\| *`(\w+)` *\|(.*)$", documents["README.md"], re.M))
    for name, field in Settings.model_fields.items():
        assert name in rows, f"README's table of settings has no row for {name}"
        if field.default not in (None, [], ""):
            default = str(field.default).lower()
            assert default in rows[name].lower(), f"README gives {name} another default than {default}"


def test_documents_and_container_files_name_only_settings_that_exist(root: Path, documents: dict[str, str]) -> None:
    from server.settings import PREFIX, Settings

    texts = [*documents.values(), *((root / name).read_text() for name in ("Dockerfile", "compose.yaml"))]
    named = {name.lower() for text in texts for name in re.findall(rf"{PREFIX}(\w+)", text)}
    # The folder of kernels is needed before the settings exist; the seed belongs to the long suite.
    assert named <= {*Settings.model_fields, "kernel_cache", "test_seed"}


@pytest.mark.long
def test_core_stands_alone() -> None:
    """Of imports of its own; the contracts of the import linter, which every check runs, forbid the others."""
    code = (
        "import sys; from core.registry import catalog; assert catalog();"
        "bad = {'fastapi', 'starlette', 'uvicorn', 'viser', 'server', 'scenarios'} & set(sys.modules);"
        "assert not bad, bad"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=dict(os.environ))
    assert done.returncode == 0, done.stderr
