"""One meaning per class name: a name is given to one class of the project."""

from __future__ import annotations

import ast
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Parts of a block, which are always read with the block: ``Pid.Params``.
PATTERN = {"Params", "State", "Packed", "Ports"}
# Other names with two meanings, each with its reason.
EXCEPTIONS: dict[str, str] = {}


def test_each_class_name_has_one_meaning():
    places = defaultdict(list)
    for top in ("core", "scenarios", "server"):
        for path in sorted((ROOT / top).rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text())):
                if isinstance(node, ast.ClassDef):
                    places[node.name].append(f"{path.relative_to(ROOT)}:{node.lineno}")
    assert len(places) > 1000
    shared = {name: where for name, where in places.items() if len(where) > 1 and name not in PATTERN}
    assert {name: where for name, where in shared.items() if name not in EXCEPTIONS} == {}
    assert set(EXCEPTIONS) <= set(shared), "a name that has one meaning needs no exception"
