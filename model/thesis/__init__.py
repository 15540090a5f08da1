# SPDX-License-Identifier: MIT
"""The thesis's hybrid dynamic model of tripod walking, as printed, with its faults."""
