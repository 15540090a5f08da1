# SPDX-License-Identifier: MIT
"""Draws from a density: Gaussians at its modes, weighted draws, ensembles of walkers."""
