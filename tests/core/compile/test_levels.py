"""Code for levels of processors serves where there is none for the processor itself, and only where it can run."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from core import kernel, kernel_cache, registry
from core.compile import code, entry, machine
from core.compile.machine import ARM, LEVELS, V2, V3, X86, Target, compiled, levels_of
from tests.lab import RICH, STORY, inner_digest, make, play

BEST, PLAIN, OTHER = LEVELS
PID = registry.block("control", "pid")


class Shelf(dict[str, bytes]):
    """Files by name."""

    def put(self, name: str, file: bytes) -> None:
        self[name] = file


@pytest.fixture
def shelf(monkeypatch) -> Shelf:
    """Put an empty shelf in the place of all; nothing is known to be loaded, compiled or borrowed."""
    made = Shelf()
    monkeypatch.setattr(kernel_cache, "_shelves", [made])
    for module, name in ((code, "borrowed"), (code, "compiled_here"), (code, "_addresses")):
        monkeypatch.setattr(module, name, type(getattr(module, name))())
    return made


class Without:
    """A shelf from which some files are hidden."""

    def __init__(self, shelf: kernel_cache.KernelShelf, hidden: set[str]) -> None:
        self._shelf, self._hidden, self.put = shelf, hidden, shelf.put

    def get(self, name: str) -> bytes | None:
        return None if name in self._hidden else self._shelf.get(name)


def put(target: Target, piece: code.Piece, shelf: Shelf) -> bytes:
    """Put the code of a piece for some processor on a shelf; return it."""
    made, name = compiled(piece.write(), target, loops=piece.loops), piece.name_for(target)
    shelf[name] = kernel_cache.marked(name, made)
    return made


@pytest.mark.parametrize(
    ("triple", "features", "has"),
    [
        (X86, V3 | {"avx512f", "sse2"}, [BEST, PLAIN]),
        (X86, V3 - {"fma"}, [PLAIN]),
        (X86, V3 - {"bmi2"}, [PLAIN]),
        (X86, V2 | {"avx"}, [PLAIN]),
        (X86, V2 - {"sse4.2"}, []),
        ("x86_64-pc-linux-gnu", V2, [PLAIN]),
        ("x86_64-apple-darwin23", V3, []),
        ("x86_64-pc-windows-msvc", V3, []),
        (ARM, {"neon", "fp-armv8"}, [OTHER]),
        ("arm64-apple-darwin23", {"neon"}, []),
        ("riscv64-unknown-linux-gnu", V3 | {"neon"}, []),
    ],
)
def test_a_machine_has_the_levels_whose_features_it_has(triple, features, has):
    assert levels_of(triple, features) == has


def test_code_for_the_processor_itself_is_used_first_then_the_best_level_it_has(shelf, monkeypatch):
    piece = code.step(PID)
    monkeypatch.setattr(code, "levels", lambda: [BEST, PLAIN])
    plain = put(PLAIN, piece, shelf)
    assert piece.kept() == plain
    best = put(BEST, piece, shelf)
    assert piece.kept() == best != plain and code.borrowed == {piece.name}
    own = put(machine.native(), piece, shelf)
    assert piece.kept() == own and code.compiled_here == []


@pytest.mark.parametrize("has", [[PLAIN], []])
def test_a_level_that_the_machine_has_not_is_never_used(shelf, monkeypatch, has):
    piece = code.step(PID)
    monkeypatch.setattr(code, "levels", lambda: has)
    best, plain = put(BEST, piece, shelf), put(PLAIN, piece, shelf)
    found = piece.kept()
    assert found != best and (found == plain) is bool(has)
    assert len(code.borrowed) == len(has) and len(code.compiled_here) == 1 - len(has)


def test_code_of_another_hash_or_with_other_bytes_is_compiled_anew(shelf, monkeypatch):
    piece, other = code.step(PID), code.step(registry.block("control", "mrac"))
    monkeypatch.setattr(code, "levels", lambda: [PLAIN])
    name = piece.name_for(PLAIN)
    put(PLAIN, other, shelf)
    shelf[name] = shelf[other.name_for(PLAIN)]
    piece.kept()
    assert code.compiled_here == [piece.name_for(machine.native())] and not code.borrowed
    del shelf[piece.name_for(machine.native())]
    put(PLAIN, piece, shelf)
    shelf[name] = shelf[name][:-1] + bytes([shelf[name][-1] ^ 1])
    piece.kept()
    assert len(code.compiled_here) == 2 and not code.borrowed


def widest(target: Target, text: str) -> int:
    """Return the bits of the widest register that code for a processor names."""
    said = said_by(target, code.Piece("wide", str, lambda: text, loops=True))
    return next((bits for bits, name in ((512, "%zmm"), (256, "%ymm"), (128, "%xmm")) if name in said), 0)


FUSED = re.compile(r"\bv?fn?m(add|sub|la|ls)")
"""A product and a sum in one instruction, rounded once."""
TARGETS = [BEST, OTHER, machine.native()]


def said_by(target: Target, piece: code.Piece) -> str:
    """Return the instructions of the processor, as text."""
    better = machine.improved(piece.write(), target, loops=piece.loops)
    return str(machine.machine(target).emit_assembly(better))


@pytest.mark.parametrize("target", TARGETS, ids=["x86-64-v3", "aarch64", "native"])
def test_no_product_and_sum_become_one_instruction(target):
    for name in ("mmae", "consistency"):
        assert not FUSED.search(said_by(target, code.step(registry.block("diagnose", name))))
    fused = "declare double @llvm.fma.f64(double, double, double)\ndefine double @step(double %a) {\n"
    text = fused + "%b = call double @llvm.fma.f64(double %a, double %a, double %a)\nret double %b\n}"
    assert FUSED.search(said_by(target, code.Piece("fused", str, lambda: text, loops=False))), "it would be seen"


@pytest.mark.long
@pytest.mark.timeout(1200)
@pytest.mark.parametrize("width", [1, 8])
def test_no_product_and_sum_of_any_block_become_one_instruction(width):
    for family in registry.FAMILIES:
        for name, block in registry.blocks(family).items():
            for target in TARGETS:
                assert not FUSED.search(said_by(target, code.step(block, width))), name


def test_code_for_a_level_has_its_registers_and_no_wider_ones():
    text = code.step(registry.block("diagnose", "mmae"), 8).write()
    assert (widest(BEST, text), widest(PLAIN, text)) == (256, 128)


def test_a_board_goes_on_with_other_code_from_a_tick_edge_and_no_bit_differs(monkeypatch):
    straight, other = make({}, STORY, base=RICH), make({}, STORY, base=RICH)
    play(straight, 400)
    pieces = [
        code.step(registry.block(*one)) for one in (("plant", "linear"), ("control", "pid"), ("diagnose", "mmae"))
    ]
    own = {piece.name_for(machine.native()) for piece in pieces}
    real, late = list(kernel_cache._shelves), Shelf()
    for piece in pieces:
        put(PLAIN, piece, late)
    monkeypatch.setattr(kernel_cache, "_shelves", [late, *(Without(one, own) for one in real)])
    monkeypatch.setattr(code, "levels", lambda: [PLAIN])
    for name in ("borrowed", "compiled_here", "_addresses"):
        monkeypatch.setattr(code, name, type(getattr(code, name))())
    other.renew()
    play(other, 150)
    before = other.walk.table[:, 0].copy()
    assert code.borrowed == {piece.name for piece in pieces} and code.compiled_here == []
    monkeypatch.setattr(kernel_cache, "_shelves", real)
    code.renew()
    other.renew()
    assert len({*other.walk.table[:, 0]} - {*before}) == len({*before} - {*other.walk.table[:, 0]}) == len(pieces)
    play(other, 250)
    assert other.digest() == straight.digest() and inner_digest(other) == inner_digest(straight)


def test_kernels_that_python_calls_are_loaded_again_too(shelf, monkeypatch):
    @kernel.kernel
    def doubled(x: float) -> float:
        return 2.0 * x

    @kernel.kernel
    def unused(x: float) -> float:
        return x

    monkeypatch.setattr(code, "levels", lambda: [PLAIN])
    piece = entry.piece(doubled.py_func, ("float64",))
    put(PLAIN, piece, shelf)
    assert doubled(1.5) == 3.0 and code.borrowed == {piece.name}
    assert doubled in kernel.used() and unused not in kernel.used()
    put(machine.native(), piece, shelf)
    before: Any = doubled._made["float64",]
    doubled.renew()
    assert doubled(np.float64(2.0)) == 4.0 and doubled._made["float64",] is not before
    assert code.borrowed == {piece.name} and code.compiled_here == []
