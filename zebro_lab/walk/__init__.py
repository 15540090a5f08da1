# SPDX-License-Identifier: MIT
"""Walk a gait or measured leg angles by a model; the walk folder and its band."""
