# SPDX-License-Identifier: MIT
"""A calibration has its five pictures, each of the fit's own draws."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from support.drawn_figures import figures_saved
from support.short_calibration import short_calibration
from zebro_lab.calibration.pictures import draw_calibration
from zebro_lab.calibration.request import CalibrationRequest


def test_every_picture_shows_the_fit_and_says_simulated(tmp_path, monkeypatch):
    saved = figures_saved(monkeypatch)
    calibration = short_calibration()
    draw_calibration(tmp_path, calibration, CalibrationRequest())
    titles = {name: figure.get_suptitle() for name, figure in saved.items()}
    assert titles == {
        "curves.png": "Slip curve by load (simulated)",
        "surface.png": "Slip surface (simulated)",
        "corner.png": "Posterior of the slip law (simulated)",
        "traces.png": "Traces by ensemble (simulated)",
        "residuals.png": "Residuals (simulated)",
    }
    k = len(calibration.posterior.law.parameters)
    assert len(saved["corner.png"].axes) == k * (k + 1) / 2
    assert len(saved["traces.png"].axes) == 2 * k
    trace = saved["traces.png"].axes[1].lines
    np.testing.assert_array_equal(trace[1].get_ydata(), calibration.draws.values[1, :, 0])
    loads = {axes.get_title(loc="left").split()[1] for axes in saved["curves.png"].axes
             if axes.get_title(loc="left").startswith("load")}  # fmt: skip
    assert loads == {f"{load:.4g}" for load in calibration.levels}
    over_slip = saved["residuals.png"].axes[0].collections[0].get_offsets()
    np.testing.assert_allclose(over_slip[:, 1], calibration.residuals.whitened)


@pytest.mark.parametrize("source", ["sim:test", "real"])
@pytest.mark.parametrize("untitled", [False, True])
def test_verdict_and_simulated_data_stand_in_every_picture(source, untitled, tmp_path, monkeypatch):
    saved = figures_saved(monkeypatch)
    calibration = replace(short_calibration(), source=source)
    request = CalibrationRequest(form="pdf", width=174 / 25.4, no_title=untitled)
    draw_calibration(tmp_path, calibration, request)
    assert {Path(name).suffix for name in saved} == {".pdf"}
    for figure in saved.values():
        assert figure.get_figwidth() == 174 / 25.4
        small = figure.legends[0].get_title().get_text()
        assert small.endswith(f"verdict: {calibration.verdict.state}")
        assert bool(figure.get_suptitle()) is not untitled
        shown = f"{figure.get_suptitle()} {small}".upper()
        assert ("SIMULATED" in shown) is (source == "sim:test")


def test_points_lie_around_the_curve_where_resistance_lowers_them(tmp_path, monkeypatch):
    saved = figures_saved(monkeypatch)
    calibration = short_calibration()
    posterior = calibration.posterior
    blocks, k = posterior.blocks, len(posterior.law.parameters)
    resisted = replace(blocks, traction_force=blocks.traction_force - 0.09 * blocks.normal_force)
    values = calibration.draws.values.copy()
    values[..., k + 5] += 0.09
    fit = replace(calibration.fit, posterior=replace(posterior, blocks=resisted))
    draws = replace(calibration.draws, values=values)
    draw_calibration(tmp_path, replace(calibration, fit=fit, draws=draws), CalibrationRequest())
    for axes in saved["curves.png"].axes[::2]:
        lines = {line.get_label(): np.array(line.get_data()) for line in axes.lines}
        below = {
            name: np.mean(lines[name][1] - np.interp(lines[name][0], *lines["posterior median"]))
            for name in ("run means, as measured", "corrected")
        }
        load = float(axes.get_title(loc="left").split()[1])
        assert below["run means, as measured"] < -0.06 * load
        assert abs(below["corrected"]) < 0.02 * load
