# SPDX-License-Identifier: MIT
"""The documentation's own list is whole, and no link in it leads nowhere."""

import re
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
PAGES = sorted([*DOCS.glob("*.md"), *DOCS.glob("decisions/*.md")])
README = DOCS / "README.md"


def links(page: Path) -> list[str]:
    return re.findall(r"\]\(([^)#\s]+)[^)\s]*\)", page.read_text(encoding="utf-8"))


def test_every_page_and_decision_is_listed_once_with_a_line_of_its_own():
    listed = [link for link in links(README) if link.endswith(".md") and "../" not in link]
    expected = [str(page.relative_to(DOCS)) for page in PAGES if page != README]
    assert sorted(listed) == sorted(expected)
    lines = [line for line in README.read_text(encoding="utf-8").splitlines() if ".md)" in line]
    for name in expected:
        [line] = [line for line in lines if f"({name})" in line]
        assert len(line.replace(name, "")) > 20


def test_a_decision_is_listed_by_its_number():
    lines = README.read_text(encoding="utf-8").splitlines()
    for page in DOCS.glob("decisions/*.md"):
        [line] = [line for line in lines if f"({page.relative_to(DOCS)})" in line]
        assert line.startswith(f"{int(page.name[:4])}. ")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_no_relative_link_leads_nowhere(page):
    for link in links(page):
        if "://" not in link:
            assert (page.parent / link).exists(), link
