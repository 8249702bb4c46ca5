"""The page that results are put together to: tabs, style and scripts in one HTML text, which needs
nothing beside it. Pictures are halved until the page is small enough, then left out from the last
tab on, and the page says so."""

from __future__ import annotations

import dataclasses
import pathlib
from collections.abc import Sequence

from reporting import view
from reporting.charts import data_uri, escaped, ramp_css
from reporting.folder import Run, ViewFiles

ASSETS = pathlib.Path(__file__).resolve().parent
STYLE, SCRIPTS = "report_page.css", ("report_page.js", "report_points.js")
MOST_BYTES = 6_000_000  # of the page
MOST_HALVINGS = 2


@dataclasses.dataclass(frozen=True)
class Panel:
    """A tab of the page: a text, or a view whose report and pictures are drawn."""

    name: str
    run: Run | None = None
    files: ViewFiles | None = None
    text: str = ""


def text_of(panel: Panel, at: int, uris: dict[str, str], remark: str) -> str:
    return panel.text or view.panel(panel.files, uris, f"v{at}", remark)


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
