# SPDX-License-Identifier: MIT
"""Which legs touch the ground, by geometry: the source's algorithms of section 3-5."""
