"""What machines take of area, and what a step along an axis changes."""

from __future__ import annotations

from collections.abc import Callable

from runs.kept_runs import KeptRuns
from machine_axes import Machine, Order
from runs.scenes import Scene
from runs.simulations import Outcome, Run

# Area is that of the machine, whatever it draws: the smallest frame there is tells it.
SMALL = Scene("area", "builtin:object?n=500")
SMALL_SIZE = "64x36"
# How many there are of what other axes make larger, and what excludes what.
STRUCTURE = ("hfus", "fetch", "rendering.clusters")


def area_mm2(view: dict) -> float:
    return view["area_mm2"]["total"]


def start_of(order: Order, simulate: Callable[[Run], Outcome]) -> Machine:
    """The machine that is nearest to the order's preset, on axes that fit what a blend takes."""
    run = Run(SMALL, size=SMALL_SIZE, config=order.preset, overrides=order.fixed)
    (view,) = simulate(run).accepted()
    blend = view["datapath"]["subtile_blend"]["used"]["macs"]
    return order.with_blend(blend).start(view["config"])


class Areas:
    """Areas of machines of any order, each simulated once."""

    def __init__(self, kept: KeptRuns):
        self.kept = kept
        self.steps: dict[tuple, tuple[int, float] | None] = {}

    def of(self, machine: Machine) -> float | None:
        """Where storage takes least of it; what a scene's own takes, its views tell. None: there is
        no such machine."""
        overrides = (*machine.overrides(), *machine.order.storage.settings[0])
        run = Run(SMALL, size=SMALL_SIZE, config=machine.order.preset, overrides=overrides)
        views = self.kept.outcome(run).views
        return area_mm2(views[0]) if views else None

    def neighbour(self, machine: Machine, which: int, step: int) -> Machine | None:
        """The next machine along an axis that there can be."""
        moved = machine.moved(which, step)
        while moved and self.of(moved) is None:
            moved = moved.moved(which, step)
        return moved

    def step_back(self, machine: Machine, which: int) -> tuple[Machine, float] | None:
        """The next machine with less on an axis, and about how much area it frees: as much as it
        did for the last machine that was alike in structure."""
        axes = machine.order.axes
        alike = [at for axis, at in zip(axes, machine.at) if axis.name in STRUCTURE]
        key = (machine.order.name, which, machine.at[which], *alike)
        if key not in self.steps:
            back = self.neighbour(machine, which, -1)
            self.steps[key] = back and (back.at[which], self.of(machine) - self.of(back))
        if not (known := self.steps[key]):
            return None
        return machine.moved(which, known[0] - machine.at[which]), known[1]
