"""The command ``polhode``."""

from __future__ import annotations

import argparse
import difflib
import io
import json
import os
import re
import signal
import sys
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from polhode._cli import check, common, store
from polhode._cli.common import (
    add_amount,
    add_command,
    add_force,
    check_written,
    file_name,
    progress,
    read_scene,
    whole_number,
)
from polhode._cli.interrupts import interruptible
from polhode._native import SceneError, __version__
from polhode._support.counts import counted
from polhode._support.files import UnreadableError, words_of

if TYPE_CHECKING:
    from polhode._scene.scene import Scene


def main(arguments: list[str] | None = None) -> int:
    """Run the command and return its exit code."""
    if sys.stderr is None:  # closed, and `print` would write errors to standard output
        sys.stderr = os.fdopen(os.open(os.devnull, os.O_WRONLY), "w")
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without ω gets a question mark, not an error
    received: list[int] = []
    try:
        with interruptible(received):
            given = _with_values(sys.argv[1:] if arguments is None else arguments)
            options = _parser(given).parse_args(given)
            with _printed_warnings():
                code = int(options.command(options))
        print(end="", flush=True)
    except KeyboardInterrupt as stop:
        code = common.TERMINATED if signal.SIGTERM in received else common.INTERRUPTED
        _complain(str(stop) or "interrupted; no file was changed", code)
    except (SceneError, UnreadableError) as error:
        code = _complain(str(error), common.BAD_INPUT)
    except BrokenPipeError:
        code = common.FAILED  # the reader of the output has closed it
    except (OSError, ValueError, ImportError, MemoryError) as error:
        code = _complain(f"polhode: error: {words_of(error) or 'out of memory'}", common.FAILED)
    _drop_output()
    return code


@contextmanager
def _printed_warnings() -> Iterator[None]:
    """Print warnings in the format of errors."""

    def show(message: object, *_: object) -> None:
        print(f"polhode: warning: {message}", file=sys.stderr)

    with warnings.catch_warnings():
        for category in (UserWarning, RuntimeWarning):
            warnings.simplefilter("always", category)
        warnings.showwarning = show  # type: ignore[assignment]
        yield


def _drop_output() -> None:
    """Drop output that cannot be written; else Python reports an error when it exits."""
    try:
        print(end="", flush=True)
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _complain(message: str, code: int) -> int:
    print(message, file=sys.stderr)
    return code


def _parser(given: Sequence[str] = ()) -> argparse.ArgumentParser:
    """Return the parser; a usage error if what was given begins with a file or a misspelt command."""
    parser = argparse.ArgumentParser(
        prog="polhode",
        description="Rigid-body motion in the language of geometric algebra.",
        epilog=(
            "Exit codes: 0 ok, 1 the run failed or an equation is false, 2 wrong usage, 3 bad input file "
            "or formula, 4 a conserved quantity drifted past its bound, 130 interrupted, 143 terminated."
        ),
    )
    parser.add_argument("--version", action="version", version=f"polhode {__version__}")
    from polhode._cli import completion, convert, examples, figure, fit, schema

    completion.add(parser)
    commands = parser.add_subparsers(metavar="COMMAND", required=True, parser_class=common.CommandParser)
    _add_scenes(commands)
    _add_formulas(commands)
    figure.add(commands)
    fit.add(commands)
    convert.add(commands)
    schema.add(commands)
    examples.add(commands)
    if given and given[0] not in commands.choices and (remedy := _remedy(given[0], commands.choices)):
        parser.error(f"{given[0]!r} is not a command; {remedy}")
    return parser


def _remedy(first: str, commands: Iterable[str]) -> str | None:
    """Return what to type for a first argument that is not a command, if this is known."""
    if first.startswith("-"):
        return None
    if command := {".toml": "run", ".nc": "view", ".md": "view"}.get(Path(first).suffix.lower()):
        return f"try `polhode {command} {first}`"
    close = difflib.get_close_matches(first, commands, n=1)
    return f"did you mean `polhode {close[0]}`?" if close else None


def _add_scenes(commands: Any) -> None:
    run = add_command(commands, "run", _run, help="run a scene: summary, data, figures")
    run.add_argument("scene", metavar="SCENE.toml", nargs="?", help="the scene file; - is standard input")
    run.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        type=store.output_name,
        help="write the motion to FILE.nc (netCDF), FILE.csv or FILE.parquet, all motions of an ensemble to "
        "FILE.nc, and figures next to it (FILE-motion.png …); or those of an ensemble of any size to the "
        "store FILE.zarr, which can be resumed",
    )
    run.add_argument(
        "--html",
        metavar="FILE.html",
        type=file_name("a page"),
        help="write a self-contained page that shows the motion in a browser",
    )
    add_force(run)
    words = "write the data alone; then matplotlib is not needed"
    run.add_argument("--no-figures", dest="figures", action="store_false", help=words)
    add_amount(run, "the summary as JSON, in SI units")
    run.add_argument(
        "--threads",
        metavar="N",
        type=whole_number("number of threads", 1, float("inf")),
        help="number of threads for ensembles, default all cores; results do not depend on it",
    )
    store.add(run)

    check.add(commands)

    view = add_command(
        commands,
        "view",
        _view,
        help="show a motion in the browser, or a lesson",
        description="Show a scene, a motion from a netCDF file, or a lesson in the browser of this machine. "
        "Reload the page to read an edited scene or lesson again.",
    )
    words = "a scene, a lesson (.md), or the netCDF file of one body's motion"
    view.add_argument("file", metavar="FILE", help=words)
    port = whole_number("port", 0, 65535)
    view.add_argument(
        "--port", metavar="N", type=port, default=0, help="port of the server, default a free one"
    )
    words = "print the address of the page without opening it"
    view.add_argument("--no-browser", dest="browser", action="store_false", help=words)


def _add_formulas(commands: Any) -> None:
    evaluate = add_command(
        commands,
        "eval",
        _eval,
        help="evaluate formulas",
        description="Evaluate formulas in paper notation or in ASCII: `-I a∧b` is `-I a^b`.",
        epilog="Lines of files and of standard input are formulas or `let NAME = VALUE`; # begins a comment.",
    )
    evaluate.add_argument("formulas", metavar="FORMULA", nargs="*", help="a formula, or an equation to check")
    evaluate.add_argument(
        "-f", "--file", metavar="FILE", help="read formulas from this file first; - is standard input"
    )
    evaluate.add_argument(
        "--let",
        metavar="NAME=VALUE",
        action="append",
        default=[],
        type=_definition,
        help="define a value, which may have units (θ=90deg), or a function (V(x)=½ x·x)",
    )
    form = evaluate.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="print the values as JSON")
    form.add_argument("--latex", action="store_true", help="print formulas and values as LaTeX")

    words = "evaluate formulas as you type them"
    add_command(
        commands, "repl", _repl, help=words, description=f"{words.capitalize()}; :help lists commands."
    )


def _definition(text: str) -> str:
    """Return the argument of --let, NAME=VALUE."""
    name, sign, value = text.partition("=")
    if not (sign and name.strip() and value.strip()):
        raise argparse.ArgumentTypeError(f"expected NAME=VALUE, such as θ=90deg, got {text!r}")
    return text


# Values that begin with a minus: a formula -a∧b, a view -20,35.
_VALUES = {"eval": r"-[^-fh]", "figure": r"-[.\d]", "film": r"-[.\d]"}


def _with_values(arguments: list[str]) -> list[str]:
    """Return arguments with a space before such values, which argparse does not take for options."""
    value = _VALUES.get(arguments[0]) if arguments else None
    return arguments if value is None else [f" {x}" if re.match(value, x) else x for x in arguments]


def _eval(options: argparse.Namespace) -> int:
    from polhode._formula.shell.eval import run

    return run(options)


def _view(options: argparse.Namespace) -> int:
    from polhode._viewer.server import run

    return run(options, progress)


def _repl(_: argparse.Namespace) -> int:
    from polhode._formula.shell.repl import run

    signal.signal(signal.SIGTERM, signal.SIG_DFL)  # the prompt goes on after Ctrl-C
    return run()


def _run(options: argparse.Namespace) -> int:
    store.check_usage(options)
    if options.status is not None:
        return store.status(options)
    scene = read_scene(options.scene)
    if store.is_store(options.output):
        return store.run(scene, options)
    targets = _checked_targets(options, scene)
    pages = [] if options.html is None else [Path(options.html)]
    if pages:
        from polhode._viewer.server import check_page

        check_page(pages[0])
    check_written([*targets, *pages], options.force)
    run = _run_one if scene.ensemble is None else _run_many
    result = run(scene, targets, pages, options)
    written = result["files"] = [str(path) for path in (*targets, *pages)]
    if options.json:
        print(json.dumps(result, indent=2, allow_nan=False))
    elif options.quiet:
        pass
    elif written:
        print("Written", *(f"  {path}" for path in written), sep="\n")
    else:
        print("No file was written; use -o FILE.nc for data and figures, --html FILE.html for a page.")
    if result["run"]["drift_within_bound"] is None:
        return _complain("polhode: error: all bodies failed", common.FAILED)
    return common.OK if result["run"]["drift_within_bound"] else common.DRIFTED


def _run_one(
    scene: Scene, targets: list[Path], pages: list[Path], options: argparse.Namespace
) -> dict[str, Any]:
    """Run one body, print its summary and write its files, all or none; return the summary."""
    from polhode._report.summary import as_text, summary
    from polhode._support.files import form_of, write_atomically

    with progress(scene.path.name, options.quiet) as report:
        trajectory = scene.run(report, options.threads)
    result = summary(scene, trajectory)
    if not (options.json or options.quiet):
        print(as_text(result))
    contents: dict[Path, bytes] = {}
    if targets:
        from polhode._report.output import encoded

        contents[targets[0]] = encoded(trajectory, form_of(targets[0], "a motion"))
    if targets[1:]:
        from polhode._figures.registry import pictures

        contents |= dict(zip(targets[1:], pictures(scene, trajectory), strict=True))
    if pages:
        from polhode._viewer.server import motion_page

        contents[pages[0]] = motion_page(trajectory)
    write_atomically(contents)
    return result


def _run_many(
    scene: Scene, targets: list[Path], pages: list[Path], options: argparse.Namespace
) -> dict[str, Any]:
    """Run an ensemble, print its summary and write its files; return the summary."""
    from polhode._cli import ensemble
    from polhode._report.ensemble.summary import as_text, summary
    from polhode._viewer.server import scene_page

    contents = {path: scene_page(scene) for path in pages}
    result = summary(ensemble.run(scene, targets, options.threads, contents, options.quiet))
    if not (options.json or options.quiet):
        print(as_text(result))
    return result


def _checked_targets(options: argparse.Namespace, scene: Scene) -> list[Path]:
    """Return the paths of the data and of two figures if they are wanted, checked before the run."""
    if options.output is None:
        return []
    from polhode._figures.registry import ON_ELLIPSOID
    from polhode._report.output import require_libraries
    from polhode._support.extras import optional
    from polhode._support.files import form_of

    output, form = Path(options.output), form_of(options.output, "a motion")
    if scene.ensemble is not None and form != "nc":
        raise ValueError(
            f"{output}: this scene has an ensemble of {counted(scene.ensemble.number, 'body')}, which is "
            f"written as netCDF or, of any size, as a Zarr store; use -o {output.with_suffix('.nc')} or "
            f"-o {output.with_suffix('.zarr')}"
        )
    require_libraries(form)
    figures: tuple[str, ...] = ()
    if options.figures:
        optional("matplotlib", "plot", "a figure")
        figures = ("motion", "polhode" if scene.kind in ON_ELLIPSOID else "axis")
        if scene.ensemble is not None:
            figures = ("ensemble",) if scene.ensemble.keep else ("ensemble", "directions")
    return [output, *(output.with_name(f"{output.stem}-{figure}.png") for figure in figures)]


if __name__ == "__main__":
    sys.exit(main())
