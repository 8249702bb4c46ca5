"""All of one view on the report page."""

from __future__ import annotations

from reporting import report_charts as charts, report_costs
from reporting import report_pictures, report_time
from reporting.report_charts import escaped, number, percent
from reporting.report_folder import ViewFiles, flat


def quality(view: dict) -> str:
    psnr_db = view["image"]["psnr_db"]
    return "equal" if psnr_db is None else f"{psnr_db:.2f} dB"


def of_the_model(view: dict) -> str:
    """How the picture stands to the streaming renderer's."""
    return f"{'bit for bit' if view['image']['equals_streaming_renderer'] else 'NOT'} the model's"


def key_numbers(view: dict) -> str:
    frame, image, dram, energy = view["frame"], view["image"], view["dram"], view["energy"]
    area = view["area_mm2"]
    joules, squares = energy["bands"]["total_j"], area["bands"]["total"]
    cards = (
        ("frames a second", number(frame["fps"]), f"{number(frame['cycles'])} cycles"),
        (
            "PSNR",
            quality(view),
            f"SSIM {image['ssim']:.4f}; {of_the_model(view)}",
        ),
        (
            "DRAM",
            f"{number(dram['bytes'] / 1e6)} MB",
            f"{number(view['limit']['ratio'])} x once; {percent(dram['of_peak'])} of peak",
        ),
        (
            "energy",
            f"{number(1e3 * energy['total_j'])} mJ",
            f"{number(1e3 * joules['low'])} .. {number(1e3 * joules['high'])} mJ; "
            f"{number(energy['mean_power_w'])} W",
        ),
        (
            "area",
            f"{number(area['total'])} mm²",
            f"{number(squares['low'])} .. {number(squares['high'])} mm², "
            f"{view['provenance']['technology']}",
        ),
        (
            "binds",
            view["binding"]["unit"],
            f"works {percent(view['binding']['utilisation'])} of the frame",
        ),
    )
    return (
        "<dl class=cards>"
        + "".join(
            f"<div><dt>{escaped(name)}</dt><dd><b>{escaped(value)}</b>"
            f"<small>{escaped(more)}</small></dd></div>"
            for name, value, more in cards
        )
        + "</dl>"
    )


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


def panel(files: ViewFiles, uris: dict[str, str], name: str, remark: str) -> str:
    """Everything about a view."""
    view = files.report
    sections = (
        ("Picture", report_pictures.pictures(files, uris, name, remark), "wide"),
        ("Where the time goes", report_time.time(view), "wide"),
        ("Energy", report_costs.energy(view), ""),
        ("DRAM traffic", report_costs.traffic(view), ""),
        ("Area", report_costs.area(view), ""),
        ("Left out", left_out(view), ""),
        ("Over the picture, by group", report_pictures.heat_maps(files), "wide"),
        ("Configuration", configuration(view), "wide"),
    )
    body = "".join(
        f'<section class="{size}"><h3>{escaped(title)}</h3>{text}</section>'
        for title, text, size in sections
    )
    return key_numbers(view) + binding(view) + f"<div class=grid>{body}</div>"
