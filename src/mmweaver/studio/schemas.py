"""The page's form: checked JSON, and the same request as a command line and as Python."""

import shlex
from dataclasses import fields, replace
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.options import Place, command_words, option, option_name, options, options_of, read_value
from mmweaver.weaver.request import Request

MAX_TEXT = 500
MAX_PATH = 200
MAX_PATH_CHARACTERS = 20_000  # of a path that is given as words
DEFAULT_BOARD = "typical:0"  # one board for all seeds, so that a prepared room stays valid
_OF_REQUEST = ("text", "seed", "at", "path")


@options
class Form(Request):
    """A request with what it is made with: names, or ids of what the session brought."""

    room: str = option("the room", default="")
    radar: str = option("the radar", default="awr1843")
    board_name: str = option("the board", default=DEFAULT_BOARD, name="board")
    method: str = option("the method", default="auto")
    recogniser: str | None = option("whose labels Live shows")
    motion_id: str | None = option("a motion that the session brought", name="motion")
    range_m: tuple[float, float] | None = option("the range window in metres", name="range")
    landmark: list[tuple[str, Place]] | None = option("where doors, windows and tables are, for example door=0.9,2.8")

    @classmethod
    def of(cls, body: Any) -> "Form":
        """Checks the JSON of a form.

        Raises:
            InputError: With the reason.
        """
        if not isinstance(body, dict):
            raise InputError("a request is a JSON object with room and text")
        own = vars(cls)["__annotations__"]
        path, most = body.get("path"), {list: MAX_PATH, str: MAX_PATH_CHARACTERS}
        if isinstance(path, list | str) and len(path) > most[type(path)]:  # before anything reads them
            raise InputError(f"a path is a list of 2 to {MAX_PATH} places")
        known = {option_name(one): one for one in options_of(cls) if one.name in own or option_name(one) in _OF_REQUEST}
        given = {name: body[name] for name in known if body.get(name) not in (None, "", [])}
        asked = cls(**{known[name].name: read_value(known[name], value) for name, value in given.items()})
        if not asked.text or any(len(one) > MAX_TEXT for one in asked.text):
            raise InputError(f"text is a sentence of at most {MAX_TEXT} characters, or a list with one for each person")
        if not 0 <= asked.seed < 2**31:
            raise InputError("the seed must be a whole number from 0 to 2147483647")
        if asked.path_m is not None and not 2 <= len(asked.path_m) <= MAX_PATH:
            raise InputError(f"a path is a list of 2 to {MAX_PATH} places")
        return asked

    @property
    def request(self) -> Request:
        """The request alone, for one person or several, the first of whom start at the given places."""
        text: list[Any] = list(self.text or ())
        places: list[Any] = list(self.at or ())[: len(text)]
        is_one = len(text) == 1
        at: Any = places + [None] * (len(text) - len(places)) if places else None
        return Request(
            text=text[0] if is_one else text, at=at[0] if at and is_one else at, path_m=self.path_m, seed=self.seed
        )

    def command(
        self, room_options: list[str], *, radar: str | None = None, board: str | None = None, motion: str | None = None
    ) -> str:
        """The request as a command line.

        Args:
            room_options: Options that read the room.
            radar: Uploaded radar file, if any.
            board: Uploaded board file, if any.
            motion: Uploaded motion file, if any.
        """
        words = ["mmweaver", "generate", *room_options, *command_words(replace(self.request, text=self.text))]
        words += [] if motion is None else ["--motion", motion]
        words += [f"--landmark={kind}={x:g},{y:g}" for kind, (x, y) in self.landmark or ()]
        words += [] if self.range_m is None else ["--range", f"{self.range_m[0]:g},{self.range_m[1]:g}"]
        words += ["--radar", radar or self.radar, "--board", board or self.board_name, "--method", self.method]
        return shlex.join([*words, "--out", "result"])

    def python(
        self, room_call: str, *, radar: str | None = None, board: str | None = None, motion: str | None = None
    ) -> str:
        """The request as Python.

        Args:
            room_call: Call of `Weaver` that reads the room.
            radar: Uploaded radar file, if any.
            board: Uploaded board file, if any.
            motion: Uploaded motion file, if any.
        """
        request = replace(self.request, board=board or self.board_name)
        given = {one.name: getattr(request, one.name) for one in fields(Request)}
        arguments = "".join(
            f", {one.name}={given[one.name]!r}"
            for one in fields(Request)
            if one.name != "text" and given[one.name] != one.default
        )
        if motion is not None:
            arguments += f", motion=weaver.read_motion({motion!r})"
        name, marks = repr(radar or self.radar), self.landmark or ()
        imports = ""
        if self.range_m is not None:
            near_m, far_m = self.range_m
            name = f"with_range(load_radar({name}), {near_m:g}, {far_m:g})"
            imports = (
                "from mmweaver.core.range_window import with_range\nfrom mmweaver.io.radar_file import load_radar\n"
            )
        placed = f".with_landmarks({', '.join(map(repr, marks))})" if marks else ""
        return (
            f"from mmweaver import Weaver\n{imports}\n"
            f"weaver = Weaver(method={self.method!r}, radar={name})\n"
            f"room = weaver.{room_call}{placed}\n"
            f"result = weaver.generate(room, {request.text!r}{arguments})\n"
            'result.save("result")\n'
        )
