"""The paper's figures (StreamingGS, DAC 2025) from our measurements, with its numbers where it has
any. What the paper says is quoted as dotted lines and text; all else was measured."""

from __future__ import annotations

from matplotlib.figure import Figure

from drawing.figure_inputs import Data, Missing, Results, number
from drawing.figure_style import (
    bar_style,
    case_label,
    from_zero,
    legend_above,
    line_style,
    note,
    panels,
    published,
)

WISHED_FPS = 90
LPDDR3_GB_S, ORIN_NX_GB_S = 25.6, 102.4
# Of the paper: frames a second of the GPU, and what its parts gain over the machine without
# codebooks and coarse filter (energy 21.5, 27.3, 62.9 times that of the GPU; speed 22.2, 45.7).
GPU_FPS = (2, 9)
NEITHER = "paper_no_vq_cgf"
PAPER_SPEED = {NEITHER: 1.0, "paper_no_cgf": 1.0, "paper": 45.7 / 22.2}
PAPER_ENERGY = {NEITHER: 1.0, "paper_no_cgf": 27.3 / 21.5, "paper": 62.9 / 21.5}

Made = tuple[Figure, str]  # with its caption


def cases_of(data: Data) -> list[tuple[str, str]]:
    """(scene, size) each."""
    return list(dict.fromkeys((row["scene"], row["size"]) for row in data.rows))


def with_memory(data: Data, row: dict[str, str]) -> str:
    """The machine of a row, with its memory where it has several."""
    machine = row["machine"]
    several = len({r["GB/s"] for r in data.where(machine=machine)}) > 1
    return f"{machine}, {row['GB/s']} GB/s" if several else machine


def grouped_bars(axes, data: Data, value) -> None:
    """A group of bars for each scene and size, one for each machine and memory; room for a remark
    behind the last."""
    cases = cases_of(data)
    machines: dict[str, dict[tuple[str, str], float]] = {}
    for row in data.rows:
        machines.setdefault(with_memory(data, row), {})[row["scene"], row["size"]] = value(row)
    width = 0.8 / len(machines)
    for at, (machine, found) in enumerate(machines.items()):
        axes.bar(
            [x + (at - (len(machines) - 1) / 2) * width for x in range(len(cases))],
            [found.get(case, 0) for case in cases],
            width,
            label=machine,
            **bar_style(at),
        )
    axes.set_xticks(range(len(cases)), [case_label(*case) for case in cases], fontsize=8)
    axes.set_xlim(-0.6, 1.1 * len(cases) - 0.4)
    axes.grid(axis="x", visible=False)


def characterisation(results: Results) -> Made:
    demand = f"GB/s at {WISHED_FPS} frames/s"
    data = results.table(
        "characterisation",
        "compare_machines.py",
        ("scene", "size", "machine", "GB/s", "frames/s", demand),
    )
    figure, (rate, bandwidth) = panels(2, width=max(7.4, 0.8 * len(cases_of(data)) + 1.4), across=1)
    grouped_bars(rate, data, lambda row: number(row["frames/s"]) or 0)
    rate.set_yscale("log")
    rate.set_title("Frames a second")
    low, high = GPU_FPS
    said = f"the paper's GPU: {low} to {high}"
    rate.axhspan(low, high, color="#c9ced8", alpha=0.55, zorder=0, label=said)
    rate.set_ylim(bottom=1)
    published(rate, WISHED_FPS, f"{WISHED_FPS} frames/s")
    grouped_bars(bandwidth, data, lambda row: number(row[demand]) or 0)
    bandwidth.set_title(f"GB/s needed for {WISHED_FPS} frames a second")
    most = max(number(row[demand]) or 0 for row in data.rows)
    for gb_s, text in ((LPDDR3_GB_S, "4 x LPDDR3-1600"), (ORIN_NX_GB_S, "Orin NX")):
        if gb_s < 1.6 * most:
            published(bandwidth, gb_s, f"{text}, {gb_s} GB/s")
            bandwidth.set_ylim(top=max(bandwidth.get_ylim()[1], 1.15 * gb_s))
    legend_above(figure, rate)
    return figure, f"Frame rate, and bandwidth at {WISHED_FPS} frames a second. From {data.made}"


def dram_by_stage(results: Results) -> Made:
    parts = ("scene %", "intermediate %", "pixels %")
    data = results.table(
        "characterisation",
        "compare_machines.py",
        ("scene", "size", "machine", "GB/s", "MB a frame", *parts),
    )
    labels = [f"{row['scene']} {row['size']}, {with_memory(data, row)}" for row in data.rows]
    figure, (axes,) = panels(1, width=7.4, height=0.34 * len(labels) + 1.1)
    left = [0.0] * len(labels)
    for at, part in enumerate(parts):
        shares = [number(row[part]) or 0 for row in data.rows]
        axes.barh(labels, shares, left=left, label=part.removesuffix(" %"), **bar_style(at))
        left = [a + b for a, b in zip(left, shares)]
    for y, row in enumerate(data.rows):
        note(axes, 101, y, f"{row['MB a frame']} MB", va="center", annotation_clip=False)
    axes.set_xlim(0, 100)
    axes.set_ylim(len(labels) - 0.4, -0.6)
    axes.set_xlabel("% of the bytes of a frame")
    axes.grid(axis="y", visible=False)
    legend_above(figure, axes)
    said = (
        "What is written and read again within a frame is `intermediate`; at 2560x1440 Neo has "
        "up to 91 % of a GPU's bytes and 69 % of GSCore's for sorting"
    )
    return figure, f"DRAM traffic by stage. {said.replace('`', '')}. From {data.made}"


def variants(results: Results) -> Made:
    data = results.table(
        "compare_variants", "compare_variants.py", ("scene", "variant", "M cycles", "mJ")
    )
    shown = {
        NEITHER: "neither",
        "paper_no_cgf": "codebooks",
        "paper_no_vq": "coarse filter",
        "paper": "both",
    }
    scenes = [
        scene for scene in data.different("scene") if data.where(scene=scene, variant=NEITHER)
    ]
    if not scenes:
        raise Missing(f"{data.made}: no rows of {NEITHER}")
    groups = [*scenes, "StreamingGS,\nas stated"]
    figure, both = panels(2, width=max(4.2, 0.8 * len(groups) + 1.4))
    for axes, column, title, said in (
        (both[0], "M cycles", "Times as fast as with neither", PAPER_SPEED),
        (both[1], "mJ", "Times less energy than with neither", PAPER_ENERGY),
    ):
        for at, (variant, label) in enumerate(shown.items()):
            gains = []
            for scene in scenes:
                (base,) = data.where(scene=scene, variant=NEITHER)
                rows = data.where(scene=scene, variant=variant)
                gains.append(number(base[column]) / number(rows[0][column]) if rows else 0)
            gains.append(said.get(variant, 0))
            places = [x + (at - 1.5) * 0.2 for x in range(len(groups))]
            drawn = axes.bar(places, gains, 0.2, label=label, **bar_style(at))
            axes.bar_label(drawn, [f"{gain:.1f}" if gain else "" for gain in gains], fontsize=7)
        axes.axvline(len(scenes) - 0.5, color="#626a78", linewidth=0.8)
        axes.set_xticks(range(len(groups)), groups, rotation=0 if len(groups) < 6 else 30)
        axes.grid(axis="x", visible=False)
        axes.set_title(title)
    legend_above(figure, both[0])
    caption = (
        "What codebooks and coarse filter gain in paper order; StreamingGS states nothing of the "
        f"coarse filter alone. From {data.made}"
    )
    return figure, caption


def voxel_size(results: Results) -> Made:
    data = results.table(
        "voxel_study", "voxel_study.py", ("scene", "of the preset's", "scene is", "PSNR dB", "mJ")
    )
    figure, (quality, energy) = panels(2)
    lines = [(s, state) for s in data.different("scene") for state in data.different("scene is")]
    for at, (scene, state) in enumerate(lines):
        rows = data.where(**{"scene": scene, "scene is": state})
        rows.sort(key=lambda row: number(row["of the preset's"]))
        sizes = [number(row["of the preset's"]) for row in rows]
        for axes, column in ((quality, "PSNR dB"), (energy, "mJ")):
            values = [number(row[column]) for row in rows]
            axes.plot(
                sizes,
                [float("nan") if v is None else v for v in values],
                label=f"{scene}, {state}",
                **line_style(at),
            )
    quality.set_title("PSNR, dB")
    energy.set_title("Energy of a frame, mJ")
    from_zero(energy)
    sizes = sorted({number(row["of the preset's"]) for row in data.rows})
    for axes in (quality, energy):
        axes.set_xscale("log", base=2)
        axes.set_xticks(sizes, [f"{size:g}" for size in sizes])
        axes.minorticks_off()
        axes.set_xlabel("size of a voxel, times the preset's (2 or 0.4, by extent)")
        published(axes, 1, "the paper's", vertical=True)
    legend_above(figure, quality, columns=3)
    return figure, f"Size of a voxel against quality and energy. From {data.made}"


def filter_units(results: Results) -> Made:
    """The grid of CFUs and FFU lanes."""
    data = results.table("explore", "explore.py", ())
    if "cycles" not in data.rows[0]:
        raise Missing(f"{results.folder / 'explore.csv'} has no column cycles")
    keys = list(data.rows[0])[: list(data.rows[0]).index("cycles")]
    varying = [key for key in keys if len(data.different(key)) > 1]
    coarse = [key for key in varying if key.rpartition(".")[2].startswith("cfu")]
    fine = [key for key in varying if key.rpartition(".")[2].startswith("ffu")]
    if len(varying) != 2 or len(coarse) != 1 or len(fine) != 1:
        raise Missing(
            f"{results.folder / 'explore.csv'} varies {', '.join(varying) or 'nothing'}, not CFUs "
            "and FFUs; scripts/explore.py --config paper --axis hfu.cfus=1,2,4,8 "
            "--axis hfu.ffu_lanes=4,8,16,32 makes it"
        )
    columns, rows = (sorted(data.different(key), key=number) for key in (coarse[0], fine[0]))
    cycles = {(row[coarse[0]], row[fine[0]]): number(row["cycles"]) for row in data.rows}
    slowest = max(cycles.values())
    gains = [
        [slowest / cycles[c, f] if (c, f) in cycles else float("nan") for c in columns]
        for f in rows
    ]
    figure, (axes,) = panels(1, width=5.2, height=3.9)
    drawn = axes.imshow(gains, cmap="YlGnBu", origin="lower", aspect="auto")
    middle = (drawn.get_clim()[0] + drawn.get_clim()[1]) / 2
    for y, line in enumerate(gains):
        for x, gain in enumerate(line):
            colour = "white" if gain > middle else "black"
            axes.annotate(f"{gain:.2f}", (x, y), ha="center", va="center", color=colour)
    axes.set_xticks(range(len(columns)), columns)
    axes.set_yticks(range(len(rows)), rows)
    axes.set_xlabel(coarse[0])
    axes.set_ylabel(fine[0])
    axes.set_title("Times as fast as the slowest")
    axes.grid(visible=False)
    figure.colorbar(drawn, ax=axes, shrink=0.9)
    said = "The paper's heat map says that more CFUs help and more FFUs do not"
    return figure, f"Coarse filters against lanes of the fine ones. {said}. From {data.made}"


FIGURES = {
    "characterisation": characterisation,
    "dram_by_stage": dram_by_stage,
    "variants": variants,
    "voxel_size": voxel_size,
    "filter_units": filter_units,
}
