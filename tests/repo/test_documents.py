"""All names in the documents exist: files, folders, links, commands, settings."""

from __future__ import annotations

import importlib.util
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from types import ModuleType

import pytest
import typer

from server.cli.main import app

PLACEHOLDER = re.compile(r"[<>{}…]|\.\.\.")


def code_spans(text: str) -> list[str]:
    """Return the inline code of a document, fenced blocks left out."""
    return re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", text, flags=re.S))


def test_named_paths_exist(root: Path, documents: dict[str, str]) -> None:
    missing = []
    for name, text in documents.items():
        for span in code_spans(text) if name != "CHANGELOG.md" else ():
            top = span.split("/")[0]
            if not (top and "/" in span and (root / top).is_dir()):
                continue
            if new := PLACEHOLDER.search(span):  # the folder of a new file exists
                span = span[: new.start()].rpartition("/")[0]
            if re.fullmatch(r"[\w.*/-]+", span) and not list(root.glob(span.rstrip("/"))):
                missing.append(f"{name}: {span}")
    assert not missing, f"they name what is not there (a new file's name is written <name>): {missing}"


def test_links_to_headings_resolve(root: Path, documents: dict[str, str]) -> None:
    headings = {name: {anchor(one) for one in re.findall(r"^#+ (.*)$", text, re.M)} for name, text in documents.items()}
    broken = []
    for name, text in documents.items():
        for target, heading in re.findall(r"\]\((?!https?:)([^)#\s]*)#([^)\s]+)\)", text):
            path = ((root / name).parent / target).resolve() if target else root / name
            if heading not in headings.get(path.relative_to(root).as_posix(), {heading}):
                broken.append(f"{name} -> {target}#{heading}")
    assert not broken


def anchor(heading: str) -> str:
    """Return the anchor of a heading, as the sites that show repositories make it."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def test_the_first_pages_stay_short_and_each_document_names_its_readers(documents: dict[str, str]) -> None:
    assert len(documents["README.md"].encode()) <= 7000
    assert documents["ARCHITECTURE.md"].count("\n") <= 100 and documents["ARCHITECTURE.md"].count("![") == 1
    heads = {name: text.partition("\n## ")[0] for name, text in documents.items()}
    assert [name for name, head in heads.items() if "\n\nFor " not in head] == ["CHANGELOG.md", "README.md"]


def test_the_first_pages_lead_to_every_document(documents: dict[str, str]) -> None:
    below = {"docs": "README.md", "docs/design": "ARCHITECTURE.md"}
    found = [(name, below[folder]) for name in documents if (folder := name.rpartition("/")[0])]
    assert len(found) > 20
    assert [name for name, start in found if f"({name}" not in documents[start]] == []


def test_what_is_installed_is_the_checkout_with_extras_that_it_has(root: Path, files: list[Path]) -> None:
    extras = tomllib.loads((root / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    texts = {path: path.read_text() for path in files if path.suffix in (".md", ".py") and path.name != "CHANGELOG.md"}
    installed = r"pip install '(?:\.|combbench)\[(\w+)\](?: @ git\+ADDRESS)?'"
    named = {(extra, path) for path, text in texts.items() for extra in re.findall(installed, text)}
    for path, text in texts.items():
        named |= {(extra, path) for extra in re.findall(r"\brequire\(\"\w+\", \"(\w+)\", \"", text)}
    assert {extra for extra, _ in named} >= {"fmi", "wall"}
    assert [(extra, path) for extra, path in named if extra not in extras] == []
    assert [
        path for path, text in texts.items() if re.search(r"pip install [^\n]*combbench\[\w+\](?! @ git)", text)
    ] == [], "no index has the project"


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


def test_the_layout_lists_what_exists_and_all_of_it(root: Path, documents: dict[str, str]) -> None:
    listed = layout(documents["docs/design/layout.md"])
    assert not [path for path in listed if not list(root.glob(path.rstrip("/")))]
    packages = {
        f"{path.parent.relative_to(root)}/"
        for top in ("core", "scenarios", "server")
        for path in [*root.glob(f"{top}/__init__.py"), *root.glob(f"{top}/*/__init__.py")]
    }
    assert not packages - set(listed), "folders that docs/design/layout.md does not list"


def test_named_commands_exist(documents: dict[str, str]) -> None:
    texts = (text for name, text in documents.items() if name != "CHANGELOG.md")
    code = "\n".join(part for text in texts for part in re.findall(r"```.*?```|`[^`\n]+`", text, re.S))
    commands = set(re.findall(r"(?<![\w./-])(?<!import )combbench ([a-z]+)", code))
    assert {"serve", "run"} <= commands
    assert commands <= {*typer.main.get_command(app).commands}


@pytest.fixture(scope="module")
def generator(root: Path) -> ModuleType:
    """The script that writes the generated parts."""
    spec = importlib.util.spec_from_file_location("write_documents", root / "scripts" / "write_documents.py")
    assert spec is not None and spec.loader is not None
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    return script


def test_generated_parts_are_current(root: Path, generator: ModuleType) -> None:
    written = generator.documents()
    assert len(written) == 4
    for path, text in written.items():
        assert (root / path).read_text() == text, f"{path}: run make codegen"


def test_every_setting_command_and_option_has_its_meaning(generator: ModuleType) -> None:
    settings, commands = generator.settings_table(), generator.commands_list()
    rows = [line.split(" | ") for line in [*settings.splitlines(), *commands.splitlines()] if line.startswith("| `")]
    assert len(rows) > 80 and [row[0] for row in rows if len(row[-1].strip("| ").split()) < 2] == []
    assert re.search(r"^\| `port` \| `8000` \| \w", settings, re.M)
    assert re.search(r"^\| `--seeds A:B` \| \w", commands, re.M)


def test_the_picture_shows_every_module_of_the_contracts(root: Path, generator: ModuleType) -> None:
    shown = set(re.findall(r"\w+", " ".join(re.findall(r"<text[^>]*>([^<]*)", generator.picture()))))
    for package in ("server", "scenarios"):  # their contracts are exhaustive
        modules = {path.stem for path in (root / package).glob("*.py") if path.stem != "__init__"}
        assert modules - shown == set()
        assert {path.parent.name for path in (root / package).glob("*/__init__.py")} - shown == set()
    assert {"board", "control", "diagnose", "plant", "block"} <= shown


def test_documents_and_container_files_name_only_settings_that_exist(root: Path, documents: dict[str, str]) -> None:
    from server.settings import PREFIX, Settings

    texts = [*documents.values(), *((root / name).read_text() for name in ("Dockerfile", "compose.yaml"))]
    named = {name.lower() for text in texts for name in re.findall(rf"{PREFIX}(\w+)", text)}
    # The folders of kernels and records are needed before the settings exist, the address by scripts; the seed is of
    # the long suite.
    assert named <= {*Settings.model_fields, "kernel_cache", "records", "address", "test_seed"}


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
