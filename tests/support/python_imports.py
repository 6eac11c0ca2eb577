"""The imports among the modules of a Python package, those inside functions included."""

import ast
from collections.abc import Iterator
from pathlib import Path


def modules(package: Path) -> dict[str, Path]:
    """Return the modules of a package by name."""
    found = {}
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package.parent).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def import_statements(node: ast.AST) -> Iterator[ast.Import | ast.ImportFrom]:
    """Yield the import statements below a node, at any depth, but for those under ``if TYPE_CHECKING``."""
    if isinstance(node, ast.Import | ast.ImportFrom):
        yield node
    elif isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
        for child in node.orelse:
            yield from import_statements(child)
    else:
        for child in ast.iter_child_nodes(node):
            yield from import_statements(child)


def imported(path: Path, names: set[str]) -> set[str]:
    """Return the modules of the package that a file imports; ``from package import module`` is the module."""
    found = set()
    for statement in import_statements(ast.parse(path.read_text())):
        if isinstance(statement, ast.ImportFrom):
            assert statement.level == 0, f"{path}:{statement.lineno}: a relative import"
            base = str(statement.module)
            for alias in statement.names:
                inner = f"{base}.{alias.name}"
                found.add(inner if inner in names else base)
        else:
            found.update(alias.name for alias in statement.names)
    return found & names


def related(one: str, other: str) -> bool:
    """Whether one module is the package of the other."""
    return one.startswith(f"{other}.") or other.startswith(f"{one}.")


def import_graph(package: Path) -> dict[str, set[str]]:
    """Return for each module those it imports, parents and children excepted."""
    files = modules(package)
    return {
        name: {other for other in imported(path, set(files)) if other != name and not related(name, other)}
        for name, path in files.items()
    }
