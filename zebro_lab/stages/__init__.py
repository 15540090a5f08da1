# SPDX-License-Identifier: MIT
"""The stages: each reads finished files and writes one new folder."""
