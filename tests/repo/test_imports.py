"""The Python files import each other in one direction: no circle, not in functions and not for types.

Only the parts of one folder may name each other for types, so that they need no protocols of each other.
"""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

PACKAGES = ("core", "scenarios", "server")

Graph = dict[str, set[str]]


def module_of(path: Path, root: Path) -> str:
    """Return the name of a file as a module; ``__init__.py`` has the package's name."""
    parts = path.relative_to(root).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def is_for_types(node: ast.AST) -> bool:
    """Whether the imports under a node are for types alone."""
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


def imported(tree: ast.AST, module: str, is_package: bool, modules: set[str]) -> set[str]:
    """Return the modules of the tree that a file imports, at its top, in a function or for its types only."""
    names: set[str] = set()
    own = module if is_package else module.rpartition(".")[0]
    aside = {id(node) for block in ast.walk(tree) if is_for_types(block) for node in ast.walk(block)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and id(node) in aside and (node.module or "").rpartition(".")[0] == own:
            continue
        elif isinstance(node, ast.ImportFrom):
            package = module.split(".") if is_package else module.split(".")[:-1]
            above = package[: len(package) - node.level + 1] if node.level else []
            base = ".".join([*above, *([node.module] if node.module else [])])
            for alias in node.names:
                submodule = f"{base}.{alias.name}"
                names.add(submodule if submodule in modules else base)
    return names & modules


def graph_of(root: Path) -> Graph:
    """Return the imports of each module of the packages."""
    paths = {module_of(path, root): path for package in PACKAGES for path in (root / package).rglob("*.py")}
    modules = set(paths)
    return {
        module: imported(ast.parse(path.read_text()), module, path.name == "__init__.py", modules)
        for module, path in paths.items()
    }


def circles(graph: Graph) -> set[frozenset[str]]:
    """Return the groups of modules that reach each other; a module that imports itself is a group of its own."""
    names = sorted(graph)
    edges = csr_array([[other in graph[name] for other in names] for name in names], dtype=np.int8)
    _, labels = connected_components(edges, connection="strong")
    groups = [frozenset(name for name, label in zip(names, labels, strict=True) if label == k) for k in set(labels)]
    return {group for group in groups if len(group) > 1 or group & graph[min(group)]}


def a_way_round(graph: Graph, group: frozenset[str]) -> str:
    """Return one closed way through a group, from its first module to itself, as people write it."""
    start = min(group)
    ways, seen = [[start]], set[str]()
    while ways:
        way = ways.pop(0)
        for module in sorted(graph[way[-1]] & group):
            if module == start:
                return " -> ".join([*way, start])
            if module not in seen:
                seen.add(module)
                ways.append([*way, module])
    raise AssertionError(f"no circle in {sorted(group)}")


def test_imports_never_go_in_a_circle(root: Path) -> None:
    graph = graph_of(root)
    found = circles(graph)
    assert not found, "\n".join(["circles of imports:", *(a_way_round(graph, group) for group in found)])


def test_a_circle_is_found_however_it_is_imported(tmp_path: Path) -> None:
    for package in PACKAGES:
        (tmp_path / package).mkdir()
        (tmp_path / package / "__init__.py").touch()
    types = "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    "
    texts = {
        "core/top.py": "from core import middle\n",
        "core/middle.py": f"{types}from core.low.bottom import Thing\n",
        "core/low/bottom.py": "def main() -> None:\n    import core.top\n",
        "core/low/part.py": f"{types}from core.low.whole import Whole\n",
        "core/low/whole.py": "from core.low.part import Part\n",
        "core/aside.py": "from core import top\nimport json\n",
        "server/near.py": "from .far import Thing\n",
        "server/far.py": "from . import near\n",
        "server/itself.py": "from server.itself import Thing\n",
    }
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    graph = graph_of(tmp_path)
    groups = circles(graph)
    assert groups == {
        frozenset({"core.top", "core.middle", "core.low.bottom"}),
        frozenset({"server.near", "server.far"}),
        frozenset({"server.itself"}),
    }
    assert a_way_round(graph, frozenset({"server.near", "server.far"})) == "server.far -> server.near -> server.far"
