"""Expressions of C for the results of instructions, and constants."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

TYPES = {"double": "double", "float": "float", "i64": "int64_t", "i1": "_Bool"}
REAL = {"fadd": "+", "fsub": "-", "fmul": "*", "fdiv": "/"}
WHOLE = {"add": "+", "sub": "-", "mul": "*", "and": "&", "or": "|", "xor": "^", "shl": "<<", "lshr": ">>"}
"""Signs for whole numbers without a sign; their overflow is defined."""
SIGNED = {"sdiv": "/", "srem": "%", "ashr": ">>"}
ORDER = {"eq": "==", "ne": "!=", "lt": "<", "le": "<=", "gt": ">", "ge": ">="}
CASTS = {"uitofp", "fptosi", "fptoui", "fpext", "fptrunc", "zext"}


def literal(value: Any, kind: str) -> str:
    """Return a constant of C."""
    if kind == "i1":
        return str(int(bool(value)))
    if kind == "i64":
        value = (value + 2**63) % 2**64 - 2**63  # the same 64 bits with a sign
        return f"INT64_C({value})" if value > -(2**63) else "INT64_MIN"
    value = float(value)
    if math.isfinite(value):
        return f"({value.hex()})"
    return '__builtin_nan("")' if math.isnan(value) else f"({'-' if value < 0.0 else ''}__builtin_inf())"


def expression(one: Any, values: Sequence[str]) -> str:
    """Return the result of an instruction that touches no memory, from the texts of its operands."""
    name, kind = one.opname, str(one.type)
    if name == "call":
        return f"__builtin_{one.callee.name.split('.')[1]}({', '.join(values)})"
    if name in ("icmp", "fcmp"):
        return _compared(one, *values)
    if name == "select":
        return "{} ? {} : {}".format(*values)
    if name == "fneg":
        return f"-{values[0]}"
    if name == "frem":
        return "fmod({}, {})".format(*values)
    if name == "bitcast":
        return f"{'number_of' if kind == 'double' else 'bits_of'}({values[0]})"
    if name == "sitofp":
        return f"(double)({values[0]} | nothing)"
    if name in CASTS:
        return f"({TYPES[kind]})({'(uint64_t)' if name == 'uitofp' else ''}{values[0]})"
    if name in REAL:
        return f"{values[0]} {REAL[name]} {values[1]}"
    if name in SIGNED:
        return f"{values[0]} {SIGNED[name]} {values[1]}"
    if kind == "i1":
        return f"{values[0]} {WHOLE[name]} {values[1]}"
    return f"(int64_t)((uint64_t){values[0]} {WHOLE[name]} (uint64_t){values[1]})"


def _compared(one: Any, first: str, second: str) -> str:
    sign, cast = one.op, ""
    if one.opname == "fcmp":
        if sign not in ("oeq", "olt", "ole", "ogt", "oge", "une"):
            raise NotImplementedError(f"a comparison {sign}")
        sign = sign[1:]
    elif sign not in ("eq", "ne"):
        cast, sign = ("(uint64_t)" if sign.startswith("u") else ""), sign[1:]
    return f"{cast}{first} {ORDER[sign]} {cast}{second}"
