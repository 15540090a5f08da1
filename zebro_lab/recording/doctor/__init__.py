# SPDX-License-Identifier: MIT
"""Diagnose this machine: what zebro-lab needs of it, and what is missing for what."""
