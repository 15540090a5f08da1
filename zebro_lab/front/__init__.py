# SPDX-License-Identifier: MIT
"""The functions that a notebook or script needs; `import zebro_lab as zl` offers them.

Paths may be strings. Functions that write a folder do so atomically, as the commands do, and raise
if the folder is the result of another command. Without `out` no files are kept.
"""
