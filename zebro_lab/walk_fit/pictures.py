# SPDX-License-Identifier: MIT
"""Pictures of a fit of walks: prior and posterior, and each walk predicted from the others."""

from collections.abc import Sequence
from pathlib import Path

from model.walk_fit.posterior import WalkPosterior
from zebro_lab.files.picture_format import PictureFormat
from zebro_lab.plots import save
from zebro_lab.plots.path_validation import path_validation
from zebro_lab.plots.walks import walk_parameters
from zebro_lab.validation.judged_run import JudgedRun

PARAMETERS, LEFT_OUT = "walk_parameters", "left_out."


def draw_walks(
    folder: Path, posterior: WalkPosterior, left_out: Sequence[JudgedRun], *, simulated: bool,
    form: PictureFormat = "png",
) -> None:  # fmt: skip
    """Draw prior and posterior, and the errors of each left-out walk.

    Args:
        folder: Folder to write `walk_parameters` and `left_out.NAME` into.
        posterior: The posterior of legs and floor.
        left_out: Each walk predicted from a fit of the other walks, with the errors.
        simulated: Whether to append "(simulated)" to the titles.
        form: Format of the pictures.
    """
    save(walk_parameters(posterior, simulated=simulated), folder / f"{PARAMETERS}.{form}")
    for run in left_out:
        figure = path_validation(
            {row.name: row.path for row in run.rows},
            run.track,
            band=run.band,
            title=f"{run.name}, from a fit of the other walks",
            simulated=simulated,
        )
        save(figure, folder / f"{LEFT_OUT}{run.name}.{form}")
