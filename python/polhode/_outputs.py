"""Methods that plot, show and save motions, attached to the classes of mechanics and scenes.

`_mechanics` and `_scene` do not import figures, files and the viewer; this module imports all of them.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from polhode._mechanics.closed_form import ClosedForm
from polhode._mechanics.closed_forms import DampedTop, LagrangeTop, LarmorSphere
from polhode._mechanics.free_motion import FreeMotion, SymmetricTop
from polhode._mechanics.simulate import simulate as simulate
from polhode._mechanics.simulate import simulate_blocks as simulate_blocks
from polhode._mechanics.trajectory import Trajectory
from polhode._scene.scene import Scene
from polhode._support.calls import explains_calls
from polhode._viewer.notebook import view as view

if TYPE_CHECKING:
    import pandas
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from polhode._report.ensemble.reduced_ensemble import ReducedEnsemble
    from polhode._viewer.widget import Viewer


def to_xarray(self: Trajectory) -> xarray.Dataset:
    """Return an `xarray.Dataset` with labelled dimensions, units and conventions.

    For a batch, the dimension `body` counts the bodies in C order; the attribute `batch_shape` is the shape.

    Examples
    --------
    >>> ball = ph.Inertia.from_principal_moments(2, 2, 2)
    >>> motion = ph.simulate(ball, ph.State(ph.Rotor.identity(), [0, 0, 1]), [0, 1, 2])
    >>> data = motion.to_xarray()
    >>> data.energy.values, data.energy.units
    (array([1., 1., 1.]), 'J')
    """
    from polhode._report.netcdf import to_xarray

    return to_xarray(self)


def to_dataframe(self: Trajectory) -> pandas.DataFrame:
    """Return a `pandas.DataFrame` with a row for each output time, in SI units.

    The index is ``time`` in s; for a batch, it is a `MultiIndex` of ``body``, the number of the body in C
    order, and ``time``. The columns are named as the variables of `to_xarray`, with the component:

    - ``attitude_w``, ``_x``, ``_y``, ``_z``: Hamilton quaternion from body axes to space axes;
    - ``omega_body_x``, ``_y``, ``_z`` in rad/s, in body axes;
    - ``momentum_space_x``, ``_y``, ``_z`` in kg m²/s, in space axes;
    - ``position_x``, ``_y``, ``_z`` in m and ``velocity_x``, ``_y``, ``_z`` in m/s, in space axes;
    - ``energy`` in J.

    x, y, z of a bivector are its components ``(e2e3, e3e1, e1e2)``. ``frame.attrs["units"]`` has the unit of
    each column; the other attributes are those of `to_xarray`.

    Raises
    ------
    ImportError
        Without pandas: ``pip install 'polhode[pandas]'``.

    Examples
    --------
    >>> ball = ph.Inertia.from_principal_moments(2, 2, 2)
    >>> motion = ph.simulate(ball, ph.State(ph.Rotor.identity(), [0, 0, 1]), [0, 1, 2])
    >>> motion.to_dataframe()["omega_body_z"]
    time
    0.0    1.0
    1.0    1.0
    2.0    1.0
    Name: omega_body_z, dtype: float64
    """
    from polhode._report.table import to_dataframe

    return to_dataframe(self)


def _repr_html_(self: Trajectory) -> str:
    """Return a table for notebooks: what `repr` gives, the regime and the certificate."""
    from polhode._report.notebook import as_html

    return as_html(self)


def read(path: str | os.PathLike[str]) -> Trajectory:
    """Read the motion of one body from a netCDF file written by `save` or ``polhode run -o``.

    The numbers are those written, to the last bit; `at` cannot evaluate the motion between its times.

    Raises
    ------
    ValueError
        If the file holds a batch (use xarray), or was not written by Polhode; if it states other units or
        another order of components, or has numbers that are missing or not finite.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> ball = ph.Inertia.from_principal_moments(2, 2, 2)
    >>> motion = ph.simulate(ball, ph.State(ph.Rotor.identity(), [0, 0, 1]), [0, 1])
    >>> motion.save("ball.nc")
    >>> again = ph.Trajectory.read("ball.nc")
    >>> bool((again.rotor == motion.rotor).all())
    True
    """
    from polhode._report.netcdf_reading import read

    return read(path)


def save(self: Trajectory, path: str | os.PathLike[str]) -> None:
    """Write a file atomically: an older file is replaced only when the new one is complete.

    The suffix selects the form:

    - ``.nc``: netCDF, with units, conventions, events, certificate and attributes; `read` reads it;
    - ``.csv``: a table with the columns of `to_dataframe` after ``time``, of a batch after ``body`` and
      ``time``; the first line has their names, and every number reads back to the same bits;
    - ``.parquet``: the data frame of `to_dataframe`, with its attributes.

    Raises
    ------
    ValueError
        If the path has another suffix.
    ImportError
        Without the libraries of the form: ``pip install 'polhode[io]'`` for ``.nc``, ``'polhode[parquet]'``
        for ``.parquet``.
    OSError
        If the file cannot be written.

    Examples
    --------
    >>> ball = ph.Inertia.from_principal_moments(2, 2, 2)
    >>> motion = ph.simulate(ball, ph.State(ph.Rotor.identity(), [0, 0, 1]), [0, 1])
    >>> motion.save("ball.csv")
    >>> with open("ball.csv") as file:
    ...     print(file.readline().split(",")[:5])
    ['time', 'attitude_w', 'attitude_x', 'attitude_y', 'attitude_z']
    """
    from polhode._report.output import encoded
    from polhode._support.files import form_of, write_atomically

    form = form_of(path, "a motion")
    write_atomically({Path(path): encoded(self, form)})


def plot(
    self: Trajectory,
    kind: str = "motion",
    *,
    view: Any = None,
    time: float | None = None,
    ax: Axes | None = None,
    caption: bool = True,
    width: str | float | None = None,
) -> Figure:
    """Return a matplotlib figure of the motion of one body.

    Settings of Matplotlib that differ from its defaults are kept, such as those of a style sheet.

    Parameters
    ----------
    kind
        ``"motion"``, angular velocity and attitude over time, and energy and |L| where they vary;
        ``"polhode"`` on its ellipsoid; ``"herpolhode"`` in the invariable plane; ``"locus"``, the path of a
        top's axis; ``"drift"`` of conserved quantities; ``"phase"``, the phase portrait; ``"scene"``, the
        body and its bivectors, captured from the viewer in a headless browser.
    view
        Azimuth and elevation of the camera in degrees, for figures in 3-d; None for the default.
    time
        Time of the figure ``"scene"`` in s; None for the last output time.
    ax
        Plane axes of matplotlib to draw on, without title and caption; their figure is returned. None for a
        new figure. For all kinds but ``"motion"``, ``"drift"``, and ``"phase"`` of bodies whose Ω stays on an
        ellipsoid, which have several panels.
    caption
        Whether a new figure has a caption.
    width
        Width of a new figure, such as ``"85mm"`` for one column of a journal, or in inches; None for that
        of two columns, about 180 mm. Letters are 9 points high, and at least 7 in narrower figures.

    Raises
    ------
    ValueError
        For a batch, a kind that does not fit the motion or `ax`, too few output times, or an invalid width.
    ImportError
        Without matplotlib, and for ``"scene"`` without Playwright: ``pip install 'polhode[film]'``.
    OSError
        For ``"scene"`` without a browser.

    Examples
    --------
    >>> body = ph.Inertia.from_principal_moments(1, 2, 3)
    >>> motion = ph.simulate(body, ph.State(ph.Rotor.identity(), [0.01, 1, 0.01]), np.linspace(0, 20, 201))
    >>> motion.plot("polhode").savefig("polhode.png")
    """
    self._require_one("plot")
    from polhode._figures.registry import figure
    from polhode._figures.style import Sheet, width_of

    return figure(self, kind, Sheet(ax, caption, width_of(width)), view, time)


def film(
    self: Trajectory,
    path: str | os.PathLike[str],
    *,
    seconds: float | None = None,
    fps: float = 25.0,
    size: tuple[int, int] | None = None,
    view: Any = None,
    progress: Callable[[float], object] | None = None,
) -> None:
    """Write a film of the motion of one body: FILE.mp4, by ffmpeg, or FILE.gif.

    The frames are captured from the viewer in a headless browser, at equally spaced times from the first
    output time on.

    Parameters
    ----------
    seconds
        Length of the film; None for true speed, a second of motion in a second of film.
    fps
        Frames per second.
    size
        Width and height in pixels; None for (1280, 720), of a GIF (640, 360).
    view
        As for `plot`; None for that of the viewer.
    progress
        Called after each frame with the fraction done.

    Raises
    ------
    ValueError
        For a batch, another suffix, fewer than 2 output times, fewer than 2 frames, or a motion too long
        or too short for true speed.
    ImportError
        Without Playwright: ``pip install 'polhode[film]'``.
    OSError
        Without a browser or ffmpeg, or if the file cannot be written; an older file stays.

    Warns
    -----
    UserWarning
        If the body turns by more than a quarter turn between frames, so that it appears to turn at
        another rate; the warning gives the largest speed at which the film is faithful.
    """
    self._require_one("film")
    from polhode._figures.film import write

    write(self, Path(path), seconds, fps, size, view, progress)


def view_of(self: Any, duration: float | None = None) -> Viewer:
    """Show the motion of one body in a notebook, as `polhode.view` does.

    Parameters
    ----------
    duration
        Duration in s, for closed forms only; None for 20 turns at the initial rate.
    """
    return view(self, duration=duration)


def reduce(
    self: Any,
    keep: Sequence[str] | None = None,
    progress: Callable[[int, float], object] | None = None,
    threads: int | None = None,
) -> ReducedEnsemble:
    """Return reduced outputs of the bodies of an ensemble, whose motions are not kept.

    Bodies are computed and reduced in blocks: the memory is that of the outputs, and bits do not depend on
    blocks and threads. `Scene.run(store=...)` and ``polhode run -o`` write these outputs for scenes with
    `keep`.

    Parameters
    ----------
    keep
        Some of the words below; None for ``keep`` of the table `[ensemble]`.
    progress, threads
        As for `polhode.simulate`.

    Returns
    -------
    ReducedEnsemble
        Arrays by name. Angles are in rad: `from_nominal` is the angle between the attitude and that of the
        scene's own body, `tilt` that of a body axis from L (from the vertical if the body is held, from up
        on an orbit), `rate` is the norm of Ω in rad/s. Unknown values, such as the last state of failed
        bodies, are NaN.

        - ``last``: `last_attitude` (number, 4), quaternions wxyz from body to space; `last_omega_body`
          (number, 3) in rad/s in body axes; `last_position`, `last_velocity` in m and m/s of moving bodies.
        - ``extrema``: `from_nominal_min`, `from_nominal_max`, the same of `tilt` and `rate` and, unless it
          is constant, of `energy` in J: over the output times, in single precision.
        - ``regime``, ``periods``, of bodies without torques: the code of the regime; `period` of Ω in the
          body and `precession_period` about L in s, as `FreeMotion.describe`.
        - ``quantiles``: `from_nominal_quantiles`, `tilt_quantiles`, `rate_quantiles` (5, n) over the bodies
          at n times, at the levels `level`, from counts in bins of a relative width of 1/1024.
        - ``events``: `flips`, how often the tilt passes 90° between output times, with `first_flip` and
          `last_flip` in s; `beyond_10_degrees` and `beyond_90_degrees`, the first time at which
          `from_nominal` is more. Times are interpolated linearly between output times.

    Raises
    ------
    ValueError
        Without an ensemble, or with words that are unknown or do not fit; else as for `Scene.run`.
    MemoryError
        If the outputs would not fit into memory; raised before the run.

    Examples
    --------
    >>> text = '''
    ... body.moments = [1, 2, 3]
    ... initial.spin = { vector = [0, 0, 1] }
    ... ensemble = { number = 100, spin = { normal = 0.3 } }
    ... run = { duration = 10, samples = 11 }
    ... '''
    >>> with open("spins.toml", "w") as file:
    ...     _ = file.write(text)
    >>> found = ph.Scene.read("spins.toml").reduce(["last"])
    >>> found["last_omega_body"].shape
    (100, 3)
    """
    from polhode._report.ensemble.reduced_ensemble import reduce

    return reduce(self, keep, progress, threads)


def run_into(
    self: Any,
    store: str | os.PathLike[str],
    resume: bool,
    bodies: tuple[int, int] | None,
    cluster: str | None,
    progress: Callable[[int, float], object] | None,
    threads: int | None,
) -> xarray.Dataset:
    """Fill a Zarr store, as `Scene.run` does, and return its dataset."""
    from polhode._report.ensemble.fill import fill
    from polhode._support.extras import optional

    reader: Any = optional("xarray", "zarr", "a Zarr store")
    fill(self, store, resume=resume, bodies=bodies, cluster=cluster, progress=progress, threads=threads)
    dataset: xarray.Dataset = reader.open_zarr(store, chunks=None)
    return dataset


# Errors and help name what the user calls; `view` here is the function of the package.
view_of.__name__ = view_of.__qualname__ = "view"
for _method in (to_xarray, to_dataframe, save, plot, film, _repr_html_):
    setattr(Trajectory, _method.__name__, _method)
setattr(Trajectory, "read", staticmethod(read))  # noqa: B010, declared for type checkers only
for _kind in (Trajectory, Scene, ClosedForm):
    setattr(_kind, "view", explains_calls(view_of))  # noqa: B010
setattr(Scene, "reduce", reduce)  # noqa: B010
setattr(Scene, "_run_into", run_into)  # noqa: B010
for _public in (Trajectory, Scene, FreeMotion, SymmetricTop, DampedTop, LagrangeTop, LarmorSphere):
    _public.__module__ = "polhode"  # unpickling imports the class from there, with these methods
