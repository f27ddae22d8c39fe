"""Draw faults to plant, by chance and by number, from all places of a layer where one of a few operators applies.

``draw_mutations.py --seed N --layer core --number K FOLDER`` writes ``core-1.patch`` and on into the folder, each for
``git apply``, and prints a line for each with seed, number, operator and place. Whoever draws more of a seed draws the
same ones first. Docstrings, comments, types and strings are not changed.
"""

from __future__ import annotations

import argparse
import ast
import difflib
import random
import re
from collections.abc import Iterator
from itertools import accumulate, pairwise
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
PYTHON, SCRIPTS = {".py"}, {".ts", ".tsx"}
LAYERS = {"core": PYTHON, "scenarios": PYTHON, "server": PYTHON, "web": SCRIPTS}
NO_PRODUCT = re.compile(r"\.(test|fixture|d)\.tsx?$|/migrations/")
OTHER: dict[type[ast.AST], tuple[str, str, str]] = {
    **{ast.Lt: ("comparison", "<", "<="), ast.LtE: ("comparison", "<=", "<")},
    **{ast.Gt: ("comparison", ">", ">="), ast.GtE: ("comparison", ">=", ">")},
    **{ast.Eq: ("equality", "==", "!="), ast.NotEq: ("equality", "!=", "==")},
    **{ast.Add: ("sum", "+", "-"), ast.Sub: ("sum", "-", "+")},
    **{ast.Mult: ("product", "*", "/"), ast.Div: ("product", "/", "*")},
    **{ast.And: ("and/or", "and", "or"), ast.Or: ("and/or", "or", "and")},
}
"""The name of an operator, its text, and the replacement."""
TYPES = {"annotation", "returns", "decorator_list"}
SCRIPT = [
    *(("comparison", rf" ({a}) ", b) for a, b in [("<", "<="), ("<=", "<"), (">", ">="), (">=", ">")]),
    *(("equality", rf" ({a}) ", b) for a, b in [("===", "!=="), ("!==", "===")]),
    *(("sum", rf" ({a}) ", b) for a, b in [(r"\+", "-"), ("-", "+")]),
    *(("product", rf" ({a}) ", b) for a, b in [(r"\*", "/"), ("/", "*")]),
    *(("and/or", rf" ({a}) ", b) for a, b in [("&&", "||"), (r"\|\|", "&&")]),
    ("dropped not", r"(?<=[\s(])(!)(?=[\w(])", ""),
    ("number", r"(?<![\w.#])(\d+(?:\.\d+)?)(?![\w.])", "+1"),
    ("dropped call", r"^\s*((?:await [\w.]+|this\.\w+)\(.*\);)$", ""),
    ("swapped return", r"return (true);", "false"),
    ("swapped return", r"return (false);", "true"),
]
"""The same for TypeScript, as expressions for a line; the first group is what changes."""
SILENT = re.compile(r"\s*(//|/?\*|import |(export )?(type|interface) )")
HIDDEN = re.compile(r"""//.*|/\*.*?\*/|"[^"]*"|'[^']*'|`[^`]*`""")


class Place(NamedTuple):
    """A span of the text of a file, its replacement, and the name of the operator."""

    operator: str
    start: int
    end: int
    text: str


def lines_of(text: str) -> list[str]:
    """Return the lines of a text as an editor counts them, each with its end."""
    return [line for line in re.split(r"(?<=\n)", text) if line]


def places_in_python(source: str) -> Iterator[Place]:
    """Find all places in a Python file."""
    ends = [0, *accumulate(map(len, lines_of(source)))]

    def at(line: int, column: int) -> int:
        text = source[ends[line - 1] : ends[line]]
        return ends[line - 1] + len(text.encode()[:column].decode())

    def begin(node: ast.expr | ast.stmt) -> int:
        return at(node.lineno, node.col_offset)

    def end(node: ast.expr | ast.stmt) -> int:
        return at(node.end_lineno or node.lineno, node.end_col_offset or 0)

    def between(left: ast.expr, kind: ast.AST, right: ast.expr) -> Iterator[Place]:
        if type(kind) in OTHER:
            operator, old, new = OTHER[type(kind)]
            start = source.index(old, end(left), begin(right))
            yield Place(operator, start, start + len(old), new)

    for node in code_of(ast.parse(source)):
        match node:
            case ast.Compare(left, ops, comparators):
                for a, kind, b in zip([left, *comparators], ops, comparators, strict=False):
                    yield from between(a, kind, b)
            case ast.BinOp(left, op, right):
                yield from between(left, op, right)
            case ast.BoolOp(op, values):
                for a, b in pairwise(values):
                    yield from between(a, op, b)
            case ast.UnaryOp(ast.Not()):
                yield Place("dropped not", begin(node), begin(node) + len("not "), "")
            case ast.Constant(int() | float() as value) if not isinstance(value, bool):
                yield Place("number", begin(node), end(node), repr(value + 1))
            case ast.Expr(ast.Await() | ast.Call(ast.Attribute(ast.Name("self")))):
                yield Place("dropped call", begin(node), end(node), "pass")
            case ast.Return(ast.Constant(bool() as value)):
                yield Place("swapped return", begin(node), end(node), f"return {not value}")
            case ast.Call(ast.Name("range"), [stop]) | ast.Call(ast.Name("range"), [_, stop, *_]):
                yield Place("range", end(stop), end(stop), " + 1")


def code_of(node: ast.AST) -> Iterator[ast.AST]:
    """Go through the executable nodes; nodes in an f-string have no sure place."""
    yield node
    for name, value in ast.iter_fields(node):
        if name not in TYPES:
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST) and not isinstance(child, ast.JoinedStr):
                    yield from code_of(child)


def places_in_script(source: str) -> Iterator[Place]:
    """Find all places in a TypeScript file."""
    start = 0
    for line in lines_of(source):
        if not SILENT.match(line):
            shown = HIDDEN.sub(lambda hidden: "\0" * len(hidden[0]), line)
            for operator, pattern, new in SCRIPT:
                for found in re.finditer(pattern, shown):
                    text = f"{float(found[1]) + 1:g}" if new == "+1" else new
                    yield Place(operator, start + found.start(1), start + found.end(1), text)
        start += len(line)


def places(layer: str) -> list[tuple[Path, Place]]:
    """Return all places of a layer in the order of its files."""
    folder = ROOT / ("web/src" if layer == "web" else layer)
    files = [path for path in folder.rglob("*") if path.suffix in LAYERS[layer]]
    find = places_in_script if layer == "web" else places_in_python
    return [
        (path, place)
        for path in sorted(files)
        if not NO_PRODUCT.search(path.as_posix())
        for place in sorted(set(find(path.read_text("utf-8"))))
    ]


def patch(path: Path, place: Place) -> str:
    """Return the patch that plants a fault."""
    old, name = path.read_text("utf-8"), path.relative_to(ROOT).as_posix()
    new = old[: place.start] + place.text + old[place.end :]
    return "".join(difflib.unified_diff(lines_of(old), lines_of(new), f"a/{name}", f"b/{name}"))


def main() -> None:
    """Draw, write and print as the command line requests."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--layer", choices=LAYERS, required=True)
    parser.add_argument("--number", type=int, required=True, help="how many are drawn")
    parser.add_argument("folder", type=Path, help="where the patches go")
    asked = parser.parse_args()
    found = places(asked.layer)
    random.Random(asked.seed).shuffle(found)
    asked.folder.mkdir(parents=True, exist_ok=True)
    for number, (path, place) in enumerate(found[: asked.number], 1):
        (asked.folder / f"{asked.layer}-{number}.patch").write_text(patch(path, place), "utf-8")
        line = path.read_text("utf-8").count("\n", 0, place.start) + 1
        where = f"{path.relative_to(ROOT).as_posix()}:{line}"
        print(f"drawn: seed {asked.seed}, number {number}, {place.operator}, {where}")


if __name__ == "__main__":
    main()
