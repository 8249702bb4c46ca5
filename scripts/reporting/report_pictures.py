"""The pictures of a view and what stands by group of pixels, as sections of the report page."""

from __future__ import annotations

from reporting import report_charts as charts
from reporting.png_pictures import size_of
from reporting.report_charts import escaped, number, percent
from reporting.report_folder import ViewFiles

HEAT_MAPS = (
    ("cycles", "Cycles of rendering", "cycles"),
    ("bytes", "Bytes asked for", "B"),
    ("misordered", "Blends out of order", "blends"),
    ("missed", "Splats missed", "splats"),
    ("blends", "Blends", "blends"),
)


def pictures(files: ViewFiles, uris: dict[str, str], name: str, remark: str) -> str:
    """uris: data of the pictures that are embedded, by what they show. name: a prefix of ids."""
    if "frame" not in uris:
        return f"<p class=note>{escaped(remark or 'No pictures lie beside this report.')}</p>"
    others = [what for what in uris if what != "frame"]
    width, height = files.report["frame"]["width_px"], files.report["frame"]["height_px"]
    layers = "".join(
        f'<div class=layer data-what={what} {"" if at == 0 else "hidden"}>'
        f'<img src="{uris[what]}" alt="{escaped(alt_text(what))}" '
        f'style="height:{tallness(files, what):.3f}%"></div>'
        for at, what in enumerate(others)
    )
    choices = "".join(
        f'<label><input type=radio name="{name}-with" value={what} {"checked" if at == 0 else ""}>'
        f"<span>{escaped(what)}</span></label>"
        for at, what in enumerate(others)
    )
    note = f"<p class=small>{escaped(remark)}</p>" if remark else ""
    slider = (
        f"<fieldset class=choice><legend>frame beside</legend>{choices}</fieldset>"
        f"<label class=slide><span>frame</span><input type=range min=0 max=100 value=50 step=1 "
        f'aria-label="how much of the picture shows the frame, in per cent">'
        f"<span class=other>{escaped(others[0])}</span></label>"
        if others
        else ""
    )
    return (
        f'<div class=compare style="--w:{width};--h:{height}">'
        f'<div class=stage><img src="{uris["frame"]}" alt="frame, as read back from DRAM">'
        f"{layers}<i class=edge></i></div>{slider}"
        "<p class=legend-of-error hidden>0.002 or less <i></i> 1: channel error, logarithmic</p>"
        f"{note}{error_parts(files.report)}</div>"
    )


def alt_text(what: str) -> str:
    texts = {"reference": "picture of the reference renderer", "error": "largest channel error"}
    return texts.get(what, f"squared error of what was {what}")


def tallness(files: ViewFiles, what: str) -> float:
    """Of a picture, in per cent of the frame's height: the legend of an error map stands beside it,
    and may be taller."""
    (_, frame), (_, height) = (size_of(files.pictures[name].png) for name in ("frame", what))
    return 100 * height / frame


def share_text(share: float | None) -> str:
    """None: the picture has no error to share."""
    return "none" if share is None else percent(share)


def error_parts(view: dict) -> str:
    """What an order that loses has lost, where."""
    parts = {
        name: part
        for name, part in view["image"].get("error_parts", {}).items()
        if part is not None
    }
    if not parts:
        return ""
    shares = ", ".join(
        f"{name.replace('_', ' ')} {share_text(part['share'])}" for name, part in parts.items()
    )
    missed, misordered, blends = (
        number(view["image"][count]) for count in ("missed", "misordered", "blends")
    )
    counts = f"{missed} splats missed by a group, {misordered} of {blends} blends out of order"
    return f"<p class=small>Of the squared error: {escaped(shares)}. {escaped(counts)}.</p>"


def heat_maps(files: ViewFiles) -> str:
    columns = [entry for entry in HEAT_MAPS if files.groups.get(entry[0])]
    if not columns:
        return (
            "<p class=small>This machine has no groups of pixels, or its results no groups.csv.</p>"
        )
    maps = (charts.heat_map(title, unit, files.groups, name) for name, title, unit in columns)
    return f"<div class=heats>{''.join(maps)}</div>"
