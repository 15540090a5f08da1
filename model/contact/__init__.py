# SPDX-License-Identifier: MIT
"""Which legs touch the ground, by geometry: the thesis's algorithms of section 3-5."""
