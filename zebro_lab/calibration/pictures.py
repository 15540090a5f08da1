# SPDX-License-Identifier: MIT
"""Draw the pictures of a calibration folder."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from model.arrays import Array
from model.bayes.calibration import Calibration
from model.bayes.estimate import Estimate
from model.bayes.law_scores import LawScores
from model.bayes.likelihood import corrected_blocks
from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.files.source_names import is_simulated
from zebro_lab.plots import laws, noise, posterior, sheet, slip, slip_law


def draw_calibration(folder: Path, calibration: Calibration, request: CalibrationRequest) -> None:
    """Draw `curves`, `surface`, `corner`, `traces` and `residuals` of a finished fit.

    Where laws were compared by their scores, `laws` draws all of them. Small print says how far the
    fit can be trusted, and without titles that data are simulated.

    Args:
        folder: Existing folder to write the pictures into.
        calibration: The finished fit.
        request: Format and width of the pictures, and whether they have titles.
    """
    law, blocks = calibration.posterior.law, calibration.posterior.blocks
    residuals, plain = calibration.residuals, calibration.fit.plain
    page = sheet.Page(is_simulated(calibration.source), request.width)
    k, centre = len(law.parameters), calibration.draws.flat.mean(axis=0)
    draws = calibration.draws.flat[:, :k]
    # Runs at one slip would lie on any curve, less zeros of their own.
    corrected = corrected_blocks(blocks, law, centre, zeros=not plain.of_run_means)
    labels = sheet.parameter_labels(law.parameters)
    figures = {
        "curves": slip.slip_curves(
            blocks, corrected, law, draws=draws, plain=plain.values,
            loads=calibration.levels, peaks=[*map(_peaks, calibration.curves)],
            of_runs=plain.of_run_means, page=page,
        ),
        "surface": slip_law.slip_surface(corrected, law, values=centre[:k], page=page),
        "corner": posterior.corner(draws, labels=labels, page=page),
        "traces": posterior.traces(calibration.draws.values[..., :k], labels=labels, page=page),
        "residuals": noise.residuals(
            blocks, whitened=residuals.whitened, run_score=residuals.run_score, page=page
        ),
    }  # fmt: skip
    scores = calibration.comparison
    if isinstance(scores, LawScores):
        figures["laws"] = laws.slip_laws(
            corrected,
            {score.name: (score.law, score.values) for score in scores.laws},
            reference=scores.laws[scores.chosen].name,
            load_levels=calibration.levels,
            page=page,
        )
    hidden = page.simulated and request.no_title
    note = f"{'SIMULATED data; ' * hidden}verdict: {calibration.verdict.state}"
    dpi = None if page.width is None else 300.0  # what journals ask of PNG
    for name, figure in figures.items():
        sheet.finish(figure, note, titled=not request.no_title)
        sheet.save(figure, folder / f"{name}.{request.form}", dpi=dpi)


def _peaks(curve: Sequence[Estimate]) -> Array:
    """Return slip [-] and traction [N] of driving, then of braking peak at one load, (2, 2)."""
    known = {each.parameter.name: each.median for each in curve}
    slip, force = known["peak_slip"], known["largest_force"]
    braking = known.get("braking_peak_slip", -slip), known.get("largest_braking_force", force)
    return np.array([[slip, force], [braking[0], -braking[1]]])
