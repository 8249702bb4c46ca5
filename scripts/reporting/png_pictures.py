"""PNG pictures of 8 bits a channel, without a library: made from pixels, and halved in size."""

from __future__ import annotations

import struct
import zlib

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
