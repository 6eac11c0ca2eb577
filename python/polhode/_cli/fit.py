"""The command ``polhode fit``."""

from __future__ import annotations

import argparse
import json
from collections.abc import Container, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from polhode._cli.common import (
    add_amount,
    add_command,
    add_force,
    check_written,
    file_name,
    positive,
    read_scene,
)
from polhode._fit import units
from polhode._native import __version__

if TYPE_CHECKING:
    from polhode._fit.result import Fit
    from polhode._fit.table import Table


def add(commands: Any) -> None:
    """Add the command."""
    fit = add_command(
        commands,
        "fit",
        run,
        help="fit a body to measured rates, attitudes or periods",
        description="Fit the ratios of the principal moments, the initial state, the bias of a gyroscope, "
        "its axes and torques to rates (columns t,wx,wy,wz in body axes), attitudes (t,qw,qx,qy,qz, from "
        "body axes to space axes) or both. The first line of the file has the names of the columns; in a "
        "file of both kinds fields of one may be empty. Units are never guessed; a table that polhode wrote "
        "(time,omega_body_x, …) states them by its names: s and rad/s. With --periods instead of a "
        "file: the rotations of a body that a light curve with these periods leaves possible.",
    )
    _add_data(fit)
    _add_model(fit)
    _add_periods(fit)
    fit.add_argument(
        "-o", "--output", metavar="FILE.json", type=file_name("a fit"), help="write the fit to this file"
    )
    fit.add_argument(
        "--plot",
        metavar="FILE",
        type=file_name("a figure"),
        help="draw the residuals to FILE.svg, FILE.pdf or FILE.png",
    )
    add_force(fit)
    add_amount(fit, "the fit as JSON, in SI units")


def _add_data(fit: argparse.ArgumentParser) -> None:
    """Add the file of the data, and what its columns are."""
    fit.add_argument("data", metavar="FILE.csv", nargs="?", help="the measured data; - is standard input")
    for what, of, names in (("time", "t", units.TIMES), ("rate", "the rates", units.RATES)):
        words = f"unit of {of}: {', '.join(names)}"
        fit.add_argument(f"--{what}-unit", metavar="UNIT", choices=names, help=words)
    fit.add_argument(
        "--columns",
        metavar="NAMES",
        type=_columns,
        help="names of the columns of time and rates (4 names), of time and quaternion (5), or of time, "
        "rates and quaternion (8), separated by commas",
    )
    words = "order of the quaternion of --columns: wxyz or xyzw"
    fit.add_argument("--order", metavar="ORDER", choices=("wxyz", "xyzw"), help=words)
    fit.add_argument(
        "--sigma",
        metavar="SIGMA",
        type=_positive,
        help="standard deviation of each rate, in the unit of the rates, or of attitudes about each axis, in "
        "rad; default estimated from the residuals",
    )
    fit.add_argument(
        "--sigma-attitude",
        metavar="RAD",
        type=_positive,
        help="standard deviation of attitudes in a file of both kinds, where --sigma is that of rates",
    )


def _add_model(fit: argparse.ArgumentParser) -> None:
    """Add the options that choose what is fitted."""
    fit.add_argument("--no-bias", dest="bias", action="store_false", help="rates without a constant bias")
    fit.add_argument(
        "--clock-offset",
        action="store_true",
        help="fit the time to add to the times of the rates, in a file of both kinds",
    )
    fit.add_argument(
        "--sensor-axes",
        metavar="AXES",
        choices=("principal", "fit"),
        default="principal",
        help="axes of the data: principal axes of the body (default), or fit them",
    )
    fit.add_argument(
        "--torque", metavar="SCENE.toml", help="scene whose torques act on the body; default free motion"
    )
    fit.add_argument(
        "--free",
        metavar="NAMES",
        type=lambda text: tuple(name.strip() for name in text.split(",")),
        default=(),
        help="parameters of these torques to fit, separated by commas, such as pd_control.kp or "
        "formula.k; they start from the values of the scene",
    )


def _add_periods(fit: argparse.ArgumentParser) -> None:
    """Add the options for the periods of a light curve."""
    fit.add_argument(
        "--periods",
        metavar=("ROTATION", "PRECESSION"),
        nargs=2,
        type=_period,
        help='periods of a light curve, such as 5.41d 7.35d or "263 h" "27.38 h", instead of a file',
    )
    fit.add_argument(
        "--moments",
        metavar=("I1", "I2", "I3"),
        nargs=3,
        type=_positive,
        help="principal moments for --periods in any unit; without them, the ranges of possible bodies",
    )


def run(options: argparse.Namespace) -> int:
    """Fit the data, print the summary and write the files."""
    from polhode._support.extras import optional
    from polhode._support.files import form_of, write_atomically

    if options.periods is not None:
        return _run_periods(options)
    if options.moments is not None:
        options.parser.error("--moments needs --periods")
    written = [Path(x) for x in (options.output, options.plot) if x is not None]
    check_written(written, options.force)
    if options.plot is not None:
        optional("matplotlib", "plot", "a figure")
    found = _fitted(options)
    text = _as_json(found.to_dict())
    contents: dict[Path, bytes | Path] = {}
    if options.output is not None:
        contents[Path(options.output)] = f"{text}\n".encode()
    if options.plot is not None:
        from polhode._figures.style import encoded

        contents[Path(options.plot)] = encoded(found.plot(), form_of(options.plot, "a figure"))
    write_atomically(contents)
    if options.json:
        print(text)
    elif not options.quiet:
        print(found.summary())
        if written:
            print("\n".join(["Written", *(f"  {path}" for path in written)]))
    return 0


def _run_periods(options: argparse.Namespace) -> int:
    """Print and write the rotations that two periods leave possible."""
    from polhode._fit.light_curve import as_dict, rotations, statements
    from polhode._support.files import write_atomically

    if options.data is not None or options.plot is not None:
        options.parser.error("--periods takes neither a file of data nor --plot")
    if options.output is not None:
        check_written([Path(options.output)], options.force)
    found = rotations(options.moments, *options.periods)
    unknown = statements(options.moments, found)
    facts = {"moments": options.moments, "rotations": as_dict(found), "undetermined": unknown}
    text = _as_json(facts)
    if options.output is not None:
        write_atomically({Path(options.output): f"{text}\n".encode()})
    if options.json:
        print(text)
    elif not options.quiet:
        for one in found:
            periods = f"rotation {one.rotation_period:.6g} s, precession {one.precession_period:.6g} s"
            print(f"{periods}, {one.mode}-axis mode\n  {one.text()}")
        print("\n".join(["not determined by the data", *(f"  {x}" for x in unknown)]))
        if options.output is not None:
            print(f"Written\n  {options.output}")
    return 0


def _as_json(facts: dict[str, Any]) -> str:
    """Return a result as JSON that names the program first, by which its files are recognised."""
    return json.dumps({"source": f"polhode {__version__}", **facts}, indent=2, allow_nan=False)


def _fitted(options: argparse.Namespace) -> Fit:
    from polhode import Rotor, fit
    from polhode._fit.table import BOTH, OF_MOTION, RATES, read_tables

    error = options.parser.error
    if options.data is None:
        error("the following arguments are required: FILE.csv, or --periods ROTATION PRECESSION")
    if options.data == options.torque == "-":
        error("FILE.csv and --torque cannot both be standard input")
    if options.free and options.torque is None:
        error("--free names parameters of torques; give them with --torque SCENE.toml")
    if options.order is None and len(options.columns or ()) > len(RATES) and options.columns not in OF_MOTION:
        error("a quaternion of --columns needs its order: --order wxyz or --order xyzw")
    if options.order == "xyzw" and options.columns in OF_MOTION:
        error("--order is xyzw, but the names of --columns state wxyz: leave it out")
    torque = None if options.torque is None else read_scene(options.torque).torque
    if options.torque is not None and torque is None:
        error(f"--torque needs a scene with torques, and {options.torque} has none")
    tables = read_tables(Path(options.data), options.columns)
    _refuse_unused(options, tables)
    time_unit, rate_unit = _units(options, tables)
    given: dict[str, Any] = {}
    if "attitude" in tables:
        table = tables["attitude"]
        rotors = Rotor.from_quaternion(table.values, order=options.order or "wxyz")
        given["attitude"] = table.times * time_unit, rotors
        given["sigma_attitude"] = options.sigma if options.sigma_attitude is None else options.sigma_attitude
    if "rates" in tables:
        table = tables["rates"]
        given["rates"] = table.times * time_unit, table.values * rate_unit
        given["sigma_rates"] = None if options.sigma is None else options.sigma * rate_unit
        given["bias"] = options.bias
    if len(tables) == 2 and (options.sigma is None or options.sigma_attitude is None):
        one = ",".join((options.columns or (OF_MOTION[0] if table.of_motion else BOTH))[: len(RATES)])
        error(
            "rates and attitudes together need --sigma, of the rates, and --sigma-attitude, to weigh them; "
            f"or name the columns of one of them, as --columns {one}"
        )
    return fit(
        **given,
        clock_offset=options.clock_offset,
        sensor_axes=options.sensor_axes,
        torque=torque,
        free=options.free,
    )


def _units(options: argparse.Namespace, tables: Mapping[str, Table]) -> tuple[float, float]:
    """Return the units of times and rates in s and rad/s, which were given or are those of the columns."""
    error, found = options.parser.error, []
    for name, own, choices, is_used in (
        ("time", "s", units.TIMES, True),
        ("rate", "rad/s", units.RATES, "rates" in tables),
    ):
        given = getattr(options, f"{name}_unit")
        of_motion = any(table.of_motion for table in tables.values())
        if of_motion and options.columns is None and given not in (None, own):
            error(
                f"--{name}-unit is {given}, but columns with these names are in {own}: leave it out, or "
                "give the names with --columns if they are not"
            )
        if not of_motion and given is None and is_used:
            error(f"{name}s need their unit: --{name}-unit {', '.join(choices)}")
        found.append(units.si(given or own))
    return found[0], found[1]


def _refuse_unused(options: argparse.Namespace, tables: Container[str]) -> None:
    """Report an option that does not apply to data of these kinds, as wrong usage."""
    error = options.parser.error
    if "rates" not in tables:
        for name, is_given in (
            ("--rate-unit", options.rate_unit is not None),
            ("--no-bias", not options.bias),
        ):
            if is_given:
                error(f"{name} needs a file with rates")
        if None not in (options.sigma, options.sigma_attitude):
            error("--sigma and --sigma-attitude are the same in a file of attitudes alone; give one of them")
    if "attitude" not in tables:
        for name, value in (("--sigma-attitude", options.sigma_attitude), ("--order", options.order)):
            if value is not None:
                error(f"{name} needs a file with attitudes")
    if options.order is not None and options.columns is None:
        error("--order needs --columns: the names qw,qx,qy,qz already state the order")
    if options.clock_offset and not ("rates" in tables and "attitude" in tables):
        error("--clock-offset needs a file with rates and attitudes")


def _columns(text: str) -> tuple[str, ...]:
    names = tuple(name.strip() for name in text.split(","))
    if len(names) not in (4, 5, 8) or not all(names):
        raise argparse.ArgumentTypeError(
            "expected 4 names (time and rates), 5 (time and quaternion) or 8 (time, rates and quaternion), "
            f"such as t,wx,wy,wz, got {text!r}"
        )
    if twice := [name for name in names if names.count(name) > 1]:
        raise argparse.ArgumentTypeError(f"each column has one meaning, but {twice[0]!r} is named twice")
    return names


def _period(text: str) -> float:
    """Return a period in s."""
    text = text.strip()
    value = text.rstrip("".join(units.PERIODS)).rstrip()
    if (unit := text.removeprefix(value).strip()) not in units.PERIODS:
        raise argparse.ArgumentTypeError(
            f"expected a number and a unit {units.PERIODS_IN_WORDS}, got {text!r}"
        )
    return positive(value, 'expected a period such as "5.41 d"') * units.si(unit)


def _positive(text: str) -> float:
    return positive(text, "expected a positive number")
