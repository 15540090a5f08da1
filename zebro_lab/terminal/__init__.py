# SPDX-License-Identifier: MIT
"""What a command says to the person at the terminal."""
