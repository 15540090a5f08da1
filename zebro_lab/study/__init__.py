# SPDX-License-Identifier: MIT
"""Studies of the slip fit on simulated data: `study sbc` and `study coverage`."""
