"""The commands ``polhode figure`` and ``polhode film``."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from polhode._cli.common import add_command, add_force, check_written, file_name, progress, read_scene

if TYPE_CHECKING:
    from polhode._mechanics.trajectory import Trajectory

_KINDS = ("motion", "polhode", "herpolhode", "locus", "drift", "phase", "scene")
_OF_HANDOUT = ("1", "2", "3")


def add(commands: Any) -> None:
    """Add both commands to those of `polhode`."""
    figure = add_command(
        commands,
        "figure",
        _figure,
        help="draw a figure for print: SVG, PDF or PNG",
        description="Draw a figure of a scene's motion, or figure 1, 2 or 3 of the handout.",
        epilog="motion: rates, attitude and drift over time; polhode, herpolhode: paths of the angular "
        "velocity; locus: the path of a top's axis; drift: conserved quantities; phase: the phase portrait; "
        "scene: the body and its bivectors (needs polhode[film] and a browser). 1: a trivector swept; "
        "2: a vector turned; 3: the inertia map.",
    )
    choices = (*_KINDS, *_OF_HANDOUT)
    figure.add_argument("what", metavar="WHAT", choices=choices, help=f"{', '.join(_KINDS)}, 1, 2, 3")
    figure.add_argument(
        "scene",
        metavar="SCENE.toml",
        nargs="?",
        help="the scene file (- is standard input), except for 1, 2 and 3",
    )
    _add_output(figure, "a figure", "FILE.svg, FILE.pdf or FILE.png")
    _add_view(figure)
    figure.add_argument("--time", metavar="T", type=float, help="time of the figure in s, default the last")
    words = "width of the figure, such as 85mm (one column of a journal), 18cm or 3.4in"
    figure.add_argument("--width", metavar="W", help=words)
    figure.add_argument("--no-caption", dest="caption", action="store_false", help="leave out the caption")

    film = add_command(
        commands,
        "film",
        _film,
        help="film a scene: MP4 (by ffmpeg) or GIF",
        description="Film a scene's motion as the viewer draws it. Needs polhode[film] and Chromium, Chrome "
        "or Edge, which runs without a window.",
    )
    film.add_argument("scene", metavar="SCENE.toml", help="the scene file; - is standard input")
    _add_output(film, "a film", "FILE.mp4 or FILE.gif")
    film.add_argument("--seconds", metavar="N", type=float, help="length in s, default that of the motion")
    film.add_argument("--fps", metavar="N", type=float, default=25.0, help="frames per second, default 25")
    film.add_argument(
        "--size", metavar="WxH", type=_size, help="size in pixels, default 1280x720, for a GIF 640x360"
    )
    _add_view(film)


def _add_output(parser: argparse.ArgumentParser, what: str, names: str) -> None:
    parser.add_argument("-o", "--output", metavar="FILE", type=file_name(what), required=True, help=names)
    add_force(parser)


def _add_view(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--view", metavar="A,E", type=_view, help="camera azimuth and elevation in degrees")


def _figure(options: argparse.Namespace) -> int:
    of_handout, error = options.what in _OF_HANDOUT, options.parser.error
    if of_handout and (options.scene or options.view or options.time is not None):
        error(f"figure {options.what} is a figure of the handout: it does not take a scene, view or time")
    if not of_handout and options.scene is None:
        error(f"figure {options.what} needs a scene: polhode figure {options.what} SCENE.toml -o FILE")
    from polhode._support.extras import optional

    optional("matplotlib", "plot", "a figure")
    path = Path(options.output)
    check_written([path], options.force)
    from polhode._figures.handout import handout_figure
    from polhode._figures.registry import check, figure, write
    from polhode._figures.style import Sheet, width_of

    try:
        sheet = Sheet(caption=options.caption, width=width_of(options.width))
        if not of_handout:
            check(options.what, options.view, options.time)
    except ValueError as mistake:
        error(str(mistake))
    if of_handout:
        drawn = handout_figure(int(options.what), sheet)
    else:
        drawn = figure(_motion(options.scene), options.what, sheet, options.view, options.time)
    write(drawn, path)
    print(f"Written\n  {path}")
    return 0


def _film(options: argparse.Namespace) -> int:
    from polhode._figures.film import planned
    from polhode._outputs import film

    path = Path(options.output)
    try:
        planned(path, options.seconds, options.fps, options.size, options.view)
    except ValueError as mistake:
        options.parser.error(str(mistake))
    check_written([path], options.force)
    trajectory = _motion(options.scene)
    with progress(path.name) as report:
        film(
            trajectory,
            path,
            seconds=options.seconds,
            fps=options.fps,
            size=options.size,
            view=options.view,
            progress=None if report is None else lambda fraction: report(0, fraction),
        )
    print(f"Written\n  {path}")
    return 0


def _motion(name: str) -> Trajectory:
    """Run the scene of a file or of standard input; a ValueError for an ensemble."""
    scene = read_scene(name)
    if scene.ensemble is not None:
        raise ValueError(
            f"{name} has {scene.ensemble.number} bodies, and this command draws one: remove its table "
            "[ensemble], or draw the ensemble with `polhode run`"
        )
    with progress(scene.path.name) as report:
        return scene.run(report)


def _size(text: str) -> tuple[int, int]:
    width, cross, height = text.partition("x")
    if not (cross and width.isascii() and width.isdigit() and height.isascii() and height.isdigit()):
        raise argparse.ArgumentTypeError(f"expected WIDTHxHEIGHT in pixels, such as 1280x720, got {text!r}")
    return int(width), int(height)


def _view(text: str) -> tuple[float, float]:
    try:
        azimuth, elevation = (float(part) for part in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"expected azimuth and elevation in degrees, such as 35,22, got {text!r}"
        ) from None
    return azimuth, elevation
