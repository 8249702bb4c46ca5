"""Results as they are read: by question in a README, and on one page with every row of every table.

questions.json beside the tables has what a person says of them, so that a table made again leaves
it as it is: of each question the finding, the table with the columns and rows that show it, what
limits it, a figure and the command that makes it again.
"""

from __future__ import annotations

import base64
import dataclasses
import pathlib
import re
from collections.abc import Iterator, Mapping, Sequence

from reporting import tables
from reporting.charts import details, escaped, table
from reporting.folder import read_table
from reporting.page import Panel, page
from tables import about_of, facts_of, made_sentence, markdown, table_of
from runs.files import content_digest, read_bytes, read_json

README, QUESTIONS = "README.md", "questions.json"
MOST_ROWS = 10  # of a table in the README
UNKNOWN = "no release"
# The commit of a program whose sources no commit has.
CHANGED = re.compile(r"\w+-dirty\b")


@dataclasses.dataclass(frozen=True)
class Question:
    """rows: values of columns that are shown. figure: a file, by its path from the tables."""

    question: str
    finding: str
    table: str
    command: str
    caveats: Sequence[str] = ()
    columns: Sequence[str] = ()
    rows: Mapping[str, Sequence[str]] = dataclasses.field(default_factory=dict)
    figure: str = ""


def questions(folder: pathlib.Path) -> list[Question]:
    """Raises ValueError for a finding with a number, which belongs into a table, OSError."""
    path = folder / QUESTIONS
    try:
        found = [Question(**each) for each in read_json(path)]
    except TypeError as error:
        raise ValueError(f"{path}: {error}") from error
    for each in found:
        if number := re.search(r"\d[\d.,]*", each.finding):
            raise ValueError(f"{path}: {each.question}: a finding with a number: {number.group()}")
    return found


def names(folder: pathlib.Path) -> list[str]:
    return sorted(path.stem for path in folder.glob("*.csv"))


def shown_rows(folder: pathlib.Path, of: Question) -> str:
    """As Markdown. Raises ValueError where there are none, or too many for a README."""
    text = table_of(folder, of.table, of.rows, of.columns)
    count = text.count("\n") - 2  # without its head
    if not 1 <= count <= MOST_ROWS:
        raise ValueError(f"{of.question}: {count} rows of {of.table}, expected 1 to {MOST_ROWS}")
    return text


def readme(folder: pathlib.Path) -> str:
    text = (
        "# Results\n\n`scripts/results.py --pages` writes this file from the tables beside it, and "
        "`out/results.html` with every row. Findings hold for their tables' scenes and sizes. Trained "
        "scenes are from the web, and not those of the literature of the same name. Their licences "
        "do not let them be shipped: give commands scenes of your own.\n"
    )
    for of in questions(folder):
        made = made_sentence(facts_of(folder, of.table))
        figure = f"; [figure]({of.figure})" if of.figure else ""
        text += (
            f"\n## {of.question}\n\n{of.finding}\n\n"
            f"<!-- rows: {of.table} -->\n{made}{shown_rows(folder, of)}\n"
            f"All rows: [{of.table}.csv]({of.table}.csv){figure}. Made again by `{of.command}`.\n"
            "<!-- end -->\n"
        )
        caveats = "".join(f"- {caveat}\n" for caveat in of.caveats)
        text += f"\n{caveats}" if caveats else ""
    listed = [(f"[{name}]({name}.csv)", command(folder, name)) for name in names(folder)]
    return (
        text
        + "\n## All tables\n\nUnits and meanings stand in a table's `.json`, limits also in `about.json`.\n\n"
        + f"<!-- rows: all -->\n{markdown(('table', 'made by'), listed)}<!-- end -->\n"
    )


def command(folder: pathlib.Path, name: str) -> str:
    """In short: the program, and of results.py the study."""
    said = facts_of(folder, name)["made"]["command"]
    short = re.match(r"(scripts/results\.py (--all )?)?[^\s,]+", said)
    return f"`{short[0]}`" if short else "no command"


def html(folder: pathlib.Path) -> str:
    asked = "".join(question_html(folder, of) for of in questions(folder))
    every = "".join(table_html(folder, name) for name in names(folder))
    panels = [Panel("questions", text=asked), Panel("all tables", text=every)]
    return page("Results", f"{len(names(folder))} tables, every row", panels)


def question_html(folder: pathlib.Path, of: Question) -> str:
    head, rule, *rows = (
        [cell.replace("\\|", "|") for cell in line[2:-2].split(" | ")]
        for line in shown_rows(folder, of).splitlines()
    )
    numeric = [at for at, cell in enumerate(rule) if cell.endswith(":")]
    caveats = "".join(f"<li>{with_code(caveat)}" for caveat in of.caveats)
    return (
        f"<section class=wide><h3>{with_code(of.question)}</h3><p>{with_code(of.finding)}</p>"
        f"{table(head, rows, numeric)}<ul>{caveats}</ul>{figure_html(folder, of)}"
        f"<p class=small>All rows: {escaped(of.table)}. <code>{escaped(of.command)}</code></p>"
        "</section>"
    )


def with_code(text: str) -> str:
    return re.sub("`([^`]*)`", r"<code>\1</code>", escaped(text))


def figure_html(folder: pathlib.Path, of: Question) -> str:
    """An SVG in the page itself."""
    if not of.figure:
        return ""
    svg = base64.b64encode(read_bytes(folder / of.figure)).decode()
    source = f"data:image/svg+xml;base64,{svg}"
    return f'<img alt="{escaped(of.question)}" src="{source}" style="max-width:100%">'


def table_html(folder: pathlib.Path, name: str) -> str:
    facts = facts_of(folder, name)
    meanings = [(of["name"], of["unit"], of["meaning"]) for of in facts["columns"]]
    made = made_sentence(facts).replace("`", "")
    return details(
        name,
        f"<p>{escaped(about_of(folder, name))}</p><p class=small>{escaped(made)}</p>"
        + tables.table_html(read_table(folder / f"{name}.csv"))
        + details("columns", table(("column", "unit", "meaning"), meanings)),
    )


def releases(folder: pathlib.Path) -> dict[str, list[str]]:
    """Tables by the program that made them: its version and commit, as far as they say it."""
    found: dict[str, list[str]] = {}
    for name in names(folder):
        made = facts_of(folder, name)["made"]
        for commit in made["commits"]:
            for release in made["releases"] or [UNKNOWN]:
                found.setdefault(f"{release}, {commit}", []).append(name)
    return found


def faults(folder: pathlib.Path) -> list[str]:
    """Why these tables are not all of one program that can be had again."""
    said = []
    made = {name: facts_of(folder, name)["made"] for name in names(folder)}
    nameless = [name for name, of in made.items() if not of["commits"]]
    if typed := [name for name in nameless if not studies_of(made[name]["command"])]:
        by_hand = ", ".join(f"{name} (`{made[name]['command']}`)" for name in typed)
        said.append(f"{len(typed)} tables name no commit, since no study writes them: {by_hand}")
    if earlier := [name for name in nameless if name not in typed]:
        again = ", ".join(f"{name} (--all {studies_of(made[name]['command'])[0]})" for name in earlier)
        said.append(f"{len(earlier)} tables name no commit, to be made again: {again}")
    if unnamed := [name for name, of in made.items() if of["commits"] and not of["releases"]]:
        said.append(f"{len(unnamed)} tables name no release: {', '.join(unnamed)}")
    if changed := [name for name, of in made.items() if any(map(CHANGED.fullmatch, of["commits"]))]:
        said.append(f"{len(changed)} tables are of uncommitted sources: {', '.join(changed)}")
    for what in ("commits", "releases"):
        if mixed := [name for name, of in made.items() if len(of[what]) > 1]:
            each = ", ".join(f"{name} ({', '.join(made[name][what])})" for name in mixed)
            said.append(f"{len(mixed)} tables mix {what}: {each}")
    said += [fault for name in made for fault in faults_of_sources(folder, name, made)]
    if len(found := releases(folder)) > 1:
        said.append(f"tables of {len(found)} programs, expected one")
        said += [f"{label}: {', '.join(of)}" for label, of in sorted(found.items())]
    return said


def studies_of(command: str) -> list[str]:
    """Those that its calls of results.py run."""
    return re.findall(r"scripts/results\.py (?:--all )?(\w+)", command)


def faults_of_sources(
    folder: pathlib.Path, name: str, made: Mapping[str, Mapping]
) -> Iterator[str]:
    """Of the tables that a table is made of: its inputs NAME.csv."""
    inputs = made[name]["inputs"]
    sources = {of: of.removesuffix(".csv") for of in inputs if of.removesuffix(".csv") in made}
    if unnamed := [source for source in sources.values() if not made[source]["releases"]]:
        yield f"{name} is made of tables that name no release: {', '.join(unnamed)}"
    for file in sources:
        if content_digest(folder / file) != inputs[file]:
            yield f"{name} was made of another {file} than there is"
