# SPDX-License-Identifier: MIT
"""Layout of the experiment that a study simulates: of a plan, or of a calibration's data."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from model.bayes.blocks import block_means
from model.bayes.likelihood import NUISANCE
from model.bayes.posterior import LoadCell, default_priors
from model.bayes.preliminary import choose_block_length
from model.bayes.priors import Prior
from model.bayes.rig_errors import (
    RADIUS_TOLERANCE,
    ROLLING_RESISTANCE,
    USUAL,
    RigErrors,
    radius_ratio_sd,
)
from model.slip.definition import SlipDefinition
from model.slip.law import SlipLaw
from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from model.study.design import StudyDesign, study_design
from rig.slip_rig.imperfections import BIAS_SD, CROSSTALK_SD, GAIN_SD, TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan, simulate_sweep
from zebro_lab.calibration.fitted_blocks import read_slip_blocks
from zebro_lab.calibration.folder import read_slip_file
from zebro_lab.calibration.prior_argument import named_priors, parse_prior
from zebro_lab.experiment.plan_file import read_plan
from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.files.folder_manifest import MANIFEST, read_json_object
from zebro_lab.study.request import LayoutRequest

TWIN_CELL: Final = LoadCell(
    zero_stability=0.1, gain_sd=GAIN_SD, bias_sd=BIAS_SD, crosstalk_sd=CROSSTALK_SD
)
"""What is known beforehand of the simulated rig's load cell; its errors are drawn from this."""
MOST_SAMPLES: Final = 2_000_000
"""Samples of a simulated plan that are held in memory at once."""


@dataclass(frozen=True)
class Layout:
    """What is simulated, with the fit's law and priors.

    Attributes:
        design: Blocks, law and priors.
        title: Plan or calibration, for titles.
        plan: Plan of the simulated sweep; None for a calibration's data.
        block_length: Samples in a block; None for a calibration's data.
        mean: A calibration's posterior mean of each parameter by name; empty for a plan.
        files: Files that were read.
        notes: Notes, one line each.
    """

    design: StudyDesign
    title: str
    plan: SweepPlan | None
    block_length: int | None
    mean: Mapping[str, float]
    files: tuple[Path, ...]
    notes: tuple[str, ...]


def read_layout(request: LayoutRequest, law: SlipLaw) -> Layout:
    """Read the layout that a request names.

    Args:
        request: Plan or calibration, and priors.
        law: Law of the fit, for a plan.

    Raises:
        ZebroLabError: A file cannot be read, or a prior cannot be used.
        FitError: No curve of the law comes near the simulated forces.
    """
    if request.calibration is not None:
        return _of_calibration(request.calibration, request)
    return _of_plan(request, law)


def _stated(request: LayoutRequest, law: SlipLaw) -> dict[str, Prior]:
    stated = [parse_prior(text, key="--prior") for text in request.prior]
    named = named_priors(stated, (*law.parameters, *NUISANCE), key="--prior")
    return {name: prior for name, (prior, _) in named.items()}


def _of_plan(request: LayoutRequest, law: SlipLaw) -> Layout:
    """Simulate the plan once: slips, loads and their spread in the blocks of such a sweep."""
    plan, title, notes = _sweep_plan(request.plan)
    rng = np.random.default_rng(0)
    sweep = simulate_sweep(THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=TYPICAL_RIG, rng=rng)
    ratio = radius_ratio_sd(plan.radius_leg, plan.radius_ground, RADIUS_TOLERANCE)
    errors = RigErrors(ratio, ROLLING_RESISTANCE)
    whole = block_means(sweep.samples, max(1, len(sweep.samples) // 1000))
    priors = default_priors(law, whole, TWIN_CELL, errors)
    length = choose_block_length(sweep.samples, law, priors=priors, rng=rng).length
    design = study_design(
        block_means(sweep.samples, length), law,
        load_cell=TWIN_CELL, rig_errors=errors, stated=_stated(request, law),
    )  # fmt: skip
    files = () if request.plan is None else (request.plan,)
    return Layout(design, title, plan, length, {}, files, notes)


def _sweep_plan(file: Path | None) -> tuple[SweepPlan, str, tuple[str, ...]]:
    """Return the simulated sweep of a plan file, its title, and notes; of the bundled sweep.

    Raises:
        SettingsError: The plan has one gliding sweep for each pass, or too many samples.
    """
    if file is None:
        return SweepPlan(), "plan of the bundled sweep", ()
    plan = read_plan(file)
    points = plan.points
    if points.sweep:
        raise SettingsError(
            "glides through its slip ratios, which studies do not simulate; set sweep = false",
            file=file,
            key="points.sweep",
        )
    up_down = points.order == "up-down"
    once = (*points.slips, *points.slips[-2::-1]) if up_down else points.slips
    swept = SweepPlan(
        slips=once * points.repeats,
        loads=points.loads,
        duration=points.duration,
        omega_leg=points.omega_leg,
    )
    if swept.n_runs * swept.n_samples > MOST_SAMPLES:
        raise SettingsError(
            f"has {swept.n_runs} points of {points.duration:g} s, "
            f"{swept.n_runs * swept.n_samples:.2g} samples at {swept.rate:g} Hz; expected at most "
            f"{MOST_SAMPLES:.2g} for a study",
            file=file,
        )
    notes = (f"simulated at {swept.rate:g} Hz, one zero a point, without check points",)
    return swept, f"plan '{plan.name}'", notes


def _of_calibration(path: Path, request: LayoutRequest) -> Layout:
    """Read blocks, law and priors of a calibration.

    Raises:
        DataError: The calibration is damaged, or of a version that kept too little.
    """
    slip = read_slip_file(path)
    folder, curve = slip.file.parent, slip.curve
    blocks = read_slip_blocks(slip.file, SlipDefinition(curve.definition))
    manifest = read_json_object(folder / MANIFEST, of="calibration")
    settings = manifest.get("settings", {})
    stated, notes = _stated_in(settings, curve.law, folder)
    design = study_design(
        blocks, curve.law,
        load_cell=_known(LoadCell, settings, "load_cell", folder),
        rig_errors=_known(RigErrors, settings, "rig_errors", folder, USUAL),
        stated={**stated, **_stated(request, curve.law)},
    )  # fmt: skip
    if "noise" in read_toml_document(slip.file):
        notes += ("its Student-t noise is left out: the study simulates and fits Gaussian noise",)
    title = f"data of {slip.file.absolute().parent.name}"
    files = (slip.file, folder / "posterior.nc", folder / MANIFEST)
    return Layout(design, title, None, None, _means(slip.file, design), files, notes)


def _stated_in(
    settings: Mapping[str, Any], law: SlipLaw, folder: Path
) -> tuple[dict[str, Prior], tuple[str, ...]]:
    """Return the priors that a calibration was told, and a note on those that are left out."""
    told = settings.get("priors") or {}
    file = folder / MANIFEST
    texts = [str(text) for text in told.get("stated", {}).values()]
    parsed = [parse_prior(text, key="settings.priors", file=file) for text in texts]
    named = named_priors(parsed, (*law.parameters, *NUISANCE), key="settings.priors", file=file)
    notes = ()
    if "from" in told:
        notes = ("the prior of --prior-from is left out: the study takes the default priors there",)
    return {name: prior for name, (prior, _) in named.items()}, notes


def _known(
    of: type[Any], settings: Mapping[str, Any], key: str, folder: Path, default: Any = None
) -> Any:
    """Return prior knowledge that a manifest holds, as a dataclass `of` its kind."""
    found = settings.get(key)
    if found is None and default is None:
        raise DataError(f"has no settings.{key}; calibrate again", file=folder / MANIFEST)
    if found is None:
        return default
    try:
        return of(**{name: float(value) for name, value in found.items()})
    except (AttributeError, TypeError, ValueError) as error:
        raise DataError(
            f"settings.{key} cannot be read ({error}); calibrate again", file=folder / MANIFEST
        ) from error


def _means(file: Path, design: StudyDesign) -> dict[str, float]:
    """Read the posterior mean of every parameter from a `slip.toml`."""
    found = read_toml_document(file).get("parameters", {})
    names = [p.name for p in design.posterior(design.blocks).parameters]
    missing = [name for name in names if name not in found]
    if missing:
        raise DataError(
            f"has no mean of {', '.join(missing)}; it is of an earlier version: calibrate again",
            file=file,
        )
    return {name: float(found[name]["mean"]) for name in names}
