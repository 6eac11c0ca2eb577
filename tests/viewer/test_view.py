"""``polhode view``: what it serves, to which hosts, and how it ends."""

import http.client
import json
import re
import shutil
import signal
import socket
import threading
from dataclasses import replace

import numpy as np
import pytest

import polhode as ph
import processes
from command_line import EXAMPLES, POLHODE, SCENE, polhode
from polhode._cli import main
from polhode._viewer import server as _view
from viewers import SCRIPT, needs_bundle

STEPPED = SCENE + 'method = "rk4"\nstep = "10 ms"\n'


@pytest.fixture
def served(scene):
    """A server of the small scene."""
    yield from serving(_view.Source(scene))


def serving(source):
    with _view.Server(source, SCRIPT.encode()) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        yield server
        server.shutdown()
        thread.join()


def answer(server, path, method="GET", host=None, folder=None):
    """Status, headers and content of an answer of the server; paths are within its folder."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=10)
    hosts = [f"127.0.0.1:{server.port}"] if host is None else host
    within = server.folder.rstrip("/") if folder is None else folder
    connection.putrequest(method, within + path, skip_host=True)
    for name in hosts:
        connection.putheader("Host", name)
    connection.endheaders()
    response = connection.getresponse()
    content = response.read()
    connection.close()
    return response.status, response.headers, content


def test_page_document_and_bundle_are_served(served):
    status, headers, content = answer(served, "/")
    assert status == 200
    assert headers["Content-Type"] == "text/html; charset=utf-8"
    assert b'<polhode-viewer titled src="document.json">' in content
    status, headers, content = answer(served, "/viewer.js")
    assert (status, headers["Content-Type"]) == (200, "text/javascript; charset=utf-8")
    assert content == SCRIPT.encode()
    status, headers, content = answer(served, "/document.json")
    assert (status, headers["Content-Type"]) == (200, "application/json; charset=utf-8")
    assert json.loads(content) == {"format": 1, "scene": SCENE, "name": "small.toml"}


@pytest.mark.parametrize(
    "path",
    [
        "/small.toml",
        "/../small.toml",
        "/..%2fsmall.toml",
        "/viewer.js/",
        "/document.json?x",
        "/%2e/",
        "*",
    ],
)
def test_nothing_else_is_served(path, served):
    status, _, content = answer(served, path)
    assert status == 404
    assert b"moments" not in content


def test_addresses_begin_with_a_random_token(served, scene):
    """At least 128 bits, new for each server: 22 characters of base64."""
    with _view.Server(_view.Source(scene), b"") as other:
        assert other.folder != served.folder
    token = served.folder.strip("/")
    assert len(token) >= 22
    assert served.url.endswith(f":{served.port}/{token}/")
    near = token[:-1] + ("a" if token[-1] != "a" else "b")
    for folder in ("", f"/{near}", f"/{token[:-1]}", f"/{token.swapcase()}", "/%c3%a9"):
        for path in ("/", "/viewer.js", "/document.json"):
            status, _, content = answer(served, path, folder=folder)
            assert (status, content) == (404, b"not found\n")
    assert answer(served, "", folder=f"/{token}")[0] == 404


def test_only_this_machine_is_served(served):
    assert served.server_address[0] == "127.0.0.1"
    port = served.port
    for host in (f"127.0.0.1:{port}", f"localhost:{port}"):
        assert answer(served, "/", host=[host])[0] == 200
    # As from a remote page whose name resolves to this machine.
    others = [
        ["polhode.example"],
        [f"polhode.example:{port}"],
        ["127.0.0.1"],
        [f"127.0.0.1:{port + 1}"],
        [f"127.0.0.1:{port}", "polhode.example"],
        [f"[::1]:{port}"],
        [""],
        [],
    ]
    for host in others:
        for path in ("/", "/viewer.js", "/document.json"):
            status, _, content = answer(served, path, host=host)
            assert (status, content) == (403, b"not a host name of this server\n")
    assert not served.verify_request(None, ("192.0.2.1", 5))


def test_headers_forbid_caching_and_foreign_content(served):
    for path in ("/", "/viewer.js", "/document.json", "/absent"):
        _, headers, _ = answer(served, path)
        assert headers["Cache-Control"] == "no-store"
        assert headers["X-Content-Type-Options"] == "nosniff"
        assert headers["Content-Security-Policy"].startswith("default-src 'none'; script-src 'self'")
        assert "Access-Control-Allow-Origin" not in headers


def test_other_requests(served):
    status, headers, content = answer(served, "/", method="HEAD")
    assert (status, content) == (200, b"")
    assert int(headers["Content-Length"]) > 0
    for method in ("POST", "PUT", "DELETE", "OPTIONS"):
        assert answer(served, "/document.json", method=method)[0] == 501


def test_invalid_requests_do_not_end_the_server(served, capsys):
    for noise in (b"\x16\x03\x01 noise\r\n\r\n", b"GET\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n"):
        with socket.create_connection(("127.0.0.1", served.port), timeout=10) as connection:
            connection.sendall(noise)
            connection.recv(1000)
    assert answer(served, "/")[0] == 200
    assert "Traceback" not in capsys.readouterr().err


def test_the_scene_is_read_again(served, scene):
    for text in (SCENE.replace("[1, 2, 3]", "[2, 3, 4]"), STEPPED, "what is this", SCENE):
        scene.write_text(text)
        shown = json.loads(answer(served, "/document.json")[2])
        assert shown["scene"] == text
        assert ("recorded" in shown) == (text == STEPPED)
    scene.unlink()
    status, _, content = answer(served, "/document.json")
    assert (status, content) == (404, f"{scene}: error: no such file\n".encode())
    scene.write_bytes(b'title = "caf\xe9"')
    assert json.loads(answer(served, "/document.json")[2])["scene"] == 'title = "caf\ufffd"'


def test_a_scene_is_run_once(scene, monkeypatch):
    scene.write_text(STEPPED)
    source, runs = _view.Source(scene), []
    run = ph.Scene.run
    monkeypatch.setattr(ph.Scene, "run", lambda self, *a: runs.append(self) or run(self, *a))
    first = source.document()
    assert source.document() == first
    assert len(runs) == 1
    scene.write_text(STEPPED.replace("10 ms", "20 ms"))
    assert source.document() != first
    assert len(runs) == 2


def test_the_page_reports_a_motion_that_fails(scene):
    text = STEPPED.replace("10 ms", "1e-15 s")
    scene.write_text(text)
    source = _view.Source(scene)
    with pytest.raises(ValueError, match="longer step"):
        source.document()
    assert source.shown() == {"format": 1, "scene": text, "name": "small.toml"}


def test_the_page_runs_an_ensemble(scene):
    text = SCENE.replace("[run]", '[ensemble]\nnumber = 3\nattitude = "uniform"\n[run]')
    scene.write_text(text)
    assert _view.Source(scene).document()["scene"] == text


def test_a_mesh_is_read_again(tmp_path):
    for name in ("t-handle.toml", "t-handle.stl"):
        shutil.copy(EXAMPLES / name, tmp_path)
    source = _view.Source(tmp_path / "t-handle.toml")
    before = source.document()
    mesh = tmp_path / "t-handle.stl"
    mesh.write_bytes(mesh.read_bytes() + b"\n")
    assert source.document()["files"] != before["files"]


def test_a_file_of_a_run_is_shown(tmp_path):
    pytest.importorskip("h5netcdf")
    start = ph.State(ph.Rotor.identity(), [0.1, 1, 0.1])
    law = ph.torque.viscous_damping(0.1)
    inertia = ph.Inertia.from_principal_moments(1, 2, 3)
    ph.simulate(inertia, start, np.linspace(0, 1, 5), law).save(tmp_path / "a.nc")
    for server in serving(_view.Source(tmp_path / "a.nc")):
        shown = json.loads(answer(server, "/document.json")[2])
        assert set(shown) == {"format", "name", "recorded"}
        (tmp_path / "a.nc").write_bytes(b"noise")
        status, _, content = answer(server, "/document.json")
        assert status == 404
        assert b"a.nc: error: cannot be read as a netCDF file" in content


# --- the command


@pytest.mark.usefixtures("bundle")
def test_files_that_cannot_be_shown_are_bad_input(tmp_path, capsys):
    (tmp_path / "bad.toml").write_text(SCENE.replace("duration", "durration"))
    (tmp_path / "bad.nc").write_bytes(b"noise")
    (tmp_path / "a.csv").write_text("time,attitude_w")
    (tmp_path / "a.stl").write_text("solid")
    for name, part in (
        ("a.csv", f"`polhode convert {tmp_path / 'a.csv'} FILE.nc --scene SCENE.toml` writes the motion"),
        ("a.stl", f"a.stl: error: not a scene but a mesh: `polhode check {tmp_path / 'a.stl'}` checks it"),
        ("bad.toml", "bad.toml:7:1: error: unknown field `durration`"),
        ("absent.toml", "absent.toml: error: no such file"),
        ("bad.nc", "bad.nc: error: cannot be read as a netCDF file"),
        ("absent.nc", "absent.nc: error: no such file"),
    ):
        assert main.main(["view", str(tmp_path / name), "--no-browser"]) == 3
        captured = capsys.readouterr()
        assert part in captured.err
        assert captured.out == ""


@pytest.mark.parametrize("form", ["csv", "aem", "nc"])
@pytest.mark.usefixtures("bundle")
def test_the_remedy_for_a_table_of_attitudes_is_shown(form, tmp_path, monkeypatch, capsys):
    """A file without an inertia; the command that the error names writes one that is shown."""
    pytest.importorskip("h5netcdf")
    monkeypatch.chdir(tmp_path)
    body = ph.Inertia.from_principal_moments(1, 2, 3)
    start = ph.State(ph.Rotor.identity(), [0.1, 1, 0.1])
    history = ph.io.AttitudeHistory.of(ph.simulate(body, start, np.linspace(0, 1, 5)))
    facts = {"reference_frame": "EME2000", "body_frame": "SC_BODY_1", "object_name": "A", "object_id": "1"}
    facts["epoch"] = "2026-01-01T00:00:00"
    ph.io.write(replace(history, inertia=None, attributes=facts), f"a.{form}")
    assert main.main(["view", f"a.{form}", "--no-browser"]) == 3
    message = capsys.readouterr().err
    assert "no inertia" in message
    (tmp_path / "SCENE.toml").write_text(SCENE)
    remedy = re.search(r"polhode (convert .*SCENE\.toml)", message)[1]
    assert main.main(remedy.split()) == 0
    assert set(_view.Source(tmp_path / "FILE.nc").document()) >= {"format", "recorded"}


def test_a_renamed_netcdf_file_is_shown(tmp_path):
    """The suffix is not known, so the first bytes tell what the file is."""
    pytest.importorskip("h5netcdf")
    start = ph.State(ph.Rotor.identity(), [0.1, 1, 0.1])
    body = ph.Inertia.from_principal_moments(1, 2, 3)
    ph.simulate(body, start, np.linspace(0, 1, 5)).save(tmp_path / "a.nc")
    (tmp_path / "a.nc").rename(tmp_path / "a.dat")
    assert len(_view.Source(tmp_path / "a.dat").document()["recorded"]) > 0


@pytest.mark.usefixtures("bundle")
def test_a_table_of_rates_is_for_a_fit(tmp_path, capsys):
    (tmp_path / "gyro.csv").write_text("t,wx,wy,wz\n0,1,2,3\n")
    assert main.main(["view", str(tmp_path / "gyro.csv"), "--no-browser"]) == 3
    message = capsys.readouterr().err
    assert "gyro.csv: error: not a motion; `polhode fit` fits a body to measured rates" in message


@pytest.mark.usefixtures("bundle")
def test_standard_input_is_not_viewed(capsys):
    with pytest.raises(SystemExit):
        main.main(["view", "-", "--no-browser"])
    assert "reads its file again when it is reloaded: give a path, not -" in capsys.readouterr().err


@pytest.mark.usefixtures("bundle")
def test_a_port_that_is_taken(scene, capsys):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert main.main(["view", str(scene), "--no-browser", "--port", str(port)]) == 1
    assert f"cannot serve at 127.0.0.1:{port}: " in capsys.readouterr().err


@pytest.mark.parametrize("port", ["-1", "65536", "x", "1.5"])
def test_a_port_is_a_number(port, scene, capsys):
    with pytest.raises(SystemExit) as stop:
        main.main(["view", str(scene), f"--port={port}"])
    assert stop.value.code == 2
    assert "port must be an integer" in capsys.readouterr().err


def test_a_missing_bundle_is_reported(scene, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("polhode._viewer.html._BUNDLE", tmp_path / "absent.js")
    assert main.main(["view", str(scene)]) == 1
    assert "make viewer" in capsys.readouterr().err


def test_the_browser_is_opened_at_the_page(scene, bundle, monkeypatch, capsys):
    opened = threading.Event()
    addresses = []

    def serve_forever(server, poll_interval=0.5):
        assert opened.wait(10)
        raise KeyboardInterrupt

    monkeypatch.setattr("webbrowser.open", lambda url: (addresses.append(url), opened.set()))
    monkeypatch.setattr(_view.Server, "serve_forever", serve_forever)
    assert main.main(["view", str(scene)]) == 130
    captured = capsys.readouterr()
    assert captured.out.startswith(f"{scene} is shown at {addresses[0]}\n")
    assert captured.err == "the viewer was closed\n"


@needs_bundle
def test_ctrl_c_ends_it(scene):
    with processes.start([POLHODE, "view", scene, "--no-browser"]) as process:
        url = process.stdout.readline().split()[-1]
        port = int(url.removeprefix("http://127.0.0.1:").partition("/")[0])
        with socket.create_connection(("127.0.0.1", port), timeout=10):
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate()
    assert process.returncode == 130
    assert errors == "the viewer was closed\n"


def test_the_help_names_it():
    assert "show a motion in the browser" in polhode("--help").stdout
