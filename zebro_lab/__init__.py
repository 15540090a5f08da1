# SPDX-License-Identifier: MIT
"""The lab bench: files, order and people."""
