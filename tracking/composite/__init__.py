# SPDX-License-Identifier: MIT
"""One picture with all exposures of a walk in it: find each, and put them in order."""

from tracking.composite.order import order_exposures
from tracking.composite.search import Exposure, find_exposures

__all__ = ["Exposure", "find_exposures", "order_exposures"]
