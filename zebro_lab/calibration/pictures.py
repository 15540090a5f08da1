# SPDX-License-Identifier: MIT
"""Draw the PNG pictures of a calibration folder."""

from pathlib import Path

from model.bayes.calibration import Calibration

CURVE_DRAWS = 400


def draw_calibration(folder: Path, calibration: Calibration) -> None:
    """Draw `curves`, `surface`, `corner`, `traces` and `residuals` of a finished fit as PNG files.

    Args:
        folder: Existing folder to write the PNG files into.
        calibration: The finished fit.
    """
    from zebro_lab import plots  # matplotlib takes most of a second to import

    blocks, law = calibration.posterior.blocks, calibration.posterior.law
    residuals, simulated = calibration.residuals, calibration.simulated
    k = len(law.parameters)
    draws = calibration.draws.flat[:, :k]
    some = draws[:: max(1, len(draws) // CURVE_DRAWS)]
    labels = plots.parameter_labels(law.parameters)
    figures = {
        "curves": plots.slip_curves(
            blocks, law, draws=some, load_levels=calibration.levels, simulated=simulated
        ),
        "surface": plots.slip_surface(blocks, law, values=draws.mean(axis=0), simulated=simulated),
        "corner": plots.corner(draws, labels=labels, simulated=simulated),
        "traces": plots.traces(
            calibration.draws.values[..., :k], labels=labels, simulated=simulated
        ),
        "residuals": plots.residuals(
            blocks, whitened=residuals.whitened, run_score=residuals.run_score, simulated=simulated
        ),
    }
    for name, figure in figures.items():
        plots.save(figure, folder / f"{name}.png")
