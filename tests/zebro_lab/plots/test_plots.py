# SPDX-License-Identifier: MIT
from dataclasses import dataclass, replace

import matplotlib as mpl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib import pyplot as plt
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image

from model.slip import MagicFormula, SlipDefinition
from model.slip.law import Array
from zebro_lab.plots import (
    corner,
    parameter_labels,
    residuals,
    save,
    slip_curves,
    slip_surface,
    traces,
)
from zebro_lab.plots.noise import _autocorrelation
from zebro_lab.plots.sheet import slip_grid

PICTURES = ("curves", "surface", "corner", "traces", "residuals")
RIG_LOADS = np.array([2.13, 6.63, 8.13, 12.75])


@dataclass(frozen=True)
class Blocks:
    slip: Array
    normal_force: Array
    traction_force: Array
    run: NDArray[np.intp]
    definition: str


@dataclass(frozen=True)
class Scene:
    """A simulated calibration, complete with posterior draws whose truth is known."""

    blocks: Blocks
    law: MagicFormula
    truth: Array
    draws: Array
    load_levels: Array

    def picture(self, name: str, *, simulated: bool = True) -> Figure:
        rng = np.random.default_rng(1)
        labels = parameter_labels(self.law.parameters)
        marks = {"simulated": simulated}
        match name:
            case "curves":
                return self.curves(simulated=simulated)
            case "surface":
                return slip_surface(self.blocks, self.law, values=self.truth, **marks)
            case "corner":
                return corner(self.draws, labels=labels, **marks)
            case "traces":
                return traces(self.draws.reshape(4, 50, -1), labels=labels, **marks)
        whitened, run_score = (
            rng.normal(size=count) for count in (len(self.blocks.slip), self.blocks.run[-1] + 1)
        )
        return residuals(self.blocks, whitened=whitened, run_score=run_score, **marks)

    def curves(self, *, simulated: bool = True) -> Figure:
        return slip_curves(
            self.blocks, self.law, draws=self.draws, load_levels=self.load_levels,
            simulated=simulated,
        )  # fmt: skip


def scene(
    law: MagicFormula,
    truth: list[float],
    slip: Array,
    load_levels: Array,
    noise: float,
    definition: str = SlipDefinition.MATERIAL,
) -> Scene:
    """Test every slip at every load, three blocks a run."""
    rng = np.random.default_rng(0)
    kappa, load = np.tile(slip, len(load_levels)), np.repeat(load_levels, len(slip))
    load = load * (1 + 0.01 * rng.normal(size=len(load)))
    force = law.force(kappa, load, truth) + noise * rng.normal(size=len(kappa))
    blocks = Blocks(kappa, load, force, np.arange(len(kappa)) // 3, definition)
    draws = np.array(truth) * (1 + 0.01 * rng.normal(size=(200, len(truth))))
    return Scene(blocks, law, np.array(truth), draws, load_levels)


@pytest.fixture(scope="module")
def rig() -> Scene:
    truth = [20.4, 1.564, 0.3798, 0.0066]
    return scene(MagicFormula(), truth, np.linspace(0, 1, 62), RIG_LOADS, 0.05)


@pytest.fixture(scope="module")
def one_load() -> Scene:
    truth = [20.4, 1.564, 0.3798, 0.0066]
    return scene(MagicFormula(), truth, np.linspace(0, 1, 62), RIG_LOADS[1:2], 0.05)


@pytest.fixture(scope="module")
def tyre() -> Scene:
    law = MagicFormula("constant", load_sensitivity=True, reference_load=1500.0)
    slip = 0.15 * np.sin(np.linspace(0, 20, 300))
    truth, loads = [22.0, 1.5, 1.1, -0.8, -0.1, 0.05], np.array([500.0, 1000.0, 2000.0, 3000.0])
    return scene(law, truth, slip, loads, 40.0, SlipDefinition.TRAVEL)


@pytest.fixture(scope="module")
def few() -> Scene:
    truth = [20.4, 1.564, 0.3798, 0.0066]
    crowd = scene(
        MagicFormula(), truth, np.linspace(0.05, 0.9, 9), np.array([2.0, 6.0, 12.0]), 0.05
    )
    return replace(crowd, blocks=replace(crowd.blocks, run=np.arange(27)))


@pytest.fixture(params=["rig", "one_load", "tyre", "few"])
def any_scene(request: pytest.FixtureRequest) -> Scene:
    return request.getfixturevalue(request.param)


def texts(figure: Figure) -> str:
    """Everything the axes of a figure are labelled with."""
    labels = []
    for axes in figure.axes:
        labels += [axes.get_xlabel(), axes.get_ylabel()]
        labels += [axes.get_zlabel()] if hasattr(axes, "get_zlabel") else []
    return "\n".join(labels)


def labelled_lines(figure: Figure, label: str) -> list:
    return [line for axes in figure.axes for line in axes.lines if line.get_label() == label]


@pytest.mark.parametrize("picture", PICTURES)
def test_every_picture_ends_as_a_png_of_page_size(rig, tmp_path, picture):
    path = tmp_path / f"{picture}.partial"
    save(rig.picture(picture), path)
    with Image.open(path) as image:
        assert image.format == "PNG"
        assert image.text == {"Software": "zebro-lab"}
        assert all(700 <= side <= 2000 for side in image.size)
        assert image.info["dpi"] == pytest.approx((150, 150), abs=0.1)
        assert np.asarray(image.convert("L")).std() > 10


def test_units_stand_on_every_axis_that_is_labelled(any_scene):
    for name in PICTURES:
        figure = any_scene.picture(name)
        labels = [label for label in texts(figure).splitlines() if label]
        assert labels, name
        assert all("[" in text for axes in figure.axes if (text := axes.get_xlabel())), name
        assert all("[" in text for axes in figure.axes if (text := axes.get_ylabel())), name


def test_the_slip_axis_names_its_definition(tyre):
    labels = {name: texts(tyre.picture(name)) for name in PICTURES}
    for name in ("curves", "surface", "residuals"):
        assert "slip ratio, travel definition [-]" in labels[name]
    assert "traction force [N]" in labels["curves"]
    assert {"normal force [N]", "traction force [N]"} <= set(labels["surface"].splitlines())
    assert "normal force [N]" in labels["residuals"]


def test_simulated_pictures_say_so_and_measured_ones_do_not(one_load):
    for name in PICTURES:
        title = one_load.picture(name, simulated=False).get_suptitle()
        assert one_load.picture(name, simulated=True).get_suptitle() == f"{title} (simulated)"


def test_no_figure_is_left_with_pyplot(one_load, tmp_path):
    figures = [one_load.picture(name) for name in PICTURES]
    save(figures[0], tmp_path / "curves.png")
    assert plt.get_fignums() == []


def test_the_users_style_neither_shows_nor_changes(one_load, tmp_path):
    save(one_load.curves(), tmp_path / "plain.png")
    mine = {"font.size": 30.0, "lines.marker": "x", "savefig.bbox": "tight", "axes.grid": True}
    with mpl.rc_context(mine):
        save(one_load.curves(), tmp_path / "styled.png")
        assert {key: mpl.rcParams[key] for key in mine} == mine
    assert (tmp_path / "plain.png").read_bytes() == (tmp_path / "styled.png").read_bytes()


def test_every_block_is_drawn_once_and_at_its_nearest_load(rig):
    wholes = rig.curves().axes[::2]
    for load, axes in zip(RIG_LOADS, wholes, strict=True):
        points = np.concatenate([np.asarray(each.get_offsets()) for each in scatters(axes)])
        mine = np.argmin(np.abs(rig.blocks.normal_force[:, None] - RIG_LOADS), axis=1)
        rows = RIG_LOADS[mine] == load
        expected = np.column_stack([rig.blocks.slip[rows], rig.blocks.traction_force[rows]])
        np.testing.assert_allclose(sorted(points.tolist()), sorted(expected.tolist()))


def test_blocks_far_off_their_load_are_hollow(one_load):
    load = one_load.blocks.normal_force.copy()
    load[::4] *= 1.5
    shifted = replace(one_load, blocks=replace(one_load.blocks, normal_force=load))
    full, hollow = scatters(shifted.curves().axes[0])
    assert (len(full.get_offsets()), len(hollow.get_offsets())) == (46, 16)
    assert len(hollow.get_facecolors()) == 0
    assert hollow.get_label() == "block means, load more than 10 % off"


def test_the_median_of_one_repeated_draw_is_the_law(tyre):
    repeated = replace(tyre, draws=np.tile(tyre.truth, (5, 1)))
    medians = labelled_lines(repeated.curves(), "posterior median")
    for load, line in zip(tyre.load_levels, medians, strict=True):
        slip, force = line.get_data()
        np.testing.assert_allclose(force, tyre.law.force(slip, load, tyre.truth))


def test_peaks_are_marked_where_the_law_has_them(any_scene):
    repeated = replace(any_scene, draws=np.tile(any_scene.truth, (5, 1)))
    marks = labelled_lines(repeated.curves(), "peak")
    expected = any_scene.law.peak_slip(any_scene.load_levels, any_scene.truth)
    found = np.unique([abs(slip) for mark in marks for slip in mark.get_xdata()])
    step = np.ptp(any_scene.blocks.slip) / 249
    assert len(found)
    for slip in found:
        assert np.abs(expected - slip).min() <= step


def test_a_narrow_peak_gets_a_close_up_and_a_wide_one_none(rig, one_load, tyre):
    assert (len(rig.curves().axes), len(one_load.curves().axes)) == (8, 2)
    assert rig.curves().axes[1].get_xlim()[1] == pytest.approx(0.15)
    assert len(tyre.curves().axes) == 4


@pytest.mark.parametrize("count", [1, 3, 5, 8])
def test_up_to_eight_loads_have_a_panel_each(rig, count):
    figure = replace(rig, load_levels=np.linspace(2, 16, count)).curves()
    assert len(figure.axes) == 2 * count
    assert max(figure.get_size_inches()) < 14


def test_a_load_without_blocks_still_shows_its_curve(one_load):
    figure = replace(one_load, load_levels=np.array([6.63, 100.0])).curves()
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert "load 100 N (no blocks)" in titles
    assert len(labelled_lines(figure, "posterior median")) == 4


def test_a_single_load_still_spans_a_surface(one_load):
    bottom, top = one_load.picture("surface").axes[0].get_ylim()
    assert bottom < 0.85 * 6.63 < 1.15 * 6.63 < top


@given(
    low=st.floats(-2, 0.5), width=st.floats(0.01, 3), count=st.integers(5, 50)
)  # fmt: skip
def test_the_slip_grid_spans_the_tested_slip_and_no_more(low, width, count):
    grid = slip_grid(np.array([low, low + width]), count)
    assert grid[0] == low
    assert grid[-1] == low + width
    assert np.all(np.diff(grid) > 0)
    assert np.diff(grid).max() <= 1.01 * width / (count - 1)


def test_regions_of_highest_density_hold_the_draws_they_name():
    draws = np.random.default_rng(3).normal(size=(4000, 2)) @ [[1.0, 0.6], [0.0, 0.8]]
    figure = corner(draws, labels=("a [-]", "b [-]"), simulated=True)
    pair = next(axes for axes in figure.axes if axes.get_xlabel() and axes.get_ylabel())
    (regions,) = [each for each in pair.collections if len(each.get_paths()) == 2]
    outer, inner = (path.contains_points(draws).mean() for path in regions.get_paths())
    assert outer == pytest.approx(0.9, abs=0.04)  # contains_points fills the hole in the outer
    assert inner == pytest.approx(0.5, abs=0.06)


def test_a_posterior_of_one_point_or_one_parameter_is_drawn(tmp_path):
    point = corner(np.ones((50, 2)), labels=("a [-]", "b [-]"), simulated=True)
    line = corner(np.linspace(0, 1, 50)[:, None], labels=("a [N]",), simulated=True)
    save(point, tmp_path / "point.png")
    save(line, tmp_path / "line.png")
    assert (len(point.axes), len(line.axes)) == (3, 1)


def test_long_chains_are_thinned_and_every_ensemble_has_a_line():
    chains = np.random.default_rng(4).normal(size=(5, 30_000, 2))
    figure = traces(chains, labels=("a [-]", "b [N]"), simulated=False)
    for density, trace in zip(figure.axes[::2], figure.axes[1::2], strict=True):
        assert len(density.lines) == len(trace.lines) == 5
        assert all(len(line.get_xdata()) <= 4000 for line in trace.lines)


def test_autocorrelation_never_pairs_blocks_of_two_runs():
    whitened = np.array([1.0, 1.0, -1.0, -1.0, 1.0, 1.0])
    lags, correlations, counts = _autocorrelation(whitened, np.array([0, 0, 1, 1, 2, 2]))
    assert (lags.tolist(), correlations.tolist(), counts.tolist()) == ([1], [1.0], [3])


def test_autocorrelation_of_an_ar1_series_decays_as_its_powers():
    rng, series = np.random.default_rng(5), np.zeros(20_000)
    for index in range(1, len(series)):
        series[index] = 0.6 * series[index - 1] + rng.normal()
    lags, correlations, _ = _autocorrelation(series, np.zeros(len(series), dtype=int))
    np.testing.assert_allclose(correlations, 0.6**lags, atol=0.05)


def test_runs_of_one_block_leave_a_note_in_place_of_lags(few):
    panel = few.picture("residuals").axes[2]
    assert [text.get_text() for text in panel.texts] == ["no run has two blocks"]


def test_wild_residuals_are_counted_and_do_not_squeeze_the_histogram(one_load):
    whitened = np.append(np.zeros(60), [50.0, -1e6])
    marks = {"run_score": np.array([0.0, 3.0]), "simulated": True}
    figure = residuals(one_load.blocks, whitened=whitened, **marks)
    assert figure.axes[1].get_xlim()[1] < 10
    legends = [axes.get_legend() for axes in figure.axes]
    entries = [text.get_text() for each in legends if each for text in each.get_texts()]
    assert "blocks (2 beyond ±8 at the edges)" in entries
    assert "central 90 %, 1 of 2 outside" in entries


def test_labels_spell_name_symbol_and_unit():
    law = MagicFormula("constant", load_sensitivity=True)
    assert parameter_labels(law.parameters)[2] == "friction\n${\\mu}$ [-]"
    assert parameter_labels(law.parameters)[4] == "friction load exponent\n$a_{\\mu}$ [-]"


def scatters(axes) -> list[PathCollection]:
    return [each for each in axes.collections if isinstance(each, PathCollection)]
