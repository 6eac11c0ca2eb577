"""The commands ``polhode figure`` and ``polhode film``."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from polhode._cli.arguments import file_name

if TYPE_CHECKING:
    from polhode._scene.scene import Scene

Report = Callable[[int, float], object]
# Progress bar of a name, on a terminal; a pass of 0 is not shown.
Shown = Callable[[str], AbstractContextManager[Report | None]]

_KINDS = ("motion", "polhode", "herpolhode", "locus", "drift", "phase", "scene")
_OF_HANDOUT = ("1", "2", "3")


def add(commands: Any, shown: Shown) -> None:
    """Add both commands to those of `polhode`."""
    figure = commands.add_parser(
        "figure",
        help="draw a figure for print: SVG, PDF or PNG",
        description="Draw a figure of a scene's motion, or figure 1, 2 or 3 of the handout.",
        epilog="motion: rates, attitude and drift over time; polhode, herpolhode: paths of the angular "
        "velocity; locus: the path of a top's axis; drift: conserved quantities; phase: the phase portrait; "
        "scene: the body and its bivectors (needs polhode[film] and a browser). 1: a trivector swept; "
        "2: a vector turned; 3: the inertia map.",
    )
    figure.add_argument(
        "what", metavar="WHAT", choices=(*_KINDS, *_OF_HANDOUT), help=f"{', '.join(_KINDS)}, 1, 2, 3"
    )
    figure.add_argument(
        "scene", metavar="SCENE.toml", nargs="?", help="the scene file, except for 1, 2 and 3"
    )
    figure.add_argument(
        "-o", "--output", metavar="FILE", type=file_name("a figure"), required=True,
        help="FILE.svg, FILE.pdf or FILE.png",
    )  # fmt: skip
    figure.add_argument("--view", metavar="A,E", type=_view, help="camera azimuth and elevation in degrees")
    figure.add_argument("--time", metavar="T", type=float, help="time of the figure in s, default the last")
    figure.set_defaults(command=lambda options: _figure(options, shown, figure))

    film = commands.add_parser(
        "film",
        help="film a scene: MP4 (by ffmpeg) or GIF",
        description="Film a scene's motion as the viewer draws it. Needs polhode[film] and Chromium, Chrome "
        "or Edge, which runs without a window.",
    )
    film.add_argument("scene", metavar="SCENE.toml", help="the scene file")
    film.add_argument(
        "-o", "--output", metavar="FILE", type=file_name("a film"), required=True,
        help="FILE.mp4 or FILE.gif",
    )  # fmt: skip
    film.add_argument("--seconds", metavar="N", type=float, help="length in s, default that of the motion")
    film.add_argument("--fps", metavar="N", type=float, default=25.0, help="frames per second, default 25")
    film.add_argument(
        "--size", metavar="WxH", type=_size, help="size in pixels, default 1280x720, for a GIF 640x360"
    )
    film.add_argument("--view", metavar="A,E", type=_view, help="camera azimuth and elevation in degrees")
    film.set_defaults(command=lambda options: _film(options, shown))


def _figure(options: argparse.Namespace, shown: Shown, parser: argparse.ArgumentParser) -> int:
    of_handout = options.what in _OF_HANDOUT
    if of_handout and (options.scene or options.view or options.time is not None):
        parser.error(
            f"figure {options.what} is a figure of the handout: it does not take a scene, view or time"
        )
    if not of_handout and options.scene is None:
        parser.error(f"figure {options.what} needs a scene: polhode figure {options.what} SCENE.toml -o FILE")
    from polhode._support.extras import optional
    from polhode._support.files import check_target

    optional("matplotlib", "plot", "a figure")
    path = Path(options.output)
    check_target(path)
    if of_handout:
        from polhode._figures.handout import handout_figure

        drawn = handout_figure(int(options.what))
    else:
        from polhode._figures.registry import check

        check(options.what, options.view, options.time)
        scene = _scene_of_one(options.scene)
        with shown(scene.path.name) as report:
            trajectory = scene.run(report)
        drawn = trajectory.plot(options.what, view=options.view, time=options.time)
    from polhode._figures.registry import write

    write(drawn, path)
    print(f"Written\n  {path}")
    return 0


def _film(options: argparse.Namespace, shown: Shown) -> int:
    from polhode._figures.film import planned

    path = Path(options.output)
    planned(path, options.seconds, options.fps, options.size, options.view)
    scene = _scene_of_one(options.scene)
    with shown(scene.path.name) as report:
        trajectory = scene.run(report)
    with shown(path.name) as report:
        trajectory.film(
            path,
            seconds=options.seconds,
            fps=options.fps,
            size=options.size,
            view=options.view,
            progress=None if report is None else lambda fraction: report(0, fraction),
        )
    print(f"Written\n  {path}")
    return 0


def _scene_of_one(name: str) -> Scene:
    """Return the scene; a ValueError for an ensemble."""
    from polhode import Scene

    scene = Scene.read(name)
    if scene.ensemble is not None:
        raise ValueError(
            f"{name} has {scene.ensemble.number} bodies, and this command draws one: remove its table "
            "[ensemble], or draw the ensemble with `polhode run`"
        )
    return scene


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
