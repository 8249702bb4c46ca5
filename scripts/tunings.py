"""Calls of `streaminggs tune` that the scripts of the quality study share, word for word, so that
what one has made the others find."""

from __future__ import annotations

import argparse
import dataclasses
import pathlib
from collections.abc import Sequence

from runs import run_arguments
import subjects
from runs.fittings import Fitting
from subjects import Subject
from target_pictures import make

PAPER, PAPER_VQ = "paper_no_vq", "paper"
EXACT, EXACT_VQ = "exact", "exact_vq"
TEST_EVERY = "500"  # steps
OWN_RATE = 0.2  # of `tune --quantise` and `--streaming`, where none is given


@dataclasses.dataclass(frozen=True)
class Tunings:
    """precision: that paper order is drawn in while it is tuned for. paper_set: KEY=VALUE over the
    presets of paper order."""

    steps: int
    quantised_steps: int
    misordered_in: str
    penalty_mean: str
    rate: float
    precision: str
    paper_set: tuple[str, ...]

    def voxel_words(self, voxel: float) -> tuple[str, ...]:
        """For --set of paper order."""
        return (f"storage.voxel_size={voxel:g}", *self.paper_set)

    def tuned_in(self) -> tuple[str, ...]:
        """For --set of a tuning for paper order: a precision, and the memory that it needs."""
        return set_words((f"rendering.precision={self.precision}", "sram.shared_bytes=0"))

    def boundary(self, subject: Subject, voxel: float, beta: float) -> Fitting:
        words = (subject.scene, "--boundary", "--config", PAPER)
        words += (*self.tuned_in(), *set_words(self.voxel_words(voxel)), *subject.target_words())
        words += ("--steps", str(self.steps), "--beta", f"{beta:g}", "--rate", f"{self.rate:g}")
        words += ("--misordered-in", self.misordered_in, "--penalty-mean", self.penalty_mean)
        label = f"{subject.name} boundary voxels {voxel:g} beta {beta:g}"
        return Fitting(label, "tune", (*words, "--test-every", TEST_EVERY))

    def quantised(
        self, subject: Subject, given: str, config: str, settings: tuple[str, ...]
    ) -> Fitting:
        """given: the scene to begin with. settings: words for the command."""
        words = (given, "--quantise", "--config", config, *settings)
        words += (*subject.target_words(given), "--steps", str(self.quantised_steps))
        label = f"{subject.name} quantise {config}"
        return Fitting(label, "tune", (*words, "--test-every", TEST_EVERY), ".sgs")

    def streaming(self, subject: Subject, price: float) -> Fitting:
        return in_reference_order(subject, price, self.steps, OWN_RATE)

    def as_long_as_boundary(self, subject: Subject) -> Fitting:
        """What its steps alone do, seen in the reference order."""
        return in_reference_order(subject, 0, self.steps, self.rate)

    def as_long_as_quantised(self, subject: Subject) -> Fitting:
        return in_reference_order(subject, 0, self.quantised_steps, OWN_RATE)


def in_reference_order(subject: Subject, price: float, steps: int, rate: float) -> Fitting:
    """Without codebooks; with a price of 0 it is for no machine at all."""
    words = (subject.scene, "--streaming", "--config", EXACT, *subject.target_words())
    words += ("--steps", str(steps), "--price", f"{price:g}", "--test-every", TEST_EVERY)
    label = f"{subject.name} streaming price {price:g}"
    if rate != OWN_RATE:
        words += ("--rate", f"{rate:g}")
        label += f" rate {rate:g}"
    return Fitting(label, "tune", words)


def set_words(settings: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(word for setting in settings for word in ("--set", setting))


def check_settings(binary: pathlib.Path, calls: Tunings, configs: Sequence[str]) -> None:
    """Whether these presets of paper order take --paper-set, before anything is trained. Raises
    ValueError."""
    for config in configs:
        words = ["builtin:object?n=1", "--config", config, *set_words(calls.paper_set)]
        make(binary, "simulate", [*words, "--print-config"])


def voxel_of_preset(binary: pathlib.Path, subject: Subject) -> float:
    """World units that the preset of paper order takes for the scene as given. Tuned, a scene would
    get others by the preset's rule."""
    lines = make(binary, "info", [subject.scene]).splitlines()
    (voxel,) = (line.split()[2] for line in lines if line.startswith("voxel size "))
    return float(voxel)


def study_parser(doc: str | None, forms: str) -> run_arguments.Parser:
    """Of a script that tunes. forms: what its subjects may be."""
    parser = run_arguments.parser(doc, " ".join(subjects.DEFAULT_SUBJECTS), forms=forms)
    run_arguments.add_fittings_side_by_side(parser)
    subjects.add_arguments(parser)
    parser.add_argument("--steps", type=int, default=3_000, help="of tuning for an order")
    parser.add_argument(
        "--misordered-in", choices=("group", "pixel"), default="group", help="as of tune"
    )
    parser.add_argument(
        "--penalty-mean", choices=("rendered", "scene"), default="rendered", help="as of tune"
    )
    parser.add_argument("--rate", type=float, default=1, help="of boundary-aware tuning")
    parser.add_argument(
        "--precision",
        choices=("fp32", "fp16"),
        default="fp32",
        help="that paper order is drawn in while it is tuned for; fp16, as its presets have it, "
        "takes half as long again to draw",
    )
    parser.add_argument(
        "--paper-set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="over the presets of paper order, where a scene is tuned and where it is drawn",
    )
    return parser


def add_beta(parser: run_arguments.Parser) -> None:
    parser.add_argument("--beta", type=float, default=0.05, help="of L_CBP; the paper's")


def tunings_of(arguments: argparse.Namespace, quantised_steps: int = 5_000) -> Tunings:
    return Tunings(
        arguments.steps,
        quantised_steps,
        arguments.misordered_in,
        arguments.penalty_mean,
        arguments.rate,
        arguments.precision,
        tuple(arguments.paper_set),
    )
