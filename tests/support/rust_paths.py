"""The uses among the files of a Rust crate, by the paths that they name.

A file uses another if a path in it (in a ``use`` or within an expression) leads there, re-exports followed.
Tests and comments do not count, nor do the paths between a module and a module within it.
"""

import re
from collections.abc import Iterator
from pathlib import Path

Module = tuple[str, ...]

WORDS = re.compile(r"(?<![\w:$.])(?:r#)?[A-Za-z_]\w*(?:::(?:r#)?[A-Za-z_]\w*)*")
USE = re.compile(r"^\s*(pub(?:\([^)]*\))?\s+)?use\s+([^;]+);", re.MULTILINE)
TESTS = re.compile(r"#\[cfg\(test\)\]\s*mod (\w+);")
TEST = re.compile(r"#\[cfg\(test\)\]\s*(?:#\[[^\]]*\]\s*)*")
QUOTED = re.compile(
    r'//[^\n]*|/\*.*?\*/|r(#*)".*?"\1|b?"(?:\\.|[^"\\])*"|b?\'(?:\\[^\n]{1,9}?|[^\'\\\n])\'', re.DOTALL
)


def without_words(text: str) -> str:
    """The code without comments and literals."""
    return QUOTED.sub(" ", text)


def without_tests(code: str) -> str:
    """The code without the items that are compiled for tests only."""
    while found := TEST.search(code):
        end, depth = found.end(), 0
        while end < len(code):
            depth += (code[end] in "{([") - (code[end] in "})]")
            if depth == 0 and code[end] in ";}":
                break
            end += 1
        code = code[: found.start()] + code[end + 1 :]
    return code


def leaves(tree: str) -> Iterator[tuple[Module, str]]:
    """The paths of a ``use`` and the names that they bring."""
    tree = tree.strip()
    if "{" not in tree:
        path, _, alias = tree.partition(" as ")
        words = tuple(part.strip() for part in path.split("::"))
        words = words[:-1] if words[-1] == "self" and len(words) > 1 else words
        yield words, alias.strip() or words[-1]
        return
    before, _, inside = tree.partition("{")
    inside = inside[: inside.rindex("}")]
    parts, depth, start = [], 0, 0
    for at, sign in enumerate(inside):
        depth += (sign == "{") - (sign == "}")
        if sign == "," and depth == 0:
            parts.append(inside[start:at])
            start = at + 1
    for part in [*parts, inside[start:]]:
        if part.strip():
            yield from leaves(before.strip() + part.strip())


class Crate:
    """The files of a crate: their modules, the names that they re-export, and whom they use."""

    def __init__(self, source: Path) -> None:
        self.code: dict[Module, str] = {}
        self.file: dict[Module, str] = {}
        tests: set[Module] = set()
        for path in sorted(source.rglob("*.rs")):
            module = path.relative_to(source).with_suffix("").parts
            module = module[:-1] if module[-1] in ("mod", "lib") else module
            code = without_words(path.read_text(encoding="utf-8"))
            tests |= {(*module, name) for name in TESTS.findall(code)}
            self.code[module] = without_tests(code)
            self.file[module] = path.relative_to(source).as_posix()
        for module in list(self.code):
            if any(module[: len(test)] == test for test in tests):
                del self.code[module]
        self.brought = {module: dict(self._brought(module)) for module in self.code}

    def _brought(self, module: Module) -> Iterator[tuple[str, Module]]:
        for found in USE.finditer(self.code[module]):
            for path, name in leaves(found[2]):
                absolute = self.absolute(module, path)
                if absolute is not None:
                    yield name, absolute

    def absolute(self, module: Module, path: Module) -> Module | None:
        """A path from the crate's root; None if it leads out of the crate."""
        if path[0] == "crate":
            return path[1:]
        if path[0] in ("super", "self") or (*module, path[0]) in self.code:
            at = module
            while path and path[0] in ("super", "self"):
                at = at[:-1] if path[0] == "super" else at
                path = path[1:]
            return (*at, *path)
        return None

    def home(self, path: Module, hops: int = 9) -> Module:
        """The module that holds what a path from the root names."""
        module = path
        while module not in self.code:
            module = module[:-1]
        rest = path[len(module) :]
        if rest and hops and (target := self.brought[module].get(rest[0])):
            return self.home((*target, *rest[1:]), hops - 1)
        return module

    def uses(self, module: Module) -> set[Module]:
        """The modules that one uses, without those above and within it."""
        paths = list(self.brought[module].values())
        for found in WORDS.finditer(USE.sub(" ", self.code[module])):
            words = tuple(found[0].split("::"))
            if len(words) == 1:
                continue
            if words[0] in self.brought[module]:
                paths.append((*self.brought[module][words[0]], *words[1:]))
            elif (absolute := self.absolute(module, words)) is not None:
                paths.append(absolute)
        homes = {self.home(path) for path in paths}
        return {m for m in homes if m[: len(module)] != module and module[: len(m)] != m}


def uses_of_files(source: Path) -> dict[str, set[str]]:
    """Return the files of a crate that each of its files uses, as paths under its source."""
    crate = Crate(source)
    return {crate.file[module]: {crate.file[other] for other in crate.uses(module)} for module in crate.code}
