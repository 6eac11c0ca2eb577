"""The imports among the TypeScript files of the viewer."""

import re
from pathlib import Path

IMPORT = re.compile(r'^(?:import|export)\b[^;]*?\bfrom\s+"(\.[^"]+)"|^import\s+"(\.[^"]+)"', re.MULTILINE)


def imports(source: Path) -> dict[str, set[str]]:
    """Return the files that each TypeScript file imports, by paths relative to `source`."""
    files = {path for path in source.rglob("*") if path.suffix in (".ts", ".tsx")}
    graph = {}
    for path in sorted(files):
        named = [a or b for a, b in IMPORT.findall(path.read_text(encoding="utf-8"))]
        targets = {(path.parent / name).resolve() for name in named}
        graph[str(path.relative_to(source))] = {
            str(target.relative_to(source.resolve()))
            for target in targets
            if target.suffix in (".ts", ".tsx")
        }
    return graph
