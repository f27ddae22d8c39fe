"""The arrays and tables of a bench as the C that ``bench.c`` includes."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from core.block import Block
from core.loop.guard import REASONS
from core.ports import TICK, TIME_MS
from core.units import MS_PER_S
from scenarios.fmu.layout import FmuLayout, table


def first_severity(one: FmuLayout, name: str) -> float:
    """Return the severity of a fault at the first tick."""
    params: Any = one.board.spec.faults.get(name)
    return 0.0 if params is None else float(params.severity)


def ends(entry: dict[str, Any]) -> tuple[float, float]:
    """Return the ends of the range of a severity."""
    low, high = (entry["minimum"], -math.inf), (entry["maximum"], math.inf)
    return tuple(float(other if given is None else given) for given, other in (low, high))  # type: ignore[return-value]


def source(one: FmuLayout, blocks: Sequence[type[Block]], token: str) -> str:
    """Return the C of a part of a bench; ``blocks`` are numbered as their steps are."""
    board, wiring = one.board, one.board.wiring
    lines: list[str] = []

    def array(name: str, numbers: Iterable[Any], kind: str = "double") -> str:
        values = [_number(value, kind) for value in numbers]
        lines.append(f"static const {kind} {name}[] = {{{', '.join(values) or '0'}}};")
        return name

    def dependence(name: str, entry: dict[str, Any]) -> str:
        places = entry["places"]
        array(f"{name}_places", places, "int64_t")
        if "factors" in entry:
            factors, points, grid, numbers = array(f"{name}_factors", entry["factors"]), 0, "NULL", "NULL"
        else:
            factors, points = "NULL", len(entry["grid"])
            grid, numbers = array(f"{name}_grid", entry["grid"]), array(f"{name}_numbers", entry["numbers"].ravel())
        return f"{{{len(places)}, {name}_places, {factors}, {points}, {grid}, {numbers}}}"

    w = np.zeros(one.signals)
    w[: len(wiring.w)] = wiring.w
    guards = [wiring.index[f"{wiring.instances[row].prefix}.trip"] for row in one.rows if _is_guard(one, row)]
    sizes = {
        "P": len(wiring.p),
        "S": len(wiring.s),
        "W": one.signals,
        "ROWS": len(one.rows),
        "CUT": one.cut,
        "COMMANDS": len(one.commands),
        "FAULTS": len(one.faults),
        "VALUES": len(one.values),
        "OUTPUTS": len(one.outputs),
        "GUARDS": len(guards),
        "TICK": TICK,
        "TIME_MS": TIME_MS,
        "DT_MS": _number(board.dt_ms, "double"),
        "DT_S": _number(board.dt_ms / MS_PER_S, "double"),
        "TOKEN": json.dumps(token),
    }
    lines += [f"#define {name} {value}" for name, value in sizes.items()]
    array("s_first", wiring.s)
    array("w_first", w)
    array("io", one.io, "int64_t")
    array("outputs", [wiring.index[signal.name] for signal in one.outputs], "int64_t")
    array("guards", guards, "int64_t")
    texts = [json.dumps(REASONS[k][0].format(signal=REASONS[k][1])) if k in REASONS else '""' for k in range(_codes())]
    lines.append(f"static const char *const reasons[] = {{{', '.join(texts)}}};")
    found = []
    for k, (name, entry) in enumerate(one.faults.items()):
        row, chosen = entry["row"], entry["variants"][0]
        packed, first = chosen["packed"], first_severity(one, name)
        places, start = wiring.signals_of_row(row), wiring.table[row]
        array(f"fault_{k}_packed", packed)
        array(f"fault_{k}_signals", places, "int64_t")
        follows = dependence(f"fault_{k}", chosen["dependence"])
        state = wiring.state_of(f"faults.{name}")
        low, high = (_number(end, "double") for end in ends(entry))
        numbers = f"{start[1]}, {len(packed)}, {start[2]}, {len(state)}, {entry['start']}"
        signals = f"fault_{k}_packed, {len(places)}, fault_{k}_signals"
        found.append(f'{{"{name}", {numbers}, {signals}, {low}, {high}, {_number(first, "double")}, {follows}}}')
    lines.append(f"static const Fault faults[] = {{{', '.join(found) or '{0}'}}};")
    array("p_first", wiring.p)
    values = []
    for k, (path, entry) in enumerate(one.values.items()):
        follows = dependence(f"value_{k}", entry["dependence"])
        limits = ", ".join(_number(entry[end], "double") for end in ("low", "high", "value"))
        values.append(f'{{"{path}", {limits}, {follows}}}')
    lines.append(f"static const Value values[] = {{{', '.join(values) or '{0}'}}};")
    for k, command in enumerate(one.commands):
        array(f"command_{k}", command.places, "int64_t")
    inputs = [f'{{"{one.unit}", {len(one.places)}, command_{k}}}' for k, one in enumerate(one.commands)]
    lines.append(f"static const Command commands[] = {{{', '.join(inputs)}}};")
    lines += [f"Step step_{k};" for k in range(len(blocks))]
    names = [*one.faults]
    rows = []
    for row, (p_at, s_at, io_at, every) in zip(one.rows, table(one).tolist(), strict=True):
        instance = wiring.instances[row]
        name = instance.key.removeprefix("faults.")
        is_fault = instance.key.startswith("faults.") and name in names
        fault = names.index(name) if is_fault else -1
        rows.append(f"{{step_{blocks.index(instance.block)}, {p_at}, {s_at}, {io_at}, {every}, {fault}}}")
    lines.append(f"static const Row rows[] = {{{', '.join(rows)}}};")
    return "\n".join(lines) + "\n"


def _codes() -> int:
    return max(REASONS) + 1


def _is_guard(one: FmuLayout, row: int) -> bool:
    return one.board.wiring.instances[row].key.split(".")[0] == "guard"


def _number(value: Any, kind: str) -> str:
    if kind == "int64_t":
        return str(int(value))
    value = float(value)
    if math.isfinite(value):
        return str(value.hex())
    return "NAN" if math.isnan(value) else f"{'-' if value < 0 else ''}INFINITY"
