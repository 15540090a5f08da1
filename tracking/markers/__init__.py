# SPDX-License-Identifier: MIT
"""Square markers: what they are and where a picture shows them."""
