# SPDX-License-Identifier: MIT
"""Links: bytes and frames in, resynchronised, counted and time-stamped."""
