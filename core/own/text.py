"""The text of a user unit: small enough to be read, and read as a syntax tree."""

from __future__ import annotations

import ast
import io
import tokenize
from typing import NoReturn

from core.errors import InputError

MOST_CHARACTERS = 65_536
MOST_TOKENS = 12_000
MOST_IN_A_LINE = 400
"""Tokens between two ends of statements: no expression is deeper than that."""
DEEPEST_BRACKETS = 30
DEEPEST_BLOCKS = 12
LONGEST_NUMBER = 40
"""Characters of a number."""
INVISIBLE = {chr(code) for code in (*range(0x200B, 0x2010), *range(0x202A, 0x202F), *range(0x2060, 0x2070), 0xFEFF)}
"""Characters that make a text look other than it reads."""


class UnitError(InputError):
    """An error in the text of a unit, and its place.

    Parameters
    ----------
    message : str
        The mistake, and the allowed form.
    line, column : int
        Where it is, both from 1.
    others : tuple of UnitError
        The other errors of the text, in its order; they are in the hint too.
    """

    def __init__(self, message: str, line: int, column: int, others: tuple[UnitError, ...] = ()) -> None:
        hint = f"also {'; '.join(map(str, others))}" if others else ""
        super().__init__(message, f"line {line}, column {column}", hint, code="unit")
        self.line, self.column, self.others = line, column, others

    @property
    def all(self) -> tuple[UnitError, ...]:
        """The error itself, then the others."""
        return self, *self.others


def refuse(node: ast.AST, message: str) -> NoReturn:
    """Raise an error at the place of a node."""
    raise UnitError(message, getattr(node, "lineno", 1), getattr(node, "col_offset", 0) + 1)


def read(source: str) -> ast.Module:
    """Return the syntax tree of a unit.

    Raises
    ------
    UnitError
        When the text is too long, too deep, or no text of that syntax.
    """
    if len(source) > MOST_CHARACTERS:
        raise UnitError(f"is {len(source)} characters long, at most {MOST_CHARACTERS}", 1, 1)
    for number, text in enumerate(source.split("\n"), 1):
        for column, character in enumerate(text, 1):
            if character in INVISIBLE or not (character.isprintable() or character == "\t"):
                raise UnitError(f"holds a character that cannot be seen, U+{ord(character):04X}", number, column)
    _measure(source)
    try:
        return ast.parse(source)
    except SyntaxError as error:
        raise UnitError(f"is no Python syntax: {error.msg}", error.lineno or 1, error.offset or 1) from None
    except (ValueError, RecursionError, MemoryError) as error:
        raise UnitError(f"cannot be read: {error}", 1, 1) from None


def _measure(source: str) -> None:
    """Refuse a text that would be slow to read: too many words, too deep, or with numbers of many digits."""
    blocks = in_a_line = 0
    brackets: list[tuple[int, int]] = []
    try:
        for count, token in enumerate(tokenize.generate_tokens(io.StringIO(source).readline)):
            line, column = token.start[0], token.start[1] + 1
            if token.type in (tokenize.NEWLINE, tokenize.ENDMARKER):
                in_a_line = 0
            elif token.type not in (tokenize.NL, tokenize.COMMENT):
                in_a_line += 1
            blocks += (token.type == tokenize.INDENT) - (token.type == tokenize.DEDENT)
            if token.type == tokenize.OP:
                if token.string in "([{":
                    brackets.append((line, column))
                elif token.string in ")]}" and brackets:
                    brackets.pop()
            limits = (
                (count > MOST_TOKENS, f"has more than {MOST_TOKENS} words"),
                (in_a_line > MOST_IN_A_LINE, f"has a statement of more than {MOST_IN_A_LINE} words"),
                (len(brackets) > DEEPEST_BRACKETS, f"has brackets deeper than {DEEPEST_BRACKETS}"),
                (blocks > DEEPEST_BLOCKS, f"has blocks deeper than {DEEPEST_BLOCKS}"),
                (
                    token.type == tokenize.NUMBER and len(token.string) > LONGEST_NUMBER,
                    f"has a number of more than {LONGEST_NUMBER} characters",
                ),
            )
            for is_broken, text in limits:
                if is_broken:
                    raise UnitError(text, line, column)
    except tokenize.TokenError as error:
        if brackets:
            raise UnitError("is no Python syntax: the bracket is not closed", *brackets[-1]) from None
        (line, column) = error.args[1]
        raise UnitError(f"is no Python syntax: {error.args[0]}", line, column + 1) from None
    except (IndentationError, SyntaxError) as error:
        raise UnitError(f"is no Python syntax: {error.msg}", error.lineno or 1, error.offset or 1) from None
