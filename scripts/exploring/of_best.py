"""What is told of the best configuration: its area within what sources leave open, and what it takes
at the rate that is required."""

from __future__ import annotations

from exploring.axes import label, of_scene
from exploring.measures import AREA_BAND, NAMES
from exploring.record import Work
from runs.simulations import memory_known, simulate, value_at


def between(band: dict[str, float], digits: int) -> str:
    """Middle and ends."""
    return "{middle:.{0}f} ({low:.{0}f} to {high:.{0}f})".format(digits, **band)


WITH_PHY = "with PHY and controller of the memory"


def area_band(work: Work) -> str:
    """What the area of the best may be, by what is known of it; empty where nobody asked for area,
    or for its band."""
    task, best = work.judge.task, work.made.best()
    asked = [*(o.measure for o in task.objectives), *(r.measure for r in task.requirements)]
    areas = (NAMES["mm2"], NAMES["mm2_with_phy"])
    if not best or not {measure.path for measure in (*asked, *task.shown)} & {*areas}:
        return ""
    own = of_scene(best.assignments, label(task.views[0][0].name))
    views = work.judge.machine(own)
    band = value_at(views[0], AREA_BAND) if views else None
    if not band:
        return ""
    with_phy = value_at(views[0], "area_mm2.with_memory_interface")
    return (
        f"mm2 of the best: {band['low']:.2f} to {band['high']:.2f} by its sources; "
        f"{between(with_phy, 2)} {WITH_PHY}."
    )


def power_at_rate(work: Work) -> str:
    """Watts of the best at the frames a second that are required, on the view that takes most
    joules; empty where no rate is, or joules are not known."""
    task, best = work.judge.task, work.made.best()
    rates = [r.bound for r in task.requirements if r.is_a_rate()]
    views = work.judge.draw(best.assignments, task.views).views if best and rates else ()
    joules = [value_at(v, NAMES["joules"]) if memory_known(v) else None for v in views]
    if not joules or None in joules:
        return ""
    scene, number = task.views[joules.index(max(joules))]
    run = task.run(scene, number, best.assignments)
    (view,) = simulate(work.arguments.streaminggs, run, "--frame-rate", str(rates[0])).accepted()
    (at_rate,) = view["fixed_rates"]
    if not at_rate["held"]:
        return ""
    return (
        f"W of the best at {rates[0]:g} frames a second, {scene.name} {number}: "
        f"{between(at_rate['power_w'], 3)}; "
        f"{between(at_rate['with_memory_interface_w'], 3)} {WITH_PHY}."
    )
