# SPDX-License-Identifier: MIT
"""Draw the pictures of a calibration folder."""

from pathlib import Path
from typing import Final

from model.bayes.calibration import Calibration
from model.bayes.law_scores import LawScores
from model.bayes.likelihood import predict_blocks
from model.bayes.verdict import State
from zebro_lab import plots
from zebro_lab.files.picture_format import PictureFormat
from zebro_lab.files.source_names import is_simulated

_MARKS: Final = {
    State.AS_TESTED: "NOT FULLY TESTED",
    State.NOT_TRUSTWORTHY: "NOT TRUSTWORTHY",
}
"""What titles say of a fit that is not trustworthy."""


def draw_calibration(folder: Path, calibration: Calibration, form: PictureFormat = "png") -> None:
    """Draw `curves`, `surface`, `corner`, `traces` and `residuals` of a finished fit.

    Where laws were compared by their scores, `laws` draws all of them. The titles of a fit that did
    not converge, is not trustworthy or not fully tested say so.

    Args:
        folder: Existing folder to write the pictures into.
        calibration: The finished fit.
        form: Format of the pictures.
    """
    law = calibration.posterior.law
    blocks = calibration.posterior.blocks
    residuals, simulated = calibration.residuals, is_simulated(calibration.source)
    k = len(law.parameters)
    draws = calibration.draws.flat[:, :k]
    labels = plots.parameter_labels(law.parameters)
    figures = {
        "curves": plots.slip_curves(
            blocks, law, draws=draws, load_levels=calibration.levels, simulated=simulated
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
    scores = calibration.comparison
    if isinstance(scores, LawScores):
        centre = calibration.draws.flat.mean(axis=0)
        residual = blocks.traction_force - predict_blocks(blocks, law, centre[None]).force[0]
        figures["laws"] = plots.slip_laws(
            blocks,
            {score.name: (score.law, score.values) for score in scores.laws},
            reference=scores.laws[scores.chosen].name,
            residual=residual,
            load_levels=calibration.levels,
            simulated=simulated,
        )
    for name, figure in figures.items():
        mark = _MARKS.get(calibration.verdict.state)
        if mark is not None:
            plots.add_to_title(figure, mark)
        plots.save(figure, folder / f"{name}.{form}")
