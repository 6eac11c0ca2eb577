"""The function `polhode.view`: show a motion in a notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from polhode._mechanics.state import State
from polhode._support.calls import explains_calls

if TYPE_CHECKING:
    from polhode._viewer.widget import Viewer


@explains_calls
def view(
    x: Any,
    state: State | None = None,
    torque: Any = None,
    force: Any = None,
    *,
    duration: float | None = None,
) -> Viewer:
    """Show a motion, or values of the algebra, in a notebook.

    The page computes with the same core: if a scene describes the motion, its spin, attitude, body and
    torques can be changed in the page, and the motion follows. Page and Python are synchronised in both
    directions; see ``help(type(viewer))``.

    Parameters
    ----------
    x
        - A `Scene`, or the path of a scene file or a lesson (.md).
        - A `Trajectory` of one body, or the path of a netCDF file of one.
        - A `FreeMotion`, `LagrangeTop`, `DampedTop` or `LarmorSphere`.
        - A `Multivector`, a list of them, or a dict of them by name. The algebra page draws those of 3-d
          space, as formulas that can be changed there, and the points, lines, planes, spheres, circles and
          motors of `pga` and `cga`.
        - A `Body` or an `Inertia`; with `state`, and `torque` and `force` as for `polhode.simulate`.
    duration
        Duration in s, for bodies and closed forms; None for 20 turns at the initial rate.

    Raises
    ------
    ImportError
        Without anywidget: ``pip install 'polhode[notebook]'``.
    TypeError, ValueError, SceneError, OSError
        For values that cannot be shown, and files that cannot be read.

    Examples
    --------
    The last line of a cell shows the page. Time and scene can be read and set:

    >>> inertia = ph.Inertia.from_principal_moments(1, 2, 3)
    >>> page = ph.view(ph.FreeMotion(inertia, ph.Rotor.identity(), [0.01, 6, 0]), duration=10)
    >>> [line for line in page.scene.splitlines() if line.startswith(("moments", "spin"))]
    ['moments = [1.0, 2.0, 3.0]', 'spin = { bivector = [0.01, 6.0, 0.0] }']
    >>> page.time = 2.5
    >>> page.state.time
    2.5
    """
    from polhode._viewer.document import document
    from polhode._viewer.widget import Viewer

    return Viewer(document(x, state, torque, force, duration=duration))
