# SPDX-License-Identifier: MIT
"""Compute errors of predicted paths against tracked ones; the validation folder."""
