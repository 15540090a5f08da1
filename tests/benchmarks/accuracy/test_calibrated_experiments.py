# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from benchmarks.accuracy import calibrated_experiments
from model.slip.thesis import THESIS_VALUES

TRUTH = np.array(THESIS_VALUES)
SD = 0.01 * TRUTH


def write_fit(out, values):
    """Write what a fit found; the fit itself takes too long here."""
    rows = np.diag(SD**2).tolist()
    means = "".join(
        f"[parameters.{name}]\nmean = {value!r}\n"
        for name, value in zip(calibrated_experiments.NAMES, values.tolist(), strict=True)
    )
    out.mkdir()
    (out / "slip.toml").write_text(
        'schema = 1\nsource = "sim:rig"\nslip_definition = "material"\n'
        'law = { name = "magic-formula", curvature = "peak" }\n'
        f"{means}[covariance]\nmatrix = {rows}\n"
        "[tested]\nnormal_force = [2.0, 13.0]\nslip_ratio = [0.0, 1.0]\n"
    )


def test_a_rig_is_measured_and_misses_are_told_in_standard_deviations(monkeypatch, tmp_path, rows):
    plan = calibrated_experiments.PLAN.read_text(encoding="utf-8")
    short = plan.replace("count = 62", "count = 3").replace("duration = 1.0 ", "duration = 0.2 ")
    (tmp_path / "plan.toml").write_text(short, encoding="utf-8")
    monkeypatch.setattr(calibrated_experiments, "PLAN", tmp_path / "plan.toml")
    command = calibrated_experiments.run

    def run(name, *words):
        if name.name != "calibrate-slip":
            return command(name, *words)
        assert any(words[0].glob("*/log.mcap"))  # the rig has been measured
        write_fit(words[-1], TRUTH + SD * [1.0, -2.0, 0.0, 0.5])
        return 0

    monkeypatch.setattr(calibrated_experiments, "run", run)
    calibrated_experiments.main(1)
    [[seed, *misses, square, codes, _]] = rows()
    assert (seed, codes) == ("0", "0, 0")
    assert [float(miss) for miss in misses] == pytest.approx([1.0, -2.0, 0.0, 0.5], abs=0.01)
    assert float(square) == pytest.approx(5.25, abs=0.01)
