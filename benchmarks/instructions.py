"""Count the instructions of the core kernels: `python benchmarks/instructions.py [--update]`.

Compares the counts a row with those of `instructions.json`, and fails where one is 3 % larger: a regression
that no timing on a shared machine would show. Counts are those under valgrind, whose processor has AVX2; they
depend on the compiler, so that with another version of it they are shown and not compared.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
COMMITTED = ROOT / "benchmarks" / "instructions.json"
TOLERANCE = 0.03
# Two numbers of runs, of which the difference leaves out the start of the program.
FEW, MANY = 2, 6


def main() -> int:
    """Print a table of counts, and return 1 if a kernel takes more instructions than it did."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument(
        "--update", action="store_true", help="write the counts to benchmarks/instructions.json"
    )
    arguments = parser.parse_args()
    program = built()
    compiler = output("rustc", "--version").strip()
    counts = {name: counted(program, name, rows) for name, rows in kernels(program).items()}
    if arguments.update:
        text = json.dumps({"compiler": compiler, "instructions": counts}, indent=2, ensure_ascii=False)
        COMMITTED.write_text(text + "\n", encoding="utf-8")
    committed = json.loads(COMMITTED.read_text(encoding="utf-8"))
    before = committed["instructions"]
    for name, count in counts.items():
        change = f"{100 * (count / before[name] - 1):+8.1f} %" if name in before else "     new"
        print(f"{name:32}{count:10.1f} instructions a row{change}")
    if compiler != committed["compiler"]:
        print(f"not compared: these are of {compiler}, the committed counts of {committed['compiler']}")
        return 0
    if list(before) != list(counts):
        print(
            "the kernels are not those of benchmarks/instructions.json; run again with --update",
            file=sys.stderr,
        )
        return 1
    worse = [name for name, count in counts.items() if count > (1 + TOLERANCE) * before[name]]
    if worse:
        print(f"more than {100 * TOLERANCE:.0f} % slower: {', '.join(worse)}", file=sys.stderr)
        print(
            "if that is meant, run benchmarks/instructions.py --update and say why in the commit",
            file=sys.stderr,
        )
    return int(bool(worse))


def output(*command: str) -> str:
    """Return what a program printed."""
    return subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout


def built() -> str:
    """Build the program of the kernels and return its path."""
    build = "cargo build --release --locked --quiet -p polhode-rigid --example counted"
    messages = output(*build.split(), "--message-format=json-render-diagnostics").splitlines()
    return next(path for path in (json.loads(line).get("executable") for line in messages) if path)


def kernels(program: str) -> dict[str, int]:
    """Return the names of the kernels, and the rows of a run of each."""
    lines = (line.split("\t") for line in output(program).splitlines())
    return {name: int(rows) for rows, name in lines}


def counted(program: str, name: str, rows: int) -> float:
    """Return the instructions a row."""
    few, many = (_instructions(program, name, str(runs)) for runs in (FEW, MANY))
    return round((many - few) / (MANY - FEW) / rows, 2)


def _instructions(*command: str) -> int:
    valgrind = [
        "valgrind",
        "--tool=cachegrind",
        "--cache-sim=no",
        "--cachegrind-out-file=/dev/null",
        *command,
    ]
    try:
        done = subprocess.run(valgrind, check=False, capture_output=True, text=True)
    except FileNotFoundError:
        raise SystemExit("valgrind is missing; install the Debian package valgrind") from None
    found = re.search(r"I +refs: +([\d,]+)", done.stderr)
    if done.returncode or not found:
        raise SystemExit(f"{' '.join(command)} failed:\n{done.stderr}")
    return int(found[1].replace(",", ""))


if __name__ == "__main__":
    sys.exit(main())
