"""Frames back to back on the report page: what they come to, their pictures, the memory's power."""

from __future__ import annotations

from reporting import charts
from reporting.charts import escaped, number, percent, rate
from reporting.folder import MEMORY_COMMANDS, MEMORY_STATES, Stream


def milliseconds(seconds: float) -> str:
    return f"{number(1e3 * seconds)} ms"


def held(report: dict) -> str:
    """Whether the display had a frame for each picture."""
    if report["frame_rate"] == 0:
        return "as fast as it goes, without a display"
    missed, frames = report["missed_frames"], len(report["frames"])
    if missed == 0:
        return f"every frame in its picture, {report['frame_rate']:g} a second"
    return (
        f"{missed} of {frames} frames miss their picture, {report['frame_rate']:g} a second; "
        f"{report['repeated_pictures']} pictures repeat the one before"
    )


def time_of(report: dict) -> str:
    """That energy and power are told of."""
    frames = report["flow"]["frames"]
    if frames == len(report["frames"]):
        return f"all {frames} frames, with the rest between them"
    return f"{frames} frames from the first picture to the last, with the rest between them"


def latency(report: dict) -> tuple[str, str, str]:
    times, late = report["latency"], report["latched_late"]
    note = f"from the pose of frame n, at n/{report['frame_rate']:g} s, to the middle row's light; "
    note += f"worst {milliseconds(times['worst_s'])}; with poses measured when frames begin "
    note += f"{milliseconds(late['median_s'])}, {milliseconds(late['worst_s'])}"
    return "motion to photon", milliseconds(times["median_s"]), note


def key_numbers(of: Stream) -> list[tuple[str, str, str]]:
    """Name, value and note each."""
    report, flow, area = of.report, of.report["flow"], of.all.report["area_mm2"]
    frames, times, watts = flow["frames"], report["frame_time"], flow["power_w"]
    squares = area["bands"]["total"]
    late = f"; {report['rows_late']} rows come too late" if report["rows_late"] else ""
    return [
        ("frames a second", rate(report["frames_per_s"]), held(report) + late),
        *([latency(report)] if report["frame_rate"] > 0 else []),
        (
            "frame, begin to last pixel",
            milliseconds(times["median_s"]),
            f"p99 {milliseconds(times['p99_s'])}; worst {milliseconds(times['worst_s'])}, "
            f"frame {report['worst_frame']}",
        ),
        (
            "power",
            f"{number(watts['middle'])} W",
            f"{number(watts['low'])} .. {number(watts['high'])} W; "
            f"{number(flow['with_memory_interface_w']['middle'])} W with PHY and controller of the "
            f"memory; {number(1e3 * flow['energy']['total_j'] / frames)} mJ a frame",
        ),
        (
            "DRAM",
            f"{number(flow['bytes'] / frames / 1e6)} MB a frame",
            f"{number(flow['bus_bytes'] / frames / 1e6)} MB on the bus",
        ),
        (
            "area",
            f"{number(area['total'])} mm²",
            f"{number(squares['low'])} .. {number(squares['high'])} mm², "
            f"{of.all.report['provenance']['technology']}",
        ),
    ]


def memory(flow: dict) -> str:
    """Watts of the memory's states and commands."""
    told, time_s = flow["memory"], flow["time_s"]
    states = [
        (
            f"in {state.replace('_', ' ')}, {percent(told[state]['time_s'] / time_s)} of the time",
            told[state]["energy_j"],
        )
        for state in MEMORY_STATES
        if state in told
    ]
    commands = [
        (f"above it: {command}", told[f"{command}_j"])
        for command in MEMORY_COMMANDS
        if f"{command}_j" in told
    ]
    rows = [(what, number(joules / time_s)) for what, joules in states + commands]
    whole = sum(joules for _, joules in states + commands)
    return charts.table(("what", "W"), [*rows, ("all", number(whole / time_s))], numeric=(1,))


def sheet(uris: dict[str, str], remark: str) -> str:
    note = f"<p class=small>{escaped(remark)}</p>" if remark else ""
    if "frames" not in uris:
        return note or "<p class=note>No pictures lie beside this report.</p>"
    return (
        f'<img class=sheet src="{uris["frames"]}" alt="frames, as the display showed them">{note}'
    )
