# SPDX-License-Identifier: MIT
"""What a study fits: the layout of an experiment's blocks, a law, and priors fixed beforehand."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from model.arrays import Array
from model.bayes.blocks import SlipBlocks
from model.bayes.fit import not_identified
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.bayes.priors import Prior
from model.bayes.rig_errors import RigErrors
from model.errors import FitError
from model.slip.law import SlipLaw

MOST_TRIES = 10_000  # prior draws, of which one has to be a curve of the law


@dataclass(frozen=True)
class StudyDesign:
    """Layout of an experiment, with the law and the priors of its fit.

    The priors are the same in every replicate. Those of a fit of real data take their scales from
    the data, which here would make the truth depend on the data that are simulated from it.

    Attributes:
        blocks: The experiment's blocks: slips, loads and their spread, of which the slips are
            exact but for the errors that the blocks state. Its traction is not used.
        law: The slip law.
        priors: Prior of every parameter by name.
        fixed: Value of each parameter that is not sampled, by name.
    """

    blocks: SlipBlocks
    law: SlipLaw
    priors: Mapping[str, Prior]
    fixed: Mapping[str, float] = field(default_factory=dict)

    def posterior(self, blocks: SlipBlocks) -> SlipPosterior:
        """Return the posterior density given blocks of this layout."""
        return SlipPosterior(blocks, self.law, self.priors, self.fixed)

    @property
    def free(self) -> tuple[str, ...]:
        """Names of the parameters that are sampled."""
        return tuple(p.name for p in self.posterior(self.blocks).free)

    def named(self, values: Array) -> dict[str, float]:
        """Return values of all parameters, shape (k + 12,), by name."""
        names = [p.name for p in self.posterior(self.blocks).parameters]
        return dict(zip(names, map(float, values), strict=True))

    def assuming(self, fixed: Mapping[str, float]) -> "StudyDesign":
        """Return the design of a fit that takes some parameters as known."""
        return replace(self, fixed={**self.fixed, **fixed})

    def draw(self, rng: np.random.Generator) -> Array:
        """Draw values of all parameters from the prior, shape (k + 12,).

        Draws of which the law makes no valid curve at the loads are drawn again, as the prior
        density is zero there.

        Raises:
            FitError: None of `MOST_TRIES` draws is valid.
        """
        prior = self.posterior(self.blocks)
        for _ in range(MOST_TRIES):
            z = rng.standard_normal((1, len(prior.free)))
            if np.isfinite(prior.log_prior(z)[0]):
                return prior.values(z)[0]
        raise FitError(
            f"none of {MOST_TRIES} draws from the priors is a valid curve of '{self.law.name}' at "
            f"loads of {self.blocks.normal_force.min():.3g} to "
            f"{self.blocks.normal_force.max():.3g} N; state other priors"
        )


def study_design(
    blocks: SlipBlocks,
    law: SlipLaw,
    *,
    load_cell: LoadCell,
    rig_errors: RigErrors,
    stated: Mapping[str, Prior] | None = None,
) -> StudyDesign:
    """Return the design of a study with the default priors of a fit.

    Args:
        blocks: The experiment's blocks; median load and largest traction scale the priors.
        law: The slip law.
        load_cell: Prior knowledge of the load cell.
        rig_errors: Prior knowledge of the rig's geometry and rolling resistance.
        stated: Priors that replace default ones, by the parameter's name.
    """
    priors = default_priors(law, blocks, load_cell, rig_errors)
    return StudyDesign(blocks, law, {**priors, **(stated or {})}, not_identified(blocks))
