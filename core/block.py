"""A block: parameters, ports, equations and one step.

A step is ``step(p, s, x)``: its numbers, its state, and its ports, all by name. A block declares each once, in the
classes ``Params`` (the user's settings), ``Packed``, ``State`` and ``Ports``. The same function, run uncompiled, is its
own oracle.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Field, ValidationError, model_validator
from pydantic_core import InitErrorDetails, PydanticCustomError

from core.noise import key
from core.ports import KINDS, BlockPorts, Port
from core.record import Record
from core.structure import Equation as Equation
from core.structure import Stage as Stage
from core.table import Table

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]


LEAST, MOST = 1e-60, 1e100
"""Parameters are 0 or between these in size: products and ratios of a few of them are still finite."""


class BlockParams(Table):
    """Parameters of a block."""

    model_config = ConfigDict(frozen=True, validate_default=False, defer_build=True)

    @model_validator(mode="after")
    def _of_a_size_to_compute_with(self) -> Self:
        """Refuse a number so small or so large that the packed numbers would not be finite."""
        for name, value in self.__dict__.items():
            for one in value if type(value) is list else (value,):
                if type(one) in (int, float) and one and not LEAST <= abs(one) <= MOST:
                    size = PydanticCustomError("size", f"must be 0, or from {LEAST:g} to {MOST:g} in size")
                    details = InitErrorDetails(type=size, loc=(name,), input=one)
                    raise ValidationError.from_exception_data(type(self).__name__, [details])
        return self


def parameter(
    default: Any,
    meaning: str,
    unit: str = "",
    *,
    ge: float | None = None,
    gt: float | None = None,
    le: float | None = None,
    equation: str = "",
    live: bool = True,
) -> Any:
    """Declare a parameter: default, meaning, unit, range, where it appears, tunable while running or not."""
    extra: dict[str, Any] = {"unit": unit, "equation": equation, "live": live}
    return Field(default, description=meaning, ge=ge, gt=gt, le=le, json_schema_extra=extra)


@dataclass(frozen=True)
class Oscillator:
    """A mass, damper and spring driven by a voltage, in the units of the loop.

    Parameters
    ----------
    mass, damping, stiffness : float
        mg, uN ms/um, uN/um.
    force : float
        Signed force per volt, uN/V (negative: a positive voltage pulls to -x).
    time_unit_ms : float
        Of a plant given as a transfer function: its unit of time. Mass, damping and stiffness are then its
        coefficients, and may be 0 or negative. 0 for a resonator.
    """

    mass: float
    damping: float
    stiffness: float
    force: float
    time_unit_ms: float = 0.0

    @property
    def static_gain(self) -> float:
        """Static displacement per volt, um/V, signed; 0 for a plant without a static equilibrium."""
        return self.force / self.stiffness if self.stiffness != 0.0 else 0.0

    @property
    def natural_frequency(self) -> float:
        """Undamped natural frequency, rad/ms; the unit 1 in the time of a transfer function."""
        if self.time_unit_ms > 0.0:
            return 1.0 / self.time_unit_ms
        return float(math.sqrt(self.stiffness / self.mass))

    @property
    def in_air(self) -> bool:
        """Whether the air around it damps it; a transfer function is no resonator and has none."""
        return self.time_unit_ms == 0.0

    @property
    def damping_ratio(self) -> float:
        """Damping ratio."""
        return float(self.damping / (2.0 * math.sqrt(self.stiffness * self.mass)))


@dataclass(frozen=True)
class Context:
    """Facts of the bench that a block may use when it packs its parameters.

    Parameters
    ----------
    dt_ms : float
        The block's own sample interval.
    every : int
        Board ticks between two calls of the block.
    seed : int
        Seed of every noise stream.
    device : Oscillator
        The nominal device.
    model : Oscillator
        The reference model the shuttle should follow.
    partner : Oscillator, optional
        The second device of a pair, nominal.
    drawing : BlockParams, optional
        Drawing of the device (``core.device.geometry``).
    temperature_k : float
        Temperature of the device.
    stator_voltages : tuple of float
        Bias of the two stators, V.
    capacitance_gradient : float
        dC/dx of one comb, uN/V^2 (the same number as 1e6 F/m).
    sensor_noise_um : float
        Standard deviation of the sensor's white noise.
    sensor_every : int
        Board ticks between two samples of the sensor.
    analogue : bool
        Whether the reference drives the plant between samples.
    limit_v : float
        Reach of the drive to either side.
    limit_un : float
        The same for a plant with axes, whose drive is a force.
    axis : str
        The axis of the block, if it belongs to one.
    tone_hz : float
        Frequency of the reference, 0 if it has none.
    sensors : mapping of str to BlockParams
        Parameters of every sensor, as a calibration would give them.
    banks : mapping of str to mapping of str to Oscillator
        The devices that each diagnoser chooses between, by the names of its hypotheses.
    """

    dt_ms: float
    every: int
    seed: int
    device: Oscillator
    model: Oscillator
    partner: Oscillator | None = None
    drawing: BlockParams | None = None
    temperature_k: float = 300.0
    stator_voltages: tuple[float, float] = (0.0, 0.0)
    capacitance_gradient: float = 0.0
    sensor_noise_um: float = 0.0
    sensor_every: int = 1
    analogue: bool = False
    limit_v: float = 30.0
    limit_un: float = 0.0
    axis: str = ""
    tone_hz: float = 0.0
    sensors: Mapping[str, BlockParams] = field(default_factory=dict)
    banks: Mapping[str, Mapping[str, Oscillator]] = field(default_factory=dict)

    def with_facts(self, **facts: Any) -> Context:
        """Return these facts with some changed."""
        found = object.__new__(Context)
        vars(found).update(vars(self), **facts)
        return found

    @property
    def assumed_noise_um(self) -> float:
        """Sensor noise that filters assume: the noise of the sensor, at least a thousandth of a micrometre."""
        return max(self.sensor_noise_um, 1e-3)

    def key(self, stream: str) -> float:
        """Return the key of a noise stream of a block; ``{axis}`` is the axis of the block."""
        return key(self.seed, stream.replace("{axis}", self.axis))


LOOP = "board"
"""The family of the blocks in ``core/loop``, which every bench has."""


class Block:
    """Base of every block; a subclass declares, ``pack`` and ``state`` turn the declaration into records."""

    family: ClassVar[str]
    name: ClassVar[str]
    title: ClassVar[str]
    text: ClassVar[str] = ""
    """The text of a user unit."""
    group: ClassVar[str] = ""
    place: ClassVar[int] = 1000
    """Where lists for people have the block: under which heading, and in which order, the usual first."""
    changes: ClassVar[str] = ""
    shows: ClassVar[str] = ""
    suggested: ClassVar[float | None] = None
    """Of a fault: the parts of the device it changes, the part it is seen on, a severity to begin with."""
    Params: ClassVar[type[BlockParams]]
    Packed: ClassVar[type[Record]] = Record
    State: ClassVar[type[Record]] = Record
    Ports: ClassVar[type[BlockPorts]] = BlockPorts
    inputs: ClassVar[tuple[Port, ...]] = ()
    outputs: ClassVar[tuple[Port, ...]] = ()
    taps: ClassVar[tuple[Port, ...]] = ()
    equations: ClassVar[tuple[Equation, ...]] = ()
    structure: ClassVar[tuple[Stage, ...]] = ()
    """The stages of a step, for a drawing; without them the block is drawn as one."""
    weaknesses: ClassVar[tuple[str, ...]] = ()
    """Where the block is known to be weak, in plain sentences with figures; read before it is trusted."""
    axes: ClassVar[tuple[str, ...] | None] = ()
    """Of a plant: axes it moves along, none for one displacement. Of another block: axes it needs, None for any."""
    per_axis: ClassVar[bool] = False
    """Whether the board makes one instance for each axis of the plant."""
    slot: ClassVar[str] = ""
    """The slot of a controller."""
    slots: ClassVar[dict[str, str]] = {"": "open_loop"}
    """Of a plant: its slots, each with the controller that usually drives; ``controller.kind`` means the last."""
    generators: ClassVar[dict[str, str]] = {}
    """The inputs of a plant with axes besides its forces, and the family of each."""
    usual_sensor: ClassVar[str] = "ideal"
    takes: ClassVar[dict[str, tuple[str, ...]]] = {}
    """Of a plant: the only blocks of a family that go with it."""
    plants: ClassVar[tuple[str, ...]] = ()
    """The only plants that a block goes with, none for any."""
    lengths: ClassVar[tuple[str, ...]] = ()
    """Parameters that set the length of the tail of ``State``; none of them may change while the board runs."""
    apart: ClassVar[bool] = False
    """Whether no bench has the block unless something puts it there, and no list shows it."""
    every_tick: ClassVar[bool] = False
    """Whether the step is called at every tick though the block runs every N, because it has to do between."""

    def __init_subclass__(cls) -> None:
        """Name the block after its file and its family after its folder; sort its ports by kind."""
        path = cls.__module__.split(".")
        cls.name = path[-1]
        folder = path[-2] if len(path) > 1 else ""
        cls.family = LOOP if folder == "loop" else folder
        cls.inputs, cls.outputs, cls.taps = (
            tuple(port for port in cls.Ports.declared if port.kind == kind) for kind in KINDS
        )

    @staticmethod
    def step(p: Any, s: Any, x: Any) -> None:
        """Compute one sample: read ``p``, read and write ``s`` and ``x``."""
        raise NotImplementedError

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:  # noqa: ARG003 (most blocks suit every device)
        """Say why the block cannot be on a bench with this device and reference model; nothing when it can."""
        return ""

    @classmethod
    def fits(cls, axes: tuple[str, ...]) -> bool:
        """Return whether the block fits a plant that moves along these axes."""
        if cls.per_axis:
            return bool(axes)
        if cls.axes is None:
            return True
        return set(cls.axes) <= set(axes) if cls.axes else not axes

    @classmethod
    def rests(cls, params: Any) -> bool:  # noqa: ARG003 (most blocks never rest)
        """Say whether the block has nothing to do with these parameters, so that it need not run."""
        return False

    @classmethod
    def caution(cls, params: Any, context: Context, hz: float) -> str:  # noqa: ARG003 (most blocks take it as it is)
        """Return a warning about the loss by the block's hold assumption under a tone; empty when the loss is small."""
        return ""

    @classmethod
    def pack(cls, params: Any, context: Context) -> Record:  # noqa: ARG003 (some read parameters only)
        """Return the numbers of the step; a number left blank is the parameter of its name."""
        return cls.Packed.blank()

    @classmethod
    def state(cls, params: Any, context: Context) -> Record:  # noqa: ARG003 (most begin with zeros)
        """Return the initial state."""
        return cls.State.zeros()

    @classmethod
    def packed(cls, params: BlockParams, context: Context) -> FloatArray:
        """Return the numbers the step reads.

        Raises
        ------
        TypeError
            When neither ``pack`` nor a parameter sets one of them.
        """
        record = cls.pack(params, context)
        for place, stream in record.streams.items():
            record.array[place] = context.key(stream)
        for name in record.blanks():
            if "." in name or not hasattr(params, name):
                raise TypeError(f"{cls.__module__}: pack leaves {name} blank, and no parameter has this name")
            setattr(record, name, float(getattr(params, name)))
        numbers: FloatArray = record.array
        return numbers

    @classmethod
    def initial(cls, params: BlockParams, context: Context) -> FloatArray:
        """Return the numbers of the initial state."""
        numbers: FloatArray = cls.state(params, context).array
        return numbers
