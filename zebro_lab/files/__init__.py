# SPDX-License-Identifier: MIT
"""Files on disk: opening what users bring within bounds, and writing results whole or not at all."""
