"""Completion in a shell: the scripts of `polhode --print-completion`, sourced and asked."""

import shutil

import pytest

import processes
from command_line import POLHODE, polhode
from polhode._cli import main

pytest.importorskip("shtab")
needs_bash = pytest.mark.skipif(shutil.which("bash") is None, reason="bash is not installed")


def printed(shell, capsys):
    with pytest.raises(SystemExit) as stop:
        main.main(["--print-completion", shell])
    assert stop.value.code == 0
    return capsys.readouterr().out


def completed(script, *words, cwd=None):
    """The words that bash offers for the last of these."""
    line = " ".join(f"'{word}'" for word in words)
    asked = f"COMP_WORDS=({line}); COMP_CWORD={len(words) - 1}; _shtab_polhode"
    command = f'{script}\n{asked}; printf "%s\\n" "${{COMPREPLY[@]}}"'
    done = processes.run(["bash", "-c", command], cwd=cwd)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout.split()


@needs_bash
def test_bash_completes_commands_options_and_files(capsys, tmp_path):
    script = printed("bash", capsys)
    assert completed(script, "polhode", "fi") == ["figure", "film", "fit"]
    assert completed(script, "polhode", "run", "--f") == ["--force"]
    assert completed(script, "polhode", "figure", "her") == ["herpolhode"]
    (tmp_path / "small.toml").touch()
    for words in (
        ("run", "sm"),
        ("check", "sm"),
        ("run", "small.toml", "-o", "sm"),
        ("film", "sm"),
        ("convert", "sm"),
    ):
        assert completed(script, "polhode", *words, cwd=tmp_path) == ["small.toml"]
    (tmp_path / "folder").mkdir()
    assert completed(script, "polhode", "demo", "-o", "fo", cwd=tmp_path)[0].rstrip("/") == "folder"


def test_zsh_has_a_script(capsys):
    script = printed("zsh", capsys)
    assert script.startswith("#compdef polhode\n")
    assert "--no-figures" in script


def test_other_shells_are_a_usage_error():
    done = polhode("--print-completion", "cmd")
    assert done.returncode == 2
    assert "invalid choice: 'cmd'" in done.stderr


def test_the_script_can_be_piped():
    done = processes.run(f'"{POLHODE}" --print-completion bash | head -1', shell=True)
    assert done.stderr == ""
