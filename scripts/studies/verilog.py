"""Modules of the Verilog that are synthesised, and the parts of the ledger that they stand for."""

from __future__ import annotations

import dataclasses
import pathlib

from runs.scenes import REPOSITORY
from studies.gates import GATED_BITS


def verilog_in(*folders: str) -> tuple[pathlib.Path, ...]:
    return tuple(
        source for folder in folders for source in sorted((REPOSITORY / folder).glob("*.v"))
    )


VERILOG = verilog_in("modules/datapath/rtl", "modules/streaminggs/rendering/rtl")
SELECTION = verilog_in("modules/datapath/rtl/selection")
SORTING = verilog_in("modules/streaminggs/sorting/rtl")
MERGE = verilog_in("modules/streaminggs/merge/rtl")

Parts = tuple[tuple[str, float], ...]  # kinds and how many


@dataclasses.dataclass(frozen=True)
class Module:
    """top, parameters: in Verilog. charged: parts of the ledger, or the datapath of `exact` that
    has them beside so many lanes. done: operations in a cycle, if not one of each part. rest: the
    charged part that has what the others leave of the module. published: what published constants
    have for it. apart: modules in it that are counted by themselves. interval: cycles that its
    input `phase` counts. sources: what is read with it; mappers choose by order, so another file
    there moves a number."""

    name: str
    top: str
    charged: Parts | str
    published: Parts = ()
    parameters: tuple[str, ...] = ()
    apart: tuple[str, ...] = ()
    lanes: int = 0
    interval: int = 1
    sources: tuple[pathlib.Path, ...] = VERILOG
    rest: str = ""
    done: Parts = ()


def one(kind: str) -> Parts:
    return ((kind, 1),)


def choice(levels: int) -> Module:
    """Of 2^levels words. A word passes a multiplexer on each level."""
    words = 1 << levels
    return Module(
        f"choice of {words} words",
        "choice",
        (("select_bit", 32 * (words - 1)), ("register_bit", words)),
        done=(("select_bit", 32 * levels), ("register_bit", words)),
        parameters=parameters(WORDS=words, SELECT_BITS=levels),
        sources=SELECTION,
    )


def parameters(**values: int) -> tuple[str, ...]:
    return tuple(f"{name} {value}" for name, value in values.items())


HALF = parameters(EXPONENT_BITS=5, FRACTION_BITS=10)
COMPARES = parameters(HAS=3)
LANE, CHAINS = one("fp32_lane"), one("fp32_chaining_lane")
LANES = ("lane", "fp32_lane")
EXCHANGE = (("comparator", 2), ("exchange_bit", 72))
PUBLISHED_EXCHANGE = (("comparator", 0.5), ("exchange_bit", 32))
# As modules/streaminggs/heap_ledger.h: keys of 256 bits, nodes of 522.
HEAP_LEVEL = (
    ("register_bit", 256 + 522),
    ("heap_bit", 7 * 256 + (4 + 2 + 1) * 522),
    ("comparator", 4),
)
# The part whose energy is published: a multiplier and an adder. All others are so much of it.
OF_KNOWN_ENERGY = "fp32 lane that only chains"
MODULES = (
    Module("fp32 lane", "fp32_lane", LANE, LANE),
    Module(OF_KNOWN_ENERGY, "lane", CHAINS, LANE, parameters(UNROUNDED=0)),
    Module("fp16 lane", "fp16_lane", one("fp16_lane"), one("fp16_lane")),
    Module("comparator of words", "word_comparator", one("comparator"), one("comparator")),
    Module(
        "comparator of numbers",
        "comparator",
        one("number_comparator"),
        one("comparator"),
        COMPARES,
    ),
    Module(
        "comparator of halves",
        "comparator",
        one("half_comparator"),
        one("comparator"),
        (*HALF, *COMPARES),
    ),
    Module("adder", "comparator", one("adder"), one("comparator"), parameters(HAS=4)),
    Module("whole number to float", "whole_number", one("conversion"), (("comparator", 2),)),
    Module("rounding", "rounding", one("rounding"), (("comparator", 3),)),
    Module("split of 2^t", "exp2_split", one("exp2_split"), (("comparator", 4),)),
    Module("split of 2^t, half", "exp2_split", one("exp2_split_half"), (("comparator", 4),), HALF),
    Module("scaling in half", "half_scale", one("half_scale"), one("comparator")),
    Module("table of 2^t", "exp2_table", one("exp2_table"), one("exp2_table")),
    Module("table of 2^t, half", "exp2_table_half", one("exp2_table_half"), one("exp2_table_half")),
    Module("seed of a root", "root_seed", one("seed_table"), one("small_table")),
    Module("seed of a reciprocal", "reciprocal_seed", one("seed_table"), one("small_table")),
    Module(
        "logarithm's table",
        "logarithm_split",
        one("logarithm_table"),
        (("small_table", 1), ("comparator", 1)),
    ),
    Module("root of a reach", "reach_table", one("reach_table"), one("small_table")),
    Module(
        "32 register bits",
        "stage",
        (("register_bit", 32),),
        (("register_bit", 32),),
        parameters(WIDTH=32),
    ),
    # Inputs of lanes: of a blend, of filters.
    choice(levels=2),
    choice(levels=5),
    # Of the rendering cluster: its lanes have rows of their own.
    Module("a comparison alone", "less_or_equal", one("number_comparator"), one("comparator")),
    Module("column of a sub-tile", "subtile_column", ()),
    Module("line above a row", "row_line", ()),
    Module(
        "farther edge of a row",
        "row_edge",
        (("number_comparator", 2), ("register_bit", 32), ("select_bit", 32)),
    ),
    Module(
        "pixel of a blend, 4 lanes apart",
        "pixel_blend",
        "subtile_blend",
        apart=LANES,
        lanes=4,
        interval=3,
    ),
    Module(
        "blend of a sub-tile, 16 pixels apart",
        "subtile_blend",
        (),
        apart=("pixel_blend",),
        interval=3,
    ),
    Module(
        "span of a row, 10 lanes apart",
        "row_span",
        "row_span",
        apart=LANES,
        lanes=10,
        interval=2,
    ),
    Module("dispatcher", "dispatcher", (("adder", 4),)),
    Module("draining of a group", "drain", ()),
    # Of the sorting network, which has 80 of them: 64 bits of a key are compared.
    Module(
        "compare-exchange of keys, place of 8 bits",
        "compare_exchange",
        EXCHANGE,
        sources=SORTING,
        rest="exchange_bit",
    ),
    Module(
        "compare-exchange of 16 bits, 16 bits beside",
        "compare_exchange",
        PUBLISHED_EXCHANGE,
        parameters=parameters(KEY_BITS=16, PLACE_BITS=16),
        sources=SORTING,
    ),
    Module(
        "level of the heap",
        "heap_level",
        HEAP_LEVEL,
        parameters=parameters(LEVEL=4),
        sources=MERGE,
        rest="heap_bit",
    ),
)
# Of cells alone: what the clock takes in a cycle, tree and wires with it.
REGISTER_CLOCK = Module("clock of a register bit", "", one("register_clock"))
CLOCK_GATE = Module(f"clock gate of {GATED_BITS} register bits", "", one("clock_gate"))
