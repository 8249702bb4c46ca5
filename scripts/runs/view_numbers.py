"""Numbers of views that tables of machines show."""

from __future__ import annotations

import pathlib
import statistics
from collections.abc import Callable, Iterable, Sequence

from runs.given_files import read_json
from runs.scenes import Scene
from runs.simulations import call, said


def view_numbers(binary: pathlib.Path, scene: Scene, text: str) -> list[int]:
    """Of the cameras that --view means. Raises ValueError."""
    if text != "all":
        if not all(number.isdecimal() for number in text.split(",")):
            raise ValueError(f"--view: '{text}', expected numbers as in 0,2, or all")
        numbers = [int(number) for number in text.split(",")]
        if len(set(numbers)) < len(numbers):
            raise ValueError(f"--view: '{text}', expected each number once")
        return numbers
    return list(range(camera_count(binary, scene)))


def view_numbers_there(binary: pathlib.Path, scene: Scene, text: str) -> list[int]:
    """The same before hours of simulation. Raises ValueError also for a view that the scene has
    not, and for a built-in scene that is none."""
    there = camera_count(binary, scene)
    numbers = list(range(there)) if text == "all" else view_numbers(binary, scene, text)
    for number in numbers:
        if number >= there:
            raise ValueError(
                f"--view: got '{number}', expected numbers of {scene.name}'s cameras, "
                f"0 to {there - 1}"
            )
    return numbers


def camera_count(binary: pathlib.Path, scene: Scene) -> int:
    """Raises ValueError."""
    if scene.cameras:
        return len(cameras_of(pathlib.Path(scene.cameras)))
    done = call(binary, [scene.spec], "info")
    if done.returncode != 0:
        raise ValueError(f"{scene.name}: {said(done)}")
    (count,) = (line.split()[1] for line in done.stdout.splitlines() if line.startswith("cameras "))
    return int(count)


def cameras_of(path: pathlib.Path) -> list:
    """Raises ValueError."""
    cameras = read_json(path)
    if not isinstance(cameras, list):
        raise ValueError(f"{path}: expected a list of cameras")
    return cameras


def vsu_waits(view: dict) -> float:
    """The share of the frame in which VSU's activity that waits most for its own reads does so."""
    activities = view["units"]["vsu"]["activities"].values()
    waits = max(activity["waited_cycles"]["reads"] for activity in activities)
    return waits / view["frame"]["cycles"]


def binders(views: Sequence[dict]) -> str:
    """Each busiest resource and its share of the frame, and what holds the frame where that is
    something else: `fine 56% .. 60% -> vsu.node_memory`."""
    by_unit: dict[str, list[dict]] = {}
    for view in views:
        by_unit.setdefault(view["binding"]["unit"], []).append(view["binding"])
    return ", ".join(binder(unit, by_unit[unit]) for unit in sorted(by_unit))


def binder(unit: str, bindings: Sequence[dict]) -> str:
    shares = [binding["utilisation"] for binding in bindings]
    low, high = f"{min(shares):.0%}", f"{max(shares):.0%}"
    held_by = sorted({binding["holds"] for binding in bindings} - {unit, ""})
    text = f"{unit} {low if low == high else f'{low} .. {high}'}"
    return f"{text} -> {' or '.join(held_by)}" if held_by else text


def decibels(view: dict) -> float:
    """Infinite where the frame equals the reference picture."""
    psnr_db = view["image"]["psnr_db"]
    return float("inf") if psnr_db is None else psnr_db


def decibels_text(value: float) -> str:
    return "equal" if value == float("inf") else f"{value:.1f}"


def decibels_span(values: Iterable[float]) -> str:
    """Of one or more."""
    ordered = sorted(values)
    texts = [decibels_text(end) for end in (ordered[0], ordered[-1])]
    return texts[0] if texts[0] == texts[1] else " .. ".join(texts)


def psnr_span(views: Sequence[dict]) -> str:
    return decibels_span(map(decibels, views))


def numbers(views: Sequence[dict]) -> tuple[float, ...]:
    """Bytes on the bus, asked over once, bus over asked, cycles, frames a second, joules, mm2, and
    waiting: means over the views, but for the slowest view's frames and the worst waiting."""

    def mean(value: Callable[[dict], float]) -> float:
        return statistics.fmean(value(view) for view in views)

    return (
        mean(lambda v: v["dram"]["bus_bytes"]),
        mean(lambda v: v["limit"]["ratio"]),
        mean(lambda v: v["dram"]["bus_bytes"] / v["dram"]["bytes"]),
        mean(lambda v: v["frame"]["cycles"]),
        min(v["frame"]["fps"] for v in views),
        mean(lambda v: v["energy"]["total_j"]),
        max(v["area_mm2"]["total"] for v in views),
        max(map(vsu_waits, views)),
    )
