# SPDX-License-Identifier: MIT
"""Stages of `zebro-lab study`: simulate and fit all replicates, judge, and write the folder."""

from collections.abc import Callable, Mapping
from contextlib import closing
from dataclasses import dataclass

from model.mapping import Mapper, Result, Shared
from model.progress import Watcher
from model.slip.definition import SlipDefinition
from model.slip.law import SlipLaw
from model.slip.laws import slip_law
from model.slip.magic_formula import MagicFormula
from model.slip.thesis import THESIS_LAW, thesis_curve
from model.study.coverage import (
    CoverageResult,
    CoverageStudy,
    conclude_coverage,
    coverage_replicate,
)
from model.study.ranks import (
    WRONG,
    RankResult,
    RankStudy,
    Replicate,
    conclude_ranks,
    rank_replicate,
)
from zebro_lab.calibration.folder import read_slip_file
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.provenance import file_hashes
from zebro_lab.files.result_folder import require_replaceable, result_folder
from zebro_lab.study.folder import (
    COVERAGE,
    SBC,
    coverage_content,
    ranks_content,
    write_coverage,
    write_ranks,
)
from zebro_lab.study.layout import Layout, read_layout
from zebro_lab.study.request import CoverageRequest, LayoutRequest, SbcRequest
from zebro_lab.study.sweeps import SweepStudy, sweep_replicate
from zebro_lab.workers.choice import open_workers

SOURCE = "sim:study"


@dataclass(frozen=True)
class Studied:
    """A finished study.

    Attributes:
        title: What was simulated and fitted, for titles.
        result: Replicates and tests.
        content: Verdict and parameters, for manifest and document.
        notes: Notes, one line each.
    """

    title: str
    result: RankResult | CoverageResult
    content: Mapping[str, object]
    notes: tuple[str, ...]


def study_sbc(request: SbcRequest, watcher: Watcher) -> Studied:
    """Test the fit by simulation-based calibration, and write the folder.

    Args:
        request: Layout, number of replicates, workers and output folder.
        watcher: Receives progress.

    Raises:
        ZebroLabError: An option or file is invalid, workers cannot be used, or the folder cannot be
            replaced.
        FitError: The priors allow no curve.
    """
    require_replaceable(request.out, SBC, inputs=request.layout.inputs)
    law = slip_law(request.law) if request.law not in (None, MagicFormula.name) else THESIS_LAW
    with open_workers(request.workers) as workers:  # first, so that a wrong address is told at once
        layout = _read(request.layout, law, watcher)
        fitted = layout.design.assuming(WRONG.get(request.wrong or "", {}))
        study = RankStudy(layout.design, fitted)
        replicates = _mapped(workers, rank_replicate, study, request, watcher)
    result = conclude_ranks(fitted.free, replicates)
    title = f"{layout.title}, law '{layout.design.law.name}'"
    if request.wrong:
        title += f", WRONG on purpose: {request.wrong}"
    studied = Studied(title, result, ranks_content(result), layout.notes)
    settings = {"law": layout.design.law.name, "wrong": request.wrong}
    content = _content(request, layout, studied, settings)
    watcher.step("drawing", None)
    with result_folder(request.out, SBC, content=content) as draft:
        write_ranks(draft, result, fitted, title=title, form=request.form)
    return studied


def study_coverage(request: CoverageRequest, watcher: Watcher) -> Studied:
    """Count how often intervals hold a known truth, and write the folder.

    Args:
        request: Layout, truth, number of replicates, workers and output folder.
        watcher: Receives progress.

    Raises:
        ZebroLabError: An option or file is invalid, workers cannot be used, or the folder cannot be
            replaced.
    """
    given = () if request.truth is None else (request.truth,)
    require_replaceable(request.out, COVERAGE, inputs=(*request.layout.inputs, *given))
    law, truth, named = _truth(request)
    with open_workers(request.workers) as workers:
        layout = _read(request.layout, law, watcher)
        if layout.plan is None or layout.block_length is None:
            study, named = CoverageStudy(layout.design, layout.mean), "its posterior mean"
            replicates = _mapped(workers, coverage_replicate, study, request, watcher)
        else:
            swept = SweepStudy(layout.design, layout.plan, layout.block_length, truth)
            replicates = _mapped(workers, sweep_replicate, swept, request, watcher)
    result = conclude_coverage(replicates)
    title = f"{layout.title}, law '{layout.design.law.name}', truth: {named}"
    studied = Studied(title, result, coverage_content(result, layout.design), layout.notes)
    settings = {"law": layout.design.law.name, "truth": named}
    content = _content(request, layout, studied, settings)
    watcher.step("drawing", None)
    with result_folder(request.out, COVERAGE, content=content) as draft:
        write_coverage(draft, result, layout.design, title=title, form=request.form)
    return studied


def _read(request: LayoutRequest, law: SlipLaw, watcher: Watcher) -> Layout:
    watcher.step("laying out", None)
    return read_layout(request, law)


def _truth(request: CoverageRequest) -> tuple[SlipLaw, Mapping[str, float], str]:
    """Return law, values by name and name of the truth of a plan's sweeps.

    Raises:
        SettingsError: The calibration is of another slip than the rig's.
    """
    if request.truth is None:
        curve, named = thesis_curve(), "the thesis's curve"
    else:
        found = read_slip_file(request.truth)
        curve, named = found.curve, f"mean of {found.file.absolute().parent.name}"
    if curve.definition is not SlipDefinition.MATERIAL:
        raise SettingsError(
            f"{request.truth} is of '{curve.definition}' slip; sweeps are simulated in 'material' "
            "slip: name another, or its own data with --calibration",
            key="--truth",
        )
    names = (p.name for p in curve.law.parameters)
    return curve.law, dict(zip(names, map(float, curve.values), strict=True)), named


def _mapped(
    workers: Mapper,
    function: Callable[[Shared, Replicate], Result],
    study: Shared,
    request: SbcRequest | CoverageRequest,
    watcher: Watcher,
) -> list[Result]:
    """Compute all replicates of a request, and report how many are done."""
    tasks = [Replicate(request.seed, index) for index in range(request.replicates)]
    found: list[Result] = []
    watcher.step("replicates", 0.0)
    with closing(workers.map(function, study, tasks)) as results:
        for each in results:
            found.append(each)
            watcher.step("replicates", len(found) / len(tasks))
    return found


def _content(
    request: SbcRequest | CoverageRequest,
    layout: Layout,
    studied: Studied,
    settings: Mapping[str, object],
) -> dict[str, object]:
    """Return source, settings, notes and hashes of inputs for the manifest."""
    design = layout.design
    return {
        "source": SOURCE,
        "title": studied.title,
        "settings": {
            **settings,
            "layout": layout.title,
            "replicates": request.replicates,
            "seed": request.seed,
            "block_length": layout.block_length,
            "blocks": len(design.blocks),
            "runs": design.blocks.n_runs,
            "priors": {name: prior.describe() for name, prior in design.priors.items()},
        },
        "notes": list(studied.notes),
        "inputs": file_hashes(layout.files),
        **studied.content,
    }
