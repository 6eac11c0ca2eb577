"""Errors about files of other programs: what they say to do."""

import numpy as np
import pytest

import polhode as ph
from polhode.io import read_aem


def message(read, path, content):
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(ValueError) as caught:
        read(path)
    return str(caught.value)


def test_long_lines_are_shown_around_the_place(tmp_path):
    links = "<gazebo/>" * 1000 + '<link name="b"><inertial/></link>' + "<gazebo/>" * 1000
    content = f'<robot name="r">{links}</robot>'
    text = message(ph.read_urdf, tmp_path / "a.urdf", content)
    heading, _, line, carets = text.split("\n")
    assert f"a.urdf:1:{content.index('<inertial') + 1}: error" in heading
    assert line[carets.index("^") : carets.rindex("^") + 1] == "<inertial/>"
    assert line.startswith("1 | …")
    assert line.endswith("…")
    assert len(line) < 200


def test_the_last_columns_of_a_long_line_are_shown(tmp_path):
    text = message(ph.read_urdf, tmp_path / "a.urdf", f'<robot name="{"r" * 300}"><link/></robot>')
    line, carets = text.split("\n")[2:]
    assert line[carets.index("^") : carets.rindex("^") + 1] == "<link/>"
    assert line.endswith("</robot>")


def test_carets_end_with_the_line(tmp_path):
    text = message(ph.read_urdf, tmp_path / "a.urdf", f"<{'x' * 1000}/>")
    line, carets = text.split("\n")[2:]
    assert len(carets) <= len(line) < 200


def test_undeclared_encodings_are_named(tmp_path):
    link = '<robot name="r"><link name="é"/></robot>'
    assert "save the file as UTF-8" in message(ph.read_urdf, tmp_path / "a.urdf", link.encode("latin-1"))
    assert "not well-formed" in message(ph.read_urdf, tmp_path / "a.urdf", "<robot name=é/>")
    assert "save the file as UTF-8" in message(
        read_aem, tmp_path / "a.aem", "ORIGINATOR = é".encode("latin-1")
    )


def test_included_files_that_are_missing_are_named(tmp_path):
    body = '<mujoco><worldbody><body name="b">{}</body></worldbody></mujoco>'
    text = message(ph.read_mjcf, tmp_path / "m.xml", body.format('<include file="geoms.xml"/>'))
    assert "no such file: '" in text
    assert "geoms.xml'; paths in <include> are relative to the main file" in text
    text = message(ph.read_mjcf, tmp_path / "m.xml", body.format("<include/>"))
    assert "needs the attribute 'file'" in text


def test_other_forms_of_aem_say_what_to_export(tmp_path):
    path = tmp_path / "a.aem"
    assert "export it as KVN" in message(read_aem, path, '<?xml version="1.0"?>\n<aem/>')
    motion = ph.simulate(
        ph.Inertia.from_principal_moments(1, 2, 3), ph.State(ph.Rotor.identity(), [0, 0, 1]), np.arange(3)
    )
    ph.io.write_aem(motion, path, epoch="2026-01-01T00:00:00", reference_frame="EME2000")
    angles = path.read_text().replace("= QUATERNION/ANGVEL", "= EULER_ANGLE")
    assert "got 'EULER_ANGLE'; export the attitudes as quaternions" in message(read_aem, path, angles)
