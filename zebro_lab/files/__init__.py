# SPDX-License-Identifier: MIT
"""Files on disk: bounded opening of what users bring; results written whole or not at all."""
