# SPDX-License-Identifier: MIT
"""Bayesian inference of the slip law from rig samples."""
