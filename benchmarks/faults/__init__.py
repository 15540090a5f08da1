# SPDX-License-Identifier: MIT
"""Behaviour under damaged input, killed processes, frozen sensors and stops."""
