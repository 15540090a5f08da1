# SPDX-License-Identifier: MIT
"""Compare two calibrations or two runs: differences with intervals."""
