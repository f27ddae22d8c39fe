"""Texts that no unit may have, by the place they are put."""

from __future__ import annotations

from tests.core.own.texts import PI, odd


def each(texts: str) -> tuple[str, ...]:
    """Return the texts of a row."""
    return tuple(texts.split(" ;; "))


DUNDERS = each(
    "__class__ ;; __dict__ ;; __globals__ ;; __builtins__ ;; __subclasses__ ;; __mro__ ;; __init__ ;; __code__"
)
MODULES = each(
    "os ;; sys ;; subprocess ;; socket ;; ctypes ;; numpy ;; builtins ;; importlib ;; pathlib ;; core ;; server"
)
FUNCTIONS = each(
    "eval ;; exec ;; compile ;; open ;; __import__ ;; getattr ;; setattr ;; globals ;; locals ;; vars ;; dir ;; type"
)
EXPRESSIONS = (
    *(f"x.{name}" for name in DUNDERS),
    *(f"p.{name}" for name in DUNDERS),
    *(f"(1.0).{name}" for name in DUNDERS),
    *(f"exp.{name}" for name in DUNDERS),
    *(f"{name}('1')" for name in FUNCTIONS),
    *(f"{name}" for name in FUNCTIONS),
    "1" * 50,
    "1e400" + "0" * 60,
    "9" * 30,
    "-".join(["e"] * 300),
    "(" * 40 + "e" + ")" * 40,
    *each(
        "x.array ;; s.array ;; x.signals[0] ;; x.places ;; p.address ;; s.layout ;; exp.py_func ;; x.declared ;; "
        "lambda: 1.0 ;; [1.0] ;; {1.0} ;; {1: 2.0} ;; (1.0, 2.0) ;; [i for i in range(3)] ;; (i for i in range(3)) ;; "
        "f'{e}' ;; 'text' ;; b'bytes' ;; ... ;; None ;; 1j ;; await e ;; (yield) ;; (yield from e) ;; (y := 1.0) ;; "
        "e ** 2 ;; 2 ** 99999999 ;; e // 2.0 ;; e % 2.0 ;; e << 1 ;; e >> 1 ;; e & 1 ;; e | 1 ;; e ^ 1 ;; ~e ;; "
        "e @ e ;; e in e ;; e is e ;; e is not None ;; not e ;; e and e ;; 1.0 if e else 2.0 ;; True + 1.0 ;; "
        "s.line ;; s.line[5] ;; s.line[-1] ;; s.line[e] ;; s.line[1.0] ;; s.line[1:2] ;; s.line[True] ;; "
        "s.line[None] ;; s.grid[12] ;; p.taps[4] ;; p.lag ;; p.lag.nothing ;; s.lag ;; x.three[3] ;; x.three ;; "
        "x.nothing ;; q.x ;; undeclared ;; undeclared(e) ;; exp() ;; exp(e, e) ;; exp(x) ;; exp(p.lag) ;; "
        "exp(*s.line) ;; exp(x=e) ;; advance_lag(e, e, e, e, e) ;; advance_lag(s, e, e, e, e) ;; "
        "advance_lag(p, e, e, e, e) ;; normalised(e, e) ;; lag(1.0, 0.1, False) ;; print(e) ;; input() ;; help() ;; "
        "math ;; math.pow(e, e) ;; math.__loader__ ;; math.sqrt ;; Block ;; Block.step ;; Record.zeros() ;; "
        "ControllerPorts ;; tap('um') ;; reads('plant.displacement') ;; parameter ;; int(e) ;; int('9' * 9) ;; "
        "float('nan') ;; str(e) ;; len(s.line) ;; sum(s.line) ;; range(9) ;; max(e) ;; abs()"
    ),
)
STATEMENTS = (
    *(f"import {name}" for name in MODULES),
    *(f"from {name} import x" for name in MODULES),
    "\n".join(f"v{i} = e" for i in range(4000)),
    "\n".join("    " * i + "if e > 0.0:" for i in range(14)) + "\n" + "    " * 14 + "pass",
    *each(
        "while True:\n    pass ;; while e > 0.0:\n    e = e - 1.0 ;; def f():\n    return 1.0 ;; class A:\n    pass ;; "
        "try:\n    e = 1.0\nexcept:\n    pass ;; with e:\n    pass ;; raise e ;; assert e ;; del e ;; global e ;; "
        "nonlocal e ;; async def f():\n    pass ;; match e:\n    case 1.0:\n        pass ;; return 1.0 ;; "
        "return e, e ;; yield e ;; for i in s.line:\n    pass ;; for i in range(e):\n    pass ;; "
        "for i in range(5000):\n    pass ;; for i in (1, 2):\n    pass ;; for i in range(int(e)):\n    pass ;; "
        "for i in range(1, 9, 0):\n    pass ;; for i, j in range(3):\n    pass ;; "
        "for i in range(4000):\n    for j in range(4000):\n        e = e + 1.0 ;; "
        "for i in range(9):\n    s.line[i] = 1.0 ;; for i in range(3):\n    i = i + 1 ;; "
        "for i in range(5):\n    s.line[i + 1] = e ;; for i in range(6):\n    s.line[i - 1] = e ;; "
        "for i in range(4):\n    s.grid[i * 4] = e ;; for e in range(3):\n    pass ;; p.gain = 1.0 ;; "
        "p.taps[0] = 1.0 ;; p.lag.decay = 1.0 ;; x.measured = 1.0 ;; x.model = 1.0 ;; x.engaged = 1.0 ;; "
        "x.tick = 0.0 ;; x.time_ms = 0.0 ;; s.nothing = 1.0 ;; x.nothing = 1.0 ;; s.line = 1.0 ;; x.three = 1.0 ;; "
        "s = p ;; p = s ;; x = 1.0 ;; exp = 1.0 ;; math = 1.0 ;; _hidden = 1.0 ;; __class__ = 1.0 ;; a = b = 1.0 ;; "
        "a, b = 1.0 ;; a, b = e ;; a = s.line\na = p.taps ;; a = 1.0\na = s.line ;; a = e > 0.0\nb = a + 1.0 ;; "
        "if e:\n    pass ;; if e > 0.0:\n    late = 1.0\nx.seen = late ;; "
        "for i in range(3):\n    late = 1.0\nx.seen = late ;; e + 1.0 ;; exp(e) ;; x.seen ;; s.line[0] ;; "
        "del s.line[0] ;; s.line[0:2] = e ;; e: float ;; x.voltage += 'a' ;; s.a = p.lag ;; s.a = x ;; s.a = s ;; "
        "s.a = exp ;; x.seen = True ;; x.seen = e > 0.0 ;; if 1.0:\n    pass ;; return\nx.seen = 1.0 ;; break ;; "
        "continue ;; pass;import os ;; exec('1') ;; lambda: 0 ;; type X = float"
    ),
)
TOPS = (
    *(f"import {name}" for name in MODULES),
    *(f"from {name} import *" for name in ("os", "core.block", "core.record", "numpy")),
    *(
        f"from core.block import {name}"
        for name in ("np", "NDArray", "_Many", "Field", "ValidationError", "__builtins__")
    ),
    *each(
        "from core.kernel import entry ;; from core.record import np ;; from . import unit ;; from .. import own ;; "
        "import math as m ;; import os.path ;; from math import sqrt ;; from core import registry ;; "
        "from core.registry import block ;; print(1) ;; x: int ;; A = [1] ;; A = open('x') ;; A = {} ;; "
        "A = lambda: 1 ;; A = 'x' * 99 ;; A = 9 ** 9 ** 9 ;; A = (1,) * 10 ;; A = range(10 ** 9) ;; "
        "A = list(range(99999)) ;; A = Record ;; A = Block.pack ;; A = ().__class__ ;; while True: pass ;; "
        "if True: pass ;; for i in range(3): pass ;; try: pass\nfinally: pass ;; with open('x'): pass ;; "
        "def f(a=1.0):\n    return a ;; @staticmethod\ndef f(a):\n    return a ;; class A(dict):\n    pass ;; "
        "class A:\n    pass ;; class A(Record, metaclass=type):\n    a: float ;; class A(Record):\n    a: int ;; "
        "class A(Record):\n    a = 1.0 ;; class A(Record):\n    a: Vector = vector(99999) ;; "
        "class A(Record):\n    a: Vector = vector(0) ;; class A(Record):\n    array: float ;; "
        "class A(Lag):\n    decay: Vector = vector(9) ;; class A(Record):\n    def f(self):\n        return 1.0 ;; "
        "class A(Record):\n    a: Records[Lag] = several(99999) ;; class Other(Block):\n    title = 'x' ;; "
        "exp = 1.0 ;; A = A ;; async def f():\n    pass ;; A, B = 1 ;; global A ;; A = '\u202e' ;; A = '\u200b' ;; "
        "A = '\x07'"
    ),
)
ATTRIBUTES = (
    *(
        f"{name} = 1"
        for name in ("__slots__", "__init_subclass__", "family", "name", "text", "slots", "lengths", "every_tick")
    ),
    "changes = " + repr("x" * 3000),
    *each(
        "axes = ('x',) ;; per_axis = True ;; Params = 1 ;; equations = 'x' ;; equations = (1,) ;; weaknesses = (1,) ;; "
        "title = 1 ;; group = 'x' * 9 ;; place = 'x' ;; lambda: 1 ;; x: float ;; import os ;; "
        "def __init__(self):\n    pass ;; @property\ndef a(self):\n    pass ;; "
        "def rests(cls, params):\n    return True ;; def packed(cls, params, context):\n    return 1 ;; "
        "def unsuited(cls, device):\n    return ''"
    ),
)
PACKS = (
    *(f"p.{name}" for name in DUNDERS),
    *(f"context.{name}" for name in DUNDERS),
    *(f"params.{name}" for name in (*DUNDERS, "model_dump", "copy", "model_fields")),
    *(f"cls.{name}" for name in (*DUNDERS, "name", "pack", "step", "Params")),
    *(f"{name}('1')" for name in FUNCTIONS),
    *each(
        "p.gain = 'x' ;; p.gain = None ;; p.gain = (1.0,) ;; p.taps = 1.0 ;; p.taps[4] = 1.0 ;; p.taps[-1] = 1.0 ;; "
        "p.array = 1.0 ;; p.nothing = 1.0 ;; p.lag = 1.0 ;; p.layout = 1 ;; p.taps[0] = 1.0 / 0.0 ;; "
        "p.gain = 10.0 ** 400.0 ;; p.gain = 9 ** 99999 ;; p.gain = 1e308 * 10.0 - 1e308 * 10.0 ;; "
        "p.gain = math.sqrt(-1.0) ;; a = 'x' * 10 ;; a = [0] * 10 ;; for i in range(100000):\n    p.gain = 1.0 ;; "
        "for i in range(9999):\n    for j in range(9999):\n        p.gain = 1.0 ;; while True:\n    pass ;; "
        "import os ;; def f():\n    pass ;; a = lambda: 1 ;; a = {1: 2} ;; a = {1} ;; a = f'{p}' ;; return 1.0 ;; "
        "return context ;; return cls.State.zeros() ;; a = [i for i in range(9999) for j in range(9999)] ;; "
        "a = p.taps.fill(1) ;; a = p.taps.ctypes ;; a = p.taps.tobytes() ;; p.taps.flags.writeable ;; "
        "a = context.sensors ;; a = context.device.__class__ ;; a = super().step ;; a = super().__init__ ;; "
        "a = cls.Packed.layout ;; a = cls.Packed.zeros(10 ** 9) ;; a = cls.Packed(1) ;; a = math.factorial(9) ;; "
        "a = sorted([1]) ;; a = print ;; a = range(10 ** 12) ;; raise a ;; assert True ;; del p ;; with p:\n    pass"
    ),
)


def corpus() -> dict[str, list[str]]:
    """Return whole texts, by the place of their hostile part."""
    whole = [
        *(
            "",
            "\n",
            "x",
            "import os",
            "(" * 5000,
            ")" * 10,
            "x" * 70_000,
            "\x00",
            "class A: pass",
            "if 1:\n  if 1:",
            "'''",
        ),
        *(
            "[" * 200 + "]" * 200,
            "-" * 3000 + "1",
            "1" + "+1" * 3000,
            "a=" * 500 + "1",
            "\t\n x",
            "0x" + "f" * 200,
            "#" * 70_000,
        ),
        PI.replace("class Pi(Block)", "class Pi(Block, Record)"),
        PI.replace("class Pi(Block)", "class Pi"),
        PI.replace("class Pi(Block)", "class Pi(object)"),
        PI.replace("def step", "async def step"),
        PI.replace("def step", "def step2"),
        PI.replace("(p: Packed, s: State, x: Ports)", "(p, s, x, y)"),
        PI.replace("(p: Packed, s: State, x: Ports)", "(p, s, *x)"),
        PI.replace("(p: Packed, s: State, x: Ports)", "(p, s, x=1)"),
        PI.replace("ControllerPorts):", "BlockPorts):").replace("import tap", "import tap, BlockPorts"),
        *(
            PI.replace('tap("um", "model minus', f'reads("{source}", "um", "model minus').replace(
                "import tap", "import reads"
            )
            for source in (
                "plant.displacement",
                "plant.velocity",
                "effects.mass_scale",
                "kalman.truth",
                "guard.trip",
                "@measuring",
            )
        ),
    ]
    return {
        "whole": whole,
        "step": [odd("step", text) for text in (*(f"x.seen = {text}" for text in EXPRESSIONS), *STATEMENTS)],
        "top": [odd("top", text) for text in TOPS],
        "attributes": [odd("attributes", text) for text in ATTRIBUTES],
        "pack": [odd("pack", text if {*"=: "} & {*text} else f"a = {text}") for text in PACKS],
    }
