# SPDX-License-Identifier: MIT
"""Public functions and classes that one checkout has and another lacks."""

import ast
from collections import Counter, defaultdict

from benchmarks.code_structure.measures import Checkout


def public_names(checkout: Checkout) -> dict[str, list[str]]:
    """Return the modules that define each public function or class, by its bare name."""
    found = defaultdict(list)
    for module in checkout.modules.values():
        for node in module.tree.body:
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef) and (
                not node.name.startswith("_")
            ):
                found[node.name].append(module.name)
    return found


def deleted(before: Checkout, after: Checkout) -> list[str]:
    """Return the qualified names that are gone.

    A name that as many modules define as before has moved, and is not gone.
    """
    had, has = public_names(before), public_names(after)
    gone = []
    for name, homes in had.items():
        left = Counter(homes) - Counter(has.get(name, []))
        moved_in = (Counter(has.get(name, [])) - Counter(homes)).total()
        gone += sorted(f"{home}.{name}" for home in left.elements())[moved_in:]
    return sorted(gone)
