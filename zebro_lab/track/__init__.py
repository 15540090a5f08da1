# SPDX-License-Identifier: MIT
"""Photo tracking: camera and floor files, annotations, and the track folder."""
