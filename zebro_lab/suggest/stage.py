# SPDX-License-Identifier: MIT
"""Stage of `rig suggest`: read plan and calibration, propose points, write the folder."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from model.bayes.posterior import SlipPosterior
from model.design.targets import Target, force_target, parameter_target
from model.similar_name import similar_name
from model.tasks import Watcher
from rig.experiment.plan import Plan
from rig.slip_rig.profile import RigProfile
from zebro_lab.calibration.draws import read_draws_of
from zebro_lab.calibration.folder import POSTERIOR, SlipFile
from zebro_lab.experiment.plan_stage import Foreseen, foresee, require_plan_allowed
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.files.opening import read_text
from zebro_lab.files.provenance import file_hashes
from zebro_lab.files.result_folder import require_replaceable, result_folder
from zebro_lab.suggest.calibrated import read_calibrated
from zebro_lab.suggest.end_pose import end_pose_target, read_walk
from zebro_lab.suggest.folder import (
    EXPECTED,
    PICTURE,
    PLAN,
    SUGGESTED,
    Expected,
    Suggested,
    points_of,
    with_points,
    write_expected,
)
from zebro_lab.suggest.pictures import draw_suggested
from zebro_lab.suggest.proposal import (
    DURATIONS,
    MOST_SLIPS,
    Knowledge,
    Proposal,
    as_planned,
    knowledge_of,
    propose,
)
from zebro_lab.suggest.request import ForceText, ParameterText, SuggestRequest, TargetText
from zebro_lab.workers import WorkersRequest, open_executor

READ_DRAWS: Final = 200
"""Draws of the posterior that are read; the first of them that are usable are used."""
MOST_PLAN: Final = 1 << 20
"""Largest plan that is read [bytes]."""
_ADVICE = "calibrate again"


def suggest(request: SuggestRequest, watcher: Watcher) -> Suggested:
    """Propose points that leave less of the uncertainty of targets, and write the folder.

    Args:
        request: Plan, calibration, targets, time and output folder.
        watcher: Receives progress.

    Raises:
        ZebroLabError: An option or file is invalid, or the folder cannot be replaced.
        RigError: The profile is missing or invalid.
        ModelError: The time is too short, or a walk of a target diverged.
    """
    require_replaceable(request.out, SUGGESTED, inputs=request.inputs)
    watcher.step("reading", None)
    foreseen = foresee(request.plan, request.rig)
    require_points(request.plan, foreseen.plan)
    fitted = read_calibrated(request.calibration)
    slip, posterior = fitted.slip, fitted.posterior
    z = _draws(slip.file.parent / POSTERIOR, posterior, seed=request.seed)
    rate = _rate(foreseen.profile) if request.rate is None else request.rate
    watcher.step("weighing the calibration's data", None)
    knowledge = knowledge_of(posterior, z, rate=rate, alone=request.alone)
    watcher.step("predicting targets", None)
    asked = list(zip(request.target, request.targets, strict=True))
    found = [_target(text, each, foreseen.plan, knowledge, z) for text, each in asked]
    targets = [target for target, _ in found]
    seconds = foreseen.estimate.seconds if request.time is None else request.time
    watcher.step("choosing points", 0.0)
    proposal = propose(
        foreseen.plan, knowledge, targets, seconds=seconds,
        progress=lambda share: watcher.step("choosing points", share),
    )  # fmt: skip
    expected = _expected(targets, foreseen.plan, knowledge, proposal)
    suggested = Suggested(
        foreseen.plan, foreseen.estimate.seconds, proposal, expected, knowledge,
        slip.file.absolute().parent.name, slip.source,
        (*_notes(request, slip, foreseen, knowledge, proposal), *fitted.notes),
    )  # fmt: skip
    walks = [file for _, files in found for file in files]
    _write(request, foreseen, suggested, (*fitted.files, *walks), watcher)
    return suggested


def require_points(file: Path, plan: Plan) -> None:
    """Raise `SettingsError` for a plan that glides through its slips, or has only one."""
    if plan.points.sweep:
        raise SettingsError(
            "glides through its slip ratios, and points are suggested; set sweep = false",
            file=file, key="points.sweep",
        )  # fmt: skip
    if min(plan.points.slips) == max(plan.points.slips):
        raise SettingsError(
            f"has one slip ratio, {plan.points.slips[0]:g}; expected the range within which slips "
            "may be suggested, as in slips = [0.0, 1.0]",
            file=file, key="points.slips",
        )  # fmt: skip


def _draws(file: Path, posterior: SlipPosterior, *, seed: int) -> Array:
    """Read draws of a calibration in random order, at most `READ_DRAWS`, as coordinates (w, d).

    Raises:
        DataError: The draws are missing, or those of another law.
    """
    names = [parameter.name for parameter in posterior.free]
    columns, _ = read_draws_of(file, "posterior", names, advice=_ADVICE)
    missing = [name for name in names if name not in columns]
    if missing:
        raise DataError(
            f"has no draws of {', '.join(missing)}; it is of another law than the slip.toml beside "
            f"it, or of an earlier version: {_ADVICE}",
            file=file,
        )
    n = len(columns[names[0]])
    chosen = np.random.default_rng(seed).permutation(n)[:READ_DRAWS]
    return np.stack(
        [posterior.coordinates({name: float(columns[name][i]) for name in names}) for i in chosen]
    )


def _rate(profile: RigProfile) -> float:
    """Return the sample rate of a rig's forces [Hz]: of its load cell, else of its board.

    Raises:
        SettingsError: The profile has neither.
    """
    cell = profile.load_cell
    if cell is not None:
        return cell.rate
    if profile.board is not None:
        return profile.board.rate
    raise SettingsError(
        f"the profile '{profile.name}' states no sample rate; state it", key="--rate"
    )


def _target(
    text: str, asked: TargetText, plan: Plan, knowledge: Knowledge, z: Array
) -> tuple[Target, tuple[Path, ...]]:
    """Return a target around the draws of a calibration, and the files that were read for it.

    Args:
        text: The target as written, its name.
        asked: The target, parsed; a force without a load is asked for at all loads of the plan.
        plan: The plan.
        knowledge: Posterior and draws around which the target is linear.
        z: Draws of the coordinates, shape (w, d); of a walk's end pose those are walked that are
            finite.

    Raises:
        SettingsError: The law has no parameter of this name.
        ZebroLabError: A walk cannot be read.
        ModelError: A walk diverged, or too few draws can be walked.
    """
    posterior, draws = knowledge.posterior, knowledge.draws
    if isinstance(asked, ParameterText):
        _require_parameter(asked.name, posterior)
        return parameter_target(posterior, draws, asked.name), ()
    if isinstance(asked, ForceText):
        loads = tuple(dict.fromkeys(plan.points.loads)) if asked.load is None else (asked.load,)
        slips = np.array(asked.slips)
        found = force_target(posterior, draws, name=text, slips=slips, loads=np.array(loads))
        return found, ()
    walk = read_walk(asked.path)
    inside = z[np.isfinite(z).all(axis=1)]
    with open_executor(WorkersRequest()) as executor:
        found = end_pose_target(
            text, walk, posterior, inside, n_draws=len(draws), executor=executor
        )
    return found, walk.files


def _require_parameter(name: str, posterior: SlipPosterior) -> None:
    """Raise `SettingsError` unless the law has a parameter of this name."""
    names = [parameter.name for parameter in posterior.law.parameters]
    if name in names:
        return
    near = similar_name(name, names)
    hint = f"; did you mean '{near}'?" if near else ""
    raise SettingsError(
        f"'{name}' is no parameter of the law '{posterior.law.name}', which has "
        f"{', '.join(names)}; nor is it force@SLIP,… or walk:RUN{hint}",
        key="--target",
    )


def _expected(
    targets: Sequence[Target], plan: Plan, knowledge: Knowledge, proposal: Proposal
) -> tuple[Expected, ...]:
    """Return standard deviations of each part of each target: now, by the plan, by the proposal.

    They are rows in the order of the targets and of their parts.
    """
    now = np.asarray(np.linalg.inv(knowledge.now), dtype=float)
    left = as_planned(plan, knowledge, targets).covariance
    rows = []
    for target in targets:
        sds = (target.sds(each) for each in (now, left, proposal.design.covariance))
        columns = zip(target.parts, target.units, *sds, strict=True)
        rows += [
            Expected(target.name, part, unit, *map(float, numbers))
            for part, unit, *numbers in columns
        ]
    return tuple(rows)


def _notes(
    request: SuggestRequest, slip: SlipFile, foreseen: Foreseen, knowledge: Knowledge,
    proposal: Proposal,
) -> tuple[str, ...]:  # fmt: skip
    """Return what a proposal assumes, one line each."""
    conditions, points = knowledge.conditions, foreseen.plan.points
    together = (
        "fitted alone, from the default priors" if request.alone
        else "fitted together with the calibration's data"
    )  # fmt: skip
    notes = [
        f"assumes that the law '{slip.curve.law.name}' holds, that further runs are measured like "
        "the calibration's, with its noise and errors of slip, and that they are " + together,
        f"assumes {knowledge.rate:g} Hz, by which the calibration's blocks of "
        f"{conditions.length:g} samples took {1000 * conditions.length / knowledge.rate:.3g} ms "
        f"and its runs {conditions.samples / knowledge.rate:.3g} s; state --rate if that is wrong",
    ]
    left_out = [load for load in points.loads if load not in proposal.plan.points.loads]
    if left_out:
        named = ", ".join(f"{load:g}" for load in dict.fromkeys(left_out))
        notes.append(
            f"loads of {named} N are left out: that saves the time of setting them, and the law "
            "alone says what happens between the others"
        )
    if proposal.counts.sum() >= MOST_SLIPS:
        notes.append(f"no more than {MOST_SLIPS} points are suggested at one load")
    low, high = slip.curve.slip_range
    if min(points.slips) < low - 0.02 or max(points.slips) > high + 0.02:
        notes.append(
            f"the plan's slips go beyond those of the calibration, {low:.3g} to {high:.3g}; there "
            "the law is extrapolated"
        )
    if slip.doubt is not None:
        notes.append(f"WARNING: the calibration is {slip.doubt}")
    return tuple(notes)


def _write(
    request: SuggestRequest, foreseen: Foreseen, suggested: Suggested, read: Sequence[Path],
    watcher: Watcher,
) -> None:  # fmt: skip
    """Write plan, table and picture, once the plan has been checked as `rig plan` does."""
    require_plan_allowed(request.plan, suggested.proposal.plan, foreseen.profile)
    told = read_text(request.plan, most=MOST_PLAN)
    text = with_points(told, suggested.proposal.plan, file=request.plan)
    watcher.step("drawing", None)
    with result_folder(request.out, SUGGESTED, content=_content(request, suggested, read)) as draft:
        (draft / PLAN).write_text(text, encoding="utf-8")
        write_expected(draft / EXPECTED, suggested.expected)
        draw_suggested(draft / f"{PICTURE}.{request.form}", suggested)


def _content(
    request: SuggestRequest, suggested: Suggested, read: Sequence[Path]
) -> Mapping[str, object]:
    """Return the manifest's entries of a suggestion, JSON-serialisable."""
    settings = {
        "plan": suggested.plan.name,
        "calibration": suggested.calibration,
        "targets": list(request.target),
        "time": request.time,
        "alone": request.alone,
        "rig": request.rig,
        "rate": suggested.knowledge.rate,
        "seed": request.seed,
        "draws": len(suggested.knowledge.draws),
        "durations_tried": DURATIONS,
    }
    return {
        "source": suggested.source,
        "settings": settings,
        **points_of(suggested),
        "notes": list(suggested.notes),
        "inputs": file_hashes(dict.fromkeys((request.plan, *read))),
    }
