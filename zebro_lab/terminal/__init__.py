# SPDX-License-Identifier: MIT
"""Terminal output of commands: messages, progress bar, errors and exit."""

import os

# One BLAS thread: decision 5. Two names, since builds differ; values set by the user are kept.
# This has an effect only before NumPy is loaded.
for _name in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")
