# SPDX-License-Identifier: MIT
"""Plain least-squares fit of a slip law, beside the posterior."""
