"""The WebAssembly core of the page, run by Node without a page."""

import base64
import contextlib
import json
from pathlib import Path

import numpy as np

import processes

ROOT = Path(__file__).parents[2]

# Offsets in a row of states, as in viewer/src/core/core.ts.
ROW = 24
PARTS = {
    "time": slice(0, 1),
    "rotor": slice(1, 5),
    "omega_body": slice(5, 8),
    "omega_space": slice(8, 11),
    "momentum_body": slice(11, 14),
    "momentum_space": slice(14, 17),
    "energy": slice(17, 18),
    "position": slice(18, 21),
    "velocity": slice(21, 24),
}


class Problem(Exception):  # noqa: N818, as in core.ts
    """An error reported by the core."""


@contextlib.contextmanager
def node_core(node):
    """The core in a Node process; the limit covers all tests."""
    command = [node, ROOT / "viewer/tests/core.mjs"]
    with processes.start(command, limit=3600, stdin=processes.PIPE) as process:
        yield NodeCore(process)


class NodeCore:
    """A Node process that answers one question at a time."""

    def __init__(self, process):
        self._process = process
        self._ended = None

    def ask(self, question, **rest):
        if self._ended is None:
            print(json.dumps({"question": question, **rest}), file=self._process.stdin, flush=True)
            with processes.limited(self._process):
                line = self._process.stdout.readline()
            if not line:
                self._ended = self._process.communicate()[1]
        if self._ended is not None:
            raise RuntimeError(f"Node ended: {self._ended}")
        answer = json.loads(line)
        if "problem" in answer:
            raise Problem(answer["problem"])
        return answer["value"]

    def motion(self, scene, times, **options):
        """Return the properties of a motion, and its states at the times by name."""
        answer = self.ask("motion", scene=scene, times=list(times), **options)
        return answer["about"], states(answer["rows"])


def states(rows):
    """Return rows of states as arrays by name."""
    rows = np.array(rows, dtype=float).reshape(-1, ROW)
    return {
        name: rows[:, part].squeeze(-1) if name in ("time", "energy") else rows[:, part]
        for name, part in PARTS.items()
    }


def packed(path):
    """Return the bytes of a file in base64."""
    return base64.b64encode(path.read_bytes()).decode()
