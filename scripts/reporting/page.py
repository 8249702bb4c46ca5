"""The page that results are put together to: tabs, style and scripts in one HTML text, which needs
nothing beside it; and the tab of a view. Pictures are halved until the page is small enough, then
left out from the last tab on, and the page says so."""

from __future__ import annotations

import dataclasses
import pathlib
from collections.abc import Sequence

from reporting import charts, costs, stream
from reporting.charts import data_uri, escaped, number, percent, ramp_css, rate, size_of
from reporting.folder import Run, Stream, ViewFiles, flat

ASSETS = pathlib.Path(__file__).resolve().parent
STYLE, SCRIPTS = "report_page.css", ("report_page.js", "report_points.js")
MOST_BYTES = 6_000_000  # of the page
MOST_HALVINGS = 2


def quality(image: dict) -> str:
    psnr_db = image["psnr_db"]
    return "equal" if psnr_db is None else f"{psnr_db:.2f} dB"


def mm2_with_phy(view: dict) -> str:
    """With PHY and controller of the memory; empty where an earlier program made the report."""
    band = view["area_mm2"].get("with_memory_interface")
    return number(band["middle"]) if band else ""


def mj_with_phy(view: dict) -> str:
    band = view["energy"].get("with_memory_interface_j")
    return number(1e3 * band["middle"]) if band else ""


def and_with_phy(amount: str, unit: str) -> str:
    """Words behind an amount; none where it is empty."""
    return f"; {amount} {unit} with PHY and controller of the memory" if amount else ""


def at_rates(view: dict) -> str:
    """Power at the rates that --frame-rate named."""
    return "".join(
        f"; {number(of['power_w']['middle'])} W at {of['per_s']:g} a second"
        if of["held"]
        else f"; does not hold {of['per_s']:g} a second"
        for of in view.get("fixed_rates", ())
    )


def of_the_model(view: dict) -> str:
    """How the picture stands to the streaming renderer's."""
    return f"{'bit for bit' if view['image']['equals_streaming_renderer'] else 'NOT'} the model's"


def key_numbers(view: dict) -> str:
    frame, image, dram, energy = view["frame"], view["image"], view["dram"], view["energy"]
    area = view["area_mm2"]
    joules, squares = energy["bands"]["total_j"], area["bands"]["total"]
    cards = (
        (
            "pairs a second" if "right_eye" in image else "frames a second",
            rate(frame["fps"]),
            f"{number(frame['cycles'])} cycles",
        ),
        (
            "PSNR",
            quality(image),
            (f"right eye {quality(image['right_eye'])}; " if "right_eye" in image else "")
            + f"SSIM {image['ssim']:.4f}; {of_the_model(view)}",
        ),
        (
            "DRAM",
            f"{number(dram['bytes'] / 1e6)} MB",
            f"{number(dram['bus_bytes'] / 1e6)} MB on the bus; "
            f"{number(view['limit']['ratio'])} x once; {percent(dram['of_peak'])} of peak",
        ),
        (
            "energy",
            f"{number(1e3 * energy['total_j'])} mJ{costs.without_memory(view)}",
            f"{number(1e3 * joules['low'])} .. {number(1e3 * joules['high'])} mJ; "
            f"{number(energy['mean_power_w'])} W{at_rates(view)}"
            + and_with_phy(mj_with_phy(view), "mJ"),
        ),
        (
            "area",
            f"{number(area['total'])} mm²",
            f"{number(squares['low'])} .. {number(squares['high'])} mm², "
            f"{view['provenance']['technology']}" + and_with_phy(mm2_with_phy(view), "mm²"),
        ),
        (
            "binds",
            view["binding"]["unit"],
            f"works {percent(view['binding']['utilisation'])} of the frame",
        ),
    )
    return charts.cards(cards)


def binding(view: dict) -> str:
    return f"<p class=note><b>What binds.</b> {escaped(view['binding']['explanation'])}</p>"


def left_out(view: dict) -> str:
    rows = [
        (entry["what"].replace("_", " "), number(entry["count"]), entry["why"], entry["saves"])
        for entry in view["left_out"]
    ]
    return charts.table(("left out", "count", "why", "saves"), rows, numeric=(1,))


def counters(view: dict) -> str:
    rows = [
        (unit, name.replace("_", " "), number(count))
        for unit, of_unit in view["units"].items()
        for name, count in of_unit["counters"].items()
    ]
    return charts.table(("unit", "counter", "count"), rows, numeric=(2,))


def configuration(view: dict) -> str:
    why = {entry["key"]: entry["why"] for entry in view.get("chosen", ())}

    def text(value: object) -> str:
        return str(value).lower() if isinstance(value, bool) else str(value)

    rows = [(key, text(value), why.get(key, "")) for key, value in flat(view["config"])]
    head = ("key", "value", "where it was left open: why the model chose it")
    facts = view["provenance"]
    made = (
        f"Version {facts['version']}, commit {facts['commit']}; technology {facts['technology']}; "
        f"memory image {facts.get('memory_image_xxh64', 'unknown')}; "
        f"{number(view['host']['simulation_wall_s'])} s of wall time."
    )
    return (
        "<p>To run it again:</p><div class=command>"
        f"<code tabindex=0>{escaped(facts['command'])}</code>"
        "<button type=button>copy</button></div>"
        f"<p class=small>{escaped(made)}</p>"
        + charts.details(f"all {len(rows)} keys of the configuration", charts.table(head, rows))
        + charts.details("counters of the units", counters(view))
    )


def panel_of_stream(files: Stream, uris: dict[str, str], remark: str) -> str:
    """Everything about frames back to back."""
    view, flow = files.all.report, files.report["flow"]
    joules = {**view, "energy": {**view["energy"], **flow["energy"]}}
    sections = (
        ("Frames", stream.sheet(uris, remark), "wide"),
        ("Where the time goes, all frames", costs.time(view), "wide"),
        ("Energy", costs.energy(joules, stream.time_of(files.report)), ""),
        ("DRAM traffic, all frames", costs.traffic(view), ""),
        ("The memory's power", stream.memory(flow), ""),
        ("Area", costs.area(view), ""),
        ("Left out", left_out(view), ""),
        ("Configuration", configuration(view), "wide"),
    )
    machine_binds = files.report["frame_rate"] == 0 or files.report["missed_frames"] > 0
    return (
        charts.cards(stream.key_numbers(files))
        + (binding(view) if machine_binds else "")
        + grid(sections)
    )


def grid(sections: Sequence[tuple[str, str, str]]) -> str:
    """Title, text and width each."""
    body = "".join(
        f'<section class="{size}"><h3>{escaped(title)}</h3>{text}</section>'
        for title, text, size in sections
    )
    return f"<div class=grid>{body}</div>"


def panel_of_view(files: ViewFiles, uris: dict[str, str], name: str, remark: str) -> str:
    """Everything about a view."""
    view = files.report
    sections = (
        ("Picture", pictures(files, uris, name, remark), "wide"),
        ("Where the time goes", costs.time(view), "wide"),
        ("Energy", costs.energy(view), ""),
        ("DRAM traffic", costs.traffic(view), ""),
        ("Area", costs.area(view), ""),
        ("Left out", left_out(view), ""),
        ("Over the picture, by group", heat_maps(files), "wide"),
        ("Configuration", configuration(view), "wide"),
    )
    return key_numbers(view) + binding(view) + grid(sections)


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
        f'<div class=layer data-what="{what}" {"" if at == 0 else "hidden"}>'
        f'<img src="{uris[what]}" alt="{escaped(alt_text(what))}" '
        f'style="height:{tallness(files, what):.3f}%"></div>'
        for at, what in enumerate(others)
    )
    choices = "".join(
        f'<label><input type=radio name="{name}-with" value="{what}" '
        f'{"checked" if at == 0 else ""}>'
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
    texts["right eye"] = "picture of the right eye"
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


@dataclasses.dataclass(frozen=True)
class Panel:
    """A tab of the page: a text, or a view or a stream whose report and pictures are drawn."""

    name: str
    run: Run | None = None
    files: ViewFiles | None = None
    text: str = ""


def text_of(panel: Panel, at: int, uris: dict[str, str], remark: str) -> str:
    if panel.run and panel.run.stream:
        return panel_of_stream(panel.run.stream, uris, remark)
    return panel.text or panel_of_view(panel.files, uris, f"v{at}", remark)


def fitted(panels: Sequence[Panel], room: int) -> list[str]:
    """Texts of the panels, at most so many bytes together: with pictures of full size, else halved,
    else of the first panels only. Raises ValueError for a picture that is no PNG of `simulate`."""
    plain = [text_of(panel, at, {}, "") for at, panel in enumerate(panels)]
    left = room - sum(len(text.encode()) for text in plain)
    for times in range(MOST_HALVINGS + 1):
        uris = [
            {
                what: data_uri(picture.halved(times))
                for what, picture in panel.files.pictures.items()
            }
            if panel.files
            else {}
            for panel in panels
        ]
        sizes = [sum(map(len, of_panel.values())) for of_panel in uris]
        if sum(sizes) <= left or times == MOST_HALVINGS:
            break
    shrunk = f"Pictures at 1/{2**times} of their width and height." if times else ""
    texts = []
    for at, panel in enumerate(panels):
        left -= sizes[at]
        left_out = panel.files and panel.files.pictures and left < 0
        remark = "Pictures left out: the page would be too large." if left_out else shrunk
        texts.append(
            text_of(panel, at, {} if left_out else uris[at], remark if panel.files else "")
        )
    return texts


def page(title: str, subtitle: str, panels: Sequence[Panel]) -> str:
    tabs = "".join(
        f"<button role=tab id=tab{at} aria-controls=panel{at} "
        f'aria-selected={"true" if at == 0 else "false tabindex=-1"}>{escaped(panel.name)}</button>'
        for at, panel in enumerate(panels)
    )
    bar = f'<div role=tablist aria-label="views">{tabs}</div>' if len(panels) > 1 else ""
    style = (ASSETS / STYLE).read_text(encoding="utf-8").replace("RAMP", ramp_css())
    script = "".join((ASSETS / name).read_text(encoding="utf-8") for name in SCRIPTS)
    before = (
        "<!doctype html><html lang=en><head><meta charset=utf-8>"
        '<meta name=viewport content="width=device-width,initial-scale=1">'
        '<meta name=color-scheme content="light dark"><link rel=icon href="data:,">'
        f"<title>{escaped(title)}</title><style>{style}</style></head><body><header><div>"
        f"<h1>{escaped(title)}</h1><p>{escaped(subtitle)}</p></div>"
        f"<button type=button id=theme>theme: system</button></header>{bar}<main>"
    )
    behind = f"</main><script>{script}</script></body></html>\n"
    texts = fitted(panels, MOST_BYTES - len((before + behind).encode()) - 200 * len(panels))
    several = len(panels) > 1
    whole = "".join(
        f"<div id=panel{at} {f'role=tabpanel aria-labelledby=tab{at}' if several else ''}>"
        f"{f'<h2>{escaped(panel.name)}</h2>' if several else ''}{text}</div>"
        for at, (panel, text) in enumerate(zip(panels, texts))
    )
    return before + whole + behind
