"""Pictures of campaigns: which kind, which figure first, over what range, and how the report paints them."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.stats import spearmanr

from core.errors import InputError
from scenarios.campaign.sweep import Sweep
from scenarios.campaign.tally import PointTally, Spread
from scenarios.metric_name import metric_limits
from scenarios.report.campaign import campaign_report
from scenarios.report.campaign_figures import by_variation, span_of
from scenarios.report.campaign_picture import CampaignPicture, campaign_picture
from scenarios.report.paint_campaign import paint_campaign
from scenarios.report.palette import ramp

ERROR, SWITCHES, F0 = "control.rms_error_um", "diagnosis.kalman.false_switches", "device.f0_hz"
NOISE = {"sensor.noise_um": [0.01, 0.02, 0.05]}
MASS = {"device.mass_kg": [2e-10, 3e-10]}
KIND = {"controller.kind": ["pid", "mrac"]}
RANGES = {
    name: {"min": 1.0, "max": 2.0} for name in ("sensor.noise_um", "reference.amplitude_um", "reference.offset_um")
}


def sweep_of(**tables: Any) -> Sweep:
    """Return a campaign of the scenario of seven steps."""
    return Sweep({"schema": 1, "scenario": "ch5-seven-step", **tables})


def point(labels: dict[str, str | float], **figures: tuple[float, float]) -> PointTally:
    """Return a point with the mean and the deviation of its figures."""
    names = {"error": ERROR, "switches": SWITCHES, "f0": F0}
    spreads = {names[name]: Spread(4, mean, std, mean, mean) for name, (mean, std) in figures.items()}
    return PointTally(labels, 4, 4, 0, [], [], spreads, {})


def results(sweep: Sweep, of: Callable[[dict[str, Any]], float], std: float = 0.01) -> dict[int, PointTally]:
    """Return a point for each of a campaign, whose error is a function of its settings."""
    return {
        number: point(one.labels, error=(of(one.values), std), f0=(2484.0, 0.0))
        for number, one in enumerate(sweep.points)
    }


def picture_of(sweep: Sweep, of: Callable[[dict[str, Any]], float], **wanted: str) -> CampaignPicture:
    """Return the picture of a campaign with such results."""
    return campaign_picture(sweep, results(sweep, of), [ERROR, F0], **wanted)


def test_the_numbers_that_vary_decide_the_kind_of_picture() -> None:
    """None: rows; one: lines; two: a map; more, or drawn by chance: a ranking. Texts are no axes."""
    spread = {"process_spread": {"devices": 5}, "scenario": "ch1-process-spread"}
    kinds = [
        ({"grid": KIND}, "rows"),
        ({"grid": NOISE | KIND}, "lines"),
        ({"grid": NOISE | MASS | {"samples": [1000]}}, "map"),
        ({"grid": NOISE | MASS | {"samples": [1000, 2000]}}, "ranking"),
        ({"latin_hypercube": {"points": 5, "ranges": RANGES}}, "ranking"),
        (spread, "ranking"),
    ]
    for tables, kind in kinds:
        assert picture_of(sweep_of(**tables), lambda _: 1.0).kind == kind, tables


def test_lines_go_over_the_number_in_its_order_one_for_each_of_the_rest() -> None:
    shown = picture_of(sweep_of(grid={"sensor.noise_um": [0.05, 0.01, 0.02]} | KIND), lambda v: v["sensor.noise_um"])
    assert [part.labels for part in shown.parts] == [{"controller.kind": "pid"}, {"controller.kind": "mrac"}]
    assert shown.across == "sensor.noise_um" and shown.up == ""
    assert shown.parts[0].x == shown.parts[0].mean == [0.01, 0.02, 0.05] and shown.parts[0].std == [0.01] * 3


def test_a_map_has_a_place_for_each_pair_and_is_turned_on_demand() -> None:
    sweep = sweep_of(grid=NOISE | MASS)
    shown = picture_of(sweep, lambda v: v["sensor.noise_um"] * v["device.mass_kg"] * 1e10)
    (part,) = shown.parts
    assert (shown.across, shown.up) == ("sensor.noise_um", "device.mass_kg") and len(part.mean) == 6
    for x, y, mean in zip(part.x, part.y, part.mean, strict=True):
        assert mean == pytest.approx(x * y * 1e10)
    turned = picture_of(sweep, lambda _: 1.0, across="device.mass_kg")
    assert (turned.across, turned.up) == ("device.mass_kg", "sensor.noise_um")


def test_a_ranking_has_the_numbers_in_the_order_of_their_rank_correlation() -> None:
    """A figure that rises with a number has 1 with it, whatever the shape, -1 where it falls, little with others."""
    sweep = sweep_of(latin_hypercube={"points": 60, "ranges": RANGES})
    shown = picture_of(sweep, lambda v: -np.exp(5.0 * v["reference.amplitude_um"]))
    assert shown.ranking[0].name == "reference.amplitude_um" == shown.across
    assert shown.ranking[0].correlation == pytest.approx(-1.0)
    assert all(abs(one.correlation) < 2.0 * shown.chance for one in shown.ranking[1:])
    assert shown.chance == pytest.approx(1.96 / np.sqrt(59))
    assert len(shown.parts) == 1 and shown.parts[0].x == sorted(shown.parts[0].x)
    flat = picture_of(sweep, lambda _: 1.0)
    assert [one.correlation for one in flat.ranking] == [0.0] * 3
    other = picture_of(sweep, lambda v: v["sensor.noise_um"], across="reference.offset_um")
    assert other.across == "reference.offset_um" and other.ranking[0].name == "sensor.noise_um"


def test_a_ranking_is_spearman_s_also_of_equal_numbers() -> None:
    sweep = sweep_of(latin_hypercube={"points": 40, "ranges": RANGES})
    shown = picture_of(sweep, lambda v: np.round(4.0 * v["sensor.noise_um"] / v["reference.amplitude_um"], 1))
    drawn = {name: np.array([point.values[name] for point in sweep.points]) for name in RANGES}
    means = np.round(4.0 * drawn["sensor.noise_um"] / drawn["reference.amplitude_um"], 1)
    assert len(np.unique(means)) < len(means)
    for one in shown.ranking:
        assert one.correlation == pytest.approx(spearmanr(drawn[one.name], means)[0], abs=1e-12), one.name


def test_drawn_devices_are_ranked_by_what_was_drawn_and_not_by_their_number() -> None:
    sweep = sweep_of(process_spread={"devices": 30}, scenario="ch1-process-spread")
    shown = picture_of(sweep, lambda v: v["device.geometry.thickness_um"])
    assert shown.ranking[0].name == "device.geometry.thickness_um"
    assert "device" not in [one.name for one in shown.ranking]


def test_the_figure_shown_first_is_that_which_varies_most_against_the_seeds() -> None:
    """A figure that is the same in all rows to a thousandth is not first, however small its deviation is."""
    noises = (0.01, 0.02, 0.05)
    flat = {0.01: 0.246992, 0.02: 0.24698, 0.05: 0.247}
    points = [point({"noise": n}, error=(flat[n], 3e-5), switches=(100.0 * n, 0.5), f0=(2484.0, 0.0)) for n in noises]
    assert by_variation(points, [F0, ERROR, SWITCHES]) == [SWITCHES, ERROR, F0]
    without = [point({"noise": n}, error=(n, 0.0), switches=(10.0 + n, 0.0)) for n in noises]
    assert by_variation(without, [SWITCHES, ERROR]) == [ERROR, SWITCHES]
    loud = [point({"noise": n}, error=(n, 1.0), switches=(10.0 + 10.0 * n, 0.001)) for n in noises]
    assert by_variation(loud, [ERROR, SWITCHES]) == [SWITCHES, ERROR]


def test_an_axis_holds_zero_where_zero_means_something_and_no_band_goes_below_it() -> None:
    assert span_of(ERROR, [(0.24, 0.25)]) == (0.0, pytest.approx(0.26))
    assert span_of(SWITCHES, [(-0.5, 0.9)])[0] == 0.0
    low, high = span_of("diagnosis.kalman.correct_fraction", [(0.98, 1.02)])
    assert (low, high) == (0.0, 1.0)
    low, high = span_of(F0, [(2480.0, 2481.0)])
    assert 2400.0 < low < 2480.0 < 2481.0 < high < 2560.0
    low, high = span_of("rate.scale_error_pct", [(1.0, 3.0)])
    assert low < 0.0 < 3.0 < high
    assert span_of(ERROR, []) == (0.0, pytest.approx(1.04))


def test_the_longest_deviation_takes_at_most_half_of_an_axis() -> None:
    for ends in ([(2484.0 - 71.0, 2484.0 + 71.0)] * 3, [(-0.1, 0.1)]):
        low, high = span_of(F0, ends)
        assert high - low >= 2.0 * (ends[0][1] - ends[0][0])


def test_the_name_of_a_figure_tells_what_it_cannot_pass() -> None:
    assert metric_limits("diagnosis.kalman.correct_fraction") == (0.0, 1.0)
    assert metric_limits("diagnosis.kalman.false_switches")[0] == metric_limits("control.rms_error_um")[0] == 0.0
    assert metric_limits("rate.scale_error_pct")[0] == -float("inf")


def test_an_unknown_figure_or_number_is_refused() -> None:
    for wanted in ({"figure": "control.nonsense"}, {"across": "sensor.nonsense"}):
        with pytest.raises(InputError, match="nonsense"):
            picture_of(sweep_of(grid=NOISE | MASS), lambda _: 1.0, **wanted)


def test_a_campaign_without_results_has_no_parts() -> None:
    shown = campaign_picture(sweep_of(grid=NOISE), {}, [])
    assert shown.figure == "" and shown.figures == [] and shown.parts == []
    assert paint_campaign(shown) == []


def texts(drawing: str) -> list[str]:
    """Return the texts of a drawing."""
    return [str(one.text) for one in ElementTree.fromstring(drawing).iter("{http://www.w3.org/2000/svg}text")]


def test_a_map_is_painted_as_cells_with_the_scale_of_their_colours() -> None:
    shown = picture_of(sweep_of(grid=NOISE | MASS), lambda v: v["sensor.noise_um"])
    (drawing,) = paint_campaign(shown)
    cells = re.findall(r'fill="(#\w+)"><title>([^<]+)</title>', drawing)
    assert len(cells) == 6
    low, high = shown.low, shown.high
    for fill, text in cells:
        noise = float(re.search(r"noise ([\d.]+)", text)[1])  # type: ignore[index]
        assert fill == ramp((noise - low) / (high - low)), text
    assert "noise 0.01\u00a0µm, mass 200\u00a0ng: 10\u00a0±\u00a010\u00a0nm" in [text for _, text in cells]
    said = texts(drawing)
    assert {"0.01", "0.02", "0.05", "200", "300", "noise, µm", "mass, ng"} <= set(said)
    assert any("over noise and mass" in one for one in said)


def test_lines_are_painted_in_their_bands_and_a_ranking_with_its_points() -> None:
    (lines,) = paint_campaign(picture_of(sweep_of(grid=NOISE | KIND), lambda v: v["sensor.noise_um"]))
    assert lines.count('class="band') == 2 and lines.count('class="line"/>') >= 2
    assert {"kind pid", "kind mrac"} <= set(texts(lines))
    sweep = sweep_of(latin_hypercube={"points": 20, "ranges": RANGES})
    ranking, dots = paint_campaign(picture_of(sweep, lambda v: v["sensor.noise_um"]))
    assert texts(ranking).index("noise") < texts(ranking).index("amplitude")
    assert dots.count("h0") == 20 and 'class="dots"' in dots
    rows = paint_campaign(picture_of(sweep_of(grid=KIND), lambda v: 1.0 + (v["controller.kind"] == "mrac")))
    assert len(rows) == 1 and {"kind pid", "kind mrac"} <= set(texts(rows[0]))


def test_a_report_has_the_name_of_its_campaign_and_its_pictures_before_the_table() -> None:
    sweep = sweep_of(grid=NOISE, title="The title")
    points = list(results(sweep, lambda v: v["sensor.noise_um"]).values())
    named = campaign_report(sweep, points, "Noise & <mass>")
    assert "<h1>Noise &amp; &lt;mass&gt;</h1>" in named and "<title>Noise &amp; &lt;mass&gt;</title>" in named
    assert "<h1>The title</h1>" in campaign_report(sweep, points)
    assert "<h1>Campaign sweep</h1>" in campaign_report(sweep_of(grid=NOISE), points)
    assert 0 < named.index("<svg") < named.index("<table") and "<details>" in named
    assert "NaN" not in named and "nan" not in named


def test_values_of_points_are_read_by_column() -> None:
    sweep = sweep_of(
        grid=NOISE | MASS | KIND,
        latin_hypercube={"points": 4, "ranges": {"reference.offset_um": {"min": 0.0, "max": 1.0}}},
    )
    numbers = np.arange(len(sweep.points))
    for path in ("sensor.noise_um", "device.mass_kg", "reference.offset_um"):
        assert sweep.points.column(path, numbers).tolist() == [sweep.points[at].values[path] for at in numbers.tolist()]
    assert np.isnan(sweep.points.column("nothing", numbers)).all()
