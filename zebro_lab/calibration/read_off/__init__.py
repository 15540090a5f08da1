# SPDX-License-Identifier: MIT
"""Read the Magic Formula's coefficients off slip curves, as the thesis does."""
