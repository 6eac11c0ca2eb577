"""README: its code, scenes, commands and output are current."""

import re
import shlex
import sys
import tomllib
from pathlib import Path

import processes
from polhode._cli import main

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text()
SYSTEMS = ("unknown-linux-gnu", "apple-darwin")
POLHODE = Path(sys.executable).with_name("polhode")


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", README, flags=re.DOTALL)


def test_python_blocks_run():
    code = "\n".join(blocks("python"))
    assert "ph.simulate" in code
    done = processes.run([sys.executable, "-W", "error", "-c", code])
    assert done.returncode == 0, done.stderr


def test_links_work_on_other_sites():
    """PyPI shows this file too, so that links are whole addresses."""
    text = re.sub(r"```.*?```|(?<!\[)`[^`\n]+`(?!\])", "", README, flags=re.DOTALL)
    addresses = dict(re.findall(r"^\[(.+)\]: (\S+)$", text, flags=re.MULTILINE))
    used = re.findall(r"\[([^\[\]]+)\](?!: http|\()", text)
    assert {*used} == {*addresses}
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    for address in addresses.values():
        kind, _, path = address.removeprefix(f"{project['urls']['Source']}/").partition("/main/")
        assert (ROOT / path).is_dir() if kind == "tree" else (ROOT / path).is_file(), address
    assert re.findall(r"\]\((?!https:)[^)]*\)", text) == []


def test_wheels_are_those_of_the_release():
    """The systems that the comment on `pip install` names are those of the workflow."""
    (said,) = re.findall(r"^pip install polhode +# (.*)$", README, flags=re.MULTILINE)
    workflow = (ROOT / ".github/workflows/release.yml").read_text()
    targets = {*re.findall(r"target: ([\w-]+)", workflow)}
    targets |= {
        f"{m}-unknown-linux-gnu" for m in ("x86_64", "aarch64") if m in (ROOT / "Makefile").read_text()
    }
    assert "Linux and macOS on x86-64 and arm64, and Windows on x86-64" in said
    assert targets == {
        *(f"{machine}-{system}" for machine in ("x86_64", "aarch64") for system in SYSTEMS),
        "x86_64-pc-windows-msvc",
    }


def test_the_scene_is_the_example():
    scene, _ = blocks("toml")
    example = (ROOT / "examples/t-handle.toml").read_text()
    example = re.sub(r'caption = """.*?"""\n', "", example, flags=re.S)
    lines = [line for line in example.splitlines() if line and not line.startswith(("#", "title"))]
    assert [line for line in scene.splitlines() if line] == lines


def test_the_torques_are_those_of_a_scene(tmp_path):
    scene, torques = blocks("toml")
    define = '[define]\nm = "0.2 A m^2 e1"\nB = "30 uT e3"\n'
    body = re.sub(r"mesh = .*\nlength_unit = .*\ndensity = .*", "moments = [1, 2, 3]", scene)
    body = body.replace("samples = 6001", "samples = 11").replace("5 rev/s", "5 deg/s")
    (tmp_path / "a.toml").write_text(define + body + torques)
    done = processes.run([POLHODE, "run", "a.toml"], cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "torque_body       m ∧ (~R B R)" in done.stdout


def test_the_error_is_shown_as_printed(tmp_path):
    text = (ROOT / "examples/t-handle.toml").read_text().replace("duration", "durration")
    (tmp_path / "t-handle.toml").write_text(text)
    done = processes.run([POLHODE, "check", "t-handle.toml"], cwd=tmp_path)
    assert done.returncode == 3
    assert any(block.strip() in done.stderr for block in blocks("text"))


def test_the_summary_is_that_of_the_demo(tmp_path):
    done = processes.run([POLHODE, "demo", "-o", tmp_path], check=True)
    (shown,) = (block for block in blocks("text") if "principal moments" in block)
    # Rounding drifts differ between machines.
    expected = [line for line in shown.splitlines() if "drift" not in line and "|R|" not in line]
    printed = done.stdout.splitlines()
    assert [line for line in expected if line not in printed] == []


def test_the_commands_are_commands():
    commands = re.findall(r"^(?:\$ )?polhode (.*?)(?:  +#.*)?$", README, flags=re.MULTILINE)
    asked = [shlex.split(command) for command in commands if not command.startswith("examples")]
    assert len(asked) > 5
    for arguments in asked:
        assert callable(main._parser().parse_args(arguments).command)


def test_the_extras_are_those_of_the_package():
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    text = README.partition("Extras:")[2].partition("\n\n")[0]
    named = {name.removeprefix("polhode[").removesuffix("]") for name in re.findall(r"`([\w\[\]-]+)`", text)}
    assert named == {*extras} - {"bench"}
