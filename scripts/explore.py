#!/usr/bin/env python3
"""Architecture exploration: which configurations hold what is required, and which of these no other
one beats.

  explore.py builtin:object --axis hfus=2,4,8 --axis hfu.ffu_lanes=8,16,32 --axis group=64,160x120
  explore.py truck platform yard --size 1280x720 --view all --machine exact \\
    --require 'min(fps) >= 90' --objectives mm2 --search tpe --minutes 10
  explore.py truck platform yard --recipe smallest

--axis KEY=V1,V2,... spans a grid, of which every configuration is simulated; --points FILE takes a
list instead, one configuration a line: KEY=VALUE KEY=VALUE ... KEY@each=V1,V2,... is an axis for
each scene, KEY@SCENE=... one for a single scene. With --search configurations are found by steps
from the preset along the axes (steps), or proposed by Optuna, between them those next to the best
ones; --machine adds the axes of an order's machine (exploring/axes.py) and begins at its preset.
--recipe stands for options, which the command line changes (exploring/recipes). --config takes any
machine, a tile-centric one (gscore) as well. Every exploration begins at the machine that `simulate`
runs: what memories decide there (groups, lists) stays for every configuration, and each gets as much
on-chip memory as it needs (--fit-memories), but for codebooks. Where --set, --axis or the list size a
memory, that size stands, and decides. With --stereo a frame is a picture for each eye. Tables show
what was simulated: values as the resolved configuration has them, the size of the pixel group always
among them: `group=SHAPE` stands for both of its sides.

Area is asked before a view is drawn: a configuration that is larger than what is required is drawn
on none; --search steps draws such ones on its way down from a preset that holds all else. Views
that took long are drawn first: a configuration that has lost on one of them is drawn on no other.
In a search by Optuna whose objectives any frame tells, one that is no better than another that
holds is not judged at all. No other one beats what is on the front in what is to be small, nor,
where pictures differ by 0.1 dB or more, in PSNR.

Simulations are kept in explore_runs.jsonl: interrupted or started again it goes on where it ended.
Writes explore.csv, a line for each configuration, explore.json, what its columns mean, what made
it, how many were judged and how a search ended, and exploration.svg and .png, whose axes are what
was required; filter_units.svg and .png where CFUs and FFU lanes are all that differs. For one
objective explore_best.json is the best as a configuration, explore_best_SCENE.json where scenes
have their own; the last line has the command that simulates it. With --stereo frames are judged
alone, without the display's reads and rows; one more line has the command that draws them back to
back for a display. Where min(fps) is required, the best's watts at that rate are told. Where no
configuration holds what is required, the exit status is 3, and the last line says which bounds are
missed and by how much the nearest one misses. Of what was interrupted or failed midway there are
explore_partial.csv and .json.

With --study the trials of a search or grid are kept by name in --storage, a file, or a database of
postgresql:// in which any number of workers on any number of machines take part, each started by
the same command. A dead worker's configuration is taken up again by another one.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import dataclasses
import functools
import json
import pathlib
import shlex
import sys
from collections.abc import Iterable, Sequence

from exploring import measures, options
from exploring.axes import (
    ORDERS,
    Assignments,
    Axis,
    Space,
    key_of,
    label,
    parse_axes,
    read_points,
    sizes_memory,
    with_own,
)
from exploring.judging import SMALL, SMALL_SIZE, Judge, Task, relative_to
from exploring.measures import Objective, objective, requirement, shown
from exploring.of_best import area_band, power_at_rate
from exploring.record import BY_ITSELF, Record, Work
from exploring.steps import Steps
from runs import run_arguments
from runs.files import write_text
from runs.keeper import SweepServer
from runs.scenes import Scene, find_scenes, view_numbers_there
from runs.simulations import GROUP, GROUP_KEYS, Run, expanded, read_config, simulate, value_at
from streaminggs import numbers
from tables import draw_beside

RUNS_FILE = "explore_runs.jsonl"
CHECKED_FRAMES = 8  # of the best, back to back


def machine_axes(
    arguments: argparse.Namespace, kept: SweepServer, config: dict
) -> tuple[tuple[Axis, ...], Assignments]:
    """Of --machine, with what its order has set, on axes that fit what a blend takes. Raises
    ValueError where what --config names is of another machine."""
    if not arguments.machine:
        return (), ()
    order = ORDERS[arguments.machine]
    options.check_machine(order, config, arguments.config)
    own = (*order.fixed, *expanded(arguments.set))
    # Of a run of its own, since what is swept keeps no schedules.
    run = dataclasses.replace(
        small_run(arguments), overrides=own, fit_memories=not sizes_memory(own)
    )
    (view,) = simulate(kept.binary, run).accepted()
    blend = order.with_blend(view["datapath"][order.blend]["used"]["macs"])
    return with_own(blend.axes, config), order.fixed


def open_memories(config: dict) -> Assignments:
    return tuple(f"sram.{key}=0" for key in config["sram"] if key != "codebook_bytes")


def small_run(arguments: argparse.Namespace) -> Run:
    return Run(SMALL, size=SMALL_SIZE, config=arguments.config, stereo=arguments.stereo)


def config_of(arguments: argparse.Namespace, kept: SweepServer) -> dict:
    """What --config names, with all keys that its machine has. Of two eyes its memories are left
    open, since those for one may be too small."""
    run = small_run(arguments)
    if arguments.stereo:
        fitted = read_config(kept.binary, dataclasses.replace(run, fit_memories=True))
        run = dataclasses.replace(run, overrides=open_memories(fitted))
    return read_config(kept.binary, run)


def find_space(arguments: argparse.Namespace, axes: Sequence[Axis], scopes: Sequence[str]) -> Space:
    """Raises ValueError where there is nothing to choose from, or --set has no effect on it."""
    if arguments.points:
        space = Space(read_points(arguments.points))
    else:
        space = Space(parse_axes(arguments.axis, axes, scopes))
    if not space.axes:
        raise ValueError("expected --axis, --points or --machine: what to choose from")
    options.check_set(arguments.set, space.axes)
    return space


def check_keys(
    arguments: argparse.Namespace,
    space: Space,
    scopes: Sequence[str],
    beside: Iterable[Assignments],
    config: dict,
) -> None:
    """Raises ValueError for what the machine that is explored has not."""
    chosen = [s for axis in space.axes for setting in axis.settings for s in setting]
    for place, settings in (
        ("--set", expanded(arguments.set)),
        ("--points" if arguments.points else "--axis", chosen),
        ("--beside", [s for assignments in beside for s in assignments]),
    ):
        options.check_keys(place, settings, scopes, config, arguments.config)


def objectives_of(text: str) -> tuple[Objective, ...]:
    """Raises ValueError."""
    found = tuple(map(objective, text.split(",")))
    asked = [(o.measure.aggregate, o.measure.path) for o in found]
    for o, measure in zip(found, asked):
        if asked.count(measure) > 1:
            raise ValueError(f"--objectives: {o.name}: there are two")
    return found


def default_objectives(config: dict) -> str:
    """Without filters where the machine has none."""
    return options.OBJECTIVES if "hfu" in config else options.OBJECTIVES.replace("filter_lanes,", "")


def find_task(
    arguments: argparse.Namespace,
    scenes: Sequence[Scene],
    keys: Sequence[str],
    fixed: Sequence[str],
    config: dict,
) -> Task:
    """config: of the machine that is explored, which tells what it has."""
    views = [
        (scene, number)
        for scene in scenes
        for number in view_numbers_there(arguments.streaminggs, scene, arguments.view)
    ]
    return Task(
        views=tuple(views),
        keys=tuple(dict.fromkeys([*keys, *((GROUP,) if GROUP_KEYS[0] in config else ())])),
        size=arguments.size,
        config=arguments.config,
        base=expanded((*fixed, *arguments.set)),
        objectives=objectives_of(arguments.objectives or default_objectives(config)),
        requirements=tuple(map(requirement, arguments.require)),
        shown=shown(arguments.show),
        open_memories=open_memories(config),
        stereo=arguments.stereo,
    )


def with_decided(task: Task, binary: pathlib.Path, view: str, config: dict) -> Task:
    """What the beginning's memories decide stays for all configurations. Raises ValueError where
    they cannot."""
    if sizes_memory(task.base):
        return task
    left_open = {key_of(each) for each in task.base if each.endswith("=0")}

    def decided_for(scene: Scene) -> Assignments:
        begin = Run(scene, view, task.size, task.config, task.base, True, task.stereo)
        told = numbers(read_config(binary, begin)).items()
        return tuple(
            f"{key}={value}"
            for key, value in told
            if value
            and not key.startswith("sram.")
            and (key in left_open or value_at(config, key) == 0)
        )

    scenes = dict.fromkeys(scene for scene, _ in task.views)
    found = {label(scene.name): decided_for(scene) for scene in scenes}
    # The smallest frame there is shows another scene.
    machine = tuple(a for a in next(iter(found.values())) if not a.startswith("storage."))
    return dataclasses.replace(task, decided={**found, "": machine})


def explore_all(work: Work) -> None:
    """Every configuration there is, side by side, and each once."""
    points = [work.space.assignments(at) for at in work.space.all()]
    done: set[Assignments] = set()

    def one(assignments: Assignments) -> None:
        work.made.add(work.judge.judged(assignments))
        with work.reporting:
            done.add(assignments)
            work.progress(len(done), len(points))

    with concurrent.futures.ThreadPoolExecutor(work.arguments.j) as pool:
        waiting = [pool.submit(one, point) for point in points]
        try:
            for each in waiting:
                each.result()
        finally:
            pool.shutdown(cancel_futures=True)
    # In the order of the grid, whichever was ready first.
    for point in points:
        work.made.add_last(work.made.judged[point])


def path_of_best(arguments: argparse.Namespace, scene: str) -> pathlib.Path:
    """scene: what tells its name apart, as best_configurations() has it."""
    return arguments.out / f"explore_best{scene}.json"


def run_of_best(work: Work, scene: str) -> Run:
    """Of the best on the first view that it is for."""
    task = work.judge.task
    of, view = next(v for v in task.views if scene in ("", f"_{v[0].name}"))
    path = str(path_of_best(work.arguments, scene))
    return Run(of, str(view), task.size, path, stereo=task.stereo)


def stream_of(run: Run, rate: float) -> list[str]:
    """The same machine with frames back to back, which a display reads at a rate; memories as large
    as that needs."""
    words = [run.scene.spec, *dataclasses.replace(run, fit_memories=True).configuration_arguments()]
    words += ["--size", run.size] if run.size else []
    words += ["--stereo", run.stereo, "--path", run.scene.cameras or "builtin:path"]
    words += ["--frames", str(CHECKED_FRAMES), "--stream"]
    return [*words, "--frame-rate", f"{rate:g}"] if rate else words


def say_best(work: Work, scene: str) -> None:
    """The command that simulates it; of two eyes, whose frames were judged alone, also as a headset
    draws them."""
    run = run_of_best(work, scene)
    path = path_of_best(work.arguments, scene)
    print(f"best: {path}: {shlex.join(['streaminggs', 'simulate', *run.arguments()])}")
    if run.stereo:
        rates = [r.bound for r in work.judge.task.requirements if r.is_a_rate()]
        words = ["streaminggs", "simulate", *stream_of(run, max(rates, default=0))]
        print(f"its frames were judged alone; back to back, for a display: {shlex.join(words)}")
    sys.stdout.flush()


def is_studied(arguments: argparse.Namespace) -> bool:
    return arguments.search in options.SAMPLERS or bool(arguments.study)


def explore(arguments: argparse.Namespace) -> None:
    try:
        explore_checked(arguments)
    except ValueError as error:
        raise ValueError(options.in_its_recipe(arguments, str(error))) from error


def explore_checked(arguments: argparse.Namespace) -> None:
    options.check_arguments(arguments)
    if is_studied(arguments):
        run_arguments.need("optuna", "python3-optuna")
    scenes = find_scenes(arguments.scenes, arguments.cameras)
    with SweepServer(arguments.streaminggs, arguments.out / RUNS_FILE, arguments.j) as kept:
        explore_with(kept, arguments, scenes)


def explore_with(kept: SweepServer, arguments: argparse.Namespace, scenes: Sequence[Scene]) -> None:
    config = config_of(arguments, kept)
    axes, fixed = machine_axes(arguments, kept, config)
    scopes = [label(scene.name) for scene in scenes]
    space = find_space(arguments, axes, scopes)
    beside = options.parse_beside(arguments.beside)
    check_keys(arguments, space, scopes, beside, config)
    keys = [*space.keys(), *Space((Axis("", tuple(beside)),)).keys()] if beside else space.keys()
    task = find_task(arguments, scenes, keys, fixed, config)
    options.check_search(arguments.search, task)
    task = with_decided(task, arguments.streaminggs, arguments.view, config)
    options.check_measures(task, Judge(task, kept.outcomes))
    task = relative_to(task, kept.outcomes)
    judge = Judge(task, kept.outcomes)
    work = Work(arguments, space, judge, Record(task, beside))
    complete = False
    try:
        for assignments in beside:
            work.made.add(judge.judged(assignments))
        if is_studied(arguments):
            from exploring import sampling  # Optuna is not everybody's

            sampling.explore(work, kept.program)
        elif arguments.search:
            Steps(work).search()
        else:
            explore_all(work)
        if arguments.search:
            work.made.ended = work.made.ended or BY_ITSELF
        kept.end()
        complete = True
    finally:
        if not complete and work.made.told():
            remark = "Not complete: what was judged so far.\n\n"
            work.made.write(arguments.out, "explore_partial", arguments.streaminggs, remark)
    if not work.made.told():
        why = work.made.not_told() or ["there was no time for any configuration (--minutes)"]
        raise ValueError(why[0].removeprefix("Refused: "))
    work.made.remarks += [area_band(work), power_at_rate(work)]
    work.made.write(arguments.out, "explore", arguments.streaminggs)
    for earlier in arguments.out.glob("explore_best*.json"):
        earlier.unlink()
    best = work.best_configurations(functools.partial(read_config, kept.binary))
    for scene, document in best.items():
        write_text(path_of_best(arguments, scene), json.dumps(document, indent=2) + "\n")
    draw_beside(arguments.out, "exploration", "filter_units")
    print(f"written to {arguments.out}")
    for scene in best:
        say_best(work, scene)
    if said := work.made.none_holds():
        raise run_arguments.NoneHolds(said)


def main() -> int:
    arguments = options.parsed(options.parser(f"{__doc__}\n{measures.__doc__}"), sys.argv[1:])
    return run_arguments.main_of_tables(explore, arguments)


if __name__ == "__main__":
    sys.exit(main())
