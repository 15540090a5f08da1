# SPDX-License-Identifier: MIT
"""Bayesian inference of leg offsets and floor from tracked walks: prior, misfit, posterior, fit."""
