"""What is needed to try the viewer; where it is missing, tests are left out and say what is."""

import shutil
import subprocess
from pathlib import Path

import pytest

from node_core import NodeCore
from viewer_scenes import ROOT, followed


@pytest.fixture(scope="package")
def node():
    """The path of Node, with the packages of the viewer."""
    found = shutil.which("node")
    version = subprocess.run([found, "--version"], capture_output=True, text=True, check=True).stdout if found else "v0"
    if int(version.strip().lstrip("v").split(".")[0]) < 20:
        pytest.skip("Node >= 20 was not found")
    if not (ROOT / "viewer/node_modules").exists():
        pytest.skip("viewer/node_modules is missing: make viewer")
    return found


@pytest.fixture(scope="package")
def core(node):
    """The core under Node."""
    core = NodeCore(node)
    yield core
    core.close()


@pytest.fixture(scope="package")
def follow(tmp_path_factory):
    """The scene of a name, followed by Python."""
    folder = tmp_path_factory.mktemp("scenes")
    return lambda name: followed(name, folder)
