# SPDX-License-Identifier: MIT
"""Physics and inference: arrays in, arrays out; no file, clock, port or plot."""
