# SPDX-License-Identifier: MIT
"""Terminal output of `calibrate-slip --walks`: posterior, wrong legs, left-out walks."""

import numpy as np
from rich.console import Console
from rich.table import Table

from model.bayes.estimate import informed
from model.counted import counted
from model.walk_fit.posterior import Contraction, WalkPosterior
from model.walk_fit.prior import FALL, UNITS
from zebro_lab.files.units import shown_unit
from zebro_lab.terminal.result import print_result
from zebro_lab.terminal.tables import plain, plain_table
from zebro_lab.validation.judged_run import JudgedRun
from zebro_lab.validation.screen import radius_text, yaw_text
from zebro_lab.walk_fit.stage import WalksCalibrated

_LIKELY = 0.01  # probability from which on a case is printed


def print_walks(console: Console, done: WalksCalibrated) -> None:
    """Print notes, parameters, wrongly mounted legs, quality, left-out walks and folder of a fit.

    Args:
        console: Console to print to.
        done: The finished fit of the walks.
    """
    posterior = done.posterior
    parts = [*done.notes, _parameter_table(posterior), *_uninformed(posterior), *_cases(posterior),
             *_quality(posterior)]  # fmt: skip
    if done.left_out:
        parts.append(_left_out_table(done.left_out))
    else:
        parts.append("A single walk cannot be predicted from others; add a second --walks.")
    print_result(console, parts, source=done.source, out=done.folder)


def _parameter_table(posterior: WalkPosterior) -> Table:
    """Return a table of prior, posterior and share informed by the walks, a row per parameter."""
    walks = counted(len(posterior.walks), "walk")
    title = f"legs and floor fitted to {walks}: {', '.join(posterior.walks)}"
    numbers = ("prior", "posterior", "unit", "informed")
    table = plain_table(title, ("parameter",), numbers, no_wrap=True)
    for each, unit in zip(posterior.contractions(), UNITS, strict=True):
        table.add_row(each.name, *_cells(each, unit))
    return table


def _cells(each: Contraction, unit: str) -> tuple[str, str, str, str]:
    """Format prior, posterior, unit and informed share of a parameter.

    Values are shown as mean ± sd; logarithms of factors, unit `log`, as exp(mean) ×/÷ exp(sd).
    `fall` is fitted as a difference from its usual value `FALL`, which is added again.
    """
    share = f"{informed(each.contraction):.0%}"
    if unit == "log":  # of a factor
        before = f"1 ×/÷ {np.exp(each.prior_sd):.2f}"
        after = f"{np.exp(each.mean):.2f} ×/÷ {np.exp(each.sd):.2f}"
        return before, after, "factor", share
    if each.name == "fall":
        after = f"{FALL + each.mean:.2f} ± {each.sd:.2f}"
        return f"{FALL:g} ± {each.prior_sd:.2f}", after, "factor", share
    scale, shown = shown_unit(unit)
    before = f"0 ± {scale * each.prior_sd:.2f}"
    return before, f"{scale * each.mean:+.2f} ± {scale * each.sd:.2f}", shown, share


def _uninformed(posterior: WalkPosterior) -> list[str]:
    """Return a line that names the parameters that the walks do not inform; empty without any.

    Their posterior variance is at least nine tenths of the prior's (`Contraction.informed`).
    """
    names = [each.name for each in posterior.contractions() if not each.informed]
    if not names:
        return []
    return [f"The walks do not inform {', '.join(names)}: the posterior equals the prior."]


def _cases(posterior: WalkPosterior) -> list[str]:
    """Return a line for each case with a probability of `_LIKELY` or more, likeliest first.

    A case is one wrongly mounted leg, in all walks or in one, with the offset of its angle; or,
    where `case` is None, that no leg is mounted wrong, which has no offset.
    """
    lines = []
    for found in posterior.found():
        if found.probability < _LIKELY:
            continue
        angle = (
            ""
            if found.case is None
            else f", by {np.degrees(found.offset):+.1f} ± {np.degrees(found.sd):.1f} deg"
        )
        lines.append(f"Mounted wrong: {found.name}{angle}: probability {found.probability:.0%}")
    return lines


def _quality(posterior: WalkPosterior) -> list[str]:
    """Format misfits and effective draws, with a warning if these are too few to be reliable."""
    misfits = zip(posterior.walks, posterior.misfit, strict=True)
    lines = [
        "Mean square of whitened residuals (about 1 or less is expected): "
        + ", ".join(f"{name} {misfit:.2f}" for name, misfit in misfits),
        f"{posterior.effective:.0f} effective draws",
    ]
    if not posterior.reliable:
        lines.append("TOO FEW effective draws for a reliable result.")
    return lines


def _left_out_table(left_out: tuple[JudgedRun, ...]) -> Table:
    """Return a table of the errors of each left-out walk, and the smallest CRPS of its baselines.

    The baselines' smallest CRPS is taken of x and of y separately; `-` is a coverage not known.
    """
    numbers = (
        "error, rms\n[mm]", "of path\n[%]", "yaw\n[deg]", "radius\n[m]", "tracked\n[m]",
        "90 % band holds\nx, y, yaw [%]", "CRPS x, y\n[mm]", "best baseline's\n[mm]",
    )  # fmt: skip
    table = plain_table(
        "each walk predicted from a fit of the others", ("walk",), numbers, fold=True
    )
    for run in left_out:
        prediction, *others = run.rows
        e, scores = prediction.errors, prediction.scores
        held = scores.coverage[list(scores.levels).index(0.9)]
        table.add_row(
            plain(run.name), f"{1000 * e.ate:.1f}", f"{100 * e.ate_of_length:.2f}",
            yaw_text(e.yaw), radius_text(e.radius[0]), radius_text(e.radius[1]),
            " ".join("-" if np.isnan(share) else f"{100 * share:.0f}" for share in held),
            _two(scores.crps), _two([min(o.scores.crps[k] for o in others) for k in range(2)]),
        )  # fmt: skip
    return table


def _two(values: "np.ndarray | list[float]") -> str:
    """Format the first two values [m], those of x and y, in millimetres."""
    return " ".join(f"{1000 * value:.1f}" for value in values[:2])
