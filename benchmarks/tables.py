# SPDX-License-Identifier: MIT
"""Tables in Markdown, as the documentation quotes them."""


def print_table(*rows: tuple[str, ...]) -> None:
    """Print a table in Markdown: a head, then rows; columns but the first are right-aligned."""
    head, *body = rows
    rule = ("---", *("---:" for _ in head[1:]))
    print("\n".join(f"| {' | '.join(row)} |" for row in (head, rule, *body)), end="\n\n")
