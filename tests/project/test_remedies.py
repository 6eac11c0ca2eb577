"""Errors name a remedy that helps; a missing file is a FileNotFoundError of any kind of file."""

import pytest

import polhode as ph
import studios
from command_line import polhode

BODY = ph.Inertia.from_principal_moments(1, 2, 3)
GRID = ph.simulate(BODY, ph.State(ph.Rotor.random((2, 3), rng=1), [0.1, 2, 0.1]), [0.0, 0.5, 1.0])


@pytest.mark.parametrize("name", ["plot", "film"])
def test_a_body_picked_from_a_batch_is_drawn(name, tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    studios.paint(monkeypatch)
    call = getattr(GRID, name)
    with pytest.raises(ValueError, match=rf"{name} .*\(2, 3\).*trajectory\[0, 0\]"):
        call(*([] if name == "plot" else [tmp_path / "a.gif"]))
    if name == "plot":
        assert GRID[0, 0].plot().axes
    else:
        GRID[0, 0].film(tmp_path / "a.gif", seconds=0.4, fps=10, size=(80, 60))
        assert (tmp_path / "a.gif").stat().st_size


def test_a_body_picked_from_a_batch_is_shown():
    from polhode._viewer.document import document

    with pytest.raises(ValueError, match=r"the viewer .*trajectory\[0, 0\]"):
        document(GRID)
    assert document(GRID[0, 0])["recorded"]


@pytest.mark.parametrize("name", ["at", "drifts"])
def test_methods_of_picked_bodies_name_the_remedy(name):
    with pytest.raises(ValueError, match="simulate that body alone"):
        getattr(GRID, name)(*([0.3] if name == "at" else []))


READERS = {
    "absent.toml": ph.Scene.read,
    "absent.nc": ph.Trajectory.read,
    "absent.stl": lambda path: ph.Body.from_mesh(path, mass=1.0),
}


@pytest.mark.parametrize("name", READERS)
def test_a_missing_file_is_a_file_not_found_error(name, tmp_path):
    if name.endswith(".nc"):
        pytest.importorskip("h5py")
    with pytest.raises(FileNotFoundError, match=rf"{name}: .*no such file"):
        READERS[name](tmp_path / name)


def test_a_missing_scene_is_a_scene_error_too(tmp_path):
    with pytest.raises(ph.SceneError, match="no such file"):
        ph.Scene.read(tmp_path / "absent.toml")
    with pytest.raises(ph.SceneError, match="is a directory") as error:
        ph.Scene.read(tmp_path)
    assert not isinstance(error.value, FileNotFoundError)
    for command in (("run",), ("check",), ("figure", "-o", "a.png", "motion")):
        done = polhode(*command, "absent.toml", cwd=tmp_path)
        assert done.returncode == 3
        assert done.stderr == "absent.toml: error: no such file\n"
