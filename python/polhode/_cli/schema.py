"""The command ``polhode schema``."""

from __future__ import annotations

import argparse
import json
from typing import Any

from polhode._cli import common
from polhode._cli.common import add_command


def add(commands: Any) -> None:
    """Add the command to those of `polhode`."""
    words = "print the JSON Schema of scene files"
    text = (
        "Print the JSON Schema (draft 7) of scene files, by which editors complete fields and mark mistakes."
    )
    add_command(commands, "schema", _schema, help=words, description=text)


def _schema(_: argparse.Namespace) -> int:
    from polhode._scene.schema import scene_schema

    print(json.dumps(scene_schema(), indent=2, ensure_ascii=False))
    return common.OK
