# SPDX-License-Identifier: MIT
"""Measures of a checkout, each a figure and the places behind it."""

import ast
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from benchmarks.code_structure.checkout import PACKAGES, Function, Module, read_modules

LONGEST_FILE = 350
_BRANCHES = (ast.If, ast.For, ast.While, ast.Try, ast.IfExp, ast.Match, ast.BoolOp)
_TIME = {"t", "time", "times", "time_s", "t_s"}
_POSITION = {"position", "positions", "position_xy", "xy"}
_HEADING = {"yaw", "yaws", "heading", "headings"}


@dataclass(frozen=True)
class Checkout:
    """A checkout to be measured.

    Attributes:
        root: Its folder.
        modules: Its modules by dotted name.
    """

    root: Path
    modules: Mapping[str, Module]

    @staticmethod
    def read(root: Path) -> "Checkout":
        """Read the modules in a folder."""
        return Checkout(root, read_modules(root))


@dataclass(frozen=True)
class Measured:
    """A figure, and the places behind it."""

    figure: str
    places: tuple[str, ...] = ()


def _places(places: list[str]) -> Measured:
    return Measured(str(len(places)), tuple(places))


def code_lines(checkout: Checkout) -> Measured:
    """Count lines of code in all packages; the places are the packages."""
    counts = Counter[str]()
    for module in checkout.modules.values():
        counts[module.path.parts[0]] += len(module.code_lines)
    return Measured(f"{counts.total():,}", tuple(f"{name}: {counts[name]:,}" for name in PACKAGES))


def other_code_lines(folder: str) -> Callable[[Checkout], Measured]:
    """Return a measure that counts lines of code of the Python files below a folder."""

    def count(checkout: Checkout) -> Measured:
        counts = Counter[str]()
        for file in sorted((checkout.root / folder).rglob("*.py")):
            path = file.relative_to(checkout.root)
            module = Module(path, file.read_text(encoding="utf-8"))
            counts["/".join(path.parts[: min(2, len(path.parts) - 1)])] += len(module.code_lines)
        places = tuple(f"{name}: {n:,}" for name, n in counts.items())
        return Measured(f"{counts.total():,}", places)

    return count


def document_lines(checkout: Checkout) -> Measured:
    """Count lines of the documents, decision records and changelog; the places are the files."""
    files = [*sorted((checkout.root / "docs").rglob("*.md")), checkout.root / "CHANGELOG.md"]
    sizes = {
        str(file.relative_to(checkout.root)): len(file.read_text(encoding="utf-8").splitlines())
        for file in files
        if file.is_file()
    }
    return Measured(f"{sum(sizes.values()):,}", tuple(f"{n} {name}" for name, n in sizes.items()))


def decision_records(checkout: Checkout) -> Measured:
    """Count the decision records."""
    return _places([file.name for file in sorted(checkout.root.glob("docs/decisions/*.md"))])


def function_lines(checkout: Checkout) -> Measured:
    """Measure functions by their lines, docstring included: median and 90th percentile."""
    return _spread(checkout, lambda module, node: (node.end_lineno or 0) - node.lineno + 1)


def function_code_lines(checkout: Checkout) -> Measured:
    """Measure functions by their lines of code: median and 90th percentile."""

    def count(module: Module, node: Function) -> int:
        return sum(node.lineno <= line <= (node.end_lineno or 0) for line in module.code_lines)

    return _spread(checkout, count)


def _spread(checkout: Checkout, size: Callable[[Module, Function], int]) -> Measured:
    found = sorted(
        (size(module, node), f"{module.path}:{node.lineno} {node.name}")
        for module in checkout.modules.values()
        for node in module.functions()
    )
    sizes = [each for each, _ in found]
    if not sizes:
        return Measured("none")
    ninety = sizes[int(0.9 * len(sizes))]
    longest = tuple(f"{n} {where}" for n, where in reversed(found[-20:]))
    return Measured(f"{median(sizes):g}, {ninety}", longest)


def long_files(checkout: Checkout) -> Measured:
    """Find files of more than 350 lines."""
    sizes = sorted(((m.n_lines, str(m.path)) for m in checkout.modules.values()), reverse=True)
    return _places([f"{n} {path}" for n, path in sizes if n > LONGEST_FILE])


def fullest_folder(checkout: Checkout) -> Measured:
    """Count the modules of the fullest folder, without `__init__.py`."""
    folders = Counter(
        str(m.path.parent) for m in checkout.modules.values() if m.path.name != "__init__.py"
    )
    fullest = folders.most_common(10)
    return Measured(f"{fullest[0][1] if fullest else 0}", tuple(f"{n} {f}" for f, n in fullest))


def flat_modules(checkout: Checkout) -> Measured:
    """Find the modules at the top of `zebro_lab`."""
    paths = sorted(m.path for m in checkout.modules.values())
    return _places([str(p) for p in paths if str(p.parent) == "zebro_lab" and p.stem != "__init__"])


def repeated_classes(checkout: Checkout) -> Measured:
    """Find names of public classes that more than one module defines."""
    homes = defaultdict(list)
    for module, node in _classes(checkout):
        homes[node.name].append(module.name)
    return _places([f"{name}: {', '.join(m)}" for name, m in sorted(homes.items()) if len(m) > 1])


def path_classes(checkout: Checkout) -> Measured:
    """Find classes with fields for time, planar position and heading."""
    found = []
    for module, node in _classes(checkout, private=True):
        fields = {
            each.target.id
            for each in node.body
            if isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Name)
        }
        placed = {"x", "y"} <= fields or fields & _POSITION
        if fields & _TIME and placed and fields & _HEADING:
            found.append(f"{module.name}.{node.name}: {', '.join(sorted(fields))}")
    return _places(found)


def _classes(checkout: Checkout, *, private: bool = False) -> Iterator[tuple[Module, ast.ClassDef]]:
    for module in checkout.modules.values():
        for node in ast.walk(module.tree):
            if isinstance(node, ast.ClassDef) and (private or not node.name.startswith("_")):
                yield module, node


def branching_modules(checkout: Checkout) -> list[Module]:
    """Return the modules in which something is decided."""
    return [
        module
        for module in checkout.modules.values()
        if module.path.name != "__init__.py"
        and any(isinstance(node, _BRANCHES) for node in ast.walk(module.tree))
    ]


def mirror_of(module: Module) -> Path:
    """Return where the test module of a module's name belongs, from the top of the checkout."""
    return "tests" / module.path.parent / f"test_{module.path.name}"


def unmirrored(checkout: Checkout) -> Measured:
    """Find modules with a branch that have no test module of their name."""
    return _places([
        str(module.path)
        for module in branching_modules(checkout)
        if not (checkout.root / mirror_of(module)).is_file()
    ])  # fmt: skip


def public_functions(module: Module) -> Iterator[tuple[str, Function]]:
    """Yield the public functions of a module and of its public classes, by qualified name."""
    for node in module.tree.body:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            if not node.name.startswith("_"):
                yield node.name, node
        elif isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            for each in node.body:
                if isinstance(each, ast.FunctionDef | ast.AsyncFunctionDef) and (
                    not each.name.startswith("_")
                ):
                    yield f"{node.name}.{each.name}", each


def _is_command(module: Module, node: Function) -> bool:
    """Return whether Typer makes options of all parameters of a function."""
    if any("command(" in ast.unparse(each) for each in node.decorator_list):
        return True
    aliases = {
        target.id: ast.unparse(each.value)
        for each in module.tree.body
        if isinstance(each, ast.Assign)
        for target in each.targets
        if isinstance(target, ast.Name)
    }
    written = [ast.unparse(each.annotation) for each in node.args.args if each.annotation]
    options = [text for text in written if "typer." in aliases.get(text, text)]
    return bool(options) and len(options) == len(node.args.args)


def without_args(checkout: Checkout) -> Measured:
    """Find public functions of two or more parameters whose docstring has no section of Args.

    Commands are left out: the help texts of their options describe their parameters.
    """
    found = []
    for module in checkout.modules.values():
        for name, node in public_functions(module):
            given = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
            named = [each for each in given if each.arg not in ("self", "cls")]
            if "Args:" in (ast.get_docstring(node) or "") or _is_command(module, node):
                continue
            if len(named) >= 2:
                found.append(f"{module.path}:{node.lineno} {name}")
    return _places(found)


def inner_imports(checkout: Checkout) -> Measured:
    """Find imports inside functions."""
    found = []
    for module in checkout.modules.values():
        inner = {
            (node.lineno, ast.unparse(node))
            for function in module.functions()
            for node in ast.walk(function)
            if isinstance(node, ast.Import | ast.ImportFrom)
        }
        found += [f"{module.path}:{line} {what}" for line, what in sorted(inner)]
    return _places(found)


MEASURES: dict[str, Callable[[Checkout], Measured]] = {
    "lines of code": code_lines,
    "lines of code of tests": other_code_lines("tests"),
    "lines of code of benchmarks": other_code_lines("benchmarks"),
    "lines of documents and changelog": document_lines,
    "decision records": decision_records,
    "lines of a function: median, 90 %": function_lines,
    "the same without docstrings, comments, blanks": function_code_lines,
    f"files over {LONGEST_FILE} lines": long_files,
    "modules in the fullest folder": fullest_folder,
    "modules at the top of zebro_lab": flat_modules,
    "names of public classes defined more than once": repeated_classes,
    "classes with time, position and heading": path_classes,
    "modules with a branch and no test module of their name": unmirrored,
    "public functions of two or more parameters without Args": without_args,
    "imports inside functions": inner_imports,
}
