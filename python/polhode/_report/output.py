"""Files of motions: netCDF, CSV and Parquet, by suffix."""

from __future__ import annotations

from polhode._mechanics.trajectory import Trajectory
from polhode._report import netcdf, table


def encoded(trajectory: Trajectory, form: str) -> bytes:
    """Return the content of a file with this suffix, a form of "a motion"."""
    match form:
        case "csv":
            return table.csv(trajectory)
        case "parquet":
            return table.parquet(trajectory)
        case _:
            return netcdf.netcdf(trajectory)


def require_libraries(form: str) -> None:
    """Raise an ImportError if libraries for files with this suffix are missing."""
    if form == "parquet":
        table.require_parquet()
    elif form == "nc":
        netcdf.require_libraries()
