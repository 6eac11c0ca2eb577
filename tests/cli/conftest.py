"""The command run in the process of the tests."""

from types import SimpleNamespace

import pytest


@pytest.fixture
def command(tmp_path, monkeypatch, capsys):
    """Return a function that runs the command in this process, in a folder of its own."""
    from polhode._cli.main import main

    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        try:
            code = main([*arguments])
        except SystemExit as stop:
            code = stop.code
        output = capsys.readouterr()
        return SimpleNamespace(returncode=code, stdout=output.out, stderr=output.err)

    return run
