"""Frequency response with tolerances."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from core.block import BlockParams, parameter
from core.device.catalogue import device as catalogued
from core.device.frequency import decibels, degrees, figures, magnitude, response, tolerance_band
from scenarios.studies.study import Study, StudyPicture

if TYPE_CHECKING:
    from core.board.board import Board

NAMES = ("mass_kg", "damping_ns_m", "stiffness_n_m")
FAR_HZ = 25_000.0


class FrequencyResponse(Study):
    """Bode figures of the device, the effect of a change of each parameter, and the band between two limits.

    ``bode.<parameter>_up.*`` are the figures with that one parameter higher; ``bode.low`` and ``bode.high`` are the
    figures of the two limiting devices; the band is the exact envelope of all devices between them.
    """

    title = "Frequency response"

    class Params(BlockParams):
        """How far the parameters reach."""

        change_pct: float = parameter(5.0, "change of one parameter at a time", "%", gt=0, le=100)
        lower: str = parameter("", "catalogue id of the lower limit; none: the device itself")
        upper: str = parameter("", "catalogue id of the upper limit; none: the device itself")

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return the figures."""
        nominal = board.spec.device.resolved
        base = figures(**nominal)
        bode = {f"bode.{name}": value for name, value in base.items()}
        far = response(**nominal, frequency_hz=np.array([1000.0, 2000.0, FAR_HZ])) * nominal["stiffness_n_m"]
        bode["bode.static_nm_per_nn"] = 1.0 / nominal["stiffness_n_m"]
        bode["bode.phase_1_khz_deg"], bode["bode.phase_2_khz_deg"] = degrees(far[:2].imag, far[:2].real).tolist()
        bode["bode.far_db"] = float(decibels(magnitude(far[2:]))[0])
        for name in NAMES:
            word = name.partition("_")[0]
            moved = figures(**{**nominal, name: nominal[name] * (1.0 + params.change_pct / 100.0)})
            bode[f"bode.{word}_up.f0_pct"] = 100.0 * (moved["f0_hz"] / base["f0_hz"] - 1.0)
            bode[f"bode.{word}_up.quality_factor"] = moved["quality_factor"]
            bode[f"bode.{word}_up.peak_db"] = moved["peak_db"]
        limits = cls._limits(nominal, params)
        for word, limit in zip(("low", "high"), limits, strict=True):
            for name in ("f0_hz", "f_peak_hz", "quality_factor", "peak_db"):
                bode[f"bode.{word}.{name}"] = figures(**limit)[name]
        reach = [[limit[name] for limit in (nominal, *limits)] for name in NAMES]
        mass, damping, stiffness = ((min(values), values[0], max(values)) for values in reach)
        band = tolerance_band(mass, damping, stiffness, np.array([base["f0_hz"]]))
        bode["bode.band_db"] = float(band.high_db[0] - band.low_db[0])
        bode["bode.band_deg"] = float(band.high_deg[0] - band.low_deg[0])
        return bode

    @classmethod
    def picture(cls, board: Board, params: Any) -> StudyPicture:
        """Return the magnitude of the device and of its two limits around their resonances."""
        nominal = board.spec.device.resolved
        devices = {"device": nominal}
        devices |= {
            name: limit
            for name, limit in zip((params.lower, params.upper), cls._limits(nominal, params), strict=True)
            if name
        }
        peaks = [figures(**device)["f0_hz"] for device in devices.values()]
        hertz = np.geomspace(0.4 * min(peaks), 2.5 * max(peaks), 200)
        at_rest = nominal["stiffness_n_m"]
        curves = [
            (name, hertz.tolist(), (20.0 * np.log10(abs(response(**device, frequency_hz=hertz)) * at_rest)).tolist())
            for name, device in devices.items()
        ]
        return StudyPicture(("frequency", "Hz"), ("magnitude", "dB"), curves, is_log_x=True)

    @staticmethod
    def _limits(nominal: dict[str, float], params: Any) -> list[dict[str, float]]:
        """Return the two limiting devices."""
        return [catalogued({"id": name}).resolved if name else nominal for name in (params.lower, params.upper)]
