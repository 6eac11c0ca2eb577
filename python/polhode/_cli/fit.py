"""The command ``polhode fit``."""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from polhode._cli.common import add_amount, add_command, file_name, positive

if TYPE_CHECKING:
    from polhode._fit.result import Fit

_TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
_RATES = {"rad/s": 1.0, "deg/s": math.pi / 180, "rpm": math.pi / 30}


def add(commands: Any) -> None:
    """Add the command."""
    fit = add_command(
        commands,
        "fit",
        run,
        help="fit a free body to measured rates or attitudes",
        description="Fit the ratios of the principal moments, the initial state and the bias of a gyroscope "
        "to rates (columns t,wx,wy,wz in body axes) or attitudes (t,qw,qx,qy,qz, from body axes to space "
        "axes) of a freely rotating body. The axes of the data are principal axes. The first line of the "
        "file has the names of the columns; units are never guessed.",
    )
    fit.add_argument("data", metavar="FILE.csv", help="the measured data")
    fit.add_argument(
        "--time-unit", metavar="UNIT", choices=_TIMES, required=True, help="unit of t: s, ms, us or ns"
    )
    fit.add_argument(
        "--rate-unit", metavar="UNIT", choices=_RATES, help="unit of the rates: rad/s, deg/s or rpm"
    )
    fit.add_argument(
        "--columns",
        metavar="NAMES",
        type=_columns,
        help="names of the columns of time and rates (4 names) or of time and quaternion (5), separated by "
        "commas",
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
    fit.add_argument("--no-bias", dest="bias", action="store_false", help="rates without a constant bias")
    fit.add_argument(
        "-o", "--output", metavar="FILE.json", type=file_name("a fit"), help="write the fit to this file"
    )
    fit.add_argument(
        "--plot",
        metavar="FILE",
        type=file_name("a figure"),
        help="draw the residuals to FILE.svg, FILE.pdf or FILE.png",
    )
    add_amount(fit, "the fit as JSON, in SI units")


def run(options: argparse.Namespace) -> int:
    """Fit the data, print the summary and write the files."""
    from polhode._support.extras import optional
    from polhode._support.files import check_target, write_atomically

    written = [Path(x) for x in (options.output, options.plot) if x is not None]
    for path in written:
        check_target(path)
    if options.plot is not None:
        optional("matplotlib", "plot", "a figure")
    found = _fitted(options)
    text = json.dumps(found.to_dict(), indent=2, allow_nan=False)
    if options.output is not None:
        write_atomically({Path(options.output): f"{text}\n".encode()})
    if options.plot is not None:
        from polhode._figures.registry import write

        write(found.plot(), Path(options.plot))
    if options.json:
        print(text)
    elif not options.quiet:
        print(found.summary())
        if written:
            print("\n".join(["Written", *(f"  {path}" for path in written)]))
    return 0


def _fitted(options: argparse.Namespace) -> Fit:
    from polhode import Rotor, fit
    from polhode._fit.table import QUATERNION, read_table

    table, names = read_table(Path(options.data), options.columns)
    times = table.times * _TIMES[options.time_unit]
    if len(names) == len(QUATERNION):
        order: Any = "wxyz" if options.columns is None else options.order
        if order is None:
            options.parser.error("a quaternion of --columns needs its order: --order wxyz or --order xyzw")
        rotors = Rotor.from_quaternion(table.values, order=order)
        return fit(attitude=(times, rotors), sigma_attitude=options.sigma)
    if options.rate_unit is None:
        options.parser.error("rates need their unit: --rate-unit rad/s, deg/s or rpm")
    unit = _RATES[options.rate_unit]
    sigma = None if options.sigma is None else options.sigma * unit
    return fit(rates=(times, table.values * unit), sigma_rates=sigma, bias=options.bias)


def _columns(text: str) -> tuple[str, ...]:
    names = tuple(name.strip() for name in text.split(","))
    if len(names) not in (4, 5) or not all(names):
        raise argparse.ArgumentTypeError(
            f"expected 4 names (time and rates) or 5 (time and quaternion), such as t,wx,wy,wz, got {text!r}"
        )
    return names


def _positive(text: str) -> float:
    return positive(text, "expected a positive number")
