"""The declarations of a unit: its imports, constants, functions and classes, read from the syntax tree."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Literal, cast

from pydantic import create_model
from pydantic.fields import FieldInfo

from core.block import Block, BlockParams
from core.own.evaluate import Evaluator
from core.own.mistakes import BROKEN, Mistakes, bound, follows, nearest
from core.own.offered import BUILTINS, MATHEMATICS, OFFERED, offered
from core.own.text import UnitError, refuse
from core.own.values import Mathematics
from core.ports import BlockPorts, Port
from core.record import Record, Records

MOST_NUMBERS = 4096
"""Numbers of a record: the most memory of a step."""
MOST_FIELDS = 200
LONGEST_TEXT = 4000
FRAMEWORK = ("array", "layout", "signals", "places", "declared")
"""Names that tables have themselves."""
KINDS = "a parameter is a float, int, bool, str or Literal, a field of a record a float, a Vector, or another record"
TABLES = (Record, BlockParams, BlockPorts)
INNER = {"Params": BlockParams, "Packed": Record, "State": Record, "Ports": BlockPorts}
"""Tables within the class of a unit, and their bases where the base of the unit has none."""


class Declaration:
    """The declarations of a text, with everything but the methods worked out.

    Attributes
    ----------
    names : dict
        Meanings of names: of the library, constants, functions (as trees) and classes.
    node : ast.ClassDef
        The class of the unit.
    base : type of Block
        The class it is based on.
    inner : dict
        Its ``Params``, ``Packed``, ``State`` and ``Ports``, as far as it declares them.
    values : dict
        Its other attributes, such as ``title``.
    methods : dict
        Its methods, as trees.
    broken : set of str
        Names of the tables in ``inner`` that have errors, and are missing there.
    """

    def __init__(self, tree: ast.Module, module: str, mistakes: Mistakes) -> None:
        self._module, self._mistakes = module, mistakes
        self.names: dict[str, Any] = {**BUILTINS}
        self._evaluator = Evaluator(self.names)
        self.node: ast.ClassDef | None = None
        self.base: type[Block] = Block
        self.inner: dict[str, Any] = {}
        self.values: dict[str, Any] = {}
        self.methods: dict[str, ast.FunctionDef] = {}
        self.broken: set[str] = set()
        for node in tree.body:
            with self._apart(*bound(node)):
                self._top(node)
        if self.node is None and not mistakes:
            raise UnitError("declares no unit: a class on Block, or on another base of the library", 1, 1)

    @contextmanager
    def _apart(self, *names: str) -> Iterator[None]:
        """Keep the error of a part, and mark its names as broken."""
        try:
            yield
        except UnitError as error:
            self._mistakes.add(error)
            for name in names:
                self.names.setdefault(name, BROKEN)

    def _top(self, node: ast.stmt) -> None:
        """Read one statement of the file."""
        if isinstance(node, ast.ImportFrom):
            self._import(node)
        elif isinstance(node, ast.Import):
            if [(alias.name, alias.asname) for alias in node.names] != [("math", None)]:
                refuse(
                    node,
                    "only math is imported whole; docs/own-units.md lists the other permitted imports",
                )
            self.names["math"] = Mathematics()
        elif isinstance(node, ast.Assign) and len(node.targets) == 1:
            self._constant(node.targets[0], node.value)
        elif isinstance(node, ast.AnnAssign) and node.value is not None:
            self._constant(node.target, node.value)
        elif isinstance(node, ast.FunctionDef):
            self._new(node, node.name)
            for decorator in node.decorator_list:
                if not (isinstance(decorator, ast.Name) and decorator.id in ("kernel", "inlined")):
                    refuse(decorator, "a function may be marked @kernel, and nothing else")
            if node.args.defaults or node.args.kwonlyargs or node.args.vararg or node.args.kwarg:
                refuse(node, "takes arguments by their place, without defaults")
            self.names[node.name] = node
        elif isinstance(node, ast.ClassDef):
            self._class(node)
        elif not _is_text(node):
            kind = type(node).__name__
            refuse(node, f"a unit has no statement {kind} outside its class: it has imports, constants and functions")

    def _import(self, node: ast.ImportFrom) -> None:
        module = "." * node.level + (node.module or "")
        for alias in node.names:
            name = alias.asname or alias.name
            with self._apart(name):
                if alias.name not in OFFERED.get(module, ()):
                    refuse(alias, f"{alias.name} cannot be imported from {module}{_instead(module, alias.name)}")
                if module != "__future__":
                    self._new(node, name)
                    self.names[name] = offered(module, alias.name)

    def _new(self, node: ast.AST, name: str) -> None:
        """Refuse a name that means something already."""
        if name in self.names or name.startswith("__") or (name.startswith("_") and isinstance(node, ast.ImportFrom)):
            refuse(node, f"{name} is declared already" if name in self.names else f"{name} is no name of a unit's own")

    def _constant(self, target: ast.expr, node: ast.expr) -> None:
        targets = target.elts if isinstance(target, ast.Tuple) else [target]
        value = self._evaluator.constant(node)
        values = value if isinstance(target, ast.Tuple) and isinstance(value, tuple) else (value,)
        if len(values) != len(targets):
            refuse(target, f"takes {len(targets)} values and is given {len(values)}")
        for one, own in zip(targets, values, strict=True):
            if not isinstance(one, ast.Name) or not isinstance(own, int | float | str | tuple | bool):
                refuse(one, "a constant is a number, a text or a tuple, under a name")
            self._new(one, one.id)
            self.names[one.id] = own

    def _class(self, node: ast.ClassDef) -> None:
        """Read a class: the unit's class, or a table it uses."""
        self._new(node, node.name)
        bases = self._bases(node)
        if any(issubclass(base, Block) for base in bases):
            if self.node is not None or len(bases) != 1:
                refuse(node, "a file declares one unit, on one base")
            self.node, (self.base,) = node, bases
            self._unit(node)
        else:
            self.names[node.name] = self._table(node, bases)

    def _bases(self, node: ast.ClassDef) -> tuple[type[Any], ...]:
        if node.keywords or node.decorator_list or not node.bases:
            refuse(node, "a class names its bases, and nothing else")
        found = []
        for base in node.bases:
            kind = self._type(base)
            if not isinstance(kind, type) or not issubclass(kind, (*TABLES, Block)):
                refuse(base, "is no base of a unit, its parameters, records or ports, such as Block or Record")
            found.append(kind)
        return tuple(found)

    def _unit(self, node: ast.ClassDef) -> None:
        """Read the class of the unit."""
        outer = dict(self.names)
        for part in node.body:
            with self._apart(*(bound(part) if isinstance(part, ast.ClassDef) else ())):
                self._part(part)
        self.values["__doc__"] = _text(node)
        self.broken = {name for name in INNER if self.names.get(name) is BROKEN}
        self.names.clear()
        self.names.update(outer)

    def _part(self, part: ast.stmt) -> None:
        """Read one statement of the class of the unit."""
        if isinstance(part, ast.ClassDef):
            if part.name in self.inner:
                refuse(part, f"{part.name} is declared already; leave one of them out")
            made = self._table(part, self._bases(part))
            self._check_inner(part, made)
            self.inner[part.name] = self.names[part.name] = made
        elif isinstance(part, ast.FunctionDef):
            if part.name in self.methods:
                refuse(part, f"{part.name} is declared already; leave one of them out")
            self.methods[part.name] = part
        elif isinstance(part, ast.Assign | ast.AnnAssign) and part.value is not None:
            for target in part.targets if isinstance(part, ast.Assign) else [part.target]:
                self._value(target, part.value)
        elif not _is_text(part) and not isinstance(part, ast.Pass):
            kind = type(part).__name__
            refuse(part, f"a unit has no statement {kind} in its class: it has attributes, tables and methods")

    def _check_inner(self, node: ast.ClassDef, made: type[Any]) -> None:
        """Refuse a table that is unknown to the framework, or that lacks a field that the base of the unit needs."""
        if node.name not in INNER:
            refuse(node, f"a class within a unit is one of {', '.join(INNER)}")
        usual: type[Any] = getattr(self.base, node.name, INNER[node.name])
        if not issubclass(made, usual):
            refuse(node, f"{node.name} must be on {usual.__qualname__}")

    def _value(self, target: ast.expr, node: ast.expr) -> None:
        """Read an attribute, or several at once."""
        value = self._evaluator.constant(node)
        if isinstance(target, ast.Tuple) and isinstance(value, tuple) and len(value) == len(target.elts):
            pairs = list(zip(target.elts, value, strict=True))
        else:
            pairs = [(target, value)]
        for one, own in pairs:
            if not isinstance(one, ast.Name) or one.id.startswith("_"):
                refuse(one, "is no attribute of a unit; it is a name that does not begin with _")
            if one.id in INNER:
                refuse(one, f"{one.id} is a class; write class {one.id}({ast.unparse(node)}): and a docstring")
            self.values[one.id] = own

    def _table(self, node: ast.ClassDef, bases: tuple[type[Any], ...]) -> type[Any]:
        """Read a class of parameters, of a record or of ports."""
        hints: dict[str, Any] = {}
        values: dict[str, Any] = {}
        is_broken = False
        for part in node.body:
            try:
                self._row(part, hints, values)
            except UnitError as error:
                self._mistakes.add(error)
                is_broken = True
        if is_broken:
            raise follows(node)
        if len(hints) > MOST_FIELDS:
            refuse(node, f"has more than {MOST_FIELDS} fields")
        try:
            made = self._made(node, bases, hints, values)
        except (TypeError, ValueError, AttributeError, NameError) as error:
            return refuse(node, f"cannot be declared: {error}")
        return made

    def _row(self, part: ast.stmt, hints: dict[str, Any], values: dict[str, Any]) -> None:
        """Read a field of a table."""
        if isinstance(part, ast.AnnAssign) and isinstance(part.target, ast.Name):
            name = part.target.id
            if name.startswith("_") or name in hints or name in FRAMEWORK:
                why = "is declared above" if name in hints else "is taken"
                refuse(part, f"{name} cannot be the name of a field: it {why}; choose another one, without _ first")
            hints[name] = self._type(part.annotation)
            if part.value is not None:
                values[name] = self._evaluator.constant(part.value)
        elif not _is_text(part) and not isinstance(part, ast.Pass):
            refuse(part, "declares fields only: name: kind = ...")

    def _made(self, node: ast.ClassDef, bases: tuple[type[Any], ...], hints: Any, values: Any) -> type[Any]:
        space = {"__module__": self._module, "__qualname__": node.name, "__doc__": _text(node)}
        if all(issubclass(base, BlockParams) for base in bases):
            fields: dict[str, Any] = {name: (hint, values.get(name, ...)) for name, hint in hints.items()}
            if any(not isinstance(value, FieldInfo) for value in values.values()) or values.keys() != hints.keys():
                raise TypeError("declare each parameter as name: kind = parameter(default, meaning, unit)")
            for base in bases:
                _check_parameters(base, hints)
            model: Any = create_model(node.name, __base__=bases, __module__=self._module, **fields)
            model.__doc__ = space["__doc__"]
            return cast(type[Any], model)
        known = {field.name for base in bases if issubclass(base, Record) for field in base.layout.fields}
        if again := known & hints.keys():
            raise TypeError(f"{sorted(again)[0]} is a field of the base already")
        if all(issubclass(base, BlockPorts) for base in bases):
            if any(not isinstance(values.get(name), Port) for name in hints):
                raise TypeError("declare each port with reads(...), output(...) or tap(...)")
        elif not all(issubclass(base, Record) for base in bases):
            raise TypeError("is based on classes of two kinds")
        made: Any = type(node.name, bases, {**space, "__annotations__": hints, **values})
        if issubclass(made, Record) and (made.layout.size > MOST_NUMBERS or made.layout.tails):
            raise TypeError(f"has {made.layout.size} numbers, at most {MOST_NUMBERS}, all of a known count")
        return made  # type: ignore[no-any-return]

    def _type(self, node: ast.expr) -> Any:
        """Return the meaning of an annotation, or of the name of a base."""
        if isinstance(node, ast.Constant) and node.value is None:
            return None
        if isinstance(node, ast.Name) and node.id in self.names:
            if self.names[node.id] is BROKEN:
                raise follows(node)
            return self.names[node.id]
        if isinstance(node, ast.Attribute):
            owner = self._type(node.value)
            if (
                isinstance(owner, type)
                and issubclass(owner, Block)
                and node.attr in ("Params", "Packed", "State", "Ports")
            ):
                return getattr(owner, node.attr)
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.BitOr):
            left, right = self._type(node.left), self._type(node.right)
            if left in (float, int) and right is None:
                return left | None
        if isinstance(node, ast.Subscript):
            return self._generic(node)
        return refuse(node, f"is no kind of a field; {KINDS}")

    def _generic(self, node: ast.Subscript) -> Any:
        kind = self._type(node.value)
        if kind is Records:
            return Records[self._type(node.slice)]  # type: ignore[misc]
        if kind is Literal:
            words = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
            texts = tuple(
                word.value for word in words if isinstance(word, ast.Constant) and isinstance(word.value, str)
            )
            if len(texts) == len(words):
                return Literal[texts]
        return refuse(node, f"is no kind of a field; {KINDS}")


def _instead(module: str, name: str) -> str:
    """Return the way out of an import that is not permitted."""
    homes = [f"write from {home} import {name}" for home, names in OFFERED.items() if name in names]
    if name in MATHEMATICS:
        homes.append(f"write import math, and math.{name}")
    if homes:
        return f"; {homes[0]}"
    if module in OFFERED:
        return nearest(name, OFFERED[module])
    return "; a unit imports names of the library alone, and docs/own-units.md lists them"


def _check_parameters(base: type[BlockParams], hints: dict[str, Any]) -> None:
    """Refuse parameters that mean something else to the framework, such as how many hypotheses there are."""
    for name, hint in hints.items():
        known = base.model_fields.get(name)
        if hasattr(base, name) or (known is not None and known.annotation != hint):
            raise TypeError(f"{name} is something else in {base.__name__}")


def _is_text(node: ast.stmt) -> bool:
    """Say whether a statement is a docstring."""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def _text(node: ast.ClassDef) -> str:
    """Return the docstring of a class."""
    text = ast.get_docstring(node) or ""
    return text if len(text) <= LONGEST_TEXT else refuse(node, f"has a text of more than {LONGEST_TEXT} characters")
