# SPDX-License-Identifier: MIT
"""Walking models: from leg angles to a path."""
