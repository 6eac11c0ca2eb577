"""Options of ``polhode run`` for Zarr stores of ensembles, and the state of a store."""

from __future__ import annotations

import argparse
import json
import math
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from polhode._cli import common
from polhode._cli.common import file_name
from polhode._support.counts import counted
from polhode._support.files import unreadable

if TYPE_CHECKING:
    from polhode._report.ensemble.store import EnsembleStore
    from polhode._scene.scene import Scene

# Number of failures that are printed.
_SHOWN = 5


def is_store(output: str | None) -> bool:
    """Whether an output is a Zarr store, by its suffix."""
    return output is not None and Path(output).suffix.lower() == ".zarr"


def output_name(name: str) -> str:
    """Check the suffix of an output, as a type of argparse."""
    if is_store(name):
        return name
    try:
        return file_name("a motion")(name)
    except argparse.ArgumentTypeError as error:
        raise argparse.ArgumentTypeError(f"{error}; an ensemble also as FILE.zarr") from None


def _bodies(text: str) -> tuple[int, int]:
    """Return a range A:B of bodies, as a type of argparse."""
    found = re.fullmatch(r"([0-9]{1,12}):([0-9]{1,12})", text)
    if not found or int(found[1]) >= int(found[2]):
        raise argparse.ArgumentTypeError(f"expected A:B, such as 0:5000, with A below B, got {text!r}")
    return int(found[1]), int(found[2])


def add(run: argparse.ArgumentParser) -> None:
    """Add the options to those of ``polhode run``."""
    words = "continue the store FILE.zarr: compute the blocks that are missing or corrupt"
    run.add_argument("--resume", action="store_true", help=words)
    run.add_argument(
        "--bodies",
        metavar="A:B",
        type=_bodies,
        help="compute the blocks of FILE.zarr that begin at the bodies A to B-1 only; processes with "
        "disjoint ranges may fill one store at the same time",
    )
    run.add_argument(
        "--cluster",
        metavar="local[:N] | ADDRESS | FILE.json",
        help="compute the blocks of FILE.zarr as tasks of a Dask cluster: N processes of this machine, the "
        "scheduler at an address, or that of a scheduler file",
    )
    run.add_argument(
        "--status",
        metavar="FILE.zarr",
        help="verify a store and print the blocks that are done, missing and corrupt; the exit code is 1 "
        "unless all are done",
    )


def check_usage(options: argparse.Namespace) -> None:
    """Report a usage error if the scene is missing, or options need a store or do not apply to its status."""
    if options.status is not None:
        _check_status(options)
        return
    if options.scene is None:
        options.parser.error("the following arguments are required: SCENE.toml")
    if not is_store(options.output):
        for name in ("resume", "bodies", "cluster"):
            if getattr(options, name) not in (None, False):
                options.parser.error(f"--{name} needs a store: -o FILE.zarr")


def _check_status(options: argparse.Namespace) -> None:
    """Report a usage error for any option with --status but those of what is printed."""
    if options.scene is not None:
        options.parser.error(f"--status takes a store and no scene: leave out {options.scene}")
    names = ("output", "html", "force", "resume", "bodies", "cluster", "threads")
    given = [f"--{name}" for name in names if getattr(options, name)]
    if not options.figures:
        given.append("--no-figures")
    if given:
        options.parser.error(f"--status computes nothing: leave out {', '.join(given)}")


def run(scene: Scene, options: argparse.Namespace) -> int:
    """Fill the store of a scene, and print its state."""
    from polhode._report.ensemble.fill import fill, require_ensemble
    from polhode._report.ensemble.store import OtherRunError

    path = Path(options.output)
    require_ensemble(scene, path, options.bodies)
    assert scene.ensemble is not None
    first, end = options.bodies or (0, scene.ensemble.number)
    if options.html is not None:
        raise ValueError("--html shows the motions of a run, which a store does not load: leave it out")
    # Other processes may fill the same store.
    keeps = next((f"--{name}" for name in ("resume", "bodies") if getattr(options, name)), None)
    try:
        with common.progress_of_bodies(scene.path.name, end - first, options.quiet) as report:
            store = fill(
                scene,
                path,
                resume=options.resume,
                bodies=options.bodies,
                cluster=options.cluster,
                replace=options.force and keeps is None,
                progress=report,
                threads=options.threads,
            )
    except OtherRunError as error:
        if options.force and keeps is not None:
            raise ValueError(
                f"{error}; --force does not replace a store with {keeps}: delete {path} first"
            ) from None
        raise
    result = outcome(store)
    if options.json:
        print(json.dumps(result, indent=2, allow_nan=False))
    elif not options.quiet:
        print(as_text(result))
    if result["bodies_complete"] and result["failures"]["count"] == result["bodies_complete"]:
        return common.FAILED
    within = all(drift <= store.drift_bound for drift, _ in result["worst_drift"].values())
    return common.OK if within else common.DRIFTED


def status(options: argparse.Namespace) -> int:
    """Verify a store and print its state."""
    from polhode._report.ensemble.store import EnsembleStore, StoreError

    try:
        store = EnsembleStore.open(Path(options.status))
    except (FileNotFoundError, StoreError) as error:
        raise unreadable(error) from None
    states = [store.state(index) for index in range(store.blocks)]
    counts = {name: states.count(name) for name in ("done", "missing", "corrupt")}
    complete = counts["done"] == store.blocks and store.shares
    spans = {name: _spans(store, states, name) for name in counts}
    users = [
        {"bodies": [lock.first, lock.end], "process": lock.pid, "host": lock.host} for lock in store.users()
    ]
    done = [index for index, state in enumerate(states) if state == "done"]
    result = {**outcome(store, done), **counts, "complete": complete, "shared_variables": store.shares}
    result |= {"bodies": spans, "running": users}
    if options.json:
        print(json.dumps(result, indent=2, allow_nan=False))
    elif not options.quiet:
        print(as_text(result), *_lines(result), sep="\n")
    return common.OK if complete else common.FAILED


def _spans(store: EnsembleStore, states: list[str], name: str) -> list[list[int]]:
    """Return the ranges of bodies whose blocks have a state, neighbours joined."""
    spans: list[list[int]] = []
    for index, state in enumerate(states):
        if state == name:
            rows = store.rows(index)
            if spans and spans[-1][1] == rows.start:
                spans[-1][1] = rows.stop
            else:
                spans.append([rows.start, rows.stop])
    return spans


def _lines(result: dict[str, Any]) -> Iterator[str]:
    """Yield the lines of a status after the outcome."""
    for name in ("done", "missing", "corrupt"):
        ranges = ", ".join(f"{first}:{end}" for first, end in result["bodies"][name])
        yield f"  {name:<8} {counted(result[name], 'block')}" + (f", bodies {ranges}" if ranges else "")
    if not result["shared_variables"]:
        yield "  corrupt  variables that all bodies share; --resume writes them again"
    for user in result["running"]:
        first, end = user["bodies"]
        yield f"  running  bodies {first}:{end}, process {user['process']} on {user['host']}"


def outcome(store: EnsembleStore, blocks: Iterable[int] | None = None) -> dict[str, Any]:
    """Return what the marks of blocks say, in values that JSON can hold."""
    complete, done, methods = 0, 0, Counter[str]()
    failures: list[list[Any]] = []
    worst: dict[str, list[Any]] = {}
    for mark in store.marks(blocks):
        done += 1
        complete += mark["bodies"][1] - mark["bodies"][0]
        methods.update(mark["methods"])
        failures += mark["failures"]
        for name, (drift, body) in mark["worst"].items():
            if drift > worst.get(name, [-math.inf])[0]:
                worst[name] = [drift, body]
    return {
        "store": str(store.path),
        "blocks": store.blocks,
        "blocks_complete": done,
        "bodies_complete": complete,
        "number": store.number,
        "methods": dict(methods.most_common()),
        "worst_drift": worst,
        "failures": {
            "count": len(failures),
            "first": [
                {"body": body, "time": reached, "message": message}
                for body, reached, message in failures[:_SHOWN]
            ],
        },
    }


def as_text(result: dict[str, Any]) -> str:
    """Return the outcome in lines for a terminal."""
    lines = [
        f"{result['store']}: {result['bodies_complete']} of {counted(result['number'], 'body')}, "
        f"{result['blocks_complete']} of {counted(result['blocks'], 'block')}"
    ]
    for name, (drift, body) in result["worst_drift"].items():
        lines.append(f"  largest drift of {name.replace('_', ' ')}: {drift:.2g}, body {body}")
    if count := result["failures"]["count"]:
        lines.append(f"  failed bodies: {count}")
        for failure in result["failures"]["first"]:
            lines.append(f"    body {failure['body']} after {failure['time']:.6g} s: {failure['message']}")
    return "\n".join(lines)
