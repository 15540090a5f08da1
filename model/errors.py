# SPDX-License-Identifier: MIT
"""Exceptions of the package `model`."""


class ModelError(Exception):
    """Root of every error that `model` raises on purpose."""


class DomainError(ModelError, ValueError):
    """An argument is invalid: outside an equation's domain, of another shape, an unknown name."""


class DefinitionMismatch(ModelError, ValueError):
    """Slip ratios, or a slip curve, have another definition than the computation expects.

    Attributes:
        found: Definition of the slip ratios, or the curve, that were given.
        expected: Definition that the computation takes: a curve's, for slip ratios given to it.
    """

    def __init__(self, found: str, expected: str) -> None:
        super().__init__(
            f"slip ratio is given as '{found}' but '{expected}' is expected; "
            f"convert it first with model.slip.convert_slip"
        )
        self.found = found
        self.expected = expected


class InsufficientData(ModelError, ValueError):
    """The data cannot determine the requested quantity."""


class FitError(ModelError, RuntimeError):
    """An optimiser or sampler failed; the message contains the evidence."""


class WalkError(ModelError, RuntimeError):
    """A walk diverged, or robot, leg angles or options do not suit the model; the message tells."""
