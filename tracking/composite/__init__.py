# SPDX-License-Identifier: MIT
"""Find and order the exposures that were pasted into one picture of a whole walk."""

from tracking.composite.known import Exposure
from tracking.composite.order import order_exposures
from tracking.composite.search import find_exposures, find_exposures_like

__all__ = ["Exposure", "find_exposures", "find_exposures_like", "order_exposures"]
