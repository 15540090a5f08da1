# SPDX-License-Identifier: MIT
"""Array type that every package annotates with."""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.floating[Any]]
