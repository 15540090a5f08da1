# SPDX-License-Identifier: MIT
"""Compare two calibrations or two runs: what differs, and how surely."""
