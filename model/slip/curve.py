# SPDX-License-Identifier: MIT
"""A fitted slip curve: a law, its parameter values and the range that was tested."""

from dataclasses import dataclass

from numpy.typing import ArrayLike

from model.slip.definition import SlipDefinition, require_definition
from model.slip.law import Array, SlipLaw


@dataclass(frozen=True)
class SlipCurve:
    """A slip law with fitted parameter values.

    Attributes:
        law: The slip law, of k parameters.
        values: Posterior mean of its parameters, shape (k,).
        covariance: Posterior covariance of its parameters, shape (k, k).
        definition: Definition of the slip ratios.
        load_range: Smallest and largest load that was tested [N].
        slip_range: Smallest and largest slip ratio that was tested [-].
    """

    law: SlipLaw
    values: Array
    covariance: Array
    definition: SlipDefinition
    load_range: tuple[float, float]
    slip_range: tuple[float, float]

    def force(self, slip: ArrayLike, load: ArrayLike, *, definition: SlipDefinition | str) -> Array:
        """Compute the traction force at the posterior mean.

        Args:
            slip: Slip ratio [-].
            load: Normal force [N].
            definition: What `slip` is divided by.

        Returns:
            Traction force [N].

        Raises:
            DefinitionMismatch: The curve was fitted in another definition.
        """
        require_definition(definition, self.definition)
        return self.law.force(slip, load, self.values)
