# SPDX-License-Identifier: MIT
"""Files on disk: read user files with size limits; write results atomically."""
