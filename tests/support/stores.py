"""A small ensemble whose Zarr store has four blocks, and the content of stores."""

import json

from command_line import SCENE, polhode

# Four blocks of bodies: 512, 512, 512 and 464. Damping has no closed form with a magnetic torque.
ENSEMBLE = """
[ensemble]
number = 2000
seed = 5
attitude = "uniform"
spin = { direction = "uniform", relative = 0.1 }
moments = { relative = 0.05 }
velocity = { normal = [1, "2 m/s", 0] }
torque.damping = { relative = 0.3 }
torque.magnetic.field = { uniform = 0.5 }
"""
LAWS = "[torque]\ndamping = 0.2\nmagnetic = { dipole = [1, 0, 0], field = [0, 1, 2] }\n"
TEXT = SCENE.replace("[run]", LAWS + "[run]") + ENSEMBLE
NUMBER = 2000


def content(store):
    """The bytes of each file of a store, locks and unfinished blocks apart."""
    files = (path for path in store.rglob("*") if path.is_file())
    names = {path.relative_to(store).as_posix(): path for path in files}
    passing = (".polhode/locks/", ".polhode/parts/")
    return {name: path.read_bytes() for name, path in names.items() if not name.startswith(passing)}


def status(store):
    """The verified state of a store."""
    done = polhode("run", "--status", store, "--json")
    assert done.returncode in (0, 1), done.stderr
    result = json.loads(done.stdout)
    assert done.returncode == (0 if result["complete"] else 1)
    return result
