# SPDX-License-Identifier: MIT
"""Compare calibrations, curves or runs: differences with intervals."""
