# SPDX-License-Identifier: MIT
"""Names of the walking models in which legs slip, for those that must not import the models."""

from typing import Final

SLIPPING: Final = frozenset({"dynamics", "thesis"})
"""Keys of `model.walk_models.MODELS` whose models need a slip law."""
