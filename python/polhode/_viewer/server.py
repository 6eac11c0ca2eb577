"""The viewer for the command: pages of ``run --html``, and the server of ``view``."""

from __future__ import annotations

import argparse
import json
import os
import secrets
import sys
import threading
import webbrowser
from collections.abc import Callable
from contextlib import AbstractContextManager
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from polhode._mechanics.trajectory import Trajectory
from polhode._report.table import columns_of
from polhode._scene.scene import Scene
from polhode._support.file_kinds import require_scene, suffix_of
from polhode._support.files import UnreadableError, check_target, unreadable
from polhode._viewer.document import Document, of_file, of_scene, of_text, of_trajectory
from polhode._viewer.html import bundle_path, page, served_page

_HOST = "127.0.0.1"

_HEADERS = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src blob:; connect-src 'self'; "
        "style-src 'unsafe-inline'; img-src data: blob:; font-src data:; base-uri 'none'; "
        "form-action 'none'; frame-ancestors 'none'"
    ),
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}


# --- run --html


def check_page(target: Path) -> None:
    """Raise an OSError if a page cannot be written there, or the viewer was not built."""
    bundle_path()
    check_target(target)


def scene_page(scene: Scene) -> bytes:
    """Return the page of a scene, which the page solves itself."""
    return page(of_scene(scene)).encode()


def motion_page(trajectory: Trajectory) -> bytes:
    """Return the page of a run."""
    return page(of_trajectory(trajectory)).encode()


# --- view

# Progress bar of a file name, which yields a function of the pass and the fraction done.
Bar = Callable[[str], AbstractContextManager[Callable[[int, float], object] | None]]


# Suffixes of files that are shown; a scene may have any other that is not known.
_SHOWN = (".nc", ".md")
# Suffixes of tables, which have no inertia; the length of a first line that may have names of columns.
_TABLES, _LINE = (".csv", ".parquet", ".aem", ".bc"), 10_000


def run(options: argparse.Namespace, bar: Bar) -> int:
    """Serve a file until Ctrl-C, which ends it with a KeyboardInterrupt."""
    path = Path(options.file)
    if options.file == "-":
        options.parser.error("the page reads its file again when it is reloaded: give a path, not -")
    if suffix_of(path) in _TABLES and path.exists():
        raise UnreadableError(f"{path}: error: {_about_table(path)}")
    if suffix_of(path) not in _SHOWN:
        require_scene(path)
    script = bundle_path().read_bytes()
    source = Source(path)
    with bar(path.name) as report:
        source.document(report)
    with Server(source, script, options.port) as server:
        try:
            print(f"{path} is shown at {server.url}", "Ctrl-C ends it.", sep="\n", flush=True)
            if options.browser:
                # In a thread: a text browser would block the server.
                threading.Thread(target=webbrowser.open, args=(server.url,), daemon=True).start()
            server.serve_forever()
        except KeyboardInterrupt:
            raise KeyboardInterrupt("the viewer was closed") from None
    return 0


def _about_table(path: Path) -> str:
    """Return why a table is not shown, and what to do with it."""
    if path.suffix.lower() == ".csv" and os.access(path, os.R_OK) and path.is_file():
        with path.open(encoding="utf-8", errors="replace") as file:
            if columns_of("attitude")[0] not in file.readline(_LINE):
                return "not a motion; `polhode fit` fits a body to measured rates and attitudes"
    return (
        "a table of a motion has no inertia, which a motion that is shown needs; "
        f"`polhode convert {path} FILE.nc --scene SCENE.toml` writes the motion of the scene's body"
    )


class Source:
    """A file to show, read again at each request."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock = threading.Lock()
        self._scene: Document = {}
        self._document: Document = {}

    def document(self, progress: Callable[[int, float], object] | None = None) -> Document:
        """Return the document of the file; a scene is run if it has changed.

        An UnreadableError or a SceneError reports an invalid file; a ValueError, a motion that fails.
        """
        if suffix_of(self.path) in _SHOWN:
            try:
                return of_file(self.path)
            except (OSError, ValueError) as error:
                raise unreadable(error) from error
        scene = Scene.read(self.path)
        with self._lock:
            if (shown := of_scene(scene)) != self._scene:
                followed = scene.ensemble is None
                self._document = of_trajectory(scene.run(progress)) if followed else shown
                self._scene = shown
            return self._document

    def shown(self) -> Document:
        """Return the document, also of an invalid or failing scene: the page reports the problem."""
        try:
            return self.document()
        except UnreadableError:
            raise
        except ValueError as error:
            try:
                text = self.path.read_text(encoding="utf-8", errors="replace")
            except OSError:
                raise UnreadableError(str(error)) from None
            return of_text(text, self.path)


class Server(ThreadingHTTPServer):
    """Server of one file for browsers on this machine; the file is read at each load of the page.

    Its paths begin with a random token, which other users and programs of the machine do not know.
    """

    daemon_threads = True

    def __init__(self, source: Source, script: bytes, port: int = 0) -> None:
        self.source, self.script = source, script
        self.folder = f"/{secrets.token_urlsafe(16)}/"
        try:
            super().__init__((_HOST, port), _Handler)
        except OSError as error:
            reason = error.strerror or error
            raise OSError(f"cannot serve at {_HOST}:{port}: {reason}; try another --port") from error

    @property
    def port(self) -> int:
        """The port; chosen by the system if 0 was requested."""
        return int(self.server_address[1])

    @property
    def url(self) -> str:
        """Address of the page."""
        return f"http://{_HOST}:{self.port}{self.folder}"

    @property
    def hosts(self) -> set[str]:
        """Host names that are accepted.

        Others belong to remote pages that resolve their name to this machine in order to read from it.
        """
        port = "" if self.port == 80 else f":{self.port}"
        return {f"{name}{port}" for name in (_HOST, "localhost")}

    def verify_request(self, request: Any, client_address: Any) -> bool:
        """Whether the client is on this machine."""
        return bool(client_address[0] == _HOST)

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Report an error in one line; a closed connection is not an error."""
        error = sys.exception()
        if not isinstance(error, ConnectionError):
            print(f"polhode: error: {type(error).__name__}: {error}", file=sys.stderr)


class _Handler(BaseHTTPRequestHandler):
    server: Server
    server_version, sys_version = "Polhode", ""
    protocol_version = "HTTP/1.1"
    timeout = 30

    def do_GET(self) -> None:
        self._answer()

    def do_HEAD(self) -> None:
        self._answer()

    def _answer(self) -> None:
        if self.headers.get_all("Host", []) not in [[host] for host in self.server.hosts]:
            self._send(HTTPStatus.FORBIDDEN, "text/plain", b"not a host name of this server\n")
            return
        folder = self.server.folder
        name = self.path[len(folder) :]
        if not secrets.compare_digest(self.path[: len(folder)].encode(), folder.encode()):
            name = "not found"
        match name:
            case "":
                self._send(HTTPStatus.OK, "text/html", served_page(self.server.source.path.name).encode())
            case "viewer.js":
                self._send(HTTPStatus.OK, "text/javascript", self.server.script)
            case "document.json":
                self._document()
            case _:
                self._send(HTTPStatus.NOT_FOUND, "text/plain", b"not found\n")

    def _document(self) -> None:
        try:
            text = json.dumps(self.server.source.shown(), allow_nan=False)
        except (OSError, UnreadableError) as error:
            self._send(HTTPStatus.NOT_FOUND, "text/plain", f"{error}\n".encode())
        else:
            self._send(HTTPStatus.OK, "application/json", text.encode())

    def _send(self, status: HTTPStatus, kind: str, content: bytes) -> None:
        self.send_response(status)
        for name, value in _HEADERS.items():
            self.send_header(name, value)
        self.send_header("Content-Type", f"{kind}; charset=utf-8")
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(content)

    def log_message(self, *_: Any) -> None:
        """Do not log requests."""
