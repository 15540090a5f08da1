# SPDX-License-Identifier: MIT
"""How far a predicted path lies from a tracked one, and whether its band is honest."""
