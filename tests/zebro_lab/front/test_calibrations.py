# SPDX-License-Identifier: MIT
"""Calibration, used as a notebook would."""

import pytest

import zebro_lab as zl


def test_a_calibration_has_summary_posterior_verdict_and_curve(sweep, monkeypatch):
    monkeypatch.setattr("zebro_lab.calibration.stage.draw_calibration", lambda *_, **__: None)
    given = {"law": "brush", "prior": ["friction = 0.4 ± 0.2"]}
    result = zl.calibrate(str(sweep), **given, engine="laplace")
    assert "normal(mean 0.4, sd 0.2)" in result.summary.loc["friction", "prior"]
    assert {"mean", "sd", "r_hat"} <= set(result.summary.columns)
    assert "friction" in result.posterior.posterior
    assert result.verdict.headline()
    assert result.curve.values[1] == pytest.approx(0.38, abs=0.1)
    assert result.data.source.startswith("sim:")
