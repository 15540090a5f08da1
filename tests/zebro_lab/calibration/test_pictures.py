# SPDX-License-Identifier: MIT
"""A calibration has its five pictures, each of the fit's own draws."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.checks.check import Check, Outcome
from model.bayes.verdict import Verdict
from support.drawn_figures import figures_saved
from support.short_calibration import short_calibration
from zebro_lab.calibration.pictures import draw_calibration


def test_every_picture_shows_the_fit_and_says_simulated(tmp_path, monkeypatch):
    saved = figures_saved(monkeypatch)
    calibration = short_calibration()
    draw_calibration(tmp_path, calibration)
    titles = {name: figure.get_suptitle() for name, figure in saved.items()}
    assert titles == {
        "curves.png": "Slip curve by load (simulated): NOT CONVERGED",
        "surface.png": "Slip surface (simulated): NOT CONVERGED",
        "corner.png": "Posterior of the slip law (simulated): NOT CONVERGED",
        "traces.png": "Traces by ensemble (simulated): NOT CONVERGED",
        "residuals.png": "Residuals (simulated): NOT CONVERGED",
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


@pytest.mark.parametrize(
    ("outcome", "mark"),
    [
        (Outcome.PASSED, ""),
        (Outcome.FAILED, ": NOT TRUSTWORTHY"),
        (Outcome.NOT_TESTABLE, ": NOT FULLY TESTED"),
    ],
)
def test_a_fit_that_is_not_trustworthy_says_so_in_every_title(outcome, mark, tmp_path, monkeypatch):
    saved = figures_saved(monkeypatch)
    sampler = Check("sampler", Outcome.PASSED, "")
    verdict = Verdict((sampler,), (Check("shape", outcome, ""),), {})
    draw_calibration(tmp_path, replace(short_calibration(), verdict=verdict))
    for figure in saved.values():
        assert figure.get_suptitle().endswith(f"(simulated){mark}")
