# SPDX-License-Identifier: MIT
"""What is printed of a fit of walks has its posterior, wrong legs and errors."""

import io
from pathlib import Path

import numpy as np
from rich.console import Console

from model.walk_fit.prior import NAMES, WrongLeg
from support.judged_walks import judged_walk
from support.walk_posteriors import posterior_of
from zebro_lab.walk_fit.screen import print_walks
from zebro_lab.walk_fit.stage import WalksCalibrated


def printed(*, left_out=(), source="sim:x", case=None) -> str:
    console = Console(file=io.StringIO(), width=200)
    print_walks(
        console,
        WalksCalibrated(posterior_of(case), left_out, Path("out/walks"), source, ("[bold]note",)),
    )
    return console.file.getvalue()


def rows(text: str) -> dict[str, list[str]]:
    return {line.split()[0]: line.split() for line in text.splitlines() if line.strip()}


def test_every_parameter_is_told_before_and_after_in_its_unit():
    posterior = posterior_of(WrongLeg(2))
    text = printed(case=WrongLeg(2))
    found = rows(text)
    assert set(NAMES) <= set(found)
    assert found["leg_offset3"][-5:] == ["+5.00", "±", "0.00", "deg", "100%"]
    grip = next(each for each in posterior.contractions() if each.name == "grip")
    assert f"{np.exp(grip.sd):.2f}" in found["grip"]
    assert found["grip"][-2] == "factor"
    assert "The walks do not inform " in text
    assert "Mounted wrong: leg 3" in text
    assert "by +5.0 ± 0.0 deg: probability 100%" in text


def test_misfits_draws_source_folder_and_notes_without_markup_are_told():
    text = printed()
    for part in ("one 0.90, two 1.10", "40 effective draws", "A single walk cannot", "SIMULATED: ",
                 "[bold]note"):  # fmt: skip
        assert part in text
    assert text.rstrip().endswith("written to out/walks")
    assert "SIMULATED" not in printed(source="real")


def test_walks_left_out_have_their_errors_beside_the_best_baselines():
    run = judged_walk("one", off=0.02)
    row = rows(printed(left_out=(run,)))["one"]
    prediction, still = run.rows
    assert row[1] == "20.0"
    assert row[2] == f"{100 * prediction.errors.ate_of_length:.2f}"
    held = prediction.scores.coverage[list(prediction.scores.levels).index(0.9)]
    assert row[6:9] == [f"{100 * share:.0f}" for share in held]
    assert row[9:11] == [f"{1000 * value:.1f}" for value in prediction.scores.crps[:2]]
    assert row[11:13] == [f"{1000 * value:.1f}" for value in still.scores.crps[:2]]
