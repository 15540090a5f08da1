# SPDX-License-Identifier: MIT
"""What a sampler drew, and in what time."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Sampled:
    """What a sampler drew in a time.

    Attributes:
        effective: Effective sample size of the worst parameter [-].
        seconds: Time that it took [s].
        quality: R-hat, or what else tells how good the draws are, as text.
    """

    effective: float
    seconds: float
    quality: str

    @property
    def rate(self) -> float:
        """Effective samples a second [1/s]."""
        return self.effective / self.seconds

    def cells(self, name: str) -> tuple[str, ...]:
        """Return the cells of a table's row: the name given, then effective samples and times."""
        size, time, rate = f"{self.effective:,.0f}", f"{self.seconds:.0f}", f"{self.rate:,.2f}"
        return name, size, time, rate, self.quality
