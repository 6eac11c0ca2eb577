"""Compare the speed with other libraries: `python benchmarks/run.py [--quick] [--only SECTION]`.

Prints tables and writes them to build/bench-COMMIT.md, the data to build/bench-COMMIT.json, plots of work and
precision to build/bench-COMMIT-motion.png, of the cost of ensembles to build/bench-COMMIT-ensembles.png and
of that of their files to build/bench-COMMIT-files.png.
Compare ratios: absolute times depend on the machine and its load. A library that is not installed has an
empty column.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import nullcontext

import numpy as np

import algebras
import attitudes
import batches
import compiled
import ensemble_files
import ensembles
import imports
import machine
import motion
import report
import scaling
import single
import work_precision
from contest import FULL, QUICK, Pace, Row
from polhode._support.files import write_atomically

SECTIONS = {
    "One value": single.rows,
    "Batches": batches.rows,
    "Batches of 16 values": batches.few_rows,
    "Attitudes": attitudes.rows,
    "Formulas": compiled.rows,
    "Any signature": algebras.rows,
    "Motion": motion.rows,
    "Ensembles": ensembles.rows,
    "Import, beyond NumPy": imports.rows,
}
SEED = 1


def measured(rows: Iterator[Row], pace: Pace) -> list[Row]:
    """Build, measure and release one row after the other."""
    done = []
    for row in rows:
        with machine.on_one_core() if row.one_core else nullcontext():
            row.measure(pace)
        row.release()
        done.append(row)
    return done


def main() -> None:
    """Run the benchmarks, print the tables and write the files."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--quick", action="store_true", help="use smaller batches and shorter runs")
    titles = [*SECTIONS, scaling.TITLE, ensemble_files.TITLE, work_precision.TITLE]
    parser.add_argument(
        "--only",
        action="append",
        choices=titles,
        metavar="SECTION",
        help=f"one of {', '.join(titles)}; repeatable",
    )
    arguments = parser.parse_args()
    pace, wanted = QUICK if arguments.quick else FULL, arguments.only or titles

    about, versions = machine.describe(), machine.versions()
    one, all_cores = (machine.copy_bandwidth(threads, pace) for threads in (1, machine.cores()))
    about["copy"] = f"{one / 1e9:.1f} GB/s on one core, {all_cores / 1e9:.1f} GB/s on all, read and written"
    about["batch"] = f"{pace.batch} values, best of {pace.rounds} runs of {pace.span:g} s or more"

    page = []

    def say(text: str) -> None:
        print(text, flush=True)
        page.append(text)

    say(f"# Benchmarks\n\n{report.facts(about)}\n- libraries: {', '.join(map(' '.join, versions.items()))}\n")
    if set(SECTIONS) & set(wanted):
        say(f"{report.LEGEND}\n")
    sections = {}
    for title in (title for title in SECTIONS if title in wanted):
        sections[title] = measured(SECTIONS[title](np.random.default_rng(SEED), pace), pace)
        say(report.section(title, sections[title], max(one, all_cores)))
    costs = scaling.points(pace) if scaling.TITLE in wanted else []
    if costs:
        say(scaling.section(costs))
    written = ensemble_files.points(pace) if ensemble_files.TITLE in wanted else []
    if written:
        say(ensemble_files.section(written))
    panels = list(work_precision.panels(pace)) if work_precision.TITLE in wanted else []
    if panels:
        say(work_precision.section(panels))
    everything = [row for rows in sections.values() for row in rows]
    if everything:
        say(report.matrices(everything))
        page.append(f"## What was timed\n\n{report.spellings(everything)}\n")

    target = machine.ROOT / "build" / f"bench-{about['commit']}"
    target.parent.mkdir(exist_ok=True)
    files = {
        target.with_name(f"{target.name}.md"): "\n".join(page).encode(),
        target.with_name(f"{target.name}.json"): report.data(
            {
                **about,
                "bandwidth": max(one, all_cores),  # bytes per second
                "versions": versions,
                "costs": scaling.data(costs),
                "files": ensemble_files.data(written),
                "panels": work_precision.data(panels),
            },
            sections,
        ),
    }
    if panels and (drawing := work_precision.plot(panels)):
        files[target.with_name(f"{target.name}-motion.png")] = drawing
    if costs and (drawing := scaling.plot(costs)):
        files[target.with_name(f"{target.name}-ensembles.png")] = drawing
    if written and (drawing := ensemble_files.plot(written)):
        files[target.with_name(f"{target.name}-files.png")] = drawing
    write_atomically(files)
    print("Written to", " and ".join(str(path.relative_to(machine.ROOT)) for path in files))


if __name__ == "__main__":
    main()
