"""What the page asks for: JSON, checked, and the same request as a command line and as Python."""

import shlex
from dataclasses import dataclass
from math import isfinite
from typing import Any

from mmweaver.core.errors import InputError

MAX_TEXT = 500
MAX_PATH = 200
DEFAULT_BOARD = "typical:0"  # one board for all seeds, so that what is prepared for the room stays valid


@dataclass(frozen=True, kw_only=True)
class Asked:
    """One request of the page."""

    room: str
    text: tuple[str, ...]
    radar: str = "awr1843"
    board: str = DEFAULT_BOARD
    method: str = "auto"
    seed: int = 0
    at: tuple[float, float] | None = None
    path: tuple[tuple[float, float], ...] | None = None  # corners of the walk on the floor
    recogniser: str | None = None  # whose labels Live shows
    motion: str | None = None  # id of a motion that the session brought

    @classmethod
    def of(cls, body: Any) -> "Asked":
        """Checks the JSON. Raises InputError with what is wrong."""
        if not isinstance(body, dict):
            raise InputError("a request is a JSON object with room and text")
        texts = body.get("text")
        texts = [texts] if isinstance(texts, str) else texts
        if not isinstance(texts, list) or not texts or not all(isinstance(one, str) for one in texts):
            raise InputError("text must be a sentence, or a list with one for each person")
        if any(len(one) > MAX_TEXT for one in texts):
            raise InputError(f"a sentence has at most {MAX_TEXT} characters")
        seed = body.get("seed", 0)
        if isinstance(seed, bool) or not isinstance(seed, int) or not 0 <= seed < 2**31:
            raise InputError("the seed must be a whole number from 0 to 2147483647")
        at, path = body.get("at"), body.get("path")
        return cls(
            room=_word(body, "room", ""), text=tuple(texts), radar=_word(body, "radar", "awr1843"),
            board=_word(body, "board", DEFAULT_BOARD),
            method=_word(body, "method", "auto"), seed=seed, at=None if at is None else _place(at),
            path=None if path is None else _path(path), motion=_word(body, "motion", "") or None,
            recogniser=_word(body, "recogniser", "") or None,
        )  # fmt: skip

    @property
    def request(self) -> dict[str, Any]:
        """The arguments of `Weaver.generate` besides room, motion and board."""
        at = self.at if self.at is None or len(self.text) == 1 else [self.at] + [None] * (len(self.text) - 1)
        text = self.text[0] if len(self.text) == 1 else list(self.text)
        return {"text": text, "seed": self.seed, "at": at} | ({"path_m": self.path} if self.path else {})

    def command(
        self, room_options: list[str], *, radar: str | None = None, board: str | None = None, motion: str | None = None
    ) -> str:
        """The same as a command line; `radar`, `board` and `motion` name the files that the session brought."""
        words = ["mmweaver", "generate", *room_options]
        for text in self.text:
            words += ["--text", text]
        if self.at is not None:
            words.append(f"--at={self.at[0]:g},{self.at[1]:g}")
        if self.path is not None:
            words.append("--path=" + " ".join(f"{x:g},{y:g}" for x, y in self.path))
        if motion is not None:
            words += ["--motion", motion]
        words += ["--radar", radar or self.radar, "--board", board or self.board]
        words += ["--method", self.method, "--seed", str(self.seed), "--out", "result"]
        return shlex.join(words)

    def python(
        self, room_call: str, *, radar: str | None = None, board: str | None = None, motion: str | None = None
    ) -> str:
        """The same as Python; `radar`, `board` and `motion` name the files that the session brought."""
        arguments = f", board={board or self.board!r}" + "".join(
            f", {name}={value!r}" for name, value in self.request.items() if name != "text" and value is not None
        )
        if motion is not None:
            arguments += f", motion=weaver.read_motion({motion!r})"
        return (
            "from mmweaver import Weaver\n\n"
            f"weaver = Weaver(method={self.method!r}, radar={(radar or self.radar)!r})\n"
            f"room = weaver.{room_call}\n"
            f"result = weaver.generate(room, {self.request['text']!r}{arguments})\n"
            'result.save("result")\n'
        )


def _word(body: dict[str, Any], name: str, default: str) -> str:
    value = body.get(name) or default
    if not isinstance(value, str) or len(value) > 100:
        raise InputError(f"{name} must be a short word")
    return value


def _place(value: Any) -> tuple[float, float]:
    is_number = isinstance(value, list) and all(
        isinstance(one, int | float) and not isinstance(one, bool) and isfinite(one) for one in value
    )
    if not is_number or len(value) != 2:
        raise InputError("a place is two numbers: metres right of and ahead of the radar")
    return float(value[0]), float(value[1])


def _path(value: Any) -> tuple[tuple[float, float], ...]:
    if not isinstance(value, list) or not 2 <= len(value) <= MAX_PATH:
        raise InputError(f"a path is a list of 2 to {MAX_PATH} places")
    return tuple(_place(one) for one in value)
