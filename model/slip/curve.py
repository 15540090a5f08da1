# SPDX-License-Identifier: MIT
"""A fitted slip curve: a law, its parameter values and the range that was tested."""

from dataclasses import dataclass

from numpy.typing import ArrayLike

from model.arrays import Array
from model.slip.definition import SlipDefinition, require_definition
from model.slip.law import SlipLaw


@dataclass(frozen=True)
class SlipCurve:
    """A slip law with fitted parameter values, their covariance and the tested range.

    Attributes:
        law: The slip law, of k parameters.
        values: Posterior mean of the law's parameters, shape (k,).
        covariance: Posterior covariance of the law's parameters, shape (k, k); zero for the
            thesis's curve, which has none.
        definition: Slip definition that the values were fitted in.
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
        """Compute the traction force of the law at the posterior mean of its parameters.

        Args:
            slip: Slip ratio [-].
            load: Normal force [N].
            definition: Slip definition of `slip`.

        Returns:
            Traction force, in the shape to which `slip` and `load` broadcast [N].

        Raises:
            DefinitionMismatch: `definition` is not the curve's.
            ValueError: `definition` is no name of a slip definition.
        """
        require_definition(definition, self.definition)
        return self.law.force(slip, load, self.values)
