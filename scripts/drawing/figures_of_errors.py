"""Error against wall time: of tuning and training, of renderers in software."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drawing.figure_inputs import Results, number
from drawing.figure_style import (
    COLOURS,
    INK,
    LINES,
    MARKERS,
    ON_PAPER,
    legend_above,
    line_style,
    panels,
    plain_logarithmic,
)
from drawing.figures_of_image_errors import SCRIPT, quality

Made = tuple[Figure, str]  # with its caption
TIMED = ("scene", "view", "renderer", "finished below", "threads", "ms", "PSNR dB")
DOUBLE = "double"


def error_tuning(results: Results) -> Made:
    columns = ("what", "of", "moved", "to", "seconds", "PSNR dB")
    data = results.table("error_tuning", SCRIPT, columns)
    subjects = list(dict.fromkeys((row["what"], row["of"], row["moved"]) for row in data.rows))
    figure, flat = panels(len(subjects), across=3, width=3.9, height=2.7)
    for axes, (what, of, knob) in zip(flat, subjects):
        of_subject = data.where(what=what, of=of)
        for at, value in enumerate(dict.fromkeys(row["to"] for row in of_subject)):
            rows = [row for row in of_subject if row["to"] == value]
            x, y = ([number(row[name]) for row in rows] for name in ("seconds", "PSNR dB"))
            axes.plot(x, y, **line_style(at), label=f"{knob} {value}")
        axes.set_title(f"{what} {of}: PSNR of test views, dB", fontsize=8.5)
        axes.set_xlabel("seconds, with the looks in them")
        axes.legend(loc="best")
    return (
        figure,
        f"Quality against wall time; a marker is a look at the test views. From {data.made}",
    )


def error_renderers(results: Results) -> Made:
    """A row of diagrams for each view: renderers, and thresholds of finishing."""
    data = results.table("error_renderers", SCRIPT, TIMED)
    views = list(dict.fromkeys((row["scene"], row["view"]) for row in data.rows))
    figure, flat = panels(2 * len(views), width=4.6, height=2.7)
    for (scene, view), of_renderers, of_thresholds in zip(views, flat[::2], flat[1::2]):
        rows = data.where(scene=scene, view=view)
        draw_renderers(of_renderers, rows)
        draw_thresholds(of_thresholds, [row for row in rows if row["renderer"] == DOUBLE])
        for axes, what in ((of_renderers, "renderers"), (of_thresholds, "finished below")):
            axes.set_xscale("log")
            plain_logarithmic(axes.xaxis)
            axes.set_title(f"{scene} {view}, {what}: PSNR, dB", fontsize=8.5)
            axes.set_xlabel("ms of a frame, wall time")
    legend_above(figure, flat[0], columns=4)
    return figure, (
        "Left: renderers beside the one in double precision, whose time is the upright line; small "
        "markers: one thread, larger ones: more. Right: double that takes a pixel as finished below "
        f"so much light, beside double to its end. From {data.made}"
    )


def draw_renderers(axes: Axes, rows: Sequence[dict[str, str]]) -> None:
    """A line from one thread to more for each renderer; the upright one is double."""
    others = [row for row in rows if row["renderer"] != DOUBLE]
    for at, name in enumerate(dict.fromkeys(row["renderer"] for row in others)):
        of_name = [row for row in others if row["renderer"] == name]
        x = [number(row["ms"]) for row in of_name]
        y = [quality(row["PSNR dB"]) for row in of_name]
        style = {"color": COLOURS[at % len(COLOURS)], "marker": MARKERS[at % len(MARKERS)]}
        axes.plot(x, y, linestyle=":", linewidth=0.8, color=style["color"])
        for size, (ms, psnr_db) in enumerate(zip(x, y)):
            label = name if size == 0 else None
            axes.plot(ms, psnr_db, linestyle="none", markersize=5 + 2.5 * size, label=label,
                      **style, markeredgecolor=INK, markeredgewidth=0.5)  # fmt: skip
    finished = {row["finished below"] for row in others}
    for row in rows:
        if row["renderer"] == DOUBLE and row["finished below"] in finished:
            axes.axvline(number(row["ms"]), color=INK, linestyle=":", linewidth=1)


def draw_thresholds(axes: Axes, rows: Sequence[dict[str, str]]) -> None:
    for at, threads in enumerate(dict.fromkeys(row["threads"] for row in rows)):
        of_threads = [row for row in rows if row["threads"] == threads]
        x, y = ([number(row[name]) for row in of_threads] for name in ("ms", "PSNR dB"))
        style = {"color": COLOURS[3 * at % len(COLOURS)], "linestyle": LINES[at % len(LINES)]}
        axes.plot(
            x,
            y,
            marker=MARKERS[at % len(MARKERS)],
            label=f"{threads} thread{'s' * (threads != '1')}",
            **style,
        )
        for row, *place in zip(of_threads, x, y) if at == 0 else ():
            axes.annotate(row["finished below"], place, xytext=(5, -3),
                          textcoords="offset points", fontsize=7, bbox=ON_PAPER)  # fmt: skip
    axes.legend(loc="lower right")


FIGURES = {
    "error_tuning": error_tuning,
    "error_renderers": error_renderers,
}
