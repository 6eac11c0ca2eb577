"""Write build/evidence.html, which `make evidence` regenerates.

The page compares our motions with the 40-digit references row by row, measures the rounding of exp and log,
runs the tests of other libraries, counts faults, and repeats the benchmarks. The program fails if a row is
bad: an estimate smaller than the error, a test that fails without a reason, or a fault.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import warnings
from collections import Counter
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

import faults
import machine
import peer_tests
import references
import report
import rounding
import throughput
from page import Page
from polhode._support.files import write_atomically

SEED = 1


@dataclass(frozen=True)
class Effort:
    """Numbers of samples, damaged inputs and killed runs, and options of the benchmarks."""

    samples: int
    damaged: int
    kills: int
    benchmarks: tuple[str, ...]


FULL = Effort(20_000, 2_000, 20, ())
QUICK = Effort(2_000, 100, 3, ("--quick",))


def main() -> None:
    """Write the page; exit with 1 if something on it is bad."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--quick", action="store_true", help="take fewer samples and shorter benchmarks")
    parser.add_argument("--no-benchmarks", action="store_true", help="leave the benchmarks out")
    arguments = parser.parse_args()
    effort = QUICK if arguments.quick else FULL

    page = Page("Polhode: evidence")
    page.text("Each figure on this page was computed by the commit below, by one command: make evidence.")
    about = machine.describe()
    page.facts(
        f"{name}: {about[name]}" for name in ("date", "commit", "processor", "cores", "system", "Python")
    )
    bad = []
    for part in (motions, rotations, peers, damage):
        print((part.__doc__ or "").partition(";")[0], flush=True)
        bad.append(part(page, effort))
    if not arguments.no_benchmarks:
        speed(page, effort, about["commit"])
    target = machine.ROOT / "build" / "evidence.html"
    target.parent.mkdir(exist_ok=True)
    write_atomically({target: page.html()})
    print(f"Written to {target.relative_to(machine.ROOT)}")
    if any(bad):
        sys.exit(f"{sum(bad)} rows are bad; they are red on the page")


def motions(page: Page, _effort: Effort) -> int:
    """Compare motions with the references; return the number of estimates that are too small."""
    rows = list(references.outcomes())
    page.heading("Motions against 40 digits")
    page.text(
        "Errors of the final state by the method that simulate chooses: |R − R_true| of the rotors with "
        "their signs, half the angle in radians, and the relative error of the angular velocity. The "
        "references are two independent computations with 60 to 80 digits. Exact motions have no estimate: "
        "their error is rounding, and that of the start, for the numbers of Toutatis and the 0.01 of "
        "dzhanibekov_001 are not floats."
    )
    exact = [row for row in rows if row.method == "exact"]
    floats = [row for row in exact if not row.case.startswith(references.DECIMAL)]
    worst = max(floats, key=lambda row: row.rotor)
    page.text(
        f"{len(exact)} of {len(rows)} states are in closed form. From starts that are floats, their largest "
        f"error is {worst.rotor:.1e} ({worst.case}, t = {worst.time:g})."
    )
    page.table(
        ["case", "t", "method", "error of R", "error of ω", "estimate", "estimate/error"],
        (
            [
                row.case,
                f"{row.time:g}",
                row.method,
                f"{row.rotor:.1e}",
                f"{row.omega:.1e}",
                "–" if row.estimate is None else f"{row.estimate:.1e}",
                "–" if row.estimate is None else f"{row.estimate / row.rotor:.2g}",
            ]
            for row in rows
        ),
        [not row.is_honest for row in rows],
    )
    return sum(not row.is_honest for row in rows)


def rotations(page: Page, effort: Effort) -> int:
    """Plot the rounding errors of exp and log; return the number of functions with more than 2 ulp."""
    page.heading("Rounding of exp and log")
    found = rounding.measured(np.random.default_rng(SEED), effort.samples)
    page.table(
        ["function", "samples", "median, ulp", "largest, ulp", "at"],
        (
            [
                e.name,
                str(len(e.ulps)),
                f"{np.median(e.ulps):.2f}",
                f"{e.ulps.max():.2f}",
                f"{e.sizes[e.ulps.argmax()]:.3g}",
            ]
            for e in found
        ),
    )
    drawing = Figure(figsize=(9, 3.2))
    for axes, errors in zip(drawing.subplots(1, len(found), sharey=True), found, strict=True):
        axes.semilogx(errors.sizes, errors.ulps, ",", color="#1f5fa8", rasterized=True)
        axes.set(
            title=errors.name,
            xlabel="size",
            ylabel="error, ulp",
            ylim=(0, None),
            xlim=(1e-8, 3 * errors.sizes.max()),
        )
    page.plot(
        drawing,
        "Errors against 60 digits. " + "; ".join(f"{e.name}: {e.about}" for e in found) + ". ulp = 2⁻⁵².",
    )
    return sum(bool(e.ulps.max() > 2) for e in found)


def peers(page: Page, _effort: Effort) -> int:
    """Run the tests of other libraries; return the number of failures without a reason."""
    page.heading("Other libraries' own tests")
    page.text(
        "The tests that other libraries have of themselves, with Polhode behind their names. Words and "
        "kinds of errors are not compared. A test that does not pass has a reason, or else it has failed."
    )
    return sum(_peer(page, peer) for peer in peer_tests.PEERS)


def _peer(page: Page, peer: peer_tests.Peer) -> int:
    page.heading(peer.title, level=3)
    page.text(peer.layer)
    try:
        suites = peer_tests.outcomes(peer)
    except ConnectionError as error:
        page.text(f"Left out: {error}.")
        return 0
    page.table(
        ["file", "passed", "different by design", "not in Polhode", "skipped by its authors", "failed"],
        (
            [
                s.name,
                *(str(n) for n in (s.passed, len(s.by_design), len(s.missing), s.skipped, len(s.failed))),
            ]
            for s in suites
        ),
        [bool(s.failed) for s in suites],
    )
    for title, reasons in (
        ("different by design", [s.by_design for s in suites]),
        ("not in Polhode", [s.missing for s in suites]),
    ):
        counts = Counter(reason for each in reasons for reason in each.values())
        if counts:
            page.table([title, "tests"], ([reason, str(count)] for reason, count in counts.items()))
    failed = [test for suite in suites for test in suite.failed]
    if failed:
        page.text("Failed: " + ", ".join(failed))
    return len(failed)


def damage(page: Page, effort: Effort) -> int:
    """Count faults; return their number."""
    page.heading("Damaged input and killed runs")
    page.text(
        "Valid inputs with a few characters or bits changed, inserted or removed. Each is read, where it "
        "stays valid, or refused with an error of the documented kinds. Anything else is a fault."
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        counts = list(faults.damaged_inputs(SEED, effort.damaged))
    page.table(
        ["input", "tried", "read", "refused", "faults"],
        ([c.kind, str(c.tried), str(c.read), str(c.refused), str(len(c.faults))] for c in counts),
        [bool(c.faults) for c in counts],
    )
    for count in counts:
        page.text(*(f"{count.kind}: {fault}" for fault in sorted(set(count.faults))[:5]))
    kills = faults.killed_runs(SEED, effort.kills)
    page.text(
        f"polhode run, killed {kills.tried} times at random moments while it replaced a file: "
        f"{kills.old} times the old file was there, "
        f"{kills.new} times the new one, {kills.partial} times a damaged one."
    )
    return sum(len(count.faults) for count in counts) + kills.partial


def speed(page: Page, effort: Effort, commit: str) -> None:
    """Repeat the benchmarks and add their tables and plots."""
    page.heading("Speed and precision beside other libraries")
    subprocess.run([sys.executable, str(machine.ROOT / "benchmarks/run.py"), *effort.benchmarks], check=True)
    target = machine.ROOT / "build" / f"bench-{commit}"
    measured = json.loads(target.with_name(f"{target.name}.json").read_text())
    page.plot(throughput.plot(measured["rows"], measured["bandwidth"]), throughput.CAPTION)
    plots = {
        "motion": "Work and precision: error of the final attitude against CPU time.",
        "ensembles": "Ensembles: cost of a body and step.",
        "files": "Ensembles: cost of their files.",
    }
    for name, caption in plots.items():
        path = target.with_name(f"{target.name}-{name}.png")
        if path.is_file():
            page.image(path, caption)
    _, _, text = target.with_name(f"{target.name}.md").read_text().partition("\n## ")
    page.text("Libraries: " + ", ".join(map(" ".join, measured["versions"].items())) + ".", report.LEGEND)
    page.markdown(f"## {text}", deeper=1)


if __name__ == "__main__":
    main()
