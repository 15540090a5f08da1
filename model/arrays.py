# SPDX-License-Identifier: MIT
"""Array types that every package annotates with."""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.floating[Any]]
Numbers: TypeAlias = float | Array
"""Of functions that take a number or arrays that broadcast, and are compiled for numbers too."""
