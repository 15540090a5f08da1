# SPDX-License-Identifier: MIT
"""Measurements that take too long, or too quiet a machine, for tests; each says how it is run."""
