# SPDX-License-Identifier: MIT
"""Break each module and see whether the test module of its name notices.

python -m benchmarks.mirrored_tests [CHECKOUT] [--only PATTERN] [--timeout S]

In a copy of the checkout the largest function or method of every module with a branch is replaced
by one that returns its first argument (after self or cls; None without one; a generator yields it).
The test module of the module's name, run alone, must then fail. Survivors are those that pass; a
test module that fails before anything was replaced says nothing, and is told apart.
"""

import argparse
import ast
import fnmatch
import os
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.code_structure.checkout import Function, Module, docstring_lines
from benchmarks.code_structure.measures import Checkout, branching_modules, mirror_of
from benchmarks.tables import print_table

HERE = Path(__file__).parents[1]
LEFT_OUT = shutil.ignore_patterns(
    ".git", ".venv*", "__pycache__", ".*_cache", ".hypothesis", "demo", "*.nbi", "*.nbc"
)
PASSED, FAILED, NO_TESTS = 0, 1, 5  # pytest's exit codes


def largest_function(module: Module) -> tuple[Function, bool] | None:
    """Return the function or method with the most lines of code, and whether it is a method.

    Functions that do nothing, whose body is a docstring or `...`, do not count.
    """
    found: list[tuple[int, Function, bool]] = []
    for parent in ast.walk(module.tree):
        if isinstance(parent, ast.Module | ast.ClassDef):
            for node in parent.body:
                if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and not _is_empty(node):
                    lines = range(node.lineno, (node.end_lineno or node.lineno) + 1)
                    size = len(module.code_lines.intersection(lines))
                    found.append((size, node, isinstance(parent, ast.ClassDef)))
    if not found:
        return None
    _, node, is_method = max(found, key=lambda each: each[0])
    return node, is_method


def _is_empty(node: Function) -> bool:
    return all(
        isinstance(each, ast.Expr) and isinstance(each.value, ast.Constant) for each in node.body
    )


def broken(module: Module) -> str | None:
    """Return the text of a module whose largest function does nothing; None without a function."""
    largest = largest_function(module)
    if largest is None:
        return None
    node, is_method = largest
    lines = module.text.splitlines()
    doc = docstring_lines(node.body[0])
    first = (doc.stop if doc else node.body[0].lineno) - 1
    head, indent = lines[:first], " " * node.body[0].col_offset
    if not doc and node.body[0].lineno == node.lineno:  # body on the line of its def
        head.append(lines[node.lineno - 1][: node.body[0].col_offset])
        indent = " " * (node.col_offset + 4)
    body = f"{indent}{_statement(node, is_method=is_method)}"
    return "\n".join([*head, body, *lines[node.end_lineno :], ""])


def _statement(node: Function, *, is_method: bool) -> str:
    given = node.args
    static = any(isinstance(d, ast.Name) and d.id == "staticmethod" for d in node.decorator_list)
    names = [each.arg for each in (*given.posonlyargs, *given.args)]
    names = names[1:] if is_method and not static else names
    names += [each.arg for each in (given.vararg, *given.kwonlyargs) if each is not None]
    first = names[0] if names else "None"
    return f"yield {first}" if _yields(node) else f"return {first}"


def _yields(node: ast.AST) -> bool:
    nested = ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
    return any(
        isinstance(child, ast.Yield | ast.YieldFrom)
        or (not isinstance(child, nested) and _yields(child))
        for child in ast.iter_child_nodes(node)
    )


def compiles(module: Module) -> bool:
    """Tell whether numba compiles a function of a module."""
    return "model.compiled import" in module.text or "numba import" in module.text


def run_tests(root: Path, test: Path, *, timeout: float, loops: str) -> int:
    """Run one test module in a copy; return pytest's exit code, 1 where it takes too long.

    Args:
        root: The copy.
        test: The test module, from the top of the copy.
        timeout: Longest run [s].
        loops: Folder of the copy that keeps loops compiled by numba.
    """
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider",
               "-m", "not long", str(test)]  # fmt: skip
    path = os.pathsep.join([str(root), os.environ.get("PYTHONPATH", "")]).rstrip(os.pathsep)
    shared = os.environ.get("ZEBRO_LAB_SHARED", str(HERE.parent / "shared"))
    environment = os.environ | {
        "PYTHONPATH": path, "PYTHONDONTWRITEBYTECODE": "1", "ZEBRO_LAB_SHARED": shared,
        "NUMBA_CACHE_DIR": str(root / loops),
    }  # fmt: skip
    try:
        return subprocess.run(
            command, cwd=root, env=environment, capture_output=True, timeout=timeout
        ).returncode
    except subprocess.TimeoutExpired:
        return FAILED


def judge(root: Path, module: Module, *, timeout: float) -> tuple[str, str]:
    """Return what was replaced and what came of it, or why there is no saying."""
    text, largest = broken(module), largest_function(module)
    if text is None or largest is None:
        return "", "no function"
    name, test, file = largest[0].name, mirror_of(module), root / module.path
    file.write_text(text, encoding="utf-8")
    try:
        # Numba keeps what it compiled when a function that it calls changes in another file.
        loops = f".numba-{module.name}" if compiles(module) else ".numba"
        code = run_tests(root, test, timeout=timeout, loops=loops)
    finally:
        file.write_text(module.text, encoding="utf-8")
    if code == NO_TESTS:
        return name, "no test ran"
    if code == PASSED:
        return name, "SURVIVED"
    whole = run_tests(root, test, timeout=timeout, loops=".numba")
    return name, "noticed" if whole == PASSED else "fails anyway"


def main(arguments: list[str]) -> int:
    """Print a row a module that is tried; return 1 where one survived."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("checkout", nargs="?", type=Path, default=HERE)
    parser.add_argument("--only", default="*", metavar="PATTERN", help="such as 'zebro_lab/walk/*'")
    parser.add_argument("--timeout", type=float, default=300.0, help="s for one test module")
    asked = parser.parse_args(arguments)
    found: list[tuple[str, str, str]] = []
    with TemporaryDirectory(prefix="mirrored-") as folder:
        root = Path(folder) / "checkout"
        shutil.copytree(asked.checkout, root, symlinks=True, ignore=LEFT_OUT)
        checkout = Checkout.read(root)
        for module in branching_modules(checkout):
            if (
                fnmatch.fnmatch(str(module.path), asked.only)
                and (root / mirror_of(module)).exists()
            ):
                found.append((str(module.path), *judge(root, module, timeout=asked.timeout)))
                print(f"{found[-1][2]:>12}  {module.path}  {found[-1][1]}", file=sys.stderr)
    bad = [row for row in found if row[2] != "noticed"]
    print(f"{len(found) - len(bad)} of {len(found)} replaced functions were noticed\n")
    print_table(("module", "replaced", "test module"), *bad)
    return int(any(row[2] == "SURVIVED" for row in bad))


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
