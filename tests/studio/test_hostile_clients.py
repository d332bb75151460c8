"""Clients that leave, stall, flood and send anything: no traceback, nothing left behind, others are served."""

import contextlib
import json
import logging
import socket
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("uvicorn", reason="the studio's extra is not installed")
pytest.importorskip("httpx", reason="httpx is not installed")
pytest.importorskip("websockets", reason="websockets is not installed")

import httpx
import uvicorn
from websockets.sync import client as websockets

from mmweaver.studio import connections, sessions, uploads
from mmweaver.studio.server import StudioServer, config_of
from mmweaver.studio.service import Service

WALK = {"room": "demo", "text": ["a person walks to the left"], "seed": 1}


class Served:
    """A studio on a port of its own, as `mmweaver studio` serves it."""

    def __init__(self) -> None:
        self.studio = StudioServer(Service(), workers=2)
        self.bound = socket.create_server(("127.0.0.1", 0), backlog=2048)
        self.address = self.bound.getsockname()
        self.server = uvicorn.Server(config_of(self.studio.app()))
        self.thread = threading.Thread(target=self.server.run, kwargs={"sockets": [self.bound]})
        self.thread.start()
        while not self.server.started:
            time.sleep(0.02)

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.address[1]}"

    def page(self) -> httpx.Client:
        return httpx.Client(base_url=self.url, timeout=30)

    def connect(self) -> socket.socket:
        return socket.create_connection(self.address, timeout=10)

    def socket(self, path: str, session: str) -> Any:
        return websockets.connect(f"ws://127.0.0.1:{self.address[1]}/api/{path}?session={session}")

    def end(self) -> None:
        self.server.should_exit = True
        self.thread.join(20)


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    one = Served()
    yield one
    one.end()


@pytest.fixture(autouse=True)
def no_tracebacks(caplog: pytest.LogCaptureFixture, served: Served) -> Iterator[None]:
    """Whatever a client does, nothing is logged as an error; all sessions end."""
    yield
    served.studio.service.sessions.end_all()
    errors = [record for record in caplog.records if record.levelno >= logging.ERROR]
    assert errors == [], [record.getMessage() for record in errors]


def own(page: httpx.Client) -> dict[str, str]:
    return {"x-session": page.post("/api/session").json()["session"]}


def until(condition: Any, seconds: float = 10.0) -> None:
    """Waits until something holds."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it never came true"
        time.sleep(0.05)


def upload(page: httpx.Client, headers: dict[str, str], files: dict[str, bytes], **data: str) -> httpx.Response:
    sent = [("files", (name, content, "application/octet-stream")) for name, content in files.items()]
    return page.post("/api/upload", files=sent, data={"radar": "awr1843", **data}, headers=headers)


def kept(served: Served, headers: dict[str, str]) -> list[Path]:
    """Files in the folder of a session."""
    folder = served.studio.service.sessions.get(headers["x-session"]).folder
    return [path for path in folder.rglob("*") if path.is_file()]


# names and files ----------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("name", ["\U0001f600" * 80 + ".png", "é" * 300, "a" * 3000], ids=["emoji", "accents", "long"])
def test_long_names_are_cut_by_their_bytes(served: Served, name: str):
    with served.page() as page:
        answer = upload(page, own(page), {"x.cfg": b"nothing"}, paths=json.dumps([name]))
    assert answer.status_code == 422
    assert any(said in answer.json()["error"] for said in ("nothing here is known", "a photo alone"))
    assert len(uploads.safe_name(name, set()).encode()) <= 255


@pytest.mark.parametrize("paths", [["a", "a/b"], ["a/b", "a"], ["a/b/c", "a/b"], ["a", "A/b", "a/a/a"]])
def test_a_name_is_that_of_a_file_and_of_a_folder(served: Served, paths: list[str]):
    with served.page() as page:
        answer = upload(page, own(page), {f"{n}.txt": b"x" for n in range(len(paths))}, paths=json.dumps(paths))
    assert answer.status_code == 422


def test_refused_uploads_leave_nothing(served: Served):
    with served.page() as page:
        headers = own(page)
        for name in ("x.txt", "x.bin", "x.npz", "depth.png", "x.glb"):
            assert upload(page, headers, {name: b"x" * 100_000}).status_code == 422
            assert kept(served, headers) == [], name


def test_what_is_brought_is_bounded(served: Served, monkeypatch: pytest.MonkeyPatch):
    """The oldest of what a session has brought goes first."""
    from mmweaver.core.boards import PRESETS

    radar = PRESETS["awr1843"].to_json().encode()
    with served.page() as page:
        headers = own(page)
        ids = [upload(page, headers, {f"{n}.json": radar}).json()["id"] for n in range(sessions.MAX_BROUGHT + 3)]
        session = served.studio.service.sessions.get(headers["x-session"])
    assert list(session.radars) == ids[3:]


def test_messages_show_no_place_of_the_server(served: Served):
    with served.page() as page:
        headers = own(page)
        answers = [
            upload(page, headers, {"radar.json": b"{"}), upload(page, headers, {"motion.bvh": b"x"}),
            upload(page, headers, {"m.glb": b"glTF"}), upload(page, headers, {"depth.png": b"x", "rgb.png": b"y"}),
            upload(page, headers, {"a.npz": b"PK"}), upload(page, headers, {"sub/x.bin": b"12", "sub/r.cfg": b"x"}),
        ]  # fmt: skip
    for answer in answers:
        assert answer.status_code == 422
        assert tempfile.gettempdir() not in answer.text, answer.text
        assert "upload-" not in answer.text, answer.text


# clients that leave -------------------------------------------------------------------------------------------------
def test_who_leaves_during_an_upload_leaves_nothing(served: Served):
    with served.page() as page:
        headers = own(page)
        with served.connect() as client:
            head = b"POST /api/upload HTTP/1.1\r\nhost: 127.0.0.1\r\ncontent-type: multipart/form-data; boundary=b\r\n"
            head += f"x-session: {headers['x-session']}\r\ncontent-length: 5000000\r\n\r\n".encode()
            part = b'--b\r\ncontent-disposition: form-data; name="files"; filename="a.bin"\r\n\r\n' + bytes(2_000_000)
            client.sendall(head + part)
            time.sleep(0.3)
        time.sleep(0.3)
        until(lambda: kept(served, headers) == [])
        assert page.get("/").status_code == 200


@pytest.mark.parametrize("path", ["presence", "live"])
def test_a_binary_frame_ends_the_socket_and_a_presence_its_session(served: Served, path: str):
    with served.page() as page:
        headers = own(page)
        with served.socket(path, headers["x-session"]) as client:
            client.send(b"\x00\xff")
            with contextlib.suppress(Exception):
                while True:
                    client.recv(timeout=10)
        if path == "presence":
            until(lambda: page.get("/api/room/demo", headers=headers).status_code == 422)
        else:
            assert page.get("/api/room/demo", headers=headers).status_code == 200


def test_a_live_client_that_sends_anything_is_answered_or_closed(served: Served):
    """Words instead of sentences, lists, and sentences without end."""
    bodies: list[Any] = [[], 3, "x", {"ack": 1}, {"text": []}, {"text": [1]}, {**WALK, "text": ["x" * 600]}]
    with served.page() as page:
        headers = own(page)
        for body in bodies:
            with served.socket("live", headers["x-session"]) as client:
                client.send(json.dumps(body))
                assert "error" in json.loads(client.recv(timeout=20))
        with served.socket("live", headers["x-session"]) as client, contextlib.suppress(Exception):
            client.send(json.dumps(WALK))
            for _ in range(500):  # the queue of sentences is bounded
                client.send(json.dumps(WALK))
            client.close()


def test_a_session_has_few_sockets(served: Served):
    with served.page() as page, contextlib.ExitStack() as stack:
        headers = own(page)
        for _ in range(sessions.MAX_SOCKETS):
            stack.enter_context(served.socket("presence", headers["x-session"]))
        with pytest.raises(Exception, match=r"403|1008"), served.socket("presence", headers["x-session"]) as one:
            one.recv(timeout=5)


# clients that stall and flood ---------------------------------------------------------------------------------------
def test_half_open_sockets_lock_nobody_out(served: Served):
    waiting = [served.connect() for _ in range(450)]
    try:
        with served.page() as page:
            assert page.get("/").status_code == 200
            assert page.post("/api/session").status_code == 200
    finally:
        for one in waiting:
            one.close()


def test_headers_have_a_deadline(served: Served, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(connections, "HEADERS_S", 0.5)
    with served.connect() as client:
        client.sendall(b"GET / HTTP/1.1\r\nhost: ")
        client.settimeout(5)
        with contextlib.suppress(ConnectionError):
            assert client.recv(100) == b""


def test_bodies_have_a_deadline(served: Served, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(connections, "BODY_PAUSE_S", 0.5)
    with served.page() as page:
        headers = own(page)
    with served.connect() as client:
        head = f"POST /api/generate HTTP/1.1\r\nhost: 127.0.0.1\r\nx-session: {headers['x-session']}\r\n"
        client.sendall(f"{head}content-length: 100\r\n\r\n{{".encode())
        client.settimeout(10)
        assert client.recv(1000).startswith(b"HTTP/1.1 408")


def test_a_body_nobody_asked_for_is_not_read_whole(served: Served):
    """A gigabyte to a call that is refused at once."""
    with served.connect() as client:
        client.sendall(b"POST /api/generate HTTP/1.1\r\nhost: 127.0.0.1\r\ncontent-length: 1000000000\r\n\r\n")
        sent = 0
        with contextlib.suppress(OSError):
            while sent < 1_000_000_000:
                client.sendall(bytes(1_000_000))
                sent += 1_000_000
        assert sent < 50_000_000


def test_who_does_not_read_is_cut_off(served: Served, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(connections, "READ_S", 0.5)
    with served.page() as page:
        headers = own(page)
    with served.connect() as client:
        client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        ask = f"GET /page/mmweaver.js HTTP/1.1\r\nhost: 127.0.0.1\r\nx-session: {headers['x-session']}\r\n\r\n"
        with contextlib.suppress(OSError):
            client.sendall(ask.encode() * 30)
        until(lambda: all(getattr(one, "is_idle", True) for one in served.server.server_state.connections))


def test_a_hundred_sessions_lock_nobody_out(served: Served, monkeypatch: pytest.MonkeyPatch):
    """Those that were opened and never used make room, not the one that works."""
    monkeypatch.setattr(sessions, "MAX_SESSIONS", 10)
    with served.page() as page:
        honest = own(page)
        assert page.get("/api/room/demo", headers=honest).status_code == 200
        for _ in range(30):
            assert page.post("/api/session").status_code == 200
        assert page.get("/api/room/demo", headers=honest).status_code == 200
        assert len(served.studio.service.sessions._open) <= 10


def test_uploads_have_a_quota(served: Served, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(sessions, "MAX_UPLOAD_BYTES", 1_000_000)
    with served.page() as page:
        headers = own(page)
        answer = upload(page, headers, {"x.bin": bytes(2_000_000)})
        assert answer.status_code in (422, 503)
        assert kept(served, headers) == []


# a server that was killed -------------------------------------------------------------------------------------------
def test_the_folders_of_a_killed_server_are_removed_by_the_next(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    session = sessions.Session()
    alive = session.folder
    dead = alive.with_name(alive.name.replace(f"-{__import__('os').getpid()}-", "-999999999-"))
    (dead / "upload-1").mkdir(parents=True)
    (dead / "upload-1" / "rgb.png").write_bytes(b"x")
    sessions.remove_abandoned()
    assert not dead.exists()
    assert alive.exists()
    session.end()
    assert not alive.exists()
