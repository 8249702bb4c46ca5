"""A search by steps along the axes, for one objective. Nothing in it is left to chance.

Where any frame tells the objective (area), resources are taken away a step at a time, that step
first which frees most for the room that it costs under what is required, on the hardest view. A
step after which that is missed is not tried again. When none is left the other views are drawn,
those with least room first, until one misses what is required: that becomes a hardest view beside
the first, and it begins again. Where time is over before, the smallest that holds on all views is
looked for among those on the way down.

Where frames tell it (cycles), the search tries each setting of the first axis, then moves along one
axis at a time. What is required of the machine is a budget: what takes more is paid for by steps
back on other axes, those first that were seen to harm least for what they free. It looks at one
view of each scene, two at a time, and gives up what is clearly worse; the best few are drawn on all
views.

Either begins at the preset. Where that misses what is required, it first gets more of what the
hardest view's binding names, or where that gains nothing, of what gains most for its area.

A machine that is larger than what is required is not drawn, with one exception: on its way to the
smallest, a search draws those between a preset that holds all else and what is allowed.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Iterator, Sequence

from exploring.axes import At, label
from exploring.judging import Drawn, Judged, Machines, View
from exploring.record import Work

LEAST_GAIN = math.log(1.003)  # in what is required: what a step is worth taking for
MOST_ROOM = 100.0  # where nothing is required of frames, or what is has no end
BETTER = 0.001  # of the objective's logarithm, to be taken for a gain
FREED = 0.003  # of the budget, to be taken where nothing is lost
UNKNOWN_HARM = 0.02
GIVEN_UP = 0.06  # worse on the views drawn, over their number: others may still make up for it
AT_ONCE = 2  # frames side by side
PATIENCE = 2  # settings in a row that are no better, of what is chosen for one scene
FINALISTS = 3


class NoTime(Exception):
    """--trials or --minutes are over."""


@dataclasses.dataclass(frozen=True)
class Point:
    at: At
    views: tuple[dict, ...]


class Steps:
    """looked: configurations drawn so far, each with how many views."""

    def __init__(self, work: Work):
        self.work, self.space, self.judge = work, work.space, work.judge
        self.task = work.judge.task
        (self.objective,) = self.task.objectives
        self.machines = Machines(self.space, self.judge)
        self.of_machines = self.task.of_machines()
        self.of_frames = [r for r in self.task.requirements if r not in self.of_machines]
        self.single = all(r.is_of_single_views() for r in self.of_frames)
        self.looked: dict[At, int] = {}
        self.harm: dict[int, float] = {}
        self.seen: set[At] = set()
        self.points: list[Point] = []
        self.hardest_first = list(self.task.views)  # views

    def search(self) -> None:
        """Into work.made. Raises ValueError where the preset is refused."""
        start = self.judge.start(self.space)
        try:
            if self.machines.size(start) is None:  # a view says why
                self.look(start, self.task.views[:1])
                return
            if self.task.of_the_machine():
                self.smallest(start)
                return
            self.best(start)
        except NoTime:
            if self.task.of_the_machine():
                self.smallest_on_all()
                return
        self.draw_finalists()

    # Drawing.

    def draw(self, at: At, views: Sequence[View]) -> Drawn:
        """Raises NoTime."""
        if not self.may_draw(at):
            raise NoTime
        return self.judge.draw(self.space.assignments(at), views)

    def may_draw(self, at: At) -> bool:
        if at not in self.looked:
            if not self.work.may_look(len(self.looked), self.work.most()):
                return False
            self.looked[at] = 0
        return True

    def tell(self, at: At, drawn: Drawn, views: Sequence[dict]) -> None:
        """What was seen of it."""
        assignments = self.space.assignments(at)
        if not drawn.views:
            judged = Judged(assignments, refused=drawn.refused, failed=drawn.failed)
        else:
            part = f"{len(views)} of {len(self.task.views)} views were looked at"
            dropped = part if len(views) < len(self.task.views) else ""
            judged = self.judge.summed(assignments, views, dropped)
        if len(views) < self.looked[at]:
            return
        self.work.made.add(judged)
        if not self.looked[at]:
            self.work.progress(len(self.looked), self.work.most())
        self.looked[at] = max(len(views), 1)

    def room(self, views: Sequence[dict]) -> float:
        """Under all that frames tell of what is required; below 0 it is missed."""
        return min([MOST_ROOM, *(r.room(views) for r in self.of_frames)])

    def look(self, at: At, views: Sequence[View]) -> tuple[dict, ...]:
        """All these views; none where one is refused."""
        drawn = self.draw(at, views)
        self.tell(at, drawn, drawn.views)
        return drawn.views

    def look_until_missed(self, at: At, watched: Sequence[View]) -> tuple[dict, ...]:
        """Views one after the other, or AT_ONCE, to the first that misses what is required by
        itself; none where one is refused."""
        return self.look_at_each([at], watched)[at]

    def look_at_each(self, ats: Sequence[At], watched: Sequence[View]) -> dict[At, tuple]:
        """The same of several, side by side, up to the first that there is no time for. Raises
        NoTime where that is the first of all."""
        left = list(itertools.takewhile(self.may_draw, ats))
        if not left:
            raise NoTime
        found: dict[At, tuple] = dict.fromkeys(left, ())
        at_once = max(1, AT_ONCE // len(left)) if self.single else len(watched)
        for first in range(0, len(watched), at_once):
            configurations = [self.space.assignments(at) for at in left]
            some = watched[first : first + at_once]
            for at, drawn in zip(left, self.judge.draw_each(configurations, some)):
                found[at] = drawn.views and (*found[at], *drawn.views)
                self.tell(at, drawn, found[at])
            left = [at for at in left if found[at] and self.room(found[at]) >= 0]
            if not left:
                break
        return found

    def hardest(self, views: Sequence[dict], watched: Sequence[View]) -> list[View]:
        """The view with least room; all that are watched where they are judged together only."""
        if not self.single:
            return list(watched)
        worst = min(views, key=lambda view: self.room([view]))
        of = (worst["scene_name"], worst["view"])
        return [view for view in watched if (view[0].name, view[1]) == of]

    # What holds what is required, and is small.

    def smallest(self, at: At) -> None:
        start, watched = at, []
        views = self.look(at, self.task.views)
        if self.single:
            views = sorted(views, key=lambda view: self.room([view]))
            places = {(scene.name, n): (scene, n) for scene, n in self.task.views}
            self.hardest_first = [places[v["scene_name"], v["view"]] for v in views]
        while views:
            hardest = self.hardest(views, self.task.views)
            if watched and (self.room(views) >= 0 or set(hardest) <= set(watched)):
                return
            watched += hardest
            if not (start := self.grown(start, watched)):
                return
            at = self.shrunk(start, watched)
            views = self.look_until_missed(at, self.hardest_first)

    def smallest_on_all(self) -> None:
        """Of those that hold on the views watched, from the smallest on, each time twice as far,
        until one holds on all."""
        ranked = sorted({point.at for point in self.points}, key=self.machines.size)
        at, step = 0, 1
        while at < len(ranked):
            best = self.work.made.best()
            if best and best.costs[0] <= self.machines.size(ranked[at]):
                return
            views = self.look_until_missed(ranked[at], self.hardest_first)
            if views and self.room(views) >= 0:
                return
            at, step = at + step, 2 * step

    def grown(self, at: At, watched: Sequence[View]) -> At | None:
        """With more of what gains room on the hardest view, until there is enough; None where that
        is never."""
        while True:
            views = self.look_until_missed(at, watched)
            if views and self.room(views) >= 0:
                return at
            more = views and self.roomier(at, self.hardest(views, watched), views)
            if views and not more and self.machines.share(at) > 1:
                more = self.fitted(at, ())
            if not more:
                self.work.made.remarks.append(
                    f"One step on any axis gains less than {math.expm1(LEAST_GAIN):.1%} of what is "
                    f"required from {' '.join(self.space.assignments(at))}."
                )
                return None
            at = more

    def roomier(self, at: At, hardest: Sequence[View], views: Sequence[dict]) -> At | None:
        """One step further: on the axis that the view's binding names, or where that has no more or
        gains nothing, on the one that gains most for what it takes."""
        worst = min(views, key=lambda view: self.room([view]))
        room = self.room([worst] if len(hardest) == 1 else views)
        ahead = {
            axis.name: more
            for n, axis in enumerate(self.space.axes)
            if (more := self.allowed_ahead(at, n))
        }
        key = worst["binding"].get("key", "")
        for tried in ([key] if key in ahead else [], [name for name in ahead if name != key]):
            worth, found = {}, {}
            for first in range(0, len(tried), AT_ONCE):
                some = tried[first : first + AT_ONCE]
                found |= self.look_at_each([ahead[name] for name in some], hardest)
            for name in tried:
                further = found.get(ahead[name])
                gain = self.room(further) - room if further else 0
                if gain >= LEAST_GAIN:
                    worth[name] = gain / max(
                        self.machines.size(ahead[name]) - self.machines.size(at), 1e-3
                    )
            if worth:
                return ahead[max(worth, key=lambda name: worth[name])]
        return None

    def allowed_ahead(self, at: At, which: int) -> At | None:
        """The next one along an axis that is not too large: where cycles are to be small others
        make room for it."""
        more = self.machines.neighbour(at, which, 1)
        if more and not self.task.of_the_machine():
            return self.fitted(more, (which,))
        return more if more and self.machines.share(more) <= 1 else None

    def shrunk(self, at: At, watched: Sequence[View]) -> At:
        """No step back holds what is required on the views watched."""
        self.points.append(Point(at, self.look_until_missed(at, watched)))
        room = self.room(self.points[-1].views)
        # Freed for the room lost, by axis, as last seen: it is looked at again before a step.
        worth = {which: math.inf for which in range(len(at))}
        while worth:
            backs: dict[int, tuple[At, float]] = {}
            for which in sorted(worth, key=lambda w: -worth[w]):
                back = self.machines.back(at, which, self.machines.size)
                if back and back[1] > 0:
                    backs[which] = back
                else:
                    del worth[which]
                if len(backs) == AT_ONCE:
                    break
            found = self.look_at_each([to for to, _ in backs.values()], watched) if backs else {}
            held: dict[int, Point] = {}
            for which, (to, freed) in backs.items():
                if to not in found:
                    continue
                left = self.room(found[to]) if found[to] else -math.inf
                if left < 0:
                    del worth[which]
                    continue
                held[which] = Point(to, found[to])
                worth[which] = freed / max(room - left, 1e-4)
            which = max(held, key=lambda w: worth[w], default=None)
            if which is not None and worth[which] >= max(worth.values()):
                at, room = held[which].at, self.room(held[which].views)
                self.points.append(held[which])
        return at

    # What does best within what is allowed.

    def best(self, start: At) -> None:
        first = {scene.name: (scene, number) for scene, number in reversed(self.task.views)}
        self.views = list(reversed(first.values()))
        if not (start := self.allowed_start(start)):
            return
        for n, view in enumerate(self.look(start, self.views)):
            if stored := self.stored_to_hold(start, n, view):
                start = stored[0]
        if start := self.grown(start, self.views):
            self.look_back(start)
            if point := self.best_of_first_axis(start):
                self.descend(self.stored_better(point))

    def allowed_start(self, at: At) -> At | None:
        """With steps back on all axes but the first, at the nearest setting of that which allows
        it, until it is within what is allowed. Where nothing is, the start is judged as it is."""
        settings = range(len(self.space.axes[0].settings))
        for to in sorted(settings, key=lambda n: abs(n - at[0])):
            if fits := self.fitted(self.space.moved(at, 0, to - at[0]), (0,)):
                return fits
        self.work.made.add(self.judge.judged(self.space.assignments(at)))
        required = " and ".join(r.text for r in self.of_machines)
        self.work.made.remarks.append(f"No steps back from the start lead to {required}.")
        return None

    def draw_finalists(self) -> None:
        """The best of those that were looked at, on all views."""
        distinct = {point.at: point for point in self.points}.values()
        ranked = sorted(distinct, key=lambda point: self.objective.cost(point.views))
        for point in ranked[:FINALISTS]:
            if self.looked[point.at] < len(self.task.views):
                drawn = self.judge.draw(self.space.assignments(point.at), self.task.views)
                self.tell(point.at, drawn, drawn.views)

    def look_back(self, at: At) -> None:
        """What a step back on each axis harms, on the first two scenes."""
        few = self.views[:AT_ONCE]
        now = self.look(at, few)
        for which, axis in enumerate(self.space.axes):
            if not axis.scope and (back := self.machines.back(at, which, self.machines.share)):
                views = self.look(back[0], few)
                self.harm[which] = self.objective.worse(views, now) if views else math.inf

    def best_of_first_axis(self, at: At) -> Point | None:
        """The best within what is allowed, of one for each setting of the first axis: the memory
        that a group takes decides what is left for all else, so that single steps do not lead from
        one to another."""
        best: Point | None = None
        settings = range(len(self.space.axes[0].settings))
        # From the start's own outward, so that what is hopeless is given up early.
        for to in sorted(settings, key=lambda n: abs(n - at[0])):
            moved = self.space.moved(at, 0, to - at[0])
            if fits := self.fitted(moved, (0,)):
                worse, point = self.measure(fits, best)
                best = point if point and (best is None or worse < 0) else best
        return best

    def fitted(self, at: At, raised: Sequence[int]) -> At | None:
        """With steps back, but on the axes that were raised, until it is within what is allowed;
        None where that is not enough."""
        while (size := self.machines.share(at)) is not None and size > 1:
            prices: list[tuple[float, int, At]] = []
            for which in range(len(at)):
                back = (
                    None if which in raised else self.machines.back(at, which, self.machines.share)
                )
                if back and back[1] > 0:
                    harm = max(self.harm.get(which, UNKNOWN_HARM), BETTER)
                    # More than what is needed is worth nothing.
                    prices.append((harm / min(back[1], size - 1), which, back[0]))
            if not prices:
                return None
            at = min(prices, key=lambda price: price[:2])[2]
        return None if size is None else at

    def measure(self, at: At, against: Point | None) -> tuple[float, Point | None]:
        """How much worse it is than another point on the views drawn before it was given up; and
        the point, if it was not. Infinite where a view is refused, or misses what is required
        however its scene is stored."""
        views: tuple[dict, ...] = ()
        worse = 0.0
        for first in range(0, len(self.views), AT_ONCE):
            some = self.views[first : first + AT_ONCE]
            drawn = self.draw(at, some)
            views += drawn.views
            self.tell(at, drawn, views)
            if not drawn.views or any(r.violation(views) > 0 for r in self.of_machines):
                return math.inf, None
            for n in range(first, len(views)):
                stored = self.stored_to_hold(at, n, views[n])
                if not stored:
                    return math.inf, None
                at, view = stored
                views = (*views[:n], view, *views[n + 1 :])
            if against:
                worse = self.objective.worse(views, against.views[: len(views)])
                if len(views) < len(self.views) and worse > GIVEN_UP / len(views):
                    return worse, None
        if self.room(views) < 0:
            return math.inf, None
        self.looked.setdefault(at, 0)
        self.tell(at, drawn, views)
        self.points.append(Point(at, views))
        return worse, self.points[-1]

    def stored_to_hold(self, at: At, n: int, view: dict) -> tuple[At, dict] | None:
        """The n-th view as it was drawn or, where it misses what is required, with what is chosen
        for its scene as near to that as holds it."""

        def holds(view: dict) -> bool:
            return not any(r.is_lost([view]) for r in self.of_frames)

        if holds(view):
            return at, view
        for which in self.axes_of(view["scene_name"]):
            settings = range(len(self.space.axes[which].settings))
            for to in sorted(settings, key=lambda to: abs(to - at[which]))[1:]:
                trial = self.space.moved(at, which, to - at[which])
                drawn = self.draw(trial, [self.views[n]])
                self.tell(trial, drawn, drawn.views)
                if drawn.views and holds(drawn.views[0]):
                    return trial, drawn.views[0]
        return None

    def axes_of(self, scene: str) -> list[int]:
        return [n for n, axis in enumerate(self.space.axes) if axis.scope == label(scene)]

    def descend(self, best: Point) -> Point:
        """The point from which no move is better."""
        while True:
            before = best
            for which, step in self.moves(best):
                best = self.along(best, which, step)
            best = self.stored_better(best)
            if best is before:
                return best

    def moves(self, point: Point) -> Iterator[tuple[int, int]]:
        """Axes and steps: back where that was seen to gain; on, what holds most scenes first; then
        back."""
        axes = [n for n, axis in enumerate(self.space.axes) if not axis.scope]
        gains = [which for which in axes if self.harm.get(which, 0) < -BETTER]
        yield from ((which, -1) for which in sorted(gains, key=lambda w: self.harm[w]))
        held_by = [view["binding"].get("key", "") for view in point.views]
        named = {which: held_by.count(self.space.axes[which].name) for which in axes}
        yield from ((which, 1) for which in sorted(axes, key=lambda w: -named[w]))
        yield from ((which, -1) for which in axes)

    def along(self, best: Point, which: int, step: int) -> Point:
        """As far along an axis as it gets better."""
        while moved := self.machines.neighbour(best.at, which, step):
            fits = self.fitted(moved, (which,))
            worse, point = self.taken(fits, best) if fits else (math.inf, None)
            if step < 0 and math.isfinite(worse):
                self.harm[which] = worse
            if not point:
                break
            best = point
        return best

    def taken(self, at: At, best: Point) -> tuple[float, Point | None]:
        """What is better, or as good and smaller; it is not looked at twice."""
        if at in self.seen:
            return math.inf, None
        self.seen.add(at)
        worse, point = self.measure(at, best)
        smaller = self.machines.size(best.at) - self.machines.size(at) > FREED
        return worse, point if point and worse < (BETTER if smaller else -BETTER) else None

    def stored_better(self, best: Point) -> Point:
        """With what does best for each scene on this machine. Each way it is given up where some
        settings in a row are no better."""
        for n, (scene, _) in enumerate(self.views):
            for which in self.axes_of(scene.name):
                for step in (-1, 1):
                    at, misses = best.at, 0
                    while misses < PATIENCE and (at := self.space.moved(at, which, step)):
                        worse, point = self.measure(at, best)
                        better = point and worse < -BETTER / len(self.views)
                        best, misses = (point, 0) if better else (best, misses + 1)
        return best
