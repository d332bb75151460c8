"""Sentences read by a language model: a small server answers rightly, wrongly, slowly and hostilely."""

import json
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.model_parser import KEY_VARIABLE, MAX_ANSWER_BYTES, named_parser, schema, url_parser
from mmweaver.motion.language.plan import NOT_DONE, Side

TEXT = "the lady promenades leftwards, afterwards greets thrice"
RIGHT = {
    "steps": [
        {"lower": "walk", "direction": "left", "words": ["the lady promenades leftwards"]},
        {"lower": "stand", "upper": "wave", "count": 3, "words": ["greets", "thrice"]},
    ],
    "not_shown": ["afterwards"],
}
Answer = Callable[[BaseHTTPRequestHandler, dict[str, Any], int], None]


def said(content: Any, **more: Any) -> bytes:
    content = content if isinstance(content, str) else json.dumps(content)
    return json.dumps({"choices": [{"message": {"content": content}}], "system_fingerprint": "fp_1", **more}).encode()


@contextmanager
def server(answer: Answer) -> Iterator[tuple[str, list[dict[str, Any]]]]:
    """An OpenAI-compatible server on this machine, and the requests that it got."""
    asked: list[dict[str, Any]] = []

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
            asked.append({**body, "path": self.path, "key": self.headers.get("Authorization")})
            answer(self, body, len(asked))

        def log_message(self, format: str, *args: Any) -> None:
            pass

    own = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=own.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{own.server_port}/v1", asked
    finally:
        own.shutdown()
        own.server_close()


def sends(*bodies: bytes) -> Answer:
    """Answers with one body after the other, then with the last one again."""

    def answer(handler: BaseHTTPRequestHandler, _: dict[str, Any], number: int) -> None:
        body = bodies[min(number, len(bodies)) - 1]
        handler.send_response(200)
        handler.end_headers()
        handler.wfile.write(body)

    return answer


def with_step(**fields: Any) -> dict[str, Any]:
    return {**RIGHT, "steps": [{**RIGHT["steps"][0], **fields}, RIGHT["steps"][1]]}


def test_a_right_answer_becomes_a_plan_and_is_asked_for_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv(KEY_VARIABLE, "secret")
    with server(sends(said(RIGHT))) as (url, asked):
        plans = [url_parser(f"{url}#small", cache=tmp_path)(TEXT, in_part=True) for _ in range(2)]
    assert [(step.lower, step.upper, step.direction, step.count) for step in plans[0].steps] == [
        ("walk", "", Side.LEFT, 0), ("stand", "wave", None, 3),
    ]  # fmt: skip
    assert [record.status for record in plans[0].clauses] == ["done", "done", NOT_DONE]
    assert plans[0].steps == plans[1].steps
    (request,) = asked  # the second plan came from the cache
    assert (request["model"], request["key"], request["path"]) == ("small", "Bearer secret", "/v1/chat/completions")
    form = request["response_format"]["json_schema"]["schema"]["properties"]["steps"]["items"]["properties"]
    assert set(form["lower"]["enum"]) | set(form["upper"]["enum"]) == {*BY_KEY, ""}
    assert "small" in plans[0].notes[-1]
    assert "fp_1" in plans[0].notes[-1]
    assert "secret" not in "".join(file.read_text() for file in tmp_path.iterdir())


def test_a_wrong_answer_is_sent_back_with_the_reason():
    with server(sends(said("no idea"), said(with_step(lower="fly")), said(RIGHT))) as (url, asked):
        assert len(url_parser(url)(TEXT, in_part=True).steps) == 2
    assert len(asked) == 3
    assert "fly" in asked[2]["messages"][-1]["content"]


@pytest.mark.parametrize(
    "answer",
    [
        "no json",
        [],
        {"steps": [], "not_shown": []},
        {**RIGHT, "run": "rm -rf"},
        with_step(lower="fly"),
        with_step(direction="up"),
        with_step(distance_m=1e9),
        with_step(distance_m="2"),
        with_step(count=True),
        with_step(count=7),  # the sentence has no seven
        with_step(words=["dances"]),  # nor a dance
        with_step(words=[]),
        with_step(exec="import os"),
        {**RIGHT, "not_shown": []},  # 'afterwards' is nowhere
        {**RIGHT, "steps": RIGHT["steps"] * 100},
        "[" * 50_000,
    ],
)
def test_what_does_not_validate_is_refused_after_three_tries(answer: Any, tmp_path: Path):
    with server(sends(said(answer))) as (url, asked), pytest.raises(InputError, match="no usable answer"):
        url_parser(url, cache=tmp_path)(TEXT)
    assert len(asked) == 3
    assert not list(tmp_path.iterdir())


def _trickles(handler: BaseHTTPRequestHandler, _: dict[str, Any], __: int) -> None:
    handler.send_response(200)
    handler.end_headers()
    for _ in range(40):
        try:
            handler.wfile.write(b" ")
            handler.wfile.flush()
        except OSError:
            return
        time.sleep(0.05)


def _waits(handler: BaseHTTPRequestHandler, _: dict[str, Any], __: int) -> None:
    time.sleep(1.0)
    handler.close_connection = True


def _redirects(handler: BaseHTTPRequestHandler, _: dict[str, Any], __: int) -> None:
    handler.send_response(302)
    handler.send_header("Location", "http://127.0.0.1:9/stolen")
    handler.end_headers()


def _fails(handler: BaseHTTPRequestHandler, _: dict[str, Any], __: int) -> None:
    handler.send_error(500)


@pytest.mark.parametrize(
    "answer",
    [
        _trickles,
        _waits,
        _redirects,
        _fails,
        sends(b"x" * (MAX_ANSWER_BYTES + 10)),
        sends(b"{}"),
        sends(said("")[:-3]),
    ],
)
def test_slow_and_hostile_servers_cost_one_line_and_little_time(answer: Answer):
    began = time.monotonic()
    with server(answer) as (url, asked), pytest.raises(InputError, match="gave no answer"):
        url_parser(url, timeout_s=0.4)(TEXT)
    assert len(asked) == 1
    assert time.monotonic() - began < 5


def test_who_reads_is_a_url_a_folder_or_a_plug_in(tmp_path: Path):
    for name in ("file:///etc/passwd", "ftp://host/v1", "nowhere", "os:nothing", str(tmp_path / "none")):
        with pytest.raises(InputError, match="--parser"):
            named_parser(name)


def test_a_damaged_answer_in_the_cache_is_asked_for_again(tmp_path: Path):
    with server(sends(said(RIGHT))) as (url, asked):
        parser = url_parser(url, cache=tmp_path)
        parser(TEXT, in_part=True)
        for file in tmp_path.iterdir():
            file.write_text(json.dumps({"answer": with_step(lower="fly")}))
        assert url_parser(url, cache=tmp_path)(TEXT, in_part=True).steps[0].lower == "walk"
    assert len(asked) == 2


def test_the_schema_has_no_entry_that_steps_lack():
    assert schema()["properties"]["steps"]["items"]["additionalProperties"] is False
