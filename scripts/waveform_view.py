#!/usr/bin/env python3
"""Writes the GTKWave view of a waveform: every signal, grouped by unit, under its own name.

    scripts/waveform_view.py small.vcd --out small.gtkw
    gtkwave small.vcd small.gtkw

Groups stand in the order in which the machine's units publish their signals, which is that of the
pipeline; the view opens with the whole of this waveform in sight.
"""

from __future__ import annotations

import math
import pathlib
import re
import sys
from collections.abc import Iterator

from runs import run_arguments
from runs.files import write_text

# Names of what stands between a unit and the leaf: an activity, a FIFO or a memory port.
OF_AN_ACTIVITY = {"busy", "waits_for"}
OF_A_CHANNEL = {"fill", "bytes_outstanding"}

# GTKWave's flags of a trace: how a value is shown, and groups that are open or folded.
BINARY, DECIMAL, ANALOG_STEPS = "@28", "@24", "@8024"
GROUP_BEGIN, GROUP_BEGIN_FOLDED = "@800200", "@c00200"
GROUP_END, GROUP_END_FOLDED = "@1000200", "@1401200"

WINDOW_PX, SIGNALS_PX, TREE_PX = 1600, 340, 160
FRAME_PX = 200  # GTKWave shows 2^-zoom time units in so many pixels
BORDERS_PX = 160  # of its window, between the panes, and what the window manager takes

Signal = tuple[str, str]  # path, bits as in "[31:0]" or nothing


def code_number(code: str) -> int:
    """SystemC numbers signals in the order in which they are traced, written in letters."""
    number = 0
    for letter in code:
        number = 26 * number + ord(letter) - ord("a")
    return number


def signals_of(lines: Iterator[str]) -> list[Signal]:
    """The signals that a VCD declares, in the order in which they were traced."""
    found, scopes = [], []
    for line in lines:
        words = line.split()
        if not words:
            continue
        if words[0] == "$enddefinitions":
            break
        if words[0] == "$scope":
            scopes.append(words[2])
        elif words[0] == "$upscope":
            scopes.pop()
        elif words[0] == "$var":
            bits = "" if words[5] == "$end" else words[5]
            found.append((code_number(words[3]), (".".join([*scopes, words[4]]), bits)))
    return [signal for _, signal in sorted(found)]


def last_time(path: pathlib.Path) -> int:
    """The time of the waveform's last change, in its own unit."""
    with path.open("rb") as file:
        size = file.seek(0, 2)
        file.seek(max(0, size - 65536))
        times = [line for line in file.read().split(b"\n") if line.startswith(b"#")]
    if not times:
        raise ValueError(f"{path}: no time found at its end, expected a whole VCD file")
    return int(times[-1][1:])


def split(path: str) -> tuple[str, str]:
    """Where a signal stands, "SystemC.accelerator.hfu0.coarse", and its name there."""
    parts = path.split(".")
    own = 2 if parts[-1] in OF_AN_ACTIVITY | OF_A_CHANNEL else 1
    return ".".join(parts[:-own]), ".".join(parts[-own:])


def top_of(signals: list[Signal]) -> str:
    """The machine: "SystemC." and the name that the most signals begin with."""
    tops = [".".join(path.split(".")[:2]) for path, _ in signals]
    return max(set(tops), key=tops.count)


def flag_of(path: str) -> str:
    leaf = path.rsplit(".", 1)[-1]
    if leaf in OF_A_CHANNEL:
        return ANALOG_STEPS
    return BINARY if leaf == "busy" else DECIMAL


def view_of(signals: list[Signal], time: int) -> str:
    """The text of a GTKWave save file."""
    top = top_of(signals)
    groups: dict[str, list[Signal]] = {}
    for path, bits in signals:
        groups.setdefault(split(path)[0], []).append((path, bits))
    frames = (WINDOW_PX - SIGNALS_PX - TREE_PX - BORDERS_PX) / FRAME_PX
    zoom = -math.log2(max(1, time) / frames)
    lines = ["[*] A view of every signal, by unit; written by scripts/waveform_view.py",
             "[timestart] 0", f"[size] {WINDOW_PX} 1000", "[pos] -1 -1",
             f"*{zoom:.6f} -1" + " -1" * 26,
             f"[sst_width] {TREE_PX}", f"[signals_width] {SIGNALS_PX}", "[sst_expanded] 1"]
    for place, members in groups.items():
        below = place.removeprefix(top).strip(".")
        name = "queues between the units" if place == top else below or place
        name = name.removeprefix("SystemC.")
        # Of units that stand several times, the first is open.
        folded = re.search(r"[1-9][0-9]*(\.|$)", name) is not None
        lines += [GROUP_BEGIN_FOLDED if folded else GROUP_BEGIN, "-" + name]
        for path, bits in members:
            # GTKWave shows only what stands behind a name's last dot.
            own = path.removeprefix(top + ".").removeprefix("SystemC.").replace(".", " ")
            lines += [flag_of(path), f"+{{{own}}} {path}{bits}"]
        lines += [GROUP_END_FOLDED if folded else GROUP_END, "-" + name]
    return "\n".join(lines) + "\n"


def write_view(vcd: pathlib.Path, out: pathlib.Path) -> None:
    """Raises ValueError for what is no VCD file."""
    with vcd.open(errors="replace") as file:
        signals = signals_of(file)
    if not signals:
        raise ValueError(f"{vcd}: no signal found, expected a VCD file")
    write_text(out, view_of(signals, last_time(vcd)))


def main() -> int:
    parser = run_arguments.Parser(__doc__.splitlines()[0])
    parser.add_argument("vcd", type=pathlib.Path, help="waveform, as `simulate --vcd` writes it")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="view to write, .gtkw")
    arguments = parser.parse_args()
    return run_arguments.main(lambda: write_view(arguments.vcd, arguments.out))


if __name__ == "__main__":
    sys.exit(main())
