# SPDX-License-Identifier: MIT
"""Put the finished folders of every stage onto one page."""
