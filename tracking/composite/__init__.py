# SPDX-License-Identifier: MIT
"""Find and order the exposures of a composite photograph, one picture of a whole walk."""

from tracking.composite.by_look import find_exposures_like
from tracking.composite.exposure import Exposure
from tracking.composite.order import order_exposures
from tracking.composite.reading import Merged
from tracking.composite.search import find_exposures

__all__ = ["Exposure", "Merged", "find_exposures", "find_exposures_like", "order_exposures"]
