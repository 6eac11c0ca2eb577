"""Problem: the arguments of a simulation of one body."""

from __future__ import annotations

from dataclasses import dataclass

from polhode._mechanics.bodies import Body
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.state import State
from polhode._support.arrays import Array
from polhode.force import Force
from polhode.torque import Torque


@dataclass(frozen=True, eq=False)
class Problem:
    """The arguments of `polhode.simulate` for one body, whose state is the single one at the start.

    The tolerance is the larger one of rtol and atol, `limits` are `max_step`, `max_steps` and `breaks`.
    """

    body: Body | Inertia
    state: State
    torque: Torque | None
    force: Force | None
    times: Array
    method: str = "auto"
    step: float | None = None
    tolerance: float | None = None
    limits: tuple[float | None, float | None, list[float]] = (None, None, [])

    @property
    def held(self) -> bool:
        """Whether the body is held at a fixed point, the origin of its axes."""
        return self.torque is not None and self.torque.holds
