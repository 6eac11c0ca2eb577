"""Motions shown in notebooks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from polhode._mechanics.state import State

if TYPE_CHECKING:
    from polhode._viewer.widget import Viewer


def view(
    x: Any,
    state: State | None = None,
    torque: Any = None,
    force: Any = None,
    *,
    duration: float | None = None,
) -> Viewer:
    """Show a motion in a notebook, with controls for the scene that says it.

    The page computes with the same core: of a motion that a scene can say, spin, attitude, body and torques
    can be changed there, and the motion follows. What is changed there is changed here, and the other way
    round; see ``help(type(viewer))``.

    Parameters
    ----------
    x
        - A `Scene`, or the path of a scene file.
        - A `Trajectory` of one body, or the path of a netCDF file of one.
        - A `FreeMotion`, `LagrangeTop`, `DampedTop` or `LarmorSphere`.
        - A `Body` or an `Inertia`; with `state`, and `torque` and `force` as for `polhode.simulate`.
    duration
        For how long, in s, of motions that have no end of their own; None for 20 turns at the initial rate.

    Raises
    ------
    ImportError
        Without anywidget: ``pip install 'polhode[notebook]'``.
    TypeError, ValueError, SceneError, OSError
        For what cannot be shown, and files that cannot be read.
    """
    from polhode._viewer.document import document
    from polhode._viewer.widget import Viewer

    return Viewer(document(x, state, torque, force, duration=duration))
