# SPDX-License-Identifier: MIT
"""What a command says to the person at the terminal, and how it ends."""

import os

# One BLAS thread: decision 13. Two names, since builds differ; whoever sets them is obeyed. Before
# NumPy is loaded, or in vain.
for _name in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")
