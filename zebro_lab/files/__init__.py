# SPDX-License-Identifier: MIT
"""Files on disk: opening what users bring within bounds, writing results whole or not at all."""
