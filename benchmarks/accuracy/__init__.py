# SPDX-License-Identifier: MIT
"""Errors against known truth: of models, of fits, of predicted walks."""
