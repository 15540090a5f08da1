# SPDX-License-Identifier: MIT
"""reach: two ways to a place, stop-turn-walk against a curve, walked by the same model."""
