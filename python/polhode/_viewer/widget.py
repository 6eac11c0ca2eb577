"""The notebook widget: a viewer whose state is synchronised with Python."""

from __future__ import annotations

import math
import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._algebra.constructors import bivector, vector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.state import State
from polhode._mechanics.trajectory import Trajectory
from polhode._scene.scene import Scene
from polhode._support.extras import optional
from polhode._support.files import form_of, write_atomically
from polhode._viewer.document import Document, document, scene_of
from polhode._viewer.html import bundle_path, page
from polhode._viewer.recording import state_at

if TYPE_CHECKING:
    import anywidget
    import traitlets
else:
    anywidget = optional("anywidget", "notebook", "a viewer in a notebook")
    traitlets = optional("traitlets", "notebook", "a viewer in a notebook")

# As in viewer/src/document.ts.
CAMERAS = ("oblique", "along e1", "along e2", "along e3", "along L", "with the body")
THEMES = ("auto", "light", "dark")
DRAWN = (
    *("body", "bodyFrame", "spaceFrame", "omega", "momentum", "torque", "sources", "axial", "poinsot"),
    *("polhode", "herpolhode", "trace", "energy", "ghost", "gravity", "labels"),
)

_VIEW = ("time", "playing", "speed", "camera", "theme", "shown")


def _state_of(numbers: dict[str, Any] | None, _: Any) -> State | None:
    """Return the state that the page sent."""
    if numbers is None:
        return None
    rotor = Rotor.from_components(numbers["rotor"])
    place, velocity = vector(numbers["position"]), vector(numbers["velocity"])
    return State(rotor, bivector(numbers["omega_body"]), place, velocity, time=numbers["time"])


class _StateShown(traitlets.Instance):  # type: ignore[type-arg]
    """The state reported by the page; computed here for a time or scene that it has not reported yet."""

    def get(self, obj: Any, cls: Any = None) -> State | None:
        reported: State | None = super().get(obj, cls)
        return reported if obj._sending or obj._is_reported() else obj._state_now()


class Viewer(anywidget.AnyWidget):
    """A motion in a notebook; created by `polhode.view`. Works in every front end that anywidget supports.

    Attributes except `state` and `problem` can be set; all can be observed, as those of other widgets. Until
    a page shows the widget, attributes of the view that were not set are None; then they are what the page
    shows. While the motion plays, the page reports time and state ten times a second, and exactly when it
    stops.

    Attributes
    ----------
    scene
        The scene in TOML, as edited in the page; None if the motion is a recording alone. The page does not
        accept an invalid scene: `problem` has the reason.
    time
        Time shown, in s.
    playing
        Whether the motion plays.
    speed
        Seconds of motion per second.
    camera
        Camera preset: "oblique", "along e1", "along e2", "along e3", "along L" or "with the body".
    theme
        "auto", "light" or "dark".
    shown
        Visibility by name: body, bodyFrame, spaceFrame, omega, momentum, torque, sources, axial, poinsot,
        polhode, herpolhode, trace, energy, ghost, gravity, labels. Names that are left out do not change.
    state
        The `State` at `time` of the motion of `scene`, as the page reports it. After time or scene were set
        here, until the page has answered, it is computed here, with the errors of `run`. None if `time` is.
    problem
        The errors of the scene with their places; None if it is valid.
    document
        The document that the page was given.
    """

    _esm = bundle_path()

    document = traitlets.Dict().tag(sync=True)
    scene = traitlets.Unicode(None, allow_none=True).tag(sync=True)
    time = traitlets.CFloat(None, allow_none=True).tag(sync=True)
    playing = traitlets.Bool(None, allow_none=True).tag(sync=True)
    speed = traitlets.CFloat(None, allow_none=True).tag(sync=True)
    camera = traitlets.Enum(CAMERAS, None, allow_none=True).tag(sync=True)
    theme = traitlets.Enum(THEMES, None, allow_none=True).tag(sync=True)
    shown = traitlets.Dict(key_trait=traitlets.Enum(DRAWN), value_trait=traitlets.Bool()).tag(sync=True)
    state = _StateShown(State, allow_none=True, read_only=True).tag(
        sync=True, from_json=_state_of, to_json=lambda state, _: None
    )
    problem = traitlets.Unicode(None, allow_none=True, read_only=True).tag(sync=True)

    # Time, scene and document of the last state that the page reported.
    _reported: tuple[Any, ...] | None = None
    # Scene text, document, scene and motion of the last state that was computed here.
    _computed: tuple[Any, Any, Scene, Trajectory] | None = None
    _sending = False

    def __init__(self, shown: Document) -> None:
        super().__init__(document=shown, scene=shown.get("scene"))

    def set_state(self, sync_data: dict[str, Any]) -> None:
        """Apply changes from the page; called by ipywidgets."""
        if "state" in sync_data:
            time = (
                sync_data.get("time", self.time) if sync_data["state"] is None else sync_data["state"]["time"]
            )
            self._reported = (time, sync_data.get("scene", self.scene), self.document)
        super().set_state(sync_data)

    def get_state(self, key: Any = None, drop_defaults: bool = False) -> dict[str, Any]:
        """Return the values to send to the page, without `state`; called by ipywidgets."""
        self._sending = True
        try:
            return super().get_state(key, drop_defaults)  # type: ignore[no-any-return]
        finally:
            self._sending = False

    def _is_reported(self) -> bool:
        time, scene, document = self._reported or (None, None, None)
        return document is self.document and (time, scene) == (self.time, self.scene)

    def _state_now(self) -> State | None:
        """Return the state at `time`, or at the end of the motion if that is earlier."""
        if self.time is None:
            return None
        if "recorded" in self.document and self.scene == self.document.get("scene"):
            return state_at(self.document["recorded"], self.time)
        known = self._computed
        if known is None or known[0] != self.scene or known[1] is not self.document:
            scene = self.to_scene().alone()
            known = self._computed = (self.scene, self.document, scene, scene.run())
        *_, scene, motion = known
        first, last = motion.time[[0, -1]].tolist()
        if motion.certificate.method == "exact" and not first <= self.time <= last:
            motion = replace(scene, times=np.array([self.time])).run()
            return motion.at(self.time)
        return motion.at(min(max(self.time, first), last))

    @traitlets.validate("time", "speed")
    def _finite(self, proposal: Any) -> float | None:
        value, name = proposal["value"], proposal["trait"].name
        if value is not None and not math.isfinite(value):
            raise traitlets.TraitError(f"{name} is {value}; it must be finite")
        return value  # type: ignore[no-any-return]

    def show(self, x: Any, *arguments: Any, **named: Any) -> None:
        """Show another motion, from its start; the arguments are those of `polhode.view`."""
        shown = document(x, *arguments, **named)
        with self.hold_sync():
            self.document, self.scene = shown, shown.get("scene")
            self.time = self.speed = None
            self.set_trait("problem", None)

    def run(self) -> Trajectory:
        """Return the motion of the current scene of the page, computed here.

        A ValueError if there is no scene; a SceneError if it is invalid.
        """
        return self.to_scene().run()

    def to_scene(self) -> Scene:
        """Return the current scene of the page. Errors as in `run`."""
        if self.scene is None:
            raise ValueError("this motion is a recording without a scene and cannot be run again")
        return scene_of({**self.document, "scene": self.scene})

    def html(self) -> str:
        """Return a self-contained page that shows the current state."""
        return page(self._now())

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the page of `html` to FILE.html, whole or not at all. A ValueError for another suffix."""
        form_of(path, "a page")
        write_atomically({Path(path): self.html().encode()})

    def _now(self) -> Document:
        """Return the document of the current state."""
        now: Document = dict(self.document)
        if self.scene != now.get("scene"):
            now["scene"] = self.scene
            now.pop("recorded", None)
        view = {name: getattr(self, name) for name in _VIEW}
        now["view"] = {name: x for name, x in view.items() if x not in (None, {})}
        return now
