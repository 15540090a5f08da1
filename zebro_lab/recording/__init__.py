# SPDX-License-Identifier: MIT
"""What a recording is made of: its threads, its folder on the disk, its display."""
