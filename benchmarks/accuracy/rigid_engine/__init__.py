# SPDX-License-Identifier: MIT
"""A rigid-body engine that shares no code with our walking model, to compare walks with."""
