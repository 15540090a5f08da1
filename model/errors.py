# SPDX-License-Identifier: MIT
"""Exceptions of the package `model`."""


class ModelError(Exception):
    """Root of every error that `model` raises on purpose."""


class DomainError(ModelError, ValueError):
    """A value, shape or name lies outside the domain of the function that received it."""


class DefinitionMismatch(ModelError, ValueError):
    """Slip ratios of two definitions were used in one computation.

    Attributes:
        found: Definition of the slip ratio that was given.
        expected: Definition that the receiver's parameters were fitted with.
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
    """A walk could not be computed to its end; the message states the time and the state."""
