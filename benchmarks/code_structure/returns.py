# SPDX-License-Identifier: MIT
"""Rooms that the stage functions call, in the order of their source.

What counts is a function, or a method called by the name of its class, that another module of the
four packages defines; building a value does not, and a method of a value cannot be told from the
syntax. Functions of the stage's own module are followed, or those of its whole room, which is never
left. The room of `zebro_lab.X.Y` is `X`, that of the other packages the package. A room that is
called again after another one was called is a return.
"""

import ast
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby

from benchmarks.code_structure.checkout import PACKAGES, Function, Module
from benchmarks.code_structure.deleted import public_names
from benchmarks.code_structure.measures import Checkout

STAGES = ("calibrate", "track", "calibrate_walks", "predict", "validate", "record")
NOT_COUNTED = ("files", "terminal", "plots")


@dataclass(frozen=True)
class Call:
    """A call of a function of another module.

    Attributes:
        module: Dotted name of the module that defines it.
        function: Its name.
    """

    module: str
    function: str


def stage_module(checkout: Checkout, stage: str) -> Module:
    """Find the module of a stage function.

    Raises:
        SystemExit: There is none, or more than one.
    """
    found = [
        module
        for module in checkout.modules.values()
        if ("stage" in module.path.stem or "stages" in module.path.parts)
        and stage in functions_of(module)
    ]
    if len(found) != 1:
        raise SystemExit(f"{len(found)} stage modules define {stage}() under {checkout.root}")
    return found[0]


def functions_of(module: Module) -> dict[str, Function]:
    """Return the functions at the top of a module by name."""
    return {
        node.name: node
        for node in module.tree.body
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    }


class Rooms:
    """Says in which room a function is.

    Args:
        as_in: A checkout whose rooms are taken where it defines the same public name once, so that
            a checkout without rooms can be compared; None where every module has its own room.
    """

    def __init__(self, as_in: Checkout | None = None) -> None:
        self._as_in = as_in
        self._homes = {} if as_in is None else public_names(as_in)

    def of_stage(self, checkout: Checkout, stage: str) -> str:
        """Return the room of a stage function."""
        return room_of(stage_module(self._as_in or checkout, stage).name)

    def of(self, call: Call) -> str:
        """Return the room of a function that is called."""
        homes = self._homes.get(call.function.split(".")[0], [])
        return room_of(homes[0] if len(homes) == 1 else call.module)


def room_of(module: str) -> str:
    """Return a module's room; of a flat module of `zebro_lab` it is its own name."""
    first, *rest = module.split(".")
    return rest[0] if first == "zebro_lab" and rest else first


def calls_of(
    checkout: Checkout, stage: str, *, rooms: Rooms, whole_room: bool = False
) -> list[Call]:
    """List what a stage function calls in other modules, as the source is evaluated.

    Args:
        checkout: Where.
        stage: Name of the function.
        rooms: Which function is in which room.
        whole_room: Whether the functions of the stage's whole room are followed and left out, and
            not those of its own module alone.
    """
    module = stage_module(checkout, stage)
    home = rooms.of_stage(checkout, stage)
    found: list[Call] = []
    entered: list[tuple[str, str]] = []

    def follow(module: Module, name: str) -> None:
        if (module.name, name) in entered:
            return
        entered.append((module.name, name))
        own, names = functions_of(module), imported_names(module)
        for called in called_names(own[name]):
            if called in own:
                follow(module, called)
            elif (call := _resolve(checkout, names, called)) is not None:
                target = checkout.modules[call.module]
                if whole_room and rooms.of(call) == home and call.function in functions_of(target):
                    follow(target, call.function)
                else:
                    found.append(call)
        entered.pop()

    follow(module, stage)
    return found


def imported_names(module: Module) -> dict[str, tuple[str, str]]:
    """Return the module and name behind each name that is imported, inside functions too."""
    found = {}
    for node in ast.walk(module.tree):
        if isinstance(node, ast.ImportFrom) and node.module and not node.level:
            for each in node.names:
                found[each.asname or each.name] = (node.module, each.name)
        elif isinstance(node, ast.Import):
            for each in node.names:
                found[each.asname or each.name] = (each.name, "")
    return {name: home for name, home in found.items() if home[0].split(".")[0] in PACKAGES}


def called_names(node: ast.AST) -> Iterator[str]:
    """Yield dotted names that are called, arguments before the function they are given to."""
    if isinstance(node, ast.Call):
        name = _dotted(node.func)
        if name is None:
            yield from called_names(node.func)
        for each in (*node.args, *node.keywords):
            yield from called_names(each)
        if name == "partial" and node.args:  # it is called later, of which the source tells nothing
            name = _dotted(node.args[0])
        if name is not None:
            yield name
        return
    for each in ast.iter_child_nodes(node):
        yield from called_names(each)


def _dotted(node: ast.AST) -> str | None:
    parts: list[str] = []
    while isinstance(node, ast.Attribute):
        parts.append(node.attr)
        node = node.value
    return ".".join([node.id, *reversed(parts)]) if isinstance(node, ast.Name) else None


def _resolve(checkout: Checkout, names: Mapping[str, tuple[str, str]], called: str) -> Call | None:
    first, *rest = called.split(".")
    if first not in names:
        return None
    module, name = names[first]
    if f"{module}.{name}" in checkout.modules:  # a module was imported
        module, name, rest = f"{module}.{name}", *(rest[:1] or [""]), rest[1:]
    home = _home(checkout, module, name)
    if home is None:
        return None
    defined = next(n for n in home.tree.body if getattr(n, "name", None) == name)
    if isinstance(defined, ast.ClassDef) and not rest:
        return None  # a value is built
    return Call(home.name, ".".join([name, *rest]))


def _home(checkout: Checkout, module: str, name: str) -> Module | None:
    """Find the module that defines a name, through packages that hand it on."""
    while module in checkout.modules:
        found = checkout.modules[module]
        if any(getattr(node, "name", None) == name for node in found.tree.body):
            return found
        onward = imported_names(found).get(name)
        if onward is None or not onward[1]:
            return None
        module, name = onward
    return None


def count_returns(entered: list[str]) -> int:
    """Count rooms that are entered again after another one was."""
    return len(entered) - len(set(entered))


def print_returns(checkout: Checkout, *, rooms_as_in: Checkout | None = None) -> None:
    """Print returns and rooms of every stage.

    Args:
        checkout: What is measured.
        rooms_as_in: A checkout whose rooms are taken where it defines the same name once.
    """
    rooms = Rooms(rooms_as_in)
    print("| stage | followed | calls | returns | rooms in order |\n|---|---|---:|---:|---|")
    for stage in STAGES:
        home = rooms.of_stage(checkout, stage)
        for whole_room in (False, True):
            calls = calls_of(checkout, stage, rooms=rooms, whole_room=whole_room)
            visited = [r for r in map(rooms.of, calls) if r not in (*NOT_COUNTED, home)]
            entered = [room for room, _ in groupby(visited)]
            print(
                f"| {stage} | {'its room' if whole_room else 'its module'} | {len(calls)} | "
                f"{count_returns(entered)} | {' '.join(entered)} |"
            )
