# SPDX-License-Identifier: MIT
"""The commands: each file parses, calls one stage and prints."""

import os

# Matrices here are a few dozen wide. The threads of a BLAS wait for each other in a busy loop at
# every product of them: a fit took 2.5 times as long, and a pool of processes starves itself. Two
# names, since builds differ; whoever sets them is obeyed. Before NumPy is loaded, or in vain.
for _name in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")
