# SPDX-License-Identifier: MIT
"""A plan, and what is known of a small calibration, for suggestions of further points."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from model.design.targets import parameter_target
from rig.experiment.plan import Plan
from support.experiment_plans import THESIS_PLAN
from support.small_layouts import posterior as posterior_of
from zebro_lab.experiment.plan_stage import read_plan
from zebro_lab.suggest.folder import Expected, Suggested
from zebro_lab.suggest.proposal import (
    Knowledge,
    Proposal,
    as_planned,
    knowledge_of,
    propose,
    seconds_of,
)

TIME = 200.0  # s


def plan(**points) -> Plan:
    """Return the thesis's plan at two loads with twelve slips and one zero."""
    whole = read_plan(THESIS_PLAN)
    own = {"loads": (3.0, 9.0), "slips": tuple(np.linspace(-0.2, 0.8, 12).tolist()), **points}
    return replace(
        whole, points=replace(whole.points, **own),
        controls=replace(whole.controls, tare_every=0, check_every=0),
    )  # fmt: skip


@cache
def knowledge(*, alone: bool = False) -> Knowledge:
    """Return what blocks of a Coulomb law say; draws are around the prior's median."""
    posterior = posterior_of()
    z = 0.2 * np.random.default_rng(5).standard_normal((30, len(posterior.free)))
    return knowledge_of(posterior, z, rate=100.0, alone=alone)


@cache
def suggested() -> Suggested:
    """Return a suggestion for slip stiffness."""
    known, asked = knowledge(), plan()
    targets = [parameter_target(known.posterior, known.draws, "slip_stiffness")]
    proposal: Proposal = propose(asked, known, targets, seconds=TIME)
    sds = (
        float(targets[0].sds(each)[0])
        for each in (np.linalg.inv(known.now), as_planned(asked, known, targets).covariance,
                     proposal.design.covariance)
    )  # fmt: skip
    row = Expected("slip_stiffness", "slip_stiffness", "dimensionless", *sds)
    return Suggested(
        asked, seconds_of(asked), proposal, (row,), known, "mine", "sim:test", ("assumes much",)
    )


def write_plan(folder: Path, *replacements: tuple[str, str]) -> Path:
    """Write the thesis's plan with two loads and a short zero, its texts replaced."""
    text = THESIS_PLAN.read_text()
    for old, new in (
        ("loads = [2.13, 6.63, 8.13, 12.75]", "loads = [4.0, 8.0, 12.0]"),
        ("patience = 30.0", "patience = 5.0"),
        ("last = 1.0, count = 62", "last = 0.3, count = 12"),
        *replacements,
    ):
        assert old in text
        text = text.replace(old, new)
    file = folder / "plan.toml"
    file.write_text(text)
    return file
