# SPDX-License-Identifier: MIT
"""Measurements that take too long, or too quiet a machine, for tests; each says how it is run."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1] / "tests"))  # for what they share with tests: support
