# SPDX-License-Identifier: MIT
"""Replicate of a coverage study: a simulated sweep, sample by sample, fitted in blocks."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from model.bayes.blocks import block_means
from model.study.coverage import CoverageReplicate, compare_fit, draw_rig
from model.study.design import StudyDesign
from model.study.ranks import Replicate
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan, simulate_sweep


@dataclass(frozen=True)
class SweepStudy:
    """What all replicates of a study share.

    Attributes:
        design: Law and priors of the fit.
        plan: Plan of the sweep.
        block_length: Samples in a block.
        truth: True value of each parameter of the law, by name.
    """

    design: StudyDesign
    plan: SweepPlan
    block_length: int
    truth: Mapping[str, float]


def sweep_replicate(study: SweepStudy, task: Replicate) -> CoverageReplicate:
    """Simulate the samples of a sweep on a rig drawn from the priors, fit its blocks, and compare.

    Unlike blocks that are simulated as blocks, noise of speeds, wander of slip, the bump and the
    correlation of noise from sample to sample are simulated here, and averaged as in a calibration.

    Args:
        study: Plan, design and true values.
        task: Seed and number of the replicate, which determine the result.
    """
    rng = np.random.default_rng([task.seed, task.index])
    design, law = study.design, study.design.law
    errors = draw_rig(design, rng)
    sweep = simulate_sweep(
        law,
        [study.truth[p.name] for p in law.parameters],
        plan=study.plan,
        imperfections=replace(TYPICAL_RIG, **errors),
        rng=rng,
    )
    blocks = block_means(sweep.samples, study.block_length)
    return compare_fit(design, blocks, {**study.truth, **errors}, task.index, rng)
