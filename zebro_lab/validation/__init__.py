# SPDX-License-Identifier: MIT
"""Judge predicted paths against tracked ones; the validation folder."""
