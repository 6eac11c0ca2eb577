"""The command ``polhode examples`` and the example scenes of the package."""

from __future__ import annotations

import argparse
import difflib
import tomllib
from pathlib import Path
from typing import Any

from polhode._cli.common import add_command, add_folder

FOLDER = Path(__file__).parents[1] / "_examples"


def add(commands: Any) -> None:
    """Add the command to those of `polhode`."""
    words = "List the example scenes, or copy the named ones. Existing files are not replaced."
    parser = add_command(
        commands, "examples", _run, help="list or copy the example scenes", description=words
    )
    parser.add_argument("names", metavar="NAME", nargs="*", help="name of an example; without one, list all")
    add_folder(parser, "copies")


def examples() -> dict[str, Path]:
    """Return the scene files of the examples by name; a FileNotFoundError if there are none."""
    if not (found := {path.stem: path for path in sorted(FOLDER.glob("*.toml"))}):
        raise FileNotFoundError(
            f"{FOLDER} has no examples: polhode was installed without them; install a wheel, or copy them "
            "from the folder examples/ of the source repository"
        )
    return found


def _run(options: argparse.Namespace) -> int:
    known = examples()
    if not options.names:
        width = max(map(len, known))
        print("\n".join(f"{name:<{width}}  {_content(path)['title']}" for name, path in known.items()))
        return 0
    names = [name.removesuffix(".toml") for name in options.names]
    for name in names:
        if name not in known:
            close = difflib.get_close_matches(name, known, n=1)
            hint = f"did you mean {close[0]}?" if close else "`polhode examples` lists them"
            options.parser.error(f"unknown example {name!r}; {hint}")
    files = [file for name in dict.fromkeys(names) for file in _files(known[name])]
    copied = _copy(files, Path(options.output))
    print("Written", *(f"  {path}" for path in copied), sep="\n")
    print(f"Try `polhode run {copied[0]}` or `polhode view {copied[0]}`.")
    return 0


def _content(path: Path) -> dict[str, Any]:
    return tomllib.loads(path.read_text(encoding="utf-8"))


def _files(scene: Path) -> list[Path]:
    """Return a scene file and its mesh file, if it has one."""
    mesh = _content(scene)["body"].get("mesh")
    return [scene] if mesh is None else [scene, scene.with_name(mesh)]


def _copy(files: list[Path], folder: Path) -> list[Path]:
    """Copy files into a folder, all or none, and return the copies; an OSError if one exists."""
    targets = {folder / file.name: file.read_bytes() for file in files}
    if not folder.is_dir():
        raise FileNotFoundError(f"no such directory: {folder}; create it first")
    for path in targets:
        if path.exists() or path.is_symlink():
            raise FileExistsError(f"{path} exists; move it, or choose another folder with -o")
    for path, content in targets.items():
        with path.open("xb") as file:
            file.write(content)
    return list(targets)
