"""The studio's calls, without a browser: who may make them, and what they give."""

import asyncio
import contextlib
import io
import math
import shlex
import zipfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

pytest.importorskip("starlette", reason="the studio's extra is not installed")
pytest.importorskip("httpx", reason="httpx, which starlette's test client needs, is not installed")

from starlette.routing import Route
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from mmweaver import Weaver
from mmweaver.cli.main import main
from mmweaver.core.boards import PRESETS
from mmweaver.core.errors import NoRoomError
from mmweaver.studio.exports import EXPORTS
from mmweaver.studio.server import StudioServer
from mmweaver.studio.service import Service
from mmweaver.viz.body_in_photo import unpack

WALK = {"room": "demo", "text": ["a person walks to the left"], "seed": 1}
HOST = "http://127.0.0.1:8765"
SAMPLE = Path(__file__).resolve().parents[2] / "src" / "mmweaver" / "sample"


@pytest.fixture(scope="module")
def page() -> Iterator[TestClient]:
    with TestClient(StudioServer(Service(), workers=2).app(), base_url=HOST) as client:
        yield client


def session(page: TestClient) -> dict[str, str]:
    """The headers of a new session."""
    return {"x-session": page.post("/api/session").json()["session"]}


def generated(page: TestClient, own: dict[str, str], **change: Any) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    return unpack(page.post("/api/generate", json={**WALK, **change}, headers=own).content)


# who may ask --------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("host", ["evil.example", "evil.example:8765", "", "127.0.0.1.evil.example"])
def test_another_host_name_is_not_served(page: TestClient, host: str):
    answer = page.post("/api/session", headers={"host": host})
    assert answer.status_code == 403
    assert "host name" in answer.json()["error"]


def test_another_page_is_not_answered(page: TestClient):
    assert page.post("/api/session", headers={"origin": "http://evil.example"}).status_code == 403
    assert page.post("/api/session", headers={"origin": HOST}).status_code == 200


def test_another_host_needs_the_token():
    app = StudioServer(Service(), workers=1).app(hosts={"lab"}, token="secret")
    page = TestClient(app, base_url="http://lab:8765")  # not entered: without warming up
    assert page.get("/").status_code == 200
    assert page.post("/api/session").status_code == 403
    assert page.post("/api/session", headers={"x-token": "wrong"}).status_code == 403
    assert page.post("/api/session", headers={"x-token": "secret"}).status_code == 200


def _is_policy(closed: WebSocketDisconnect) -> bool:
    return closed.code == 1008


OWN, FOREIGN = {"host": "lab:8765", "origin": "http://lab:8765"}, "http://evil.example"


@pytest.mark.parametrize("path", ["/api/presence", "/api/live"])
@pytest.mark.parametrize(
    ("headers", "token", "is_let_in"),
    [
        (OWN, "secret", True),
        ({"host": "lab:8765"}, "secret", True),
        ({**OWN, "host": "evil.example"}, "secret", False),
        ({"host": "evil.example", "origin": FOREIGN}, "secret", False),  # whose name leads to this machine
        ({**OWN, "origin": FOREIGN}, "secret", False),
        ({**OWN, "origin": "http://lab:80"}, "secret", False),
        (OWN, "wrong", False),
        (OWN, "", False),
        (OWN, "secre", False),
    ],
)
def test_a_socket_is_opened_only_where_a_call_would_be_answered(
    path: str, headers: dict[str, str], token: str, is_let_in: bool
):
    """A WebSocket is no subject of the browser's own rules: any page may open one to any host."""
    studio = StudioServer(Service(), workers=1)
    page = TestClient(studio.app(hosts={"lab"}, token="secret"), base_url="http://lab:8765")
    name = studio.service.sessions.open().id
    refusal = contextlib.nullcontext() if is_let_in else pytest.raises(WebSocketDisconnect, check=_is_policy)
    with refusal, page.websocket_connect(f"ws://lab:8765{path}?session={name}&token={token}", headers=headers):
        pass
    called = page.post("/api/session", headers={**headers, "x-token": token})
    assert (called.status_code == 200) == is_let_in


def test_every_call_asks_for_host_origin_and_token():
    app = StudioServer(Service(), workers=1).app(hosts={"lab"}, token="secret")
    page = TestClient(app, base_url="http://lab:8765")
    calls = [(route.path, method) for route in app.routes if isinstance(route, Route) for method in route.methods or ()]
    assert len(calls) > 10
    for path, method in calls:
        refused = [{"x-token": "secret", "host": "evil.example"}, {"x-token": "secret", "origin": FOREIGN}]
        for headers in [*refused, *([{}] if path.startswith("/api/") else [])]:
            assert page.request(method, path, headers=headers).status_code == 403, (path, method, headers)


def test_content_is_never_framed_sniffed_kept_or_told_to_others(page: TestClient):
    own = session(page)
    room = page.get("/api/room/demo", headers=own)
    for answer in (page.get("/"), page.get("/page/mmweaver.js"), room):
        assert answer.status_code == 200
        assert answer.headers["x-content-type-options"] == "nosniff"
        assert answer.headers["referrer-policy"] == "no-referrer"
        assert answer.headers["cache-control"] == "no-store"
        policy = dict(part.split(maxsplit=1) for part in answer.headers["content-security-policy"].split(";"))
        assert policy["default-src"] == "'self'"
        assert {policy[name] for name in ("frame-ancestors", "base-uri", "form-action")} == {"'none'"}
        assert not {"*", "http:", "https:", "'unsafe-eval'"} & set(" ".join(policy.values()).split())
        assert "script-src" not in policy  # as default-src: no script from elsewhere, and none in the page


@pytest.mark.parametrize("length", ["300000001", "1" + "0" * 30, "-1", "many"])
def test_an_upload_of_more_than_300_mb_is_refused_before_it_is_read(page: TestClient, length: str):
    own = session(page)
    sent: list[Any] = []
    scope = {
        "type": "http", "method": "POST", "path": "/api/upload", "query_string": b"", "http_version": "1.1",
        "headers": [(b"host", b"localhost"), (b"x-session", own["x-session"].encode()),
                    (b"content-type", b"multipart/form-data; boundary=b"), (b"content-length", length.encode())],
    }  # fmt: skip

    async def receive() -> dict[str, Any]:
        raise AssertionError("the body was read")

    async def send(message: Any) -> None:
        sent.append(message)

    asyncio.run(page.app(scope, receive, send))
    assert sent[0]["status"] == 422
    assert b"at most 300 MB" in sent[1]["body"]


def test_an_upload_says_how_long_it_is_and_has_few_files(page: TestClient):
    own = session(page)
    chunked = page.post("/api/upload", headers=own, content=iter([b"--b"]))  # without a content-length
    assert chunked.status_code == 422
    for count, status in ((201, 400), (200, 422)):  # refused unread, and read: nothing known is among them
        assert upload(page, own, {f"{number}.txt": b"x" for number in range(count)}).status_code == status


def test_a_request_that_is_too_long_is_given_up_while_it_comes(page: TestClient):
    taken = []

    def endless() -> Iterator[bytes]:
        while True:
            taken.append(1)
            assert len(taken) < 50
            yield b" " * 10_000

    own = session(page)
    sent: list[Any] = []
    source = endless()
    scope = {
        "type": "http", "method": "POST", "path": "/api/generate", "query_string": b"", "http_version": "1.1",
        "headers": [(b"host", b"localhost"), (b"x-session", own["x-session"].encode())],
    }  # fmt: skip

    async def receive() -> dict[str, Any]:
        return {"type": "http.request", "body": next(source), "more_body": True}

    async def send(message: Any) -> None:
        sent.append(message)

    asyncio.run(page.app(scope, receive, send))
    assert sent[0]["status"] == 422
    assert len(taken) <= 11  # 100 kB


def test_nothing_is_loaded_from_elsewhere(page: TestClient):
    answer = page.get("/")
    assert "default-src 'self'" in answer.headers["content-security-policy"]
    assert "http" not in answer.text.replace("http-equiv", "")


def test_calls_need_a_session(page: TestClient):
    answer = page.post("/api/generate", json=WALK)
    assert answer.status_code == 422
    assert "load the page again" in answer.json()["error"]


# what it gives ------------------------------------------------------------------------------------------------------
def test_a_sentence_becomes_a_sequence(page: TestClient):
    header, arrays = generated(page, session(page))
    weaver = Weaver()
    expected = weaver.generate(weaver.sample_room(), WALK["text"][0], seed=1, board="typical:0")
    np.testing.assert_allclose(arrays["joints"][0], expected.pose.joints_m, atol=1e-5)
    assert header["meta"]["seed"] == 1
    assert "--text 'a person walks to the left'" in header["command"]


def test_two_sessions_do_not_see_each_other(page: TestClient):
    mine, yours = session(page), session(page)
    header, _ = generated(page, mine)
    assert page.get(f"/api/result/{header['result']}", headers=mine).status_code == 200
    assert page.get(f"/api/result/{header['result']}", headers=yours).status_code == 422


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"text": ["a person flies"]}, "names no activity"),
        ({"room": "/etc"}, "this room is not known"),
        ({"radar": "/etc/passwd"}, "unknown radar"),
        ({"method": "magic"}, "unknown method"),
        ({"seed": -1}, "the seed must be"),
    ],
)
def test_what_cannot_be_is_said_in_one_line(page: TestClient, change: dict[str, Any], said: str):
    answer = page.post("/api/generate", json={**WALK, **change}, headers=session(page))
    assert answer.status_code == 422
    assert said in answer.json()["error"]
    assert "\n" not in answer.json()["error"]


@pytest.mark.parametrize("body", [b"", b"{", b"[" * 5000, b'{"seed": 1' + b"0" * 500 + b"}", b"\xff\xfe"])
def test_what_is_no_json_is_refused(page: TestClient, body: bytes):
    assert page.post("/api/generate", content=body, headers=session(page)).status_code == 422


def unzipped(content: bytes) -> dict[str, bytes]:
    """Files of an archive by their paths below its one folder; those of a single file under its name."""
    archive = zipfile.ZipFile(io.BytesIO(content))
    return {one.split("/", 1)[-1]: archive.read(one) for one in archive.namelist() if not one.endswith("/")}


@pytest.fixture(scope="module")
def exported(page: TestClient, tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, str], str, Path]:
    """A session, its result, and the folder that the command of its drawer makes."""
    own, out = session(page), tmp_path_factory.mktemp("cli") / "walk"
    header, _ = generated(page, own)
    words = shlex.split(header["command"])
    assert words[-2] == "--out"
    assert main([*words[1:-1], str(out), "--bin", "--quiet"]) == 0
    return own, header["result"], out


def test_exports_equal_the_command_line(page: TestClient, exported: tuple[dict[str, str], str, Path]):
    own, name, cli = exported
    for kind, file in (("npz", "radar.npz"), ("points", "points.npz")):
        assert page.get(f"/api/export/{name}/{kind}", headers=own).content == (cli / file).read_bytes(), file
    for kind, more in (("folder", ("preview.png",)), ("bin", ("adc_data.bin",))):
        files = unzipped(page.get(f"/api/export/{name}/{kind}", headers=own).content)
        for file in ("radar.npz", "points.npz", "pose.npz", "radar.json", "board.json", *more):
            assert files[file] == (cli / file).read_bytes(), file
    assert b"<html" in page.get(f"/api/export/{name}/html", headers=own).content
    assert page.get(f"/api/export/{name}/exe", headers=own).status_code == 422


VIDEOS = [pytest.param(kind, marks=pytest.mark.slow) for kind in ("mp4", "webm")]  # the others hold the same way


@pytest.mark.parametrize("kind", ["mat", "zarr", "mcap", "ros2", "rerun", *VIDEOS])
def test_other_formats_equal_mmweaver_export(
    page: TestClient, exported: tuple[dict[str, str], str, Path], kind: str, tmp_path: Path
):
    """Byte for byte, but for text that says when and how fast it was made."""
    if kind not in EXPORTS:
        pytest.skip(f"the package for {kind} is not installed")
    own, name, cli = exported
    answer = page.get(f"/api/export/{name}/{kind}", headers=own)
    assert main(["export", str(cli), "--to", kind, "--out", str(tmp_path / kind)]) == 0
    expected = {
        str(file.relative_to(tmp_path / kind)): file.read_bytes()
        for file in sorted((tmp_path / kind).rglob("*")) if file.is_file()
    }  # fmt: skip
    is_archive = answer.headers["content-disposition"].endswith('.zip"')
    found = unzipped(answer.content) if is_archive else {next(iter(expected)): answer.content}
    assert set(found) == set(expected)
    differ = [file for file, content in expected.items() if timeless(found[file], file) != timeless(content, file)]
    assert [file for file in differ if not file.endswith(("meta.json", "zarr.json", "SHA256SUMS"))] == []


def timeless(content: bytes, file: str) -> Any:
    """What a file holds, without the date in the header of MATLAB's and the random number of WebM's."""
    if file.endswith(".mat"):
        return content[128:]
    if not file.endswith(".webm"):
        return content
    import av

    with av.open(io.BytesIO(content)) as video:
        return [frame.to_ndarray(format="rgb24").tobytes() for frame in video.decode(video=0)]


# what is brought ----------------------------------------------------------------------------------------------------
def upload(page: TestClient, own: dict[str, str], files: dict[str, bytes]) -> Any:
    sent = [("files", (name, content, "application/octet-stream")) for name, content in files.items()]
    return page.post("/api/upload", files=sent, data={"radar": "awr1843"}, headers=own)


def test_a_photo_with_depth_becomes_the_sessions_room(page: TestClient):
    mine, yours = session(page), session(page)
    found = upload(page, mine, {file.name: file.read_bytes() for file in SAMPLE.iterdir()}).json()
    assert found["kind"] == "room"
    _, room = unpack(page.get(f"/api/room/{found['id']}", headers=mine).content)
    assert len(room["free_floor"]) > 100
    assert generated(page, mine, room=found["id"])[0]["frames"] == 20
    assert page.get(f"/api/room/{found['id']}", headers=yours).status_code == 422


def test_a_result_folder_is_played_again(page: TestClient):
    own = session(page)
    header, arrays = generated(page, own)
    archive = zipfile.ZipFile(io.BytesIO(page.get(f"/api/export/{header['result']}/folder", headers=own).content))
    files = {name.split("/")[-1]: archive.read(name) for name in archive.namelist() if name.endswith(("npz", "json"))}
    found = upload(page, other := session(page), files).json()
    _, again = unpack(page.get(f"/api/result/{found['id']}", headers=other).content)
    np.testing.assert_array_equal(again["range_doppler"], arrays["range_doppler"])


def test_a_radar_and_a_motion_are_the_sessions_own(page: TestClient, tmp_path: Path):
    mine, yours = session(page), session(page)
    radar = upload(page, mine, {"mine.json": replace(PRESETS["awr1843"], num_loops=16).to_json().encode()}).json()
    assert (radar["kind"], radar["label"]) == ("radar", "mine.json")
    clip = Weaver().generate(Weaver().sample_room(), "a person waves", frames=12).pose
    np.savez(tmp_path / "clip.npz", joints_m=clip.joints_m, fps=10.0)
    motion = upload(page, mine, {"clip.npz": (tmp_path / "clip.npz").read_bytes()}).json()
    assert motion["kind"] == "motion", motion
    header, _ = generated(page, mine, radar=radar["id"], motion=motion["id"])
    assert header["meta"]["radar"]["num_loops"] == 16
    assert "--radar mine.json" in header["command"]
    assert "--motion clip.npz" in header["command"]
    for change in ({"radar": radar["id"]}, {"motion": motion["id"]}):
        answer = page.post("/api/generate", json={**WALK, **change}, headers=yours)
        assert answer.status_code == 422


def test_a_drawn_path_is_walked(page: TestClient):
    own = session(page)
    path = [[0.3, 2.3], [0.3, 1.5], [0.7, 1.4]]
    header, arrays = generated(page, own, path=path)
    way = arrays["joints"][0][:, 0, :2]
    for corner in path:
        assert np.linalg.norm(way - corner, axis=1).min() < 0.2
    assert "--path '0.3,2.3 0.3,1.5 0.7,1.4'" in header["command"]


def test_a_room_without_a_place_offers_recovery_options(page: TestClient, monkeypatch: pytest.MonkeyPatch):
    ways = {"nearest_place_m": [0.0, 5.0], "range_m": [4.0, 6.0], "radars": ["awr1843", "hupr"]}

    def none(*_: Any, **__: Any) -> None:
        raise NoRoomError("no room", recovery_options=ways)

    monkeypatch.setattr(Weaver, "carry_out", none)
    answer = page.post("/api/generate", json=WALK, headers=session(page))
    assert answer.status_code == 422
    assert answer.json()["code"] == "no_room"
    changes = [way["change"] for way in answer.json()["ways_on"]]
    assert changes == [{"range": [4.0, 6.0]}, *({"radar": name, "range": None} for name in ("awr1843", "hupr"))]


@pytest.mark.parametrize(
    "files",
    [
        {"rgb.png": b"no picture", "depth.png": b"no picture"},
        {"photo.png": b"alone"},
        {"../../etc/passwd": b"root"},
        {"radar.npz": b"PK\x03\x04", "radar.json": b"{}"},
        {"a.bin": b"\0" * 10, "a.cfg": b"profileCfg nonsense"},
    ],
)
def test_hostile_files_leave_one_line_and_the_server_alive(page: TestClient, files: dict[str, bytes]):
    own = session(page)
    answer = upload(page, own, files)
    assert answer.status_code == 422
    assert 0 < len(answer.json()["error"]) <= 500
    assert generated(page, own)[0]["frames"] == 20


def test_a_session_takes_what_was_prepared_for_it_along():
    service = Service()
    ours, other = service.sessions.open(), service.sessions.open()
    ours.radars["mine"] = ("mine.json", PRESETS["awr1843"])
    for one, radar in ((ours, "mine"), (other, "awr1843")):
        service.live(one, {**WALK, "radar": radar})
    service.end(ours)
    assert [key[1] for key in service._weavers] == ["awr1843"]
    service.sessions.end_all()


def test_uploads_are_taken_with_the_session(page: TestClient):
    own = session(page)
    upload(page, own, {"photo.png": b"alone"})
    with page.websocket_connect(f"{HOST.replace('http', 'ws')}/api/presence?session={own['x-session']}"):
        pass
    assert page.post("/api/generate", json=WALK, headers=own).status_code == 422


def test_live_waits_for_the_page(page: TestClient):
    own = session(page)
    with page.websocket_connect(f"{HOST.replace('http', 'ws')}/api/live?session={own['x-session']}") as socket:
        socket.send_json(WALK)
        first, _ = unpack(socket.receive_bytes())
        second, _ = unpack(socket.receive_bytes())
        socket.send_json({"ack": 0})
        third, _ = unpack(socket.receive_bytes())
    assert first["live"]["first_frame"] < second["live"]["first_frame"] < third["live"]["first_frame"]


def test_the_arrays_of_a_room_are_complete(page: TestClient):
    header, arrays = unpack(page.get("/api/room/demo", headers=session(page)).content)
    assert header["planes"]
    assert len(arrays["room_points"]) == len(arrays["room_uv"]) > arrays["room_faces"].max()
    assert Image.open(io.BytesIO(arrays["room_photo"].tobytes()), formats=["JPEG"]).size == (640, 480)


@pytest.mark.parametrize("method", ["auto", "physics"])
def test_rays_of_a_frame_lead_to_the_person(page: TestClient, method: str):
    own = session(page)
    header, arrays = generated(page, own, method=method)
    _, found = unpack(page.get(f"/api/rays/{header['result']}?frame=4", headers=own).content)
    kind, level_dbm, length_m, _, azimuth_rad, _ = found["ray_facts"].T
    assert (np.diff(level_dbm) <= 0).all()
    pelvis_m = arrays["joints"][0, 4, 0]
    body = kind == 3
    assert np.median(np.abs(length_m[body] / 2 - np.linalg.norm(pelvis_m))) < 0.4
    assert abs(np.median(azimuth_rad[body]) - np.arctan2(pelvis_m[0], pelvis_m[1])) < 0.2
    corners_m = found["ray_points"][kind == 6]
    sides_m = np.linalg.norm(np.diff(corners_m, axis=1), axis=-1).sum(axis=1)  # there, over the room, and back
    np.testing.assert_allclose(sides_m, length_m[kind == 6], rtol=1e-3)
    assert page.get(f"/api/rays/{header['result']}?frame=99", headers=own).status_code == 422


def test_a_landmark_and_a_range_window_belong_to_the_request(page: TestClient):
    own = session(page)
    wants_door = {**WALK, "text": ["a person walks to the door"]}
    more = {"landmark": ["door=0.6,2.4"], "range": [0.7, 4.5]}
    header, _ = generated(page, own, **{**wants_door, **more})
    assert math.dist(header["meta"]["person"]["ends_at_m"], (0.6, 2.4)) < 1.2
    assert 4.4 < header["range_m"][1] < 4.6
    assert "--landmark=door=0.6,2.4 --range 0.7,4.5" in header["command"]
