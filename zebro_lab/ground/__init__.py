# SPDX-License-Identifier: MIT
"""The ground of a walk: `ground.toml` and its maps of heights."""
