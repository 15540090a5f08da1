# SPDX-License-Identifier: MIT
"""Measure in rounds: run a plan, fit all rounds, suggest the next plan, until enough is known.

Each stage hands finished files to the next: the run folders of `round-01`, ..., the `calibration`
of all rounds, the plan in `suggested-02`, .... The rig is at rest and de-energised while a round is
fitted.
"""

import math
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from model.errors import InsufficientData
from model.progress import Watcher
from model.slip.magic_formula import MagicFormula
from rig.experiment.plan import Plan
from rig.experiment.run import Outcome
from zebro_lab.adaptive.request import AdaptiveRequest
from zebro_lab.adaptive.rounds import (
    CALIBRATION,
    Round,
    begin_or_resume,
    folder_of,
    settings_of,
    suggestion_of,
    write_rounds,
)
from zebro_lab.adaptive.widths import half_width, require_parameters
from zebro_lab.calibration import stage as calibration
from zebro_lab.calibration.folder import read_slip_file
from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.calibration.slip_draws import law_draws
from zebro_lab.experiment.journal import JOURNAL_FILE
from zebro_lab.experiment.plan_stage import foresee
from zebro_lab.experiment.request import RigRunRequest
from zebro_lab.files.opening import read_text
from zebro_lab.suggest import stage as suggestion
from zebro_lab.suggest.folder import PLAN
from zebro_lab.suggest.request import SuggestRequest
from zebro_lab.workers.choice import cores_of

DRAWS: Final = 4000
"""Draws of the law that half widths are of."""
BUDGET: Final = 3.0
"""Default budget, over the time of the plan."""
MARGIN: Final = 1.2
"""Time of the next round, over that which the half width asks for if it shrinks as 1/sqrt(time)."""

Measure = Callable[[RigRunRequest], Outcome]
Working = Callable[[], AbstractContextManager[Watcher]]


@dataclass(frozen=True)
class Adapted:
    """How an adaptive experiment ended.

    Attributes:
        rounds: The finished rounds.
        reached: Whether every half width that was asked for is reached.
        reason: Why it ended.
        outcome: Outcome of the last round that ran; None if none did.
        stopped: Folder of the round that was stopped before its end; None where none was.
    """

    rounds: tuple[Round, ...]
    reached: bool
    reason: str
    outcome: Outcome | None
    stopped: Path | None = None


def adapt(
    request: AdaptiveRequest,
    *,
    measure: Measure,
    working: Working,
    tell: Callable[[Round], None] = lambda _: None,
) -> Adapted:
    """Run rounds until the half widths are reached or the budget is spent.

    Args:
        request: Plan of the first round, rig, folder, targets and budget.
        measure: Runs the experiment of one round.
        working: Shows progress of fits and suggestions.
        tell: Called with each round that has been fitted.

    Raises:
        ZebroLabError: A file or option is invalid, or the folder holds another experiment.
        RigError: As of the experiment of a round.
        ModelError: A fit failed. The rounds that were measured remain, and can be resumed.
    """
    require_parameters(request.wanted, (MagicFormula("peak"), MagicFormula("constant")))
    foreseen = foresee(request.plan, request.rig)
    budget = BUDGET * foreseen.estimate.seconds if request.budget is None else request.budget
    suggestion.require_points(request.plan, foreseen.plan)
    text = read_text(request.plan, most=suggestion.MOST_PLAN)
    settings = settings_of(request.wanted, budget, text)
    rounds = begin_or_resume(request.data, settings, resume=request.resume)
    plan: Path | None = request.plan
    reason = ""
    if rounds:
        plan, reason = _next(request, foreseen.plan, rounds, budget, working)
    outcome = None
    while plan is not None:
        number = len(rounds) + 1
        outcome = measure(_experiment(request, plan, number))
        if not outcome.completed:
            stopped = folder_of(request.data, number)
            return Adapted(tuple(rounds), False, outcome.reason, outcome, stopped)
        widths, doubt = _fit(request, foreseen.plan, working)
        estimate = foresee(plan, request.rig).estimate
        rounds.append(
            Round(number, estimate.seconds, estimate.points, len(outcome.refused), widths, doubt)
        )
        write_rounds(request.data, settings, rounds)
        tell(rounds[-1])
        plan, reason = _next(request, foreseen.plan, rounds, budget, working)
    return Adapted(tuple(rounds), not _missed(request, rounds[-1]), reason, outcome)


def _experiment(request: AdaptiveRequest, plan: Path, number: int) -> RigRunRequest:
    """Return the request of the experiment of a round, resumed if it had begun."""
    data = folder_of(request.data, number)
    begun = (data / JOURNAL_FILE).exists()
    return RigRunRequest(
        plan, request.rig, data, resume=begun,
        reset_emergency=request.reset_emergency and begun, fast=request.fast, seed=request.seed,
    )  # fmt: skip


def _fit(request: AdaptiveRequest, plan: Plan, working: Working) -> tuple[dict[str, float], str]:
    """Fit all rounds by the first answer; return half widths by target, and the fit's doubt."""
    folder = request.data / CALIBRATION
    asked = CalibrationRequest(data=(request.data,), out=folder, engine="laplace")
    with working() as watcher:
        calibration.calibrate(asked, watcher, mapper=cores_of(asked.workers))
    slip = read_slip_file(folder)
    curve = slip.curve
    values = law_draws(
        parse_slip(str(folder), with_walks=False), curve, DRAWS, rng=np.random.default_rng(1)
    )
    widths = {
        each.text: half_width(each.target, curve.law, values, plan.points.loads)
        for each in request.wanted
    }
    return widths, slip.doubt or ""


def _missed(request: AdaptiveRequest, last: Round) -> list[str]:
    """Return the targets whose half width is not reached; one that is not known is missed."""
    return [
        each.text
        for each in request.wanted
        if each.half_width is not None and not last.half_widths[each.text] <= each.half_width
    ]


def _next(
    request: AdaptiveRequest, plan: Plan, rounds: list[Round], budget: float, working: Working
) -> tuple[Path | None, str]:
    """Return the plan of the next round; or None, and why there is none."""
    last, number = rounds[-1], len(rounds) + 1
    asked = any(each.half_width is not None for each in request.wanted)
    if asked and not _missed(request, last):
        return None, "every interval is as narrow as asked"
    data = folder_of(request.data, number)
    out = suggestion_of(request.data, number)
    if (data / JOURNAL_FILE).exists() and (out / PLAN).exists():  # the round that was stopped
        return out / PLAN, ""
    left = budget - sum(each.seconds for each in rounds)
    why = ""
    for seconds in _times(request, rounds, left):
        try:
            with working() as watcher:
                suggestion.suggest(_suggestion(request, out, seconds), watcher)
        except InsufficientData as error:
            why = str(error)
        else:
            return out / PLAN, ""
    return None, f"the budget of {budget:.0f} s is spent, {max(left, 0):.0f} s are left: {why}"


def _times(request: AdaptiveRequest, rounds: list[Round], left: float) -> list[float]:
    """Return durations to try for the next round [s], the first preferred.

    It is what the widest interval asks for, doubled while that is too short for a round, but half
    of what is left at most, so that a later round can use what this one has told; then all of it.
    """
    if left <= 0:
        return []
    spent = sum(each.seconds for each in rounds)
    ratios = [
        rounds[-1].half_widths[each.text] / each.half_width
        for each in request.wanted
        if each.half_width is not None
    ]
    needed = MARGIN * spent * (max(ratios) ** 2 - 1) if ratios else math.inf
    times = []
    while 0 < needed < left / 2:
        times.append(needed)
        needed *= 2
    return [*times, left / 2, left]


def _suggestion(request: AdaptiveRequest, out: Path, seconds: float) -> SuggestRequest:
    return SuggestRequest(
        plan=request.plan, calibration=request.data / CALIBRATION,
        target=tuple(each.text for each in request.wanted), time=seconds,
        rig=request.rig, out=out,
    )  # fmt: skip
