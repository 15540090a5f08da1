# SPDX-License-Identifier: MIT
"""Every reader of a file that a user brings, with what makes inputs for it and its first check."""
