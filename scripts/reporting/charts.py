"""Pieces of the page: numbers, tables, shares and bars as HTML, counters of pixels as pictures of a
pixel a group; and PNG files as far as it needs them. Colours are classes of report_page.css."""

from __future__ import annotations

import base64
import html
import json
import math
import struct
import zlib
from collections.abc import Sequence

# As the command's error maps (algorithm/image/error_map.cpp): even steps of lightness and hue.
RAMP = (
    (43, 26, 128),
    (99, 41, 140),
    (153, 56, 138),
    (201, 79, 122),
    (237, 112, 97),
    (252, 158, 87),
    (255, 207, 115),
    (252, 255, 115),
)


def escaped(value: object) -> str:
    return html.escape(str(value), quote=True)


def data_uri(png: bytes) -> str:
    return "data:image/png;base64," + base64.b64encode(png).decode("ascii")


def number(value: float, digits: int = 3) -> str:
    """Whole numbers with their thousands marked, others with so many digits that count."""
    if isinstance(value, int):
        return f"{value:,}"
    if value == 0 or not math.isfinite(value):
        return f"{value:g}"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:,.{decimals}f}"


def rate(fps: float) -> str:
    """Rounded down, as the terminal does: 89.96 holds no 90."""
    fps *= 1 + 1e-12  # of rounding
    return f"{math.floor(fps):,}" if fps >= 100 else f"{math.floor(10 * fps) / 10:.1f}"


def percent(share: float) -> str:
    return f"{100 * share:.0f} %" if share >= 0.0995 or share == 0 else f"{100 * share:.1f} %"


def table(
    head: Sequence[str], rows: Sequence[Sequence[object]], numeric: Sequence[int] = ()
) -> str:
    """Cells are text; columns in `numeric` stand at the right."""

    def cells(row: Sequence[object], tag: str) -> str:
        return "".join(
            f'<{tag}{" class=n" if at in numeric else ""}>{escaped(cell)}</{tag}>'
            for at, cell in enumerate(row)
        )

    body = "".join(f"<tr>{cells(row, 'td')}</tr>" for row in rows)
    return (
        f'<div class=scroll tabindex=0 role=region aria-label="{escaped(head[0])}, table">'
        f'<table class=plain aria-label="{escaped(head[0])}">'
        f"<thead><tr>{cells(head, 'th')}</tr></thead><tbody>{body}</tbody></table></div>"
    )


def details(summary: str, body: str) -> str:
    return f"<details><summary>{escaped(summary)}</summary>{body}</details>"


def cards(entries: Sequence[tuple[str, str, str]]) -> str:
    """Name, value and note each."""
    return (
        "<dl class=cards>"
        + "".join(
            f"<div><dt>{escaped(name)}</dt><dd><b>{escaped(value)}</b>"
            f"<small>{escaped(note)}</small></dd></div>"
            for name, value, note in entries
        )
        + "</dl>"
    )


def legend(classes: Sequence[tuple[str, str]]) -> str:
    """(class of the colour, name) each."""
    entries = "".join(f"<li><i class={name}></i>{escaped(text)}</li>" for name, text in classes)
    return f"<ul class=legend>{entries}</ul>"


Part = tuple[str, float, str]  # class of the colour, share of the row's width, what it is


def bar(parts: Sequence[Part], band: tuple[float, float] | None = None, thin: bool = False) -> str:
    """Parts side by side from the left; band: shares between which a line says what may be."""
    at, drawn = 0.0, []
    for colour, share, what in parts:
        if share > 0:
            drawn.append(
                f'<rect class="{colour}" x="{100 * at:.3f}%" width="{100 * share:.3f}%" '
                f'height="100%"><title>{escaped(what)}</title></rect>'
            )
        at += share
    if band:
        low, high = (f"{100 * share:.3f}%" for share in band)
        drawn.append(f'<line class=band x1="{low}" x2="{high}" y1="50%" y2="50%"/>')
        drawn += [f'<line class=band x1="{x}" x2="{x}" y1="25%" y2="75%"/>' for x in (low, high)]
    size = "thin" if thin else "bar"
    return f'<svg class={size} aria-hidden=true focusable=false>{"".join(drawn)}</svg>'


def bars(head: Sequence[str], rows: Sequence[tuple[str, str, Sequence[str]]], caption: str) -> str:
    """A table of bars. head: names of the columns, the first of the labels; the column of bars has
    none. Each row: its label, its bar, and its numbers."""
    first, *others = head
    named = "".join(f"<th scope=col class=n>{escaped(name)}</th>" for name in others)
    body = "".join(
        f"<tr><th scope=row>{escaped(label)}</th><td class=chart>{drawn}</td>"
        + "".join(f"<td class=n>{escaped(cell)}</td>" for cell in numbers)
        + "</tr>"
        for label, drawn, numbers in rows
    )
    return (
        f"<table class=bars><caption>{escaped(caption)}</caption><thead><tr>"
        f"<th scope=col>{escaped(first)}</th><td></td>{named}</tr></thead>"
        f"<tbody>{body}</tbody></table>"
    )


def colour_at(place: float) -> tuple[int, int, int]:
    """Of the ramp, place 0 to 1."""
    at = min(max(place, 0.0), 1.0) * (len(RAMP) - 1)
    low = min(int(at), len(RAMP) - 2)
    pair = zip(RAMP[low], RAMP[low + 1])
    return tuple(round(a + (b - a) * (at - low)) for a, b in pair)  # type: ignore[return-value]


def ramp_css() -> str:
    return ",".join(f"rgb{colour}".replace(" ", "") for colour in RAMP)


def heat_map(title: str, unit: str, groups: dict[str, list[int]], column: str) -> str:
    """A column of groups.csv over the frame, from 0 to its largest value; the same in words where
    all are 0."""
    values = groups[column]
    most = max(values)
    head = f"<figcaption><b>{escaped(title)}</b><small>"
    if most == 0:
        return f"<figure class=heat>{head}none in any group</small></figcaption></figure>"
    columns = groups["y_px"].count(groups["y_px"][0])
    rows = len(values) // columns
    width_px = max(x + w for x, w in zip(groups["x_px"], groups["width_px"]))
    height_px = max(y + h for y, h in zip(groups["y_px"], groups["height_px"]))
    group_px = groups["width_px"][0], groups["height_px"][0]
    pixels = bytes(channel for value in values for channel in colour_at(value / most))
    middle = sorted(values)[len(values) // 2]
    words = f"{title}: {len(values)} groups, median {number(middle)}, most {number(most)} {unit}"
    facts = {"values": values, "columns": columns, "group": group_px, "unit": unit}
    return (
        f"<figure class=heat data-heat='{escaped(json.dumps(facts, separators=(',', ':')))}'>"
        f"{head}median {number(middle)}, most {number(most)} {escaped(unit)}</small></figcaption>"
        f'<svg viewBox="0 0 {width_px} {height_px}" role=img tabindex=0 '
        f'aria-label="{escaped(words)}; arrow keys read single groups">'
        f'<image href="{data_uri(write_png(columns, rows, pixels))}" preserveAspectRatio=none '
        f'width="{columns * group_px[0]}" height="{rows * group_px[1]}"/>'
        f"<rect class=mark hidden></rect></svg>"
        f"<div class=scale aria-hidden=true><span>0</span><i></i><span>{number(most)}</span></div>"
        "<output aria-live=polite>&nbsp;</output></figure>"
    )


SIGNATURE = b"\x89PNG\r\n\x1a\n"
SMALLEST_BYTES = 8 + 25 + 12  # signature, IHDR, IEND
CHANNELS = {0: 1, 2: 3, 6: 4}  # by colour type: grey, RGB, RGBA


def write_png(width: int, height: int, pixels: bytes) -> bytes:
    """pixels: [height, width, 1, 3 or 4], row by row from the top."""
    channels = len(pixels) // (width * height)
    colour_type = {count: kind for kind, count in CHANNELS.items()}[channels]
    step = width * channels
    rows = b"".join(b"\0" + pixels[at : at + step] for at in range(0, len(pixels), step))
    parts = (
        (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, colour_type, 0, 0, 0)),
        (b"IDAT", zlib.compress(rows, 9)),
        (b"IEND", b""),
    )
    return SIGNATURE + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in parts
    )


def size_of(png: bytes) -> tuple[int, int]:
    """Width and height. Raises ValueError where it is no PNG."""
    if png[:8] != SIGNATURE or len(png) < 33:
        raise ValueError("got no PNG, expected one")
    return struct.unpack(">II", png[16:24])


def is_whole(png: bytes) -> bool:
    """Whether it is a PNG that has its end, and pixels; these are not looked at."""
    has_ends = png[:8] == SIGNATURE and png[-8:-4] == b"IEND" and len(png) >= SMALLEST_BYTES
    return has_ends and all(size_of(png))


def read_png(png: bytes) -> tuple[int, int, list[bytearray]]:
    """Width, height and rows of [width, channels]. Raises ValueError for what `streaminggs` does
    not write: other depths than 8 bits, palettes, interlacing; and where the file is cut."""
    width, height = size_of(png)
    depth, colour_type, *_, interlaced = png[24:29]
    if depth != 8 or colour_type not in CHANNELS or interlaced:
        raise ValueError("got another kind of PNG, expected 8 bits a channel, not interlaced")
    at, packed = 8, b""
    while at + 8 <= len(png):
        (length,) = struct.unpack(">I", png[at : at + 4])
        if png[at + 4 : at + 8] == b"IDAT":
            packed += png[at + 8 : at + 8 + length]
        at += 12 + length
    try:
        data = zlib.decompress(packed)
    except zlib.error as error:
        raise ValueError(f"PNG: {error}") from error
    channels = CHANNELS[colour_type]
    step = width * channels
    if len(data) != height * (step + 1):
        raise ValueError(f"PNG: got {len(data)} B of rows, expected {height * (step + 1)}")
    rows: list[bytearray] = []
    above = bytearray(step)
    for begin in range(0, len(data), step + 1):
        row = bytearray(data[begin + 1 : begin + 1 + step])
        unfilter(data[begin], row, above, channels)
        rows.append(row)
        above = row
    return width, height, rows


def unfilter(kind: int, row: bytearray, above: bytearray, channels: int) -> None:
    """In place, as section 9.2 of the PNG specification: none, sub, up, average, Paeth."""
    if kind == 2:
        row[:] = bytes((a + b) & 255 for a, b in zip(row, above))
    elif kind in (1, 3, 4):
        for i in range(len(row)):
            left = row[i - channels] if i >= channels else 0
            if kind == 1:
                guess = left
            elif kind == 3:
                guess = (left + above[i]) >> 1
            else:
                guess = paeth(left, above[i], above[i - channels] if i >= channels else 0)
            row[i] = (row[i] + guess) & 255


def paeth(left: int, up: int, corner: int) -> int:
    to_left, to_up, to_corner = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
    if to_left <= to_up and to_left <= to_corner:
        return left
    return up if to_up <= to_corner else corner


def halved(png: bytes) -> bytes:
    """Of half the width and height: means of 2 x 2 pixels; an odd last row or column is left out.
    Raises ValueError."""
    width, height, rows = read_png(png)
    if width < 2 or height < 2:
        raise ValueError(f"PNG: {width} x {height} px, expected at least 2 x 2")
    channels = len(rows[0]) // width
    across = width // 2 * 2 * channels
    pixels = bytearray(width // 2 * (height // 2) * channels)
    step = width // 2 * channels
    for y in range(height // 2):
        sums = [a + b for a, b in zip(rows[2 * y][:across], rows[2 * y + 1][:across])]
        for c in range(channels):
            left, right = sums[c :: 2 * channels], sums[channels + c :: 2 * channels]
            pixels[y * step + c : (y + 1) * step : channels] = bytes(
                (a + b + 2) >> 2 for a, b in zip(left, right)
            )
    return write_png(width // 2, height // 2, bytes(pixels))
