# SPDX-License-Identifier: MIT
"""The commands of the documentation, run for real, and what two checkouts make of them."""
