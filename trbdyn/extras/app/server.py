"""The server of the page: on this machine alone, opened by a token that is valid once."""

from __future__ import annotations

import socket
import webbrowser
from pathlib import Path
from typing import Any, Final

import uvicorn
from fastapi import FastAPI
from fastapi.responses import FileResponse, PlainTextResponse, Response
from nicegui import ui

from trbdyn.base.own_files import create
from trbdyn.errors import FileError
from trbdyn.extras.app.guard import HOSTS, Guard
from trbdyn.extras.app.jobs import Bench
from trbdyn.extras.app.page import show_page

DOOR: Final = "open.html"
"""A file that only this user can read, which leads the browser to the page: every user of a machine can read a browser's command
line, so that the address with its token is not there.
"""
OF_STRANGERS = "sandbox allow-scripts; default-src 'none'; img-src data: blob:; style-src 'unsafe-inline'; \
script-src 'unsafe-inline' 'unsafe-eval' data: blob:; worker-src blob:; font-src data:; connect-src data: blob:; \
frame-ancestors 'self'"
"""What reports and views may do: names in them come from cases of others. They are drawn, and reach nothing else."""


def application(bench: Bench) -> FastAPI:
    """The page, and the files of the runs."""
    app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None)

    @app.get("/files/{name}/{inside:path}", response_model=None)
    def file(name: str, inside: str) -> Response:
        path = bench.file(name, inside)
        if path is None:
            return PlainTextResponse("there is no such file", status_code=404)
        headers = {"Content-Security-Policy": OF_STRANGERS, "Cache-Control": "no-store"}
        if path.suffix not in (".html", ".png"):
            headers["Content-Disposition"] = f'attachment; filename="{path.name}"'
        return FileResponse(path, headers=headers)

    def root() -> None:
        show_page(bench)

    ui.run_with(app, root=root, title="trbdyn", show_welcome_message=False, reconnect_timeout=30.0)
    return app


def serve(folder: Path, *, port: int = 0, browser: bool = True) -> None:
    """Serve the page until Ctrl-C, on a port of this machine (0: any that is free); the folder keeps the design and all runs."""
    bench = Bench.open(folder)
    listener = socket.socket()
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((HOSTS[0], port))
        listener.listen()
    except (OSError, OverflowError) as error:
        raise FileError(f"port {port}: cannot be used: {getattr(error, 'strerror', None) or error}") from None
    port = listener.getsockname()[1]
    door = folder / DOOR

    def address() -> str:
        return f"http://{HOSTS[0]}:{port}/?token={guard.token}"

    def used() -> None:
        door.unlink(missing_ok=True)
        print(f"opened; for another browser: {address()}", flush=True)

    guard = Guard(application(bench), port, used)
    print(f"trbdyn app: {address()}\nIt keeps everything in {folder}. Ctrl-C ends it.", flush=True)
    if browser:
        _lead(door, address())
        webbrowser.open(door.as_uri())
    options: dict[str, Any] = {"log_level": "warning", "access_log": False, "server_header": False}
    try:
        uvicorn.Server(uvicorn.Config(guard, **options)).run(sockets=[listener])
    finally:
        door.unlink(missing_ok=True)
        if bench.job is not None:
            bench.job.end()


def _lead(door: Path, address: str) -> None:
    """Write the file that leads to an address, for this user alone."""
    try:
        door.unlink(missing_ok=True)
        with create(door, 0o600) as stream:
            stream.write(f"<!doctype html><meta http-equiv='refresh' content='0;url={address}'>".encode())
    except OSError as error:
        raise FileError(f"{door}: cannot be written: {error.strerror or error}") from error
