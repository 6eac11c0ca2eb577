"""Runs a target of `readers` under atheris: python fuzz/python/run.py NAME [options of libFuzzer].

The corpus is in build/fuzz/NAME, and begins with files that the writers make.
"""

import sys
from pathlib import Path

import atheris

with atheris.instrument_imports(include=["polhode"]):
    from readers import TARGETS

if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] not in TARGETS:
        sys.exit(f"usage: python fuzz/python/run.py {{{','.join(TARGETS)}}} [options of libFuzzer]")
    target, corpus = TARGETS[sys.argv[1]], Path("build/fuzz") / sys.argv[1]
    corpus.mkdir(parents=True, exist_ok=True)
    for k, seed in enumerate(target.corpus()):
        (corpus / f"seed-{k}").write_bytes(seed)
    atheris.Setup([sys.argv[0], str(corpus), *sys.argv[2:]], target.check)
    atheris.Fuzz()
