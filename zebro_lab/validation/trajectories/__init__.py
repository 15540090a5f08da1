# SPDX-License-Identifier: MIT
"""Validate an estimated trajectory against a reference, both files of other programs."""
