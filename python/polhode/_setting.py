"""What a motion was made with, beside its states: figures ask for it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from polhode._bodies import Body
    from polhode.force import Force
    from polhode.torque import Torque


@dataclass(frozen=True, eq=False)
class Setting:
    """What acted on one body; where a scene said it, the text, the file and the body in its axes.

    Attributes
    ----------
    torque, force
        As in the scene or as given to `simulate`; None where nothing acted.
    text, path, body
        Of the scene; None for a motion that was simulated without one.
    """

    torque: Torque | None
    force: Force | None
    text: str | None = None
    path: Path | None = None
    body: Body | None = None

    @property
    def held(self) -> bool:
        """Whether the body is held at a fixed point, the origin of its axes."""
        return self.torque is not None and self.torque.holds
