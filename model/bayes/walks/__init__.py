# SPDX-License-Identifier: MIT
"""What tracked walks say of a robot's legs and floor: prior, misfit, posterior, fit."""
