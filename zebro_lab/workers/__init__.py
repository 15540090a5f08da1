# SPDX-License-Identifier: MIT
"""Where independent tasks are computed: this process, this machine's cores, or a Dask cluster."""
