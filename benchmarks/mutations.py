# SPDX-License-Identifier: MIT
"""Change one comparison, sign, constant or index of a function, and see whether tests notice.

python -m benchmarks.mutations BEFORE [AFTER] [--n 60] [--seed 1] [--timeout S]

BEFORE and AFTER are folders or commits; without AFTER it is BEFORE. Mutations are drawn by seed
from the functions that both have, and tried in BEFORE until `--n` of them are noticed there, by the
test module of the changed module's name or those of its folder. Each of these is then tried in
AFTER, in the end by all tests that are not long; a mutation that none notices survives. Only tests
that pass without a mutation count: this environment needs what BEFORE and AFTER depend on.
"""

import argparse
import ast
import compileall
import copy
import os
import shutil
import subprocess
import sys
import textwrap
from collections import defaultdict
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.code_structure.checkout import Function, Module, docstring_lines, open_checkout
from benchmarks.code_structure.measures import Checkout, mirror_of
from benchmarks.tables import print_table

HERE = Path(__file__).parents[1]
LEFT_OUT = shutil.ignore_patterns(
    ".git", ".venv*", "__pycache__", ".*_cache", ".hypothesis", "demo", "*.nbi", "*.nbc"
)
PASSED, NO_TESTS = 0, 5  # pytest's exit codes
ALL = Path("tests")
UNCHANGED = "unchanged"
KINDS = ("comparison", "sign", "constant", "index")
COMPARISONS: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
SIGNS: dict[type, type] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.USub: ast.UAdd, ast.UAdd: ast.USub,
}  # fmt: skip


@dataclass(frozen=True)
class Mutation:
    """A change of one node of a function.

    Attributes:
        kind: One of `KINDS`.
        function: The function's name.
        same: The function's syntax tree as text, by which it is found in another checkout.
        node: Index of the node in `body_nodes` of the function.
    """

    kind: str
    function: str
    same: str
    node: int


def kind_of(node: ast.AST) -> str | None:
    """Return the kind of mutation that a node admits, None for none."""
    if isinstance(node, ast.Compare) and type(node.ops[0]) in COMPARISONS:
        return "comparison"
    if isinstance(node, ast.BinOp | ast.UnaryOp) and type(node.op) in SIGNS:
        return "sign"
    if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant | ast.UnaryOp):
        inner = node.slice.operand if isinstance(node.slice, ast.UnaryOp) else node.slice
        return "index" if isinstance(inner, ast.Constant) and _is_number(inner) else None
    return "constant" if isinstance(node, ast.Constant) and _is_number(node) else None


def _is_number(node: ast.Constant) -> bool:
    return isinstance(node.value, int | float) and not isinstance(node.value, bool)


def mutated(function: Function, mutation: Mutation) -> Function:
    """Return a copy of a function with one node changed."""
    changed = copy.deepcopy(function)
    node = body_nodes(changed)[mutation.node]
    if isinstance(node, ast.Compare):
        node.ops[0] = COMPARISONS[type(node.ops[0])]()
    elif isinstance(node, ast.BinOp | ast.UnaryOp):
        node.op = SIGNS[type(node.op)]()
    elif isinstance(node, ast.Subscript):
        node.slice = ast.BinOp(node.slice, ast.Add(), ast.Constant(1))
    elif isinstance(node, ast.Constant):
        assert isinstance(node.value, int | float)
        node.value = 1.5 * node.value if isinstance(node.value, float) else node.value + 1
    return ast.fix_missing_locations(changed)


def body_nodes(function: Function) -> list[ast.AST]:
    """Return the nodes of a function's body without docstring, alike in all with one tree."""
    body = function.body[1:] if docstring_lines(function.body[0]) else function.body
    return [node for each in body for node in ast.walk(each)]


def tree_of(function: Function) -> str:
    """Return the syntax tree of a function as text, without docstring and annotations."""
    bare = copy.deepcopy(function)
    if docstring_lines(bare.body[0]):
        bare.body = bare.body[1:]
    bare.returns = None
    for each in ast.walk(bare.args):
        if isinstance(each, ast.arg):
            each.annotation = None
    return ast.dump(bare)


def functions_by_tree(checkout: Checkout) -> dict[str, tuple[Module, Function]]:
    """Return the functions of a checkout by their tree; those that stand twice are left out."""
    found = defaultdict(list)
    for module in checkout.modules.values():
        for function in module.functions():
            found[tree_of(function)].append((module, function))
    return {tree: homes[0] for tree, homes in found.items() if len(homes) == 1}


def sites(function: Function) -> Iterator[Mutation]:
    """Yield every mutation that the body of a function admits."""
    tree = tree_of(function)
    for number, node in enumerate(body_nodes(function)):
        kind = kind_of(node)
        if kind is not None:
            yield Mutation(kind, function.name, tree, number)


def drawn(before: Checkout, after: Checkout, rng: np.random.Generator) -> Iterator[Mutation]:
    """Yield mutations of functions that both checkouts have, all kinds alike, in random order."""
    ours, theirs = functions_by_tree(before), functions_by_tree(after)
    by_kind: dict[str, list[Mutation]] = {kind: [] for kind in KINDS}
    for tree, (_, function) in sorted(ours.items()):
        if tree in theirs:
            for each in sites(function):
                by_kind[each.kind].append(each)
    orders = {kind: rng.permutation(len(found)) for kind, found in by_kind.items()}
    for turn in range(max(map(len, by_kind.values()))):
        for kind, found in by_kind.items():
            if turn < len(found):
                yield found[orders[kind][turn]]


def text_with(module: Module, old: Function, new: Function) -> str:
    """Return the text of a module with one function replaced."""
    first = min([old.lineno, *(each.lineno for each in old.decorator_list)])
    lines = module.text.splitlines()
    body = textwrap.indent(ast.unparse(new), " " * old.col_offset).splitlines()
    return "\n".join([*lines[: first - 1], *body, *lines[old.end_lineno :], ""])


class Copy:
    """A copy of a checkout in which mutations are tried.

    Args:
        root: Folder of the copy.
        timeout: Longest run of a test module [s]; ten times that for all tests.
    """

    def __init__(self, root: Path, *, timeout: float) -> None:
        self.checkout = Checkout.read(root)
        self._root = root
        self._timeout = timeout
        self._functions = functions_by_tree(self.checkout)
        self._sound: dict[Path, bool] = {}

    def place(self, mutation: Mutation) -> str:
        """Return where the function of a mutation is."""
        return str(self._functions[mutation.same][0].path)

    def noticed_by(self, mutation: Mutation, *, by_all: bool) -> str:
        """Apply a mutation, run tests until one fails; return which, "" where it survives.

        Args:
            mutation: What to change.
            by_all: Whether all tests run in the end, after those of the module and of its folder.
        """
        module, function = self._functions[mutation.same]
        text = text_with(module, function, mutated(function, mutation))
        # numba keeps what it compiled when a function that it calls changes in another file.
        loops = module.name if "compiled" in module.text else UNCHANGED
        file, mirror = self._root / module.path, mirror_of(module)
        for tests in (mirror, mirror.parent, *([ALL] if by_all else [])):
            if not self._pass_unchanged(tests):
                continue
            file.write_text(text, encoding="utf-8")
            try:
                if self._fail(tests, loops=loops):
                    return str(tests)
            finally:
                file.write_text(module.text, encoding="utf-8")
        return ""

    def _pass_unchanged(self, tests: Path) -> bool:
        """Return whether tests exist and pass without a mutation; each is run once for that."""
        if tests not in self._sound:
            exist = (self._root / tests).exists()
            self._sound[tests] = exist and not self._fail(tests, loops=UNCHANGED)
        return self._sound[tests]

    def _fail(self, tests: Path, *, loops: str) -> bool:
        """Run tests that are not long; return whether any fails, or they take too long.

        Args:
            tests: Test module, a folder for the modules in it, or `ALL`.
            loops: Name for a folder of compiled loops.
        """
        whole, place = tests == ALL, self._root / tests
        files = sorted(place.glob("test_*.py")) if place.is_dir() and not whole else [place]
        if not files:
            return False
        command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider",
                   "-m", "not long", *(["-n", "2"] if whole else []), *map(str, files)]  # fmt: skip
        path = os.pathsep.join([str(self._root), os.environ.get("PYTHONPATH", "")])
        environment = os.environ | {
            "PYTHONPATH": path.rstrip(os.pathsep), "PYTHONDONTWRITEBYTECODE": "1",
            "ZEBRO_LAB_SHARED": os.environ.get("ZEBRO_LAB_SHARED", str(HERE.parent / "shared")),
            "NUMBA_CACHE_DIR": str(self._root / f".numba-{loops}"),
        }  # fmt: skip
        try:
            ended = subprocess.run(
                command, cwd=self._root, env=environment, capture_output=True,
                timeout=self._timeout * (10 if whole else 1),
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return True
        return ended.returncode not in (PASSED, NO_TESTS)


def main(arguments: list[str]) -> int:
    """Print a row a mutation; return 1 where one that BEFORE notices survives in AFTER."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("before")
    parser.add_argument("after", nargs="?")
    parser.add_argument("--n", type=int, default=60, help="mutations that BEFORE notices")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--timeout", type=float, default=300.0, help="s for one test module")
    asked = parser.parse_args(arguments)
    rows = []
    with ExitStack() as stack:
        copies = []
        for name in [each for each in (asked.before, asked.after) if each]:
            root = Path(stack.enter_context(TemporaryDirectory(prefix="mutated-"))) / "checkout"
            shutil.copytree(stack.enter_context(open_checkout(name)), root, ignore=LEFT_OUT)
            compileall.compile_dir(root, quiet=2)
            copies.append(Copy(root, timeout=asked.timeout))
        before, after = copies[0], copies[-1]
        for each in drawn(before.checkout, after.checkout, np.random.default_rng(asked.seed)):
            if not before.noticed_by(each, by_all=False):
                continue
            rows.append((each.kind, after.place(each), each.function,
                         after.noticed_by(each, by_all=True) or "SURVIVED"))  # fmt: skip
            print(*rows[-1], sep="  ", file=sys.stderr, flush=True)
            if len(rows) == asked.n:
                break
    survived = sum(row[-1] == "SURVIVED" for row in rows)
    print(f"{len(rows) - survived} of {len(rows)} mutations were noticed\n")
    print_table(("mutation", "module", "function", "noticed by"), *rows)
    return int(survived > 0)


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
