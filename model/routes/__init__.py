# SPDX-License-Identifier: MIT
"""Programs of several gaits, and ways to a goal."""
