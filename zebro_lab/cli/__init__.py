# SPDX-License-Identifier: MIT
"""The commands: each file parses, calls one stage and prints."""
