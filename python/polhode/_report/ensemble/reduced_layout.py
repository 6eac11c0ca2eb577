"""Layout of the reduced outputs of an ensemble: their variables, shared by its files."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from polhode import _native
from polhode._report.ensemble.collect import LEVELS
from polhode._report.ensemble.layout import EnsembleLayout, Variable, flags
from polhode._report.ensemble.reduced import ReducedBlock
from polhode._report.netcdf import MOTION
from polhode._scene.scene import Scene
from polhode._support.arrays import Array

# Names in files of the series whose extrema are kept, with unit and description; in the order of `rows`.
# `{tilt}` stands for the tilt in words, which say of what it is and from what.
_EXTREMA = {
    "from_nominal": ("rad", "angle between the attitude and that of the nominal body"),
    "tilt": ("rad", "{tilt}"),
    "rate": ("rad/s", "angular velocity |Omega|"),
    "energy": ("J", "rotational kinetic and potential energy"),
}
# The numbers of `rows` after the extrema.
_EVENTS = {
    "flips": ("1", "number of times that the {tilt} passes 90 degrees between output times"),
    "first_flip": ("s", "first time of a flip, interpolated"),
    "last_flip": ("s", "last time of a flip, interpolated"),
    "beyond_10_degrees": ("s", "first time at which the attitude is over 10 degrees from the nominal one"),
    "beyond_90_degrees": ("s", "first time at which the attitude is over 90 degrees from the nominal one"),
}
_PERIODS = {"period": "period of the angular velocity in the body", "precession_period": "precession about L"}


class ReducedLayout(EnsembleLayout):
    """The variables of an ensemble whose motions are not kept.

    Points and given numbers are written; drawn parameters, inertia included, are not: they follow from the
    seed.
    """

    def __init__(self, scene: Scene) -> None:
        super().__init__(scene)
        self._keep = self._ensemble.keep

    def attributes(self) -> dict[str, Any]:
        """Return the attributes of the data: text and numbers."""
        return {**super().attributes(), "keep": " ".join(self._keep)}

    def shared(self) -> Iterator[Variable]:
        """Yield the variables that all bodies share, without the labels."""
        yield from super().shared()
        if "quantiles" in self._keep:
            yield Variable("level", ("level",), np.array(LEVELS), "1", "level of a quantile")

    def of_bodies(self, rows: slice, block: Any) -> Iterator[Variable]:
        """Yield the variables of a `ReducedBlock`, without the method and the number of the body."""
        columns = block.columns
        meanings = flags(["complete", "failed"])
        yield Variable("failed", (), (~block.ok).astype(np.int8), "1", "1 if the body failed", meanings)
        if "last" in self._keep:
            yield from self._last(columns)
        if "extrema" in self._keep:
            yield from self._extrema(columns["rows"], block.tilt)
        if "events" in self._keep:
            yield from _events(columns["rows"], block.tilt)
        if "regime" in self._keep:
            names = ["none", *(_word(name) for name in _native.regimes())]
            text = "regime of the free motion"
            yield Variable("regime", (), columns["regime"], "1", text, flags(names, -1))
        if "periods" in self._keep:
            for name, text in _PERIODS.items():
                yield Variable(name, (), columns[name], "s", text)
        if self._ensemble.points is not None:
            yield from self._points(rows, self._ensemble.points)

    def _last(self, columns: dict[str, Array]) -> Iterator[Variable]:
        wxyz = columns["rotor"] * np.array([1.0, -1.0, -1.0, -1.0])
        for name, values in {"attitude": wxyz, **columns}.items():
            moved = name in ("position", "velocity") and name in self._notes
            if moved or name in ("attitude", "omega_body"):
                dims, units, text = MOTION[name]
                yield Variable(f"last_{name}", dims, values, units, f"{text}, at the last output time")

    def _extrema(self, rows: Array, tilt: str) -> Iterator[Variable]:
        for k, (name, (units, text)) in enumerate(_EXTREMA.items()):
            if self._notes.get(name, None) is None:  # constant quantities have no extrema
                for end, (word, least) in enumerate((("min", "smallest"), ("max", "largest"))):
                    label = f"{least} over the output times: {text.format(tilt=tilt)}"
                    yield Variable(
                        f"{name}_{word}", (), rows[:, 2 * k + end].astype(np.float32), units, label
                    )


def _events(rows: Array, tilt: str) -> Iterator[Variable]:
    for k, (name, (units, text)) in enumerate(_EVENTS.items()):
        values = rows[:, 2 * len(_EXTREMA) + k]
        text = text.format(tilt=tilt)
        yield Variable(name, (), values.astype(np.int32) if name == "flips" else values, units, text)


def _word(name: str) -> str:
    """Return the name of a regime as a word of `flag_meanings`."""
    return name.replace(",", "").replace(" ", "_")


def layout_of(scene: Scene) -> EnsembleLayout:
    """Return the layout of a scene's ensemble."""
    assert scene.ensemble is not None
    return ReducedLayout(scene) if scene.ensemble.keep else EnsembleLayout(scene)


def bytes_of_body(scene: Scene) -> int:
    """Return the bytes of a body in a file of reduced outputs."""
    assert scene.ensemble is not None
    one = np.full((1, 13), 0.0)
    columns = {"rotor": one[:, :4], "rows": one, "regime": np.zeros(1, np.int8)}
    columns |= dict.fromkeys(("omega_body", "position", "velocity"), one[:, :3])
    columns |= dict.fromkeys(_PERIODS, one[:, 0])
    block = ReducedBlock(columns, None, (), None)  # type: ignore[arg-type]
    number_and_method = 8 + 1
    found = ReducedLayout(scene).of_bodies(slice(0, 1), block)
    return number_and_method + sum(int(variable.values.nbytes) for variable in found)
